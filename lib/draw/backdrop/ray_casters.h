/* This header leaves out the objects that hide no light from the surfaces in a strip of the
 * picture. These surfaces lie in a box along the axes of the world. The box is swept towards a
 * light, and what the swept box does not meet, hides nothing. The bounds are generous: what is left
 * out hides no more of a light than rounding would. */
#ifndef KILN_DRAW_BACKDROP_RAY_CASTERS_H
#define KILN_DRAW_BACKDROP_RAY_CASTERS_H

#include "draw/backdrop/ray_shapes.h"

/* m, and as a part of coordinates: more than rays start off surfaces, and than rounding displaces.
 */
#define CASTER_MARGIN   0.01f
#define CASTER_ROUNDING 1e-5f

/* How much wider than a light's disc its cone is taken to be. Strips that bound the covers of
 * shapes cross beside their corners, and maps of meshes are blurred. */
#define CASTER_WIDER      1.5f
#define CASTER_MESH_WIDER 4.0f

/* Lamps: half of the edges of the box in which the cone from a place ends, which is at least
 * CASTER_NEAR away, as a part of the lamp's extent. The cone goes on behind the lamp's middle, and
 * still widens there, as far as parts of the lamp do. */
#define CASTER_END  3.2f
#define CASTER_NEAR 3.0f

/* A box that moves, and grows, towards a light: at t its middle is center + t * way, and half of
 * its edges are half + t * grow. */
struct swept_box {
    float center[3], half[3], way[3], grow[3];
    float last; /* t goes from 0 to this */
};

/* Makes a box around the points of vectors. */
struct lit_vectors {
    struct vf3 from, to;
};

SIMD struct lit_vectors no_lit_vectors(void)
{
    const vf most = vf_all(3e38f);
    return (struct lit_vectors){{most, most, most}, {-most, -most, -most}};
}

SIMD void add_lit(struct lit_vectors *lit, struct vf3 at, vi active)
{
    const struct vf3 from = {vf_min(lit->from.x, at.x), vf_min(lit->from.y, at.y),
                             vf_min(lit->from.z, at.z)};
    const struct vf3 to = {vf_max(lit->to.x, at.x), vf_max(lit->to.y, at.y),
                           vf_max(lit->to.z, at.z)};
    lit->from = vf3_select(active, from, lit->from);
    lit->to = vf3_select(active, to, lit->to);
}

static struct kiln_lit_box lit_box_of(const struct lit_vectors *lit)
{
    const vf from[3] = {lit->from.x, lit->from.y, lit->from.z};
    const vf to[3] = {lit->to.x, lit->to.y, lit->to.z};
    struct kiln_lit_box box;
    for (int k = 0; k < 3; k++) {
        box.from[k] = from[k][0];
        box.to[k] = to[k][0];
        for (int i = 1; i < LANES; i++) {
            box.from[k] = from[k][i] < box.from[k] ? from[k][i] : box.from[k];
            box.to[k] = to[k][i] > box.to[k] ? to[k][i] : box.to[k];
        }
    }
    return box;
}

static struct swept_box swept_from(const struct kiln_lit_box *box)
{
    struct swept_box swept = {.last = 1.0f};
    for (int k = 0; k < 3; k++) {
        swept.center[k] = 0.5f * (box->from[k] + box->to[k]);
        swept.half[k] = 0.5f * (box->to[k] - box->from[k]) + CASTER_MARGIN +
                        CASTER_ROUNDING * fabsf(swept.center[k]);
    }
    return swept;
}

/* Returns how far parts of a lamp are from its centre, m; of a rectangle, also where its disc is
 * lifted above a horizon (lamp_way_to). */
static float lamp_extent(const struct kiln_draw_light *lamp)
{
    const float4 right = lamp->right, up = lamp->up;
    if (lamp->facing.w != KILN_LAMP_RECTANGLE)
        return lamp->color.w;
    return lamp->color.w + sqrtf(right.x * right.x + right.y * right.y + right.z * right.z) +
           sqrtf(up.x * up.x + up.y * up.y + up.z * up.z);
}

/* Returns whether a lamp is so near to a box that its light comes from everywhere. */
static bool is_near_lamp(const struct kiln_lit_box *box, float4 lamp, float extent)
{
    const float at[3] = {lamp.x, lamp.y, lamp.z};
    float square = 0.0f;
    for (int k = 0; k < 3; k++) {
        const float aside = fmaxf(fmaxf(box->from[k] - at[k], at[k] - box->to[k]), 0.0f);
        square += aside * aside;
    }
    const float near = CASTER_NEAR * extent + CASTER_MARGIN;
    return square <= near * near;
}

/* Returns the way to a lamp, where the box ends as one around the lamp. */
static struct swept_box sweep_to_lamp(const struct kiln_lit_box *box, float4 lamp, float extent)
{
    struct swept_box swept = swept_from(box);
    const float to[3] = {lamp.x, lamp.y, lamp.z};
    for (int k = 0; k < 3; k++) {
        swept.way[k] = to[k] - swept.center[k];
        swept.grow[k] =
            CASTER_END * extent + CASTER_MARGIN + CASTER_ROUNDING * fabsf(to[k]) - swept.half[k];
    }
    return swept;
}

/* Returns the way to the sun. spread: by which the box grows, m per m. */
static struct swept_box sweep_to_sun(const struct kiln_lit_box *box, float4 direction, float spread)
{
    struct swept_box swept = swept_from(box);
    const float way[3] = {direction.x, direction.y, direction.z};
    for (int k = 0; k < 3; k++) {
        swept.way[k] = way[k];
        swept.grow[k] = spread;
    }
    swept.last = 3e38f;
    return swept;
}

/* Returns the lanes of bounds, from `first` on, that a swept box meets. On each axis and at each
 * side, they meet where t * speed >= gap. */
SIMD vi sweep_meets(const struct swept_box *swept, const struct kiln_object_bounds *bounds,
                    int first)
{
    vf from = vf_all(0.0f), to = vf_all(swept->last);
    vi apart = vi_all(0);
    for (int k = 0; k < 3; k++) {
        const vf aside = vf_load(bounds->center[k] + first) - swept->center[k];
        const vf room = vf_load(bounds->half[k] + first) + swept->half[k];
        const vf gaps[2] = {aside - room, -aside - room};
        const float speeds[2] = {swept->grow[k] + swept->way[k], swept->grow[k] - swept->way[k]};
        for (int side = 0; side < 2; side++) {
            const float speed = speeds[side];
            if (speed > 1e-12f)
                from = vf_max(from, gaps[side] * (1.0f / speed));
            else if (speed < -1e-12f)
                to = vf_min(to, gaps[side] * (1.0f / speed));
            else
                apart |= gaps[side] > 0.0f;
        }
    }
    return ~apart & (from <= to);
}

/* Returns a bit for each of some bounds that a swept box meets. begin, end: multiples of 16. */
SIMD uint64_t find_met(const struct swept_box *swept, const struct kiln_object_bounds *bounds,
                       int begin, int end)
{
    uint64_t met = 0;
    for (int i = begin; i < end; i += LANES)
        met |= (uint64_t)(uint32_t)vi_bits(sweep_meets(swept, bounds, i)) << (i - begin);
    return met;
}

/* Returns the trimmed set of those shapes that a swept box meets. */
SIMD struct kiln_shape_set find_shapes_met(const struct kiln_shape_set *shapes,
                                           const struct swept_box *swept,
                                           const struct kiln_object_bounds *bounds)
{
    struct kiln_shape_set met;
    met.count = shapes->count;
    for (uint32_t i = 0; i < shapes->count; i++) {
        const int first = 32 * (int)i;
        met.words[i] = shapes->words[i];
        if (met.words[i])
            met.words[i] &= (uint32_t)find_met(swept, bounds, first, first + 32);
    }
    kiln_shape_set_trim(&met);
    return met;
}

/* Finds what may hide lights from points in a box. */
SIMD struct kiln_casters find_casters(const struct kiln_ray_frame *frame,
                                      const struct kiln_lit_box *box)
{
    struct kiln_casters casters;
    const struct kiln_draw_backdrop *b = frame->backdrop;
    const struct kiln_shape_set none = kiln_shape_set_empty(0);
    casters.sun_objects = none;
    casters.sun_meshes = 0;
    for (uint32_t i = 0; i < b->counts.y; i++)
        casters.lamps[i] = none;
    if (!(box->from[0] <= box->to[0]))
        return casters;
    const struct kiln_casters *all = frame->all_casters;
    const struct kiln_object_bounds *bounds = frame->object_bounds;
    const float spread = frame->shapes->sun_right.w;
    if (kiln_shape_set_any(&all->sun_objects)) {
        const struct swept_box swept = sweep_to_sun(box, b->sun_direction, CASTER_WIDER * spread);
        casters.sun_objects = find_shapes_met(&all->sun_objects, &swept, bounds);
    }
    if (all->sun_meshes) {
        const struct swept_box swept =
            sweep_to_sun(box, b->sun_direction, CASTER_MESH_WIDER * spread);
        const int end = KILN_BOUNDS_MESHES + ((int)frame->shapes->counts.z + 15) / 16 * 16;
        casters.sun_meshes = all->sun_meshes & find_met(&swept, bounds, KILN_BOUNDS_MESHES, end);
    }
    for (uint32_t i = 0; i < b->counts.y; i++) {
        const float4 lamp = b->lights[i].position_radius2;
        const float extent = lamp_extent(&b->lights[i]);
        casters.lamps[i] = all->lamps[i];
        if (!kiln_shape_set_any(&all->lamps[i]) || is_near_lamp(box, lamp, extent))
            continue;
        const struct swept_box swept = sweep_to_lamp(box, lamp, extent);
        casters.lamps[i] = find_shapes_met(&all->lamps[i], &swept, bounds);
    }
    return casters;
}

#endif
