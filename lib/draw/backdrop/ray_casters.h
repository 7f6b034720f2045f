/* This header leaves out the objects that hide no light from the surfaces in a strip of the
 * picture. These surfaces lie in a box along the axes of the world. The box is swept towards a
 * light, and what the swept box does not meet, hides nothing. All bounds are generous, so that
 * nothing changes but time. */
#ifndef KILN_DRAW_BACKDROP_RAY_CASTERS_H
#define KILN_DRAW_BACKDROP_RAY_CASTERS_H

#include "draw/backdrop/ray_shapes.h"

/* m, and as a part of coordinates: more than rays start off surfaces, and than rounding displaces.
 */
#define CASTER_MARGIN   0.01f
#define CASTER_ROUNDING 1e-5f

/* How many times as wide as the sun a mesh's penumbra may be, which is blurred. */
#define CASTER_BLUR 4.0f

/* A box around points that get light, m; from > to: there are none. */
struct lit_box {
    float from[3], to[3];
};

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

static struct lit_box lit_box_of(const struct lit_vectors *lit)
{
    const vf from[3] = {lit->from.x, lit->from.y, lit->from.z};
    const vf to[3] = {lit->to.x, lit->to.y, lit->to.z};
    struct lit_box box;
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

static struct swept_box swept_from(const struct lit_box *box)
{
    struct swept_box swept = {.last = 1.0f};
    for (int k = 0; k < 3; k++) {
        swept.center[k] = 0.5f * (box->from[k] + box->to[k]);
        swept.half[k] = 0.5f * (box->to[k] - box->from[k]) + CASTER_MARGIN +
                        CASTER_ROUNDING * fabsf(swept.center[k]);
    }
    return swept;
}

/* Returns the way to a lamp, where the box ends as one around the lamp. */
static struct swept_box sweep_to_lamp(const struct lit_box *box, const struct kiln_draw_light *lamp)
{
    struct swept_box swept = swept_from(box);
    const float4 at = lamp->position_radius2;
    const float to[3] = {at.x, at.y, at.z};
    for (int k = 0; k < 3; k++) {
        swept.way[k] = to[k] - swept.center[k];
        swept.grow[k] =
            lamp->color.w + CASTER_MARGIN + CASTER_ROUNDING * fabsf(to[k]) - swept.half[k];
    }
    return swept;
}

/* Returns the way to the sun. spread: by which the box grows, m per m. */
static struct swept_box sweep_to_sun(const struct lit_box *box, float4 direction, float spread)
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
SIMD vi sweep_meets(const struct swept_box *swept, const struct kiln_caster_bounds *bounds,
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
SIMD uint32_t find_met(const struct swept_box *swept, const struct kiln_caster_bounds *bounds,
                       int begin, int end)
{
    uint32_t met = 0;
    for (int i = begin; i < end; i += LANES)
        met |= (uint32_t)vi_bits(sweep_meets(swept, bounds, i)) << (i - begin);
    return met;
}

/* Finds what may hide lights from points in a box. */
SIMD struct kiln_casters find_casters(const struct kiln_ray_frame *frame, const struct lit_box *box)
{
    struct kiln_casters casters = {.sun_objects = 0};
    if (!(box->from[0] <= box->to[0]))
        return casters;
    const struct kiln_draw_backdrop *b = frame->backdrop;
    const struct kiln_casters *all = frame->all_casters;
    const struct kiln_caster_bounds *bounds = frame->caster_bounds;
    const float spread = frame->shapes->sun_right.w;
    if (all->sun_objects) {
        const struct swept_box swept = sweep_to_sun(box, b->sun_direction, spread);
        casters.sun_objects = all->sun_objects & find_met(&swept, bounds, 0, KILN_CASTER_MESHES);
    }
    if (all->sun_meshes) {
        const struct swept_box swept = sweep_to_sun(box, b->sun_direction, CASTER_BLUR * spread);
        casters.sun_meshes =
            all->sun_meshes & find_met(&swept, bounds, KILN_CASTER_MESHES, KILN_CASTER_ROOM);
    }
    for (uint32_t i = 0; i < b->counts.y; i++) {
        if (!all->lamps[i])
            continue;
        const struct swept_box swept = sweep_to_lamp(box, &b->lights[i]);
        casters.lamps[i] = all->lamps[i] & find_met(&swept, bounds, 0, KILN_CASTER_MESHES);
    }
    return casters;
}

#endif
