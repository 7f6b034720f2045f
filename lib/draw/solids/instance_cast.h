/* This header casts rays at particles that are meshes: it finds the nearest triangle in each sample
 * of a pixel, and computes the light of each visible triangle. In a pixel, a triangle has one depth
 * and one colour, as a sphere has. Both are taken on the ray through the pixel's middle, or at the
 * triangle's edge where that ray misses the triangle. solid_simd.c includes it. */
#ifndef KILN_DRAW_SOLIDS_INSTANCE_CAST_H
#define KILN_DRAW_SOLIDS_INSTANCE_CAST_H

#include "draw/solids/opaque_ray.h"
#include "shared/exact.h"

static inline bool is_instance(const struct kiln_solid_strip *s, uint32_t number)
{
    return s->instances && s->instances[number].triangles > 0;
}

/* Returns the first corner of a triangle, in floats. */
static inline int32_t corner_of(const struct kiln_solid_strip *s, uint32_t number,
                                uint32_t triangle)
{
    return (int32_t)((s->instances[number].first + 3 * triangle) * 8);
}

/* ---- samples --------------------------------------------------------------------------------- */

/* Holds a triangle in view space. Its edges are linear functions of a ray (u, v, -1), as factors of
 * u, v and 1. A ray hits the triangle where none of the three is negative; there they are
 * proportional to the weights of the corners. */
struct cast_triangle {
    float edges[3][3];
    float depth[3];             /* view depths of the corners, m */
    struct kiln_row_range x, y; /* columns and rows that it may touch */
};

/* Transforms a corner from the mesh to view space, m. */
static inline float3 cast_corner(const struct kiln_drawn_instance *instance, float4 at)
{
    const float(*rows)[4] = instance->to_view;
    return (float3){rows[0][0] * at.x + rows[0][1] * at.y + rows[0][2] * at.z + rows[0][3],
                    rows[1][0] * at.x + rows[1][1] * at.y + rows[1][2] * at.z + rows[1][3],
                    rows[2][0] * at.x + rows[2][1] * at.y + rows[2][2] * at.z + rows[2][3]};
}

/* Rounds a position to the subpixel grid on which GL places corners (GL_SUBPIXEL_BITS). Otherwise,
 * for objects a few pixels large, one sample in a hundred would be covered here and not in GL.
 * place: px from the principal point, which is on that grid; floats are finest near 0. */
static inline float cast_snap(float place)
{
    return floorf(place * 256.0f + 0.5f) * (1.0f / 256.0f);
}

/* Bounds the pixels that a triangle may touch; a triangle whose corners are all nearer than the
 * near plane touches none. Snaps the other corners to GL's subpixel grid. */
static inline void cast_bounds(const struct kiln_view *view, float3 p[3], struct cast_triangle *t)
{
    const float4 frustum = view->frustum;
    float x[2] = {1e9f, -1e9f}, y[2] = {1e9f, -1e9f};
    int corners_beyond = 0;
    for (int k = 0; k < 3; k++) {
        t->depth[k] = -p[k].z;
        if (!(t->depth[k] >= view->eye.w))
            continue;
        float m_right = 2.0f * frustum.x * t->depth[k] / frustum.z; /* m a pixel */
        float m_up = 2.0f * frustum.y * t->depth[k] / frustum.w;
        float right = cast_snap(p[k].x / m_right), up = cast_snap(p[k].y / m_up);
        float column = view->principal.x + right, row = view->principal.y - up;
        p[k].x = right * m_right;
        p[k].y = up * m_up;
        x[0] = exact_min(x[0], column);
        x[1] = exact_max(x[1], column);
        y[0] = exact_min(y[0], row);
        y[1] = exact_max(y[1], row);
        corners_beyond++;
    }
    bool crosses_near = corners_beyond > 0 && corners_beyond < 3;
    /* A triangle that reaches the near plane may be anywhere in the picture. */
    const float margin = crosses_near ? 1e9f : KILN_RANGE_MARGIN;
    t->x = kiln_row_range_between(x[0] - margin, x[1] + margin, frustum.z);
    t->y = kiln_row_range_between(y[0] - margin, y[1] + margin, frustum.w);
    if (corners_beyond == 0)
        t->y = (struct kiln_row_range){0, 0};
}

/* Returns the plane through an edge and the eye. With a and b exchanged it is exactly the same
 * plane times -1, so that no ray passes between two triangles that share an edge. */
static inline float3 cast_side(float3 a, float3 b)
{
    bool swap = a.x > b.x || (a.x == b.x && (a.y > b.y || (a.y == b.y && a.z > b.z)));
    float3 from = swap ? b : a, to = swap ? a : b;
    return float3_scale(float3_cross(from, float3_sub(to, from)), swap ? -1.0f : 1.0f);
}

/* Computes the triangle's edge functions; returns false for a triangle that is seen edge-on. */
static inline bool cast_edges(const float3 p[3], struct cast_triangle *t)
{
    float3 face = float3_cross(float3_sub(p[1], p[0]), float3_sub(p[2], p[0]));
    float volume = float3_dot(p[0], face), sign = volume < 0.0f ? -1.0f : 1.0f;
    float size2 = float3_dot(face, face) * float3_dot(p[0], p[0]);
    if (!(volume * volume > 1e-10f * size2))
        return false;
    for (int k = 0; k < 3; k++) {
        float3 side = float3_scale(cast_side(p[(k + 1) % 3], p[(k + 2) % 3]), sign);
        t->edges[k][0] = side.x;
        t->edges[k][1] = side.y;
        t->edges[k][2] = -side.z;
    }
    return true;
}

SIMD vf cast_edge(const float plane[3], vf u, vf v)
{
    return plane[0] * u + (plane[1] * v + plane[2]);
}

/* Updates the samples of LANES pixels of a row, from column x on, where the triangle is nearest.
 * Samples that it does not change are stored, too: a branch would often be foreseen wrongly. */
SIMD void cast_pixels(const struct kiln_solid_strip *s, const struct cast_triangle *t,
                      int32_t number, int32_t triangle, uint32_t row, int32_t x)
{
    vf column = vf_count() + ((float)x + 0.5f), zero = vf_all(0.0f);
    float line = (float)(s->y + row) + 0.5f;
    const struct vf3 middle = view_ray(s->frame, column, vf_all(line));
    vf a = vf_max(cast_edge(t->edges[0], middle.x, middle.y), zero);
    vf b = vf_max(cast_edge(t->edges[1], middle.x, middle.y), zero);
    vf c = vf_max(cast_edge(t->edges[2], middle.x, middle.y), zero), sum = a + b + c;
    vf depth = (a * t->depth[0] + b * t->depth[1] + c * t->depth[2]) / vf_max(sum, vf_all(1e-30f));
    vi visible = (sum > 0.0f) & (depth >= s->frame->view->eye.w) & (column < (float)t->x.to);
    size_t at = (size_t)row * KILN_SOLID_SAMPLES * s->pitch + (size_t)x;
    if (!any(visible))
        return;
    for (int k = 0; k < KILN_SOLID_SAMPLES; k++, at += s->pitch) {
        const struct vf3 ray =
            view_ray(s->frame, column + SAMPLE_OFFSETS[k][0], vf_all(line + SAMPLE_OFFSETS[k][1]));
        vf before = vf_load(s->samples + at);
        vi nearer = visible & (depth < before) & (cast_edge(t->edges[0], ray.x, ray.y) >= 0.0f) &
                    (cast_edge(t->edges[1], ray.x, ray.y) >= 0.0f) &
                    (cast_edge(t->edges[2], ray.x, ray.y) >= 0.0f);
        float *numbers = (float *)(void *)(s->nearest + at);
        float *triangles = (float *)(void *)(s->triangles + at);
        vf_store(s->samples + at, vf_select(nearer, depth, before));
        vf_store(numbers, (vf)vi_select(nearer, vi_all(number), (vi)vf_load(numbers)));
        vf_store(triangles, (vf)vi_select(nearer, vi_all(triangle), (vi)vf_load(triangles)));
    }
}

static void sample_triangle(const struct kiln_solid_strip *s, uint32_t number, uint32_t triangle)
{
    const struct kiln_drawn_instance *instance = &s->instances[number];
    const float4(*corners)[2] = s->corners + instance->first + (size_t)3 * triangle;
    struct cast_triangle t;
    float3 p[3] = {cast_corner(instance, corners[0][0]), cast_corner(instance, corners[1][0]),
                   cast_corner(instance, corners[2][0])};
    cast_bounds(s->frame->view, p, &t);
    int32_t y = t.y.from > (int32_t)s->y ? t.y.from : (int32_t)s->y;
    int32_t y_to = t.y.to < (int32_t)s->y_to ? t.y.to : (int32_t)s->y_to;
    if (y >= y_to || t.x.from >= t.x.to || !cast_edges(p, &t))
        return;
    for (; y < y_to; y++) {
        for (int32_t x = t.x.from; x < t.x.to; x += LANES)
            cast_pixels(s, &t, (int32_t)number, (int32_t)triangle, (uint32_t)y - s->y, x);
    }
}

static void sample_instance(const struct kiln_solid_strip *s, uint32_t number)
{
    for (uint32_t i = 0; i < s->instances[number].triangles; i++)
        sample_triangle(s, number, i);
}

/* ---- light ----------------------------------------------------------------------------------- */

/* Transforms a direction from the mesh to view space, or a position relative to its middle. */
SIMD struct vf3 cast_to_view(const struct vf3 rows[3], struct vf3 v)
{
    return (struct vf3){vf3_dot(rows[0], v), vf3_dot(rows[1], v), vf3_dot(rows[2], v)};
}

SIMD struct vf3 cast_cross(struct vf3 a, struct vf3 b)
{
    return (struct vf3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* Returns a corner's weight on the ray, times a factor that is the same for all three corners; 0
 * instead of a negative weight. a, b: the two other corners. */
SIMD vf cast_weight(struct vf3 a, struct vf3 b, struct vf3 ray, vf sign)
{
    vf part = vf3_dot(cast_cross(a, vf3_sub(b, a)), ray) * sign;
    return vf_max(part, vf_all(0.0f));
}

SIMD struct vf3 cast_mean(const struct vf3 of[3], const vf parts[3])
{
    return vf3_add_scaled(vf3_add_scaled(vf3_scale(of[0], parts[0]), of[1], parts[1]), of[2],
                          parts[2]);
}

/* Computes the colours of a vector of visible triangles in row y, one a lane. */
static void light_triangles(const struct kiln_solid_strip *s,
                            const struct visible_particles *visible, uint32_t y,
                            struct ray_color *color)
{
    const struct kiln_ray_frame *frame = s->frame;
    const struct kiln_drawn_instance *all = s->instances;
    const float *corners = &s->corners[0][0].x;
    const struct vf3 ray = view_ray(frame, vf_of(visible->column) + 0.5f, vf_all((float)y + 0.5f));
    struct vf3 rows[3], p[3], normals[3];
    for (int i = 0; i < 3; i++)
        rows[i] = gather3(all->to_view[i], visible->particle);
    const struct vf3 center = {vf_gather(&all->to_view[0][3], visible->particle),
                               vf_gather(&all->to_view[1][3], visible->particle),
                               vf_gather(&all->to_view[2][3], visible->particle)};
    for (size_t k = 0; k < 3; k++) {
        p[k] = vf3_add(cast_to_view(rows, gather3(corners + 8 * k, visible->corner)), center);
        normals[k] = gather3(corners + 8 * k + 4, visible->corner);
    }
    struct vf3 face = cast_cross(vf3_sub(p[1], p[0]), vf3_sub(p[2], p[0]));
    vi away = vf3_dot(face, p[0]) > 0.0f;
    vf sign = vf_select(away, vf_all(1.0f), vf_all(-1.0f));
    vf parts[3] = {cast_weight(p[1], p[2], ray, sign), cast_weight(p[2], p[0], ray, sign),
                   cast_weight(p[0], p[1], ray, sign)};
    vf scale = 1.0f / vf_max(parts[0] + parts[1] + parts[2], vf_all(1e-30f));
    for (int k = 0; k < 3; k++)
        parts[k] *= scale;
    struct vf3 point = cast_mean(p, parts);
    struct vf3 normal = cast_to_view(rows, cast_mean(normals, parts));
    vi behind = vf3_dot(normal, face) * sign > 0.0f; /* both sides of a triangle are visible */
    normal = vf3_normalize(vf3_scale(normal, vf_select(behind, vf_all(-1.0f), vf_all(1.0f))));

    struct visible_point place = {.depth = -point.z,
                                  .lit = vf_gather(&all->lit, visible->particle),
                                  .albedo = gather3(all->albedo, visible->particle),
                                  .glow = gather3(all->glow, visible->particle)};
    place.direction = view_to_world(frame, ray);
    place.normal = view_to_world(frame, normal);
    place.at = vf3_add(vf3_all(frame->view->eye), view_to_world(frame, point));
    place.middle = vf3_add(vf3_all(frame->view->eye), view_to_world(frame, center));
    /* The ray to the sun starts past the particle's middle, so that the sphere that stands for the
     * particle in shadows does not shade the particle itself. */
    const float4 sun = frame->backdrop->sun_direction;
    vf ahead = vf3_dot_all(view_to_world(frame, vf3_sub(center, point)), sun);
    vf out = ahead + 0.05f * vf_gather(&all->shade, visible->particle) + 1e-5f * place.depth;
    place.sun_from = vf3_add_scaled(place.at, vf3_all(sun), vf_max(out, vf_all(0.0f)));
    light_place(frame, &place, visible, color);
}

#endif
