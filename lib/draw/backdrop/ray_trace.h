/* This header describes rays from the eye, and declares what follows them to what they hit. That is
 * code of its own for each level of vectors (ray_trace_simd.c), since several loops call it. */
#ifndef KILN_DRAW_BACKDROP_RAY_TRACE_H
#define KILN_DRAW_BACKDROP_RAY_TRACE_H

#include "base/simd.h"
#include "draw/backdrop/ray_shapes.h"

/* Describes rays from the eye that belong to one layer of hits. */
struct ray_place {
    vf u, v;   /* the ray is (u, v, -1) in view space */
    vi hit;    /* index of the pixel in the meshes' hits, in layer 0 */
    int layer; /* layer of hits; -1: the rays are not from the eye */
};

/* Holds rays from the eye through pixels. */
struct eye_rays {
    struct ray ray;
    struct ray_place place;
};

SIMD struct eye_rays rays_at(const struct kiln_ray_frame *frame, const struct ray_place *place)
{
    const float4 *rows = frame->view->world_to_view;
    vf u = place->u, v = place->v;
    return (struct eye_rays){
        .ray = {.origin = vf3_all(frame->view->eye),
                .direction = {rows[0].x * u + rows[1].x * v - rows[2].x,
                              rows[0].y * u + rows[1].y * v - rows[2].y,
                              rows[0].z * u + rows[1].z * v - rows[2].z}},
        .place = *place,
    };
}

/* Returns the rays through the centres of pixels. */
SIMD struct eye_rays rays_through_pixels(const struct kiln_ray_frame *frame, vi column, vi row)
{
    const float4 frustum = frame->view->frustum, principal = frame->view->principal;
    vf x = vf_of(column) + 0.5f, y = vf_of(row) + 0.5f;
    struct ray_place place = {
        .u = (x * (2.0f / frustum.z) - 1.0f) * frustum.x - principal.z,
        .v = (1.0f - y * (2.0f / frustum.w)) * frustum.y - principal.w,
    };
    if (frame->meshes)
        place.hit = row * (int32_t)(KILN_HIT_LAYERS * frame->meshes->pitch) + column;
    return rays_at(frame, &place);
}

/* Returns the rays through a sample of pixels. at: the rays through the centres of the same
 * pixels. */
SIMD struct ray_place sample_place(const struct kiln_ray_frame *frame, const struct ray_place *at,
                                   int sample)
{
#define PAIR(x, y)                                                                                 \
    {                                                                                              \
        x, y                                                                                       \
    }
    static const float offsets[KILN_EDGE_SAMPLES][2] = {KILN_EDGE_OFFSETS(PAIR)};
#undef PAIR
    const float4 frustum = frame->view->frustum;
    float right = (offsets[sample][0] - 0.5f) * 2.0f * frustum.x / frustum.z;
    float down = (offsets[sample][1] - 0.5f) * 2.0f * frustum.y / frustum.w;
    return (struct ray_place){at->u + right, at->v - down, at->hit, 1 + sample};
}

/* Finds the first hit of each ray. floor: the t at which each ray meets the floor; the albedo of
 * hits on the floor is left unset. */
void KILN_SIMD_NAME(kiln_rays_trace)(const struct kiln_ray_frame *frame,
                                     const struct kiln_shape_set *shapes, const struct ray *ray,
                                     const vf *floor, const struct ray_place *place,
                                     struct ray_hit *found);

SIMD struct ray_hit trace(const struct kiln_ray_frame *frame, const struct kiln_shape_set *shapes,
                          const struct ray *ray, vf floor, const struct ray_place *place)
{
    struct ray_hit nearest;
    KILN_SIMD_NAME(kiln_rays_trace)(frame, shapes, ray, &floor, place, &nearest);
    return nearest;
}

/* Marks edges inside a mesh, where it hides itself or bends, in the surface's number, and sets
 * *surface to that. middle: what the rays through the centres of pixels hit. */
void KILN_SIMD_NAME(kiln_rays_mark_edges)(const struct kiln_ray_frame *frame,
                                          const struct ray_place *at, const struct ray_hit *middle,
                                          vf *surface);

#endif
