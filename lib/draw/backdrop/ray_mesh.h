/* This header computes where vectors of rays hit meshes, from triangles that meshes_cpu.c
 * rasterised beforehand. */
#ifndef KILN_DRAW_BACKDROP_RAY_MESH_H
#define KILN_DRAW_BACKDROP_RAY_MESH_H

#include "base/compress.h"
#include "draw/backdrop/ray_picture.h"
#include "draw/backdrop/ray_trace.h"

/* The room for samples of LANES pixels; whole vectors are written behind the last one. */
enum { SIDE_ROOM = (KILN_EDGE_SAMPLES + 1) * LANES };

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

/* Reads depth and normal of a triangle. Both sides of it are visible; the normal is turned to the
 * side that faces the eye. */
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

/* Holds the derivatives by u and v of a value that is linear on a triangle. */
struct ray_derivative {
    vf u, v;
};

SIMD struct ray_derivative find_derivative(const float *plane, const float *nearness, vi uvs,
                                           vi triangle, vf value, vf depth)
{
    return (struct ray_derivative){
        (vf_gather(plane, uvs) - value * vf_gather(nearness, triangle)) * depth,
        (vf_gather(plane + 1, uvs) - value * vf_gather(nearness + 1, triangle)) * depth};
}

/* Puts the paint over the mesh's own colour. The mip level follows from the area of the texture
 * that a pixel covers: the area that its derivatives span, or the square of half of the longer one
 * if that is more. */
SIMD struct vf3 add_paint(const struct kiln_ray_frame *frame, const struct ray_place *at,
                          const struct ray_mesh_hit *found, vi active, struct vf3 albedo)
{
    const struct kiln_mesh_view *meshes = frame->meshes;
    const int stride = (int)(sizeof *meshes->triangles / sizeof(float));
    const int uvs_stride = (int)(sizeof *meshes->uvs / sizeof(float));
    vi triangle = vi_select(found->triangle >= 0, found->triangle * stride, vi_all(0));
    vi uvs = vi_select(found->triangle >= 0, found->triangle * uvs_stride, vi_all(0));
    const float *nearness = meshes->triangles->nearness;
    vf u = read_plane(meshes->uvs->u, uvs, at) * found->depth;
    vf v = read_plane(meshes->uvs->v, uvs, at) * found->depth;
    const float4 frustum = frame->view->frustum;
    const float right = 2.0f * frustum.x / frustum.z, down = 2.0f * frustum.y / frustum.w;
    struct ray_derivative of_u =
        find_derivative(meshes->uvs->u, nearness, uvs, triangle, u, found->depth);
    struct ray_derivative of_v =
        find_derivative(meshes->uvs->v, nearness, uvs, triangle, v, found->depth);
    vf area = vf_abs(of_u.u * of_v.v - of_u.v * of_v.u) * (right * down);
    vf across = (of_u.u * of_u.u + of_v.u * of_v.u) * (right * right);
    vf along = (of_u.v * of_u.v + of_v.v * of_v.v) * (down * down);
    vf square = vf_max(area, vf_max(across, along) * 0.25f);
    vf level = vf_log2(vf_min(vf_max(square, vf_all(1e-12f)), vf_all(1e12f))) * 0.5f;
    for (int lane = 0; lane < LANES; lane++) {
        const struct kiln_pyramid *paint = active[lane] ? meshes->paint[found->mesh[lane]] : NULL;
        if (!paint)
            continue;
        const struct ray_levels levels =
            choose_levels(paint, level[lane] + (float)(paint->levels - 1));
        const ray_texel texel =
            read_picture(paint, &levels, fraction(u[lane]), fraction(v[lane]), true);
        const float left = 1.0f - texel[3];
        albedo.x[lane] = albedo.x[lane] * left + texel[0];
        albedo.y[lane] = albedo.y[lane] * left + texel[1];
        albedo.z[lane] = albedo.z[lane] * left + texel[2];
    }
    return albedo;
}

/* Returns the number of a mesh as a surface. */
SIMD vf surface_of_mesh(const struct kiln_ray_frame *frame, vi mesh)
{
    return vf_of(mesh * 4 + (int32_t)frame->shapes->counts.y);
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
    nearest->surface = vf_select(nearer, surface_of_mesh(frame, found.mesh), nearest->surface);
    nearest->normal = vf3_select(nearer, found.normal, nearest->normal);
    struct vf3 albedo = {vf_gather(colors, index), vf_gather(colors + 1, index),
                         vf_gather(colors + 2, index)};
    if (frame->meshes->uvs)
        albedo = add_paint(frame, at, &found, nearer, albedo);
    nearest->albedo = vf3_select(nearer, albedo, nearest->albedo);
}

/* Holds what samples beside the centres of LANES pixels hit, without gaps. */
struct side_hits {
    int count;
    float u[SIDE_ROOM], v[SIDE_ROOM];
    int32_t triangle[SIDE_ROOM];
    int32_t lane[SIDE_ROOM]; /* number of the sample's pixel, 0 to LANES - 1 */
};

/* Adds a sample of each pixel in the lanes of a mask. */
SIMD void add_side_hits(struct side_hits *hits, vi mask, vi triangle, const struct ray_place *at)
{
    const struct selection selected = selection_of(mask);
    vf_compress(hits->u + hits->count, selected, at->u);
    vf_compress(hits->v + hits->count, selected, at->v);
    vi_compress(hits->triangle + hits->count, selected, triangle);
    vi_compress(hits->lane + hits->count, selected, vi_count());
    hits->count += selected.count;
}

/* Returns the pixels with a sample on another mesh than their centre, at another depth, or with
 * another normal. middle: what the rays through the centres hit. */
SIMD vi find_bends(const struct kiln_ray_frame *frame, struct side_hits *hits,
                   const struct ray_hit *middle)
{
    _Alignas(64) float t[LANES], surface[LANES], normal[3][LANES];
    _Alignas(64) int32_t bends[LANES] = {0}, found[LANES];
    vf_store(t, middle->t);
    vf_store(surface, middle->surface);
    vf_store(normal[0], middle->normal.x);
    vf_store(normal[1], middle->normal.y);
    vf_store(normal[2], middle->normal.z);
    const vi none = vi_all(0); /* fills the lanes of the last vector that have no sample */
    memcpy(hits->triangle + hits->count, &none, sizeof none);
    memcpy(hits->lane + hits->count, &none, sizeof none);
    vf_store(hits->u + hits->count, vf_all(0.0f));
    vf_store(hits->v + hits->count, vf_all(0.0f));
    for (int i = 0; i < hits->count; i += LANES) {
        const struct ray_place at = {.u = vf_load(hits->u + i), .v = vf_load(hits->v + i)};
        const struct ray_mesh_hit hit = find_mesh(frame->meshes, vi_load(hits->triangle + i), &at);
        const vi lane = vi_load(hits->lane + i);
        const vf depth = vf_gather(t, lane);
        const struct vf3 of_middle = {vf_gather(normal[0], lane), vf_gather(normal[1], lane),
                                      vf_gather(normal[2], lane)};
        const vi bent = (surface_of_mesh(frame, hit.mesh) != vf_gather(surface, lane)) |
                        (vf_abs(hit.depth - depth) > 0.01f * depth) |
                        (vf3_dot(hit.normal, of_middle) < 0.95f);
        memcpy(found, &bent, sizeof found);
        for (int k = 0; k < LANES && i + k < hits->count; k++)
            bends[hits->lane[i + k]] |= found[k];
    }
    return vi_load(bends);
}

#endif
