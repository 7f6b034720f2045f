/* This file finds what vectors of rays hit: objects, meshes, and the floor. */
#include "draw/backdrop/ray_mesh.h"
#include "draw/backdrop/ray_trace.h"

void KILN_SIMD_NAME(kiln_rays_trace)(const struct kiln_ray_frame *frame,
                                     const struct kiln_shape_set *shapes, const struct ray *ray,
                                     const vf *floor, const struct ray_place *place,
                                     struct ray_hit *found)
{
    struct ray_hit nearest = {.t = vf_all(RAY_FAR),
                              .surface = vf_all(-1.0f),
                              .normal = {vf_all(0.0f), vf_all(1.0f), vf_all(0.0f)},
                              .albedo = {{0}, {0}, {0}}};
    trace_shapes(frame, shapes, ray, &nearest);
    if (frame->meshes && place->layer >= 0)
        trace_meshes(frame, place, &nearest);
    vi below = *floor < nearest.t;
    const struct vf3 up = {vf_all(0.0f), vf_all(1.0f), vf_all(0.0f)};
    nearest.t = vf_select(below, *floor, nearest.t);
    nearest.surface = vf_where(~below, nearest.surface);
    nearest.normal = vf3_select(below, up, nearest.normal);
    *found = nearest;
}

void KILN_SIMD_NAME(kiln_rays_mark_edges)(const struct kiln_ray_frame *frame,
                                          const struct ray_place *at, const struct ray_hit *middle,
                                          vf *surface)
{
    *surface = middle->surface;
    const vi seen = *surface >= (float)frame->shapes->counts.y;
    if (!any(seen))
        return;
    const vi center = read_hit(frame->meshes, at, 0);
    vi edge = vi_all(0);
    struct side_hits hits;
    hits.count = 0;
    for (int s = 0; s < KILN_EDGE_SAMPLES; s++) {
        const struct ray_place aside = sample_place(frame, at, s);
        const vi triangle = read_hit(frame->meshes, &aside, aside.layer);
        const vi other = seen & (triangle != center);
        edge |= other & (triangle < 0);
        add_side_hits(&hits, other & (triangle >= 0), triangle, &aside);
    }
    if (hits.count > 0)
        edge |= find_bends(frame, &hits, middle);
    *surface += vf_where(edge, vf_all(0.25f * KILN_EDGE_MARK));
}
