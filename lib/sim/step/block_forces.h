/* Sums up the forces on a block of places in vectors: on particles (slots_simd.c), and at the
 * points of a baked wind (bake_simd.c). The functions compute the bits of forces_sum
 * (shaders/shared/forces.h). */
#ifndef KILN_SIM_STEP_BLOCK_FORCES_H
#define KILN_SIM_STEP_BLOCK_FORCES_H

#include "sim/step/slots_block.h"

static inline void find_values(const struct kiln_sim *sim, struct kiln_value v,
                               const struct kiln_block *b, float *y)
{
    kiln_lanes_values(sim->value_keys, v, &b->clocks, y);
}

static inline void find_values3(const struct kiln_sim *sim, struct kiln_value3 v,
                                const struct kiln_block *b, struct kiln_floats3 *y)
{
    find_values(sim, v.x, b, y->x);
    find_values(sim, v.y, b, y->y);
    find_values(sim, v.z, b, y->z);
}

static inline struct force_input input_at(const struct kiln_sim *sim, const struct kiln_block *b,
                                          uint32_t i, uint32_t force)
{
    const struct force_values values = {
        .vector = kiln_get3(&b->vector, i),
        .second = kiln_get3(&b->second, i),
        .strength = b->strength[i],
        .pull = b->pulling[i],
        .quadratic = b->braking[i],
        .scale = b->scale[i],
    };
    return force_input_of(sim, force, kiln_get3(&b->at, i), values);
}

static inline struct force_effect effect_at(const struct kiln_block *b, uint32_t i)
{
    return (struct force_effect){kiln_get3(&b->acceleration, i), b->pull[i], b->quadratic[i]};
}

static inline void clear_sum(struct kiln_block *b)
{
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        kiln_set3(&b->acceleration, i, (float3){0.0f, 0.0f, 0.0f});
        b->pull[i] = 0.0f;
        b->quadratic[i] = 0.0f;
    }
}

static inline void add_effect(struct kiln_block *b, uint32_t i, struct force_effect effect)
{
    struct force_effect sum = forces_add(effect_at(b, i), effect);
    kiln_set3(&b->acceleration, i, sum.acceleration);
    b->pull[i] = sum.pull;
    b->quadratic[i] = sum.quadratic;
}

/* Computes force_curl of all lanes, one octave after the other. */
static inline void add_curl(const struct kiln_sim *sim, struct kiln_block *b, uint32_t number)
{
    const uint32_t seed = sim->step->noise_seed, octaves = sim->step->forces[number].octaves;
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        kiln_set3(&b->place, i, force_curl_place(input_at(sim, b, i, number)));
        kiln_set3(&b->curl, i, (float3){0.0f, 0.0f, 0.0f});
    }
    for (uint32_t octave = 0; octave < octaves && octave < NOISE_OCTAVES; octave++) {
        for (uint32_t i = 0; i < KILN_LANES; i++)
            kiln_set3(
                &b->curl, i,
                noise_curl_add(kiln_get3(&b->curl, i), kiln_get3(&b->place, i), seed, octave));
    }
    for (uint32_t i = 0; i < KILN_LANES; i++)
        add_effect(b, i, force_air(input_at(sim, b, i, number), kiln_get3(&b->curl, i)));
}

/* Two samples that lie side by side along x. */
typedef float kiln_sample_pair __attribute__((vector_size(32)));
typedef float kiln_sample __attribute__((vector_size(16)));

/* Loads samples `first` and `first` + 1. */
static inline void load_pair(kiln_sample_pair *pair, const float4 *words, uint32_t first)
{
    memcpy(pair, words + first, sizeof *pair);
}

/* Looks up the grid of a baked wind as force_baked does, for both neighbours along x at once. */
static inline float4 look_up(const float4 *words, const struct kiln_grid *grid, uint32_t first,
                             float part_x, float part_y, float part_z)
{
    const uint32_t row = grid->size.x, layer = grid->size.x * grid->size.y;
    kiln_sample_pair low, above_low, high, above_high;
    load_pair(&low, words, first);
    load_pair(&above_low, words, first + row);
    load_pair(&high, words, first + layer);
    load_pair(&above_high, words, first + layer + row);
    const kiln_sample_pair before = low + (above_low - low) * part_y,
                           after = high + (above_high - high) * part_y,
                           column = before + (after - before) * part_z;
    kiln_sample left, right;
    memcpy(&left, &column, sizeof left);
    memcpy(&right, (const char *)&column + sizeof left, sizeof right);
    const kiln_sample y = left + (right - left) * part_x;
    return FLOAT4(y[0], y[1], y[2], y[3]);
}

/* Computes force_baked of all lanes: first where they are in the grid, then what it holds there. */
static inline void add_baked(const struct kiln_sim *sim, struct kiln_block *b, uint32_t number)
{
    const struct kiln_grid grid = sim->surroundings->grids[sim->step->forces[number].grid];
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        const float3 at = force_field_place(input_at(sim, b, i, number));
        const struct grid_place place = grid_find(grid, at);
        b->sample[i] = grid_index(grid, place.x.first, place.y.first, place.z.first);
        kiln_set3(&b->place, i, (float3){place.x.part, place.y.part, place.z.part});
    }
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        const float4 sampled = look_up(sim->grid_words, &grid, b->sample[i], b->place.x[i],
                                       b->place.y[i], b->place.z[i]);
        kiln_set3(&b->curl, i, (float3){sampled.x, sampled.y, sampled.z});
        b->braking[i] = sampled.w;
    }
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        const float3 sampled = kiln_get3(&b->curl, i);
        add_effect(b, i, baked_effect(FLOAT4(sampled.x, sampled.y, sampled.z, b->braking[i])));
    }
}

/* Adds the effect of one force to each lane. */
#define ADD_EFFECT(effect)                                                                         \
    for (uint32_t i = 0; i < KILN_LANES; i++)                                                      \
    add_effect(b, i, effect)

/* Takes the places of all lanes into the node of the present force. */
static inline void enter_node(struct kiln_block *b, const struct kiln_still_frame frame,
                              uint32_t kind)
{
    b->kept_at = b->at;
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        kiln_set3(&b->at, i, still_frame_inside(frame, kiln_get3(&b->at, i)));
        b->scale[i] = forces_size(kind, b->scale[i], frame.at.w);
    }
}

static inline void add_force(const struct kiln_sim *sim, struct kiln_block *b, uint32_t number)
{
    const struct kiln_force_params *force = &sim->step->forces[number];
    find_values3(sim, force->vector, b, &b->vector);
    find_values(sim, force->strength, b, b->strength);
    find_values3(sim, force->second, b, &b->second);
    find_values(sim, force->pull, b, b->pulling);
    find_values(sim, force->quadratic, b, b->braking);
    find_values(sim, force->scale, b, b->scale);
    if (still_frame_is(force->frame))
        enter_node(b, force->frame, force->kind);
    switch (force->kind) {
    case FORCE_GRAVITY:
        ADD_EFFECT(force_gravity(input_at(sim, b, i, number)));
        break;
    case FORCE_DRAG:
        ADD_EFFECT(force_drag(input_at(sim, b, i, number)));
        break;
    case FORCE_WIND:
        ADD_EFFECT(force_wind(input_at(sim, b, i, number)));
        break;
    case FORCE_CURL:
        add_curl(sim, b, number);
        break;
    case FORCE_FIELD:
        ADD_EFFECT(force_field(sim, input_at(sim, b, i, number)));
        break;
    case FORCE_BAKED:
        add_baked(sim, b, number);
        break;
#define FORCES_ROW(id, function)                                                                   \
    case id:                                                                                       \
        ADD_EFFECT(function(input_at(sim, b, i, number)));                                         \
        break;
        FORCES_MORE(FORCES_ROW)
#undef FORCES_ROW
    default:
        break;
    }
}

/* Puts the sum of the forces aside, so that the next force is summed up alone. */
static inline void keep_sum(struct kiln_block *b)
{
    b->kept_acceleration = b->acceleration;
    memcpy(b->kept_pull, b->pull, sizeof b->pull);
    memcpy(b->kept_quadratic, b->quadratic, sizeof b->quadratic);
    clear_sum(b);
}

/* Brings the places back to the world, and turns the effects out of the node. */
static inline void leave_node(struct kiln_block *b, const struct kiln_still_frame frame)
{
    b->at = b->kept_at;
    for (uint32_t i = 0; i < KILN_LANES; i++)
        kiln_set3(&b->acceleration, i, float3_turn(frame.turn, kiln_get3(&b->acceleration, i)));
}

/* Leaves of the present force what acts at each lane's place. */
static inline void fade(struct kiln_block *b, const struct kiln_force_params *force)
{
    const uint region = force->region;
    const float4 center = force->region_center, size = force->region_size;
    const struct kiln_still_frame frame = force->region_frame;
    if (still_frame_is(frame)) {
        for (uint32_t i = 0; i < KILN_LANES; i++)
            kiln_set3(&b->place, i, still_frame_inside(frame, kiln_get3(&b->at, i)));
    } else {
        b->place = b->at;
    }
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        const float weight = force_region_weight(kiln_get3(&b->place, i), region, center, size);
        const struct force_effect faded = force_region_fade(effect_at(b, i), weight);
        kiln_set3(&b->acceleration, i, faded.acceleration);
        b->pull[i] = faded.pull;
        b->quadratic[i] = faded.quadratic;
    }
}

/* Adds a force that stands apart to the sum that was put aside, as forces_apart does. */
static inline void add_apart(struct kiln_block *b, const struct kiln_force_params *force)
{
    if (still_frame_is(force->frame))
        leave_node(b, force->frame);
    if (force->region != REGION_NONE)
        fade(b, force);
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        const struct force_effect effect = effect_at(b, i);
        kiln_set3(&b->acceleration, i, kiln_get3(&b->kept_acceleration, i));
        b->pull[i] = b->kept_pull[i];
        b->quadratic[i] = b->kept_quadratic[i];
        add_effect(b, i, effect);
    }
}

/* Both ways to integrate call this, so it is not inlined into them: it is most of their code. */
__attribute__((flatten, noinline)) static void
add_forces(const struct kiln_sim *sim, struct kiln_block *b, const struct kiln_floats3 *velocity)
{
    b->clocks.velocity = velocity;
    clear_sum(b);
    for (uint32_t k = 0; k < sim->step->force_count; k++) {
        const bool apart = forces_stand_apart(sim, k);
        if (apart)
            keep_sum(b);
        add_force(sim, b, k);
        if (apart)
            add_apart(b, &sim->step->forces[k]);
    }
}

#endif
