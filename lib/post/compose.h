/* This header composes scene, particles and fire into one linear picture on the host. */
#ifndef KILN_POST_COMPOSE_H
#define KILN_POST_COMPOSE_H

#include "post/composite.h"

/* A pixel, RGBA. Host images need not be aligned to 16 bytes, so kiln_quad_load and kiln_quad_store
 * access them. */
typedef float kiln_quad __attribute__((vector_size(16)));
typedef float kiln_quad_unaligned __attribute__((vector_size(16), aligned(4), may_alias));

static inline kiln_quad kiln_quad_load(const float *from)
{
    return *(const kiln_quad_unaligned *)from;
}

static inline void kiln_quad_store(float *to, kiln_quad quad)
{
    *(kiln_quad_unaligned *)to = quad;
}

/* Holds the pixels of the inputs, premultiplied RGBA; `particles` and `fire` may be NULL. */
struct kiln_compose_light {
    const float *scene, *particles, *fire;
};

/* Makes the inputs' pixels available on the host. Returns false with an error on failure. */
static inline bool kiln_compose_open(struct kiln_compose_light *light, struct kiln_image *scene,
                                     struct kiln_image *particles, struct kiln_image *fire,
                                     struct kiln_error *error)
{
    *light = (struct kiln_compose_light){.scene = kiln_image_host(scene, KILN_READ, error)};
    if (particles && light->scene)
        light->particles = kiln_image_host(particles, KILN_READ, error);
    if (particles && fire && light->particles)
        light->fire = kiln_image_host(fire, KILN_READ, error);
    return light->scene && (!particles || light->particles) && (!particles || !fire || light->fire);
}

/* Composes the pixel whose first float is at index `first_float` of the images. */
static inline kiln_quad kiln_compose(const struct kiln_compose_light *light, size_t first_float)
{
    kiln_quad color = kiln_quad_load(light->scene + first_float);
    if (light->particles) {
        kiln_quad particle_color = kiln_quad_load(light->particles + first_float);
        color = particle_color + color * (1.0f - particle_color[3]);
    }
    if (light->fire) {
        kiln_quad fire_color = kiln_quad_load(light->fire + first_float);
        fire_color[3] = fire_color[3] < 1.0f ? fire_color[3] : 1.0f;
        color = fire_color + color * (1.0f - fire_color[3]);
    }
    return color;
}

#endif
