/* This header computes the part of the sky that surfaces see past the backdrop's objects. */
#ifndef KILN_DRAW_BACKDROP_RAY_SKY_H
#define KILN_DRAW_BACKDROP_RAY_SKY_H

#include "draw/backdrop/ray_shapes.h"
#include "draw/light/ray_smoke.h"
#include "shared/surface_light.h"

/* Returns the part of the sky that a shape leaves. */
SIMD vf sky_beside_shape(const struct kiln_draw_shape *shape, const struct ray_point *p)
{
    const struct vf3 towards = vf3_towards(shape->center, p->at);
    switch (shape->kind.x) {
#define SKY(KIND, name)                                                                            \
    case SHAPE_##KIND:                                                                             \
        return name##_sky(*shape, towards, p->normal);
        KILN_SHAPES(SKY)
#undef SKY
    }
    return vf_all(1.0f);
}

/* Returns the part of the sky that is seen past objects; some number in lanes that are not active.
 */
SIMD_ONCE vf sky_past_objects(const struct kiln_ray_frame *frame, const struct ray_point *p)
{
    const struct kiln_draw_shapes *shapes = frame->shapes;
    vf sky = vf_all(1.0f);
    for (uint32_t i = 0; i < shapes->counts.x; i++)
        sky *= sky_beside_shape(&shapes->shapes[i], p);
    for (uint32_t i = 0; i < shapes->counts.z; i++) {
        const struct kiln_draw_mesh *mesh = &shapes->meshes[i];
        sky *= sky_beside_mesh(vf3_towards(mesh->center, p->at), mesh->half_size, p->normal);
    }
    return vf_select(p->active, sky, vf_all(1.0f));
}

#endif
