/* Finds which particles of a block may touch a collider on their way, for slots_simd.c. It compares
 * bounding boxes of ways and colliders in vectors. A particle that touches a collider must be
 * found; a particle that is found needlessly only costs time. */
#ifndef KILN_SIM_STEP_SLOTS_TOUCHING_H
#define KILN_SIM_STEP_SLOTS_TOUCHING_H

#include "sim/step/papers/touching_depths.h"
#include "sim/step/slots_block.h"

/* Finds the lanes that may touch a half space, which has no bounding box. If it turns, all lanes
 * may. Otherwise a way touches only if one of its ends does, up to the rounding of places far from
 * the plane's centre. */
static inline void find_touching_plane(struct kiln_block *b, const struct kiln_collider *c,
                                       bool pushed)
{
    const float3 start = {c->center.x, c->center.y, c->center.z};
    const float3 end = {c->center_end.x, c->center_end.y, c->center_end.z};
    const float3 normal = {c->axis.x, c->axis.y, c->axis.z};
    const bool turns = c->spin.w != 0.0f;
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        float3 from = float3_sub(particle_position(record_at(b, i)), start);
        float3 to = float3_sub(kiln_get3(&b->position, i), end);
        float far_from = exact_abs(from.x) + exact_abs(from.y) + exact_abs(from.z);
        float far_to = exact_abs(to.x) + exact_abs(to.y) + exact_abs(to.z);
        const float away = 0.01f + (pushed ? b->radius[i] : 0.0f);
        bool above_from = float3_dot(from, normal) > away + 1e-5f * far_from;
        bool above_to = float3_dot(to, normal) > away + 1e-5f * far_to;
        b->touching[i] = (uint32_t)turns | (uint32_t) !(above_from & above_to);
    }
}

/* Finds the lanes whose way may touch a collider's box. pushed: particles have radii, by which the
 * box is larger. */
static inline void find_touching(struct kiln_block *b, const struct kiln_collider *collider,
                                 bool pushed)
{
    const struct kiln_collider c = *collider;
    if (c.kind == COLLIDER_PLANE) {
        find_touching_plane(b, &c, pushed);
        return;
    }
    const float gap = collide_bounds_gap(&c), growth = collide_bounds_growth(&c);
    for (uint32_t i = 0; i < KILN_LANES; i++)
        b->touching[i] =
            collide_is_within(&c, pushed ? b->radius[i] * growth : 0.0f, gap,
                              particle_position(record_at(b, i)), kiln_get3(&b->position, i));
    if (c.kind != COLLIDER_CYLINDER)
        return;
    for (uint32_t i = 0; i < KILN_LANES; i++)
        b->touching[i] &=
            collide_is_between_ends(&c, (pushed ? b->radius[i] : 0.0f) + gap,
                                    particle_position(record_at(b, i)), kiln_get3(&b->position, i));
}

/* Unmarks lanes that stay well above the terrain. */
static inline void find_touching_ground(const struct kiln_sim *sim, struct kiln_block *b,
                                        const struct kiln_collider *c)
{
    const struct kiln_grid grid = sim->surroundings->grids[c->grid];
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        float3 from = particle_position(record_at(b, i)), to = kiln_get3(&b->position, i);
        const float raised = sim->step->pushed ? b->radius[i] * c->steepest : 0.0f;
        b->touching[i] &= 1u ^ (uint32_t)terrain_is_clear(sim, grid, from, to, raised);
    }
}

/* Unmarks lanes that stay well away from a mesh's surface. */
static inline void find_touching_mesh(const struct kiln_sim *sim, struct kiln_block *b,
                                      const struct kiln_collider *c)
{
    const struct kiln_grid grid = sim->surroundings->grids[c->grid];
    const struct kiln_pose pose = sim->surroundings->poses[c->mesh];
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        float3 from = sdf_local(pose, 0.0f, particle_position(record_at(b, i)));
        float3 to = sdf_local(pose, 1.0f, kiln_get3(&b->position, i));
        float larger = 0.0f;
        if (sim->step->pushed)
            larger = exact_max(sdf_radius(pose, 0.0f, b->radius[i]),
                               sdf_radius(pose, 1.0f, b->radius[i]));
        b->touching[i] &= 1u ^ (uint32_t)sdf_is_clear(sim, grid, from, to, larger);
    }
}

/* Unmarks lanes that have no plane of the volume near. */
static inline void find_touching_volume(const struct kiln_sim *sim, struct kiln_block *b,
                                        const struct kiln_collider *c)
{
    const struct kiln_grid grid = sim->surroundings->grids[c->grid];
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        float3 from = particle_position(record_at(b, i)), to = kiln_get3(&b->position, i);
        b->touching[i] &= 1u ^ (uint32_t)volume_is_clear(sim, grid, from, to);
    }
}

static inline void find_touching_any(const struct kiln_sim *sim, struct kiln_block *b)
{
    const bool pushed = sim->step->pushed != 0;
    for (uint32_t k = 0; k < sim->surroundings->collider_count; k++) {
        const struct kiln_collider *c = &sim->surroundings->colliders[k];
        if (pushed)
            find_touching(b, c, true);
        else
            find_touching(b, c, false);
        if (c->kind == COLLIDER_TERRAIN)
            find_touching_ground(sim, b, c);
        else if (c->kind == COLLIDER_SDF)
            find_touching_mesh(sim, b, c);
        else if (c->kind == COLLIDER_VOLUME)
            find_touching_volume(sim, b, c);
        else if (c->kind == COLLIDER_DEPTH)
            find_touching_depths(sim, b, c);
        for (uint32_t i = 0; i < KILN_LANES; i++)
            b->alone[i] |= b->touching[i] ? ALONE_TOUCHES : ALONE_NOT;
    }
}

#endif
