/* This file makes the parameters of forces. Values that are the same for all particles become
 * constants. A force that lies in a node keeps its directions, and kernels evaluate it in the frame
 * of the node (shaders/shared/forces.h); its place and the sizes of its region are scaled here,
 * and so is nothing else but what kernels scale: radii, eddies and grids. */
#include "sim/world/force_params.h"

#include <math.h>

#include "shared/exact.h"

float kiln_sim_forces_s(const struct kiln_scene *scene, uint32_t step)
{
    const float start_s = kiln_scene_time(scene, step - 1), end_s = kiln_scene_time(scene, step);
    const bool staged = scene->integration >= KILN_INTEGRATE_TRAPEZOID;
    return staged ? 0.5f * (start_s + end_s) : start_s;
}

struct kiln_value kiln_sim_value_at(const struct kiln_sim_moment *m, struct kiln_value value)
{
    if (kiln_value_uses(m->scene->keys, &value) & KILN_VALUE_OF_PARTICLES)
        return value;
    return (struct kiln_value){.constant =
                                   kiln_scene_system_value(m->scene, m->system, &value, m->time_s)};
}

static struct kiln_value3 vector_at(const struct kiln_sim_moment *m, struct kiln_value3 value)
{
    return (struct kiln_value3){kiln_sim_value_at(m, value.x), kiln_sim_value_at(m, value.y),
                                kiln_sim_value_at(m, value.z)};
}

struct kiln_still_frame kiln_sim_frame(const struct kiln_scene *scene,
                                       const struct kiln_attach *attach, float time_s)
{
    float v[8];
    if (!attach->name)
        return (struct kiln_still_frame){.at = FLOAT4(0.0f, 0.0f, 0.0f, 0.0f)};
    const struct kiln_node_frame frame = kiln_node_frame_at(scene, attach->node, time_s, time_s);
    for (int c = 0; c < 3; c++)
        v[c] = exact_canon((float)frame.at[c]);
    v[3] = fminf(fmaxf((float)frame.scale, 0x1p-99f), 0x1p99f);
    for (int c = 0; c < 4; c++)
        v[4 + c] = exact_canon((float)frame.turn[c]);
    return (struct kiln_still_frame){.at = FLOAT4(v[0], v[1], v[2], v[3]),
                                     .turn = FLOAT4(v[4], v[5], v[6], v[7])};
}

static float3 scaled(float3 v, float scale)
{
    return float3_canon(float3_scale(v, scale));
}

/* Fills in where a force acts. scale: of the node that the region lies in. */
static void fill_region(struct kiln_force_params *params, const struct kiln_sim_moment *m,
                        const struct kiln_force_region *region, float scale)
{
    const struct kiln_scene *scene = m->scene;
    const struct kiln_value3 *center = region->sphere ? &region->ball_center : &region->box_center;
    const float3 place = kiln_scene_system_value3(scene, m->system, center, m->time_s);
    const float3 edges = kiln_scene_system_value3(scene, m->system, &region->box_size, m->time_s);
    const float radius = kiln_scene_system_value(scene, m->system, &region->radius, m->time_s);
    const float falloff = kiln_scene_system_value(scene, m->system, &region->falloff, m->time_s);
    const float3 middle = scaled(place, scale), half = scaled(edges, 0.5f * scale);
    params->region = region->sphere ? REGION_SPHERE : REGION_BOX;
    params->region_center = FLOAT4(middle.x, middle.y, middle.z, exact_canon(scale * falloff));
    params->region_size = FLOAT4(half.x, half.y, half.z, 0.0f);
    if (region->sphere)
        params->region_size = FLOAT4(exact_canon(scale * radius), 0.0f, 0.0f, 0.0f);
}

/* Lets a region lie in its own node, or else in that of its force. */
static void place_region(struct kiln_force_params *params, const struct kiln_sim_moment *m,
                         const struct kiln_force *force)
{
    const struct kiln_attach *attach =
        force->region.attach.name ? &force->region.attach : &force->attach;
    params->region_frame = kiln_sim_frame(m->scene, attach, m->time_s);
    fill_region(params, m, &force->region, attach->name ? params->region_frame.at.w : 1.0f);
}

static bool has_grid(const struct kiln_force *force)
{
    return force->kind == KILN_FORCE_FIELD || kiln_force_is_baked(force);
}

/* Lets a force lie in its node. Its place does not differ between particles, so it is constant in a
 * step. Other vectors are directions, speeds and accelerations. */
static void attach_force(struct kiln_force_params *params, const struct kiln_sim_moment *m,
                         const struct kiln_force *force)
{
    params->frame = kiln_sim_frame(m->scene, &force->attach, m->time_s);
    if (force->kind == KILN_FORCE_ATTRACT || force->kind == KILN_FORCE_VORTEX) {
        const struct kiln_value3 *at = &params->vector;
        const float3 place =
            scaled(FLOAT3(at->x.constant, at->y.constant, at->z.constant), params->frame.at.w);
        params->vector = (struct kiln_value3){
            .x = {.constant = place.x}, .y = {.constant = place.y}, .z = {.constant = place.z}};
    }
    if (has_grid(force)) /* kernels scale this to the scale of the node */
        params->scale = (struct kiln_value){.constant = 1.0f};
}

struct kiln_force_params kiln_sim_force_params(const struct kiln_sim_moment *m,
                                               const struct kiln_sim_grids *grids,
                                               const struct kiln_force *force)
{
    struct kiln_force_params params = {
        .kind = kiln_force_number(force),
        .octaves = force->octaves,
        .profile = (uint)force->profile,
        .vector = vector_at(m, force->vector),
        .second = vector_at(m, force->second),
        .strength = kiln_sim_value_at(m, force->strength),
        .pull = kiln_sim_value_at(m, force->pull),
        .quadratic = kiln_sim_value_at(m, force->quadratic),
        .scale = kiln_sim_value_at(m, force->scale),
        .inward = kiln_scene_system_value(m->scene, m->system, &force->inward, m->time_s),
        .lift = kiln_scene_system_value(m->scene, m->system, &force->lift, m->time_s),
    };
    if (has_grid(force)) {
        params.scale = (struct kiln_value){.constant = 0.0f};
        params.grid = force->kind == KILN_FORCE_FIELD ? kiln_sim_grids_find(grids, force->file)
                                                      : kiln_sim_grids_find_baked(grids, force);
    }
    if (force->mode == KILN_WIND_ADD) {
        params.added = (float)((double)m->scene->rate.num / m->scene->rate.den);
        params.pull = (struct kiln_value){.constant = 0.0f};
    }
    if (force->region.enabled)
        place_region(&params, m, force);
    if (force->attach.name)
        attach_force(&params, m, force);
    return params;
}
