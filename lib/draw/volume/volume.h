/* Stage 4c draws gas: smoke and fire of the scene's domains, by a march of rays (Heinz 2019,
 * 2.3.2). The host lights the gas, from the states of the domains, and marches in vectors, or lets
 * GL march. Pictures of the host are the same bytes on every machine; those of GL differ by
 * rounding.
 *
 * Gas hides the backdrop, objects and solid particles behind it. Other particles are blended with
 * it by the profiles of its rays (volume_profile.h), which all rasters read. */
#ifndef KILN_DRAW_VOLUME_VOLUME_H
#define KILN_DRAW_VOLUME_VOLUME_H

#include "base/footprint.h"
#include "base/thread.h"
#include "draw/light/lighting.h"
#include "draw/volume/volume_profile.h"
#include "gpu/image.h"

enum kiln_march_technique { KILN_MARCH_CPU, KILN_MARCH_GL };

struct kiln_volume_stage;

/* Names the light of gas that an image gets. */
enum kiln_volume_light_of {
    KILN_VOLUME_ALL,   /* smoke and flames */
    KILN_VOLUME_SMOKE, /* what smoke scatters, and what gas hides */
    KILN_VOLUME_FLAME, /* the light of flames alone, which hides nothing */
    KILN_VOLUME_SHINE, /* the same, which particles do not hide either */
};

/* Returns the number of domains of gas that a scene draws. */
uint32_t kiln_volume_domains(const struct kiln_scene *scene);

/* Returns whether some pixels of a domain may have no ray: KILN_GAS_HALF. */
bool kiln_volume_has_half(const struct kiln_scene *scene);

/* Creates the stage; NULL with an error. Moment and threads must outlive it. glow: whether
 * kiln_volume_add_glow will be called. */
struct kiln_volume_stage *kiln_volume_create(const struct kiln_moment *moment, bool glow,
                                             struct kiln_threads *threads,
                                             struct kiln_error *error);

/* Lets GL march the rays of a new stage, one for each pixel whatever look.resolution says. device
 * must outlive the stage. kiln_volume_draw then fails with KILN_DEVICE_FAILED, and advice in the
 * message, where the device's storage blocks are too small. */
bool kiln_volume_use_gl(struct kiln_volume_stage *stage, struct kiln_device *device,
                        struct kiln_error *error);

/* Adds the memory of the stage. Adds nothing for a scene without gas. */
void kiln_volume_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_volume_destroy(struct kiln_volume_stage **stage);

/* What a call of kiln_volume_draw draws. */
struct kiln_volume_draw {
    const struct kiln_moment *moment;
    const struct kiln_pool *pool;              /* has the gas; not the moment's pool */
    const struct kiln_draw_backdrop *backdrop; /* the sun, the sky and lamps */
    const struct kiln_lighting *lighting;      /* what is in the way of lamps; NULL: nothing */
    struct kiln_image *depth;                  /* of the scene, m */
    bool profiles;                             /* kiln_volume_profiles will be called */
    bool same; /* true: nothing but the view is other than in the last call */
    /* Gets the depth, m, at which the gas has become half opaque, as far as the scene lets it be
     * seen; 1e9 where it never does. NULL: not needed */
    struct kiln_image *halfway;
};

/* Draws gas to planes that the stage keeps. */
bool kiln_volume_draw(struct kiln_volume_stage *stage, const struct kiln_volume_draw *draw,
                      struct kiln_error *error);

/* Holds what a call of kiln_volume_draw has taken: seconds of all threads together, for a march in
 * GL those of a clock; and the work of the march. */
struct kiln_volume_costs {
    double field_s; /* copying gas to blocks */
    double light_s; /* of sun, sky and lamps */
    double glow_s;  /* the light of flames */
    double march_s;
    uint64_t rays, samples; /* rays that met gas, and places at which they were sampled */
};

/* Returns what the last call of kiln_volume_draw has taken. */
struct kiln_volume_costs kiln_volume_costs(const struct kiln_volume_stage *stage);

/* Returns the profiles of the gas that was drawn last; NULL if no gas was seen, or they were not
 * asked for. They are valid until the next call of kiln_volume_draw. */
const struct kiln_volume_profiles *kiln_volume_profiles(const struct kiln_volume_stage *stage);

/* Draws the glow of flames over an image: the gas dims the glow behind it (KILN_VOLUME_ALL), or
 * does nothing but that (KILN_VOLUME_SMOKE), or only adds its own (KILN_VOLUME_SHINE). keep: false
 * if nothing was drawn to the image before. */
bool kiln_volume_add_glow(struct kiln_volume_stage *stage, enum kiln_volume_light_of light,
                          struct kiln_image *bloom, bool keep, struct kiln_error *error);

/* Puts gas under an image of particles, premultiplied. */
bool kiln_volume_put_under(struct kiln_volume_stage *stage, enum kiln_volume_light_of light,
                           struct kiln_image *particles, struct kiln_error *error);

/* Writes the gas alone: the light of flames, dimmed by the gas before them, and the opacity of the
 * gas as alpha. Both end where the scene does. */
bool kiln_volume_write_layer(struct kiln_volume_stage *stage, struct kiln_image *image,
                             struct kiln_error *error);

#endif
