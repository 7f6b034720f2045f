/* Meshes along vectors of rays: triangles that were found beforehand (mesh_rows.h). As
 * shaders/draw/mesh_trace.glsl has it. */
#ifndef KILN_DRAW_RAY_MESH_H
#define KILN_DRAW_RAY_MESH_H

#include "draw/ray_shapes.h"

/* Rays of a layer. */
struct ray_place {
    vf u, v;   /* the ray is (u, v, -1) in view space */
    vi hit;    /* in the meshes' hits, of layer 0 */
    int layer; /* -1: other rays than those from the eye */
};

struct ray_mesh_hit {
    vi triangle; /* -1: none */
    vi mesh;
    vf depth;
    struct vf3 normal;
};

SIMD vf read_plane(const float *plane, vi triangle, const struct ray_place *at)
{
    return vf_gather(plane, triangle) * at->u + vf_gather(plane + 1, triangle) * at->v +
           vf_gather(plane + 2, triangle);
}

SIMD vi read_hit(const struct kiln_mesh_view *meshes, const struct ray_place *at, int layer)
{
    return vi_gather(meshes->hits + meshes->pitch * (size_t)layer, at->hit) - 1;
}

/* Both sides of a triangle are seen; the normal is turned to the side that faces the eye. */
SIMD struct ray_mesh_hit find_mesh(const struct kiln_mesh_view *meshes, vi triangle,
                                   const struct ray_place *at)
{
    const struct kiln_mesh_triangle *all = meshes->triangles;
    const int stride = (int)(sizeof *all / sizeof(float));
    vi index = vi_select(triangle >= 0, triangle * stride, vi_all(0));
    struct ray_mesh_hit hit = {.triangle = triangle};
    hit.depth = 1.0f / read_plane(all->nearness, index, at);
    hit.normal =
        (struct vf3){read_plane(all->normal[0], index, at), read_plane(all->normal[1], index, at),
                     read_plane(all->normal[2], index, at)};
    struct vf3 face = {vf_gather(all->face, index), vf_gather(all->face + 1, index),
                       vf_gather(all->face + 2, index)};
    vf length2 = vf_max(vf3_dot(hit.normal, hit.normal), vf_all(1e-24f));
    vf scale = vf_rsqrt(length2);
    scale = vf_select(vf3_dot(hit.normal, face) < 0.0f, -scale, scale);
    hit.normal = vf3_scale(hit.normal, scale);
    hit.mesh = vi_gather(&all->mesh, index);
    return hit;
}

SIMD void trace_meshes(const struct kiln_ray_frame *frame, const struct ray_place *at,
                       struct ray_hit *nearest)
{
    vi triangle = read_hit(frame->meshes, at, at->layer);
    if (!any(triangle >= 0))
        return;
    const struct ray_mesh_hit found = find_mesh(frame->meshes, triangle, at);
    vi nearer = (triangle >= 0) & (found.depth < nearest->t);
    if (!any(nearer))
        return;
    const float *colors = &frame->shapes->meshes[0].color.x;
    const int stride = (int)(sizeof frame->shapes->meshes[0] / sizeof(float));
    vi index = found.mesh * stride;
    nearest->t = vf_select(nearer, found.depth, nearest->t);
    nearest->surface = vf_select(nearer, vf_of(found.mesh * 4 + RAY_MESHES), nearest->surface);
    nearest->normal = vf3_select(nearer, found.normal, nearest->normal);
    const struct vf3 albedo = {vf_gather(colors, index), vf_gather(colors + 1, index),
                               vf_gather(colors + 2, index)};
    nearest->albedo = vf3_select(nearer, albedo, nearest->albedo);
}

/* The place of a sample of the same pixel. */
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

/* A mesh has edges inside, where it hides itself or bends. The surface's number changes there, and
 * so that a whole tile of edges is seen, too, it changes from pixel to pixel. */
SIMD vf mark_mesh_edges(const struct kiln_ray_frame *frame, const struct ray_place *at, vf surface,
                        vi odd)
{
    vi seen = surface >= (float)RAY_MESHES;
    if (!any(seen))
        return surface;
    vi center = read_hit(frame->meshes, at, 0), edge = vi_all(0);
    const struct ray_mesh_hit middle = find_mesh(frame->meshes, center, at);
    for (int s = 0; s < KILN_EDGE_SAMPLES; s++) {
        const struct ray_place aside = sample_place(frame, at, s);
        vi triangle = read_hit(frame->meshes, &aside, aside.layer);
        vi other = seen & (triangle != center);
        if (!any(other))
            continue;
        const struct ray_mesh_hit hit = find_mesh(frame->meshes, triangle, &aside);
        edge |= other & ((triangle < 0) | (hit.mesh != middle.mesh) |
                         (vf_abs(hit.depth - middle.depth) > 0.01f * middle.depth) |
                         (vf3_dot(hit.normal, middle.normal) < 0.95f));
    }
    return surface + vf_where(edge, vf_select(odd, vf_all(2.0f), vf_all(1.0f)));
}

#endif
