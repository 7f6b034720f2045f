/* This file steps slots on the host in blocks of vectors. Most particles fly and touch nothing in a
 * step; they are stepped stage by stage for a whole block, in loops over arrays that compilers
 * vectorise. The stages are the functions of shaders/shared, so the bits are those of
 * step_family_slot, which for systems without relations are those of step_slot. Births,
 * particles that may have met a collider, and ends of lives that leave a trace are stepped alone
 * (slots_alone.c). */
#include "shared/ride.h"
#include "sim/step/block_forces.h"
#include "sim/step/slots_touching.h"

#define STEP_SLOTS KILN_SIMD_NAME(kiln_slots_step)

/* ---- stages ---------------------------------------------------------------------------------- */

static inline void find_ages(const struct kiln_sim *sim, struct kiln_block *b)
{
    const float dt_s = sim->step->derived.dt_s;
    kiln_lanes_find_ages(&b->lanes, sim->value_keys, sim->step->derived, sim->step->step, 0.0f);
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        b->age_s[i] = b->lanes.age_s[i] - dt_s;
        b->life[i] = particle_progress(b->age_s[i], b->lanes.life_s[i]);
    }
    b->clocks = (struct kiln_lane_clocks){
        .same_time_s = forces_time_s(sim, sim->step->time_s),
        .life = b->life,
        .age_s = b->age_s,
        .position = &b->at,
        .stream = b->lanes.stream,
        .system = sim->step->derived.random_key,
        .scene = sim->step->derived.scene_key,
    };
}

static inline void limit_speed(const struct kiln_sim *sim, struct kiln_block *b,
                               struct kiln_floats3 *velocity)
{
    b->clocks.velocity = velocity;
    for (uint32_t k = 0; k < sim->step->force_count; k++) {
        const struct kiln_force_params *force = &sim->step->forces[k];
        if (force->kind != FORCE_LIMIT)
            continue;
        find_values(sim, force->strength, b, b->strength);
        for (uint32_t i = 0; i < KILN_LANES; i++)
            kiln_set3(velocity, i, force_limit_one(kiln_get3(velocity, i), b->strength[i]));
    }
}

/* Returns the number of slots in the block that begins at first_slot. */
static inline uint32_t slots_left(const struct kiln_sim *sim, uint32_t first_slot)
{
    const uint32_t left = sim->step->used - first_slot;
    return left < KILN_LANES ? left : KILN_LANES;
}

static inline void start_moving(const struct kiln_sim *sim, struct kiln_block *b,
                                uint32_t first_slot)
{
    for (uint32_t i = 0; i < KILN_LANES; i++)
        kiln_set3(&b->start, i, particle_velocity(record_at(b, i)));
    if (sim->step->carried) {
        const float4 turn = sim->step->carry.whole;
        for (uint32_t i = 0; i < KILN_LANES; i++)
            kiln_set3(&b->start, i, float3_turn(turn, kiln_get3(&b->start, i)));
    }
    if (!sim->step->pushed)
        return;
    memset(b->radius, 0, sizeof b->radius);
    for (uint32_t i = 0; i < slots_left(sim, first_slot); i++) {
        const struct step_push push = push_of(sim, first_slot + i);
        kiln_set3(&b->start, i, push_faster(push, kiln_get3(&b->start, i)));
        b->radius[i] = push.radius;
    }
}

static inline void push_on(const struct kiln_sim *sim, struct kiln_block *b, uint32_t first_slot)
{
    if (!sim->step->pushed)
        return;
    for (uint32_t i = 0; i < slots_left(sim, first_slot); i++)
        kiln_set3(&b->position, i,
                  push_farther(push_of(sim, first_slot + i), kiln_get3(&b->position, i)));
}

/* Moves all lanes on as the system's node carries them in the whole step. */
static inline void carry_on_lanes(const struct kiln_sim *sim, struct kiln_block *b)
{
    if (!sim->step->carried)
        return;
    const struct kiln_carry carry = sim->step->carry;
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        const float3 at = particle_position(record_at(b, i));
        const float3 way = float3_sub(carry_whole(carry, at), at);
        kiln_set3(&b->position, i, float3_add(kiln_get3(&b->position, i), way));
    }
}

/* Integrates all lanes over the whole step, as integrate does. */
static inline void fly(const struct kiln_sim *sim, struct kiln_block *b)
{
    const float time_s = sim->step->derived.dt_s;
    for (uint32_t i = 0; i < KILN_LANES; i++)
        kiln_set3(&b->at, i, particle_position(record_at(b, i)));
    add_forces(sim, b, &b->start);
    for (uint32_t i = 0; i < KILN_LANES; i++)
        kiln_set3(&b->velocity, i, forces_apply(effect_at(b, i), kiln_get3(&b->start, i), time_s));
    if (sim->step->forces_do & FORCES_SLOW) {
        for (uint32_t i = 0; i < KILN_LANES; i++)
            kiln_set3(&b->velocity, i,
                      forces_slow(kiln_get3(&b->velocity, i), b->quadratic[i],
                                  forces_acting_s(b->pull[i], time_s)));
    }
    if (sim->step->forces_do & FORCES_LIMIT)
        limit_speed(sim, b, &b->velocity);
    const bool position_first = sim->step->integration == INTEGRATE_POSITION_FIRST;
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        struct kiln_particle p = record_at(b, i);
        float3 before = kiln_get3(&b->start, i), after = kiln_get3(&b->velocity, i);
        float3 carrying = {position_first ? before.x : after.x, position_first ? before.y : after.y,
                           position_first ? before.z : after.z};
        kiln_set3(&b->position, i, float3_add_scaled(particle_position(p), carrying, time_s));
    }
}

static inline struct stages stages_get(const struct stages_lanes *s, uint32_t i)
{
    return (struct stages){
        .position = kiln_get3(&s->position, i),
        .velocity = kiln_get3(&s->velocity, i),
        .at = kiln_get3(&s->at, i),
        .moving = kiln_get3(&s->moving, i),
        .acceleration = kiln_get3(&s->acceleration, i),
        .first = kiln_get3(&s->first, i),
        .early = kiln_get3(&s->early, i),
        .changed = kiln_get3(&s->changed, i),
        .flown = kiln_get3(&s->flown, i),
        .pull = s->pull[i],
        .quadratic = s->quadratic[i],
        .fastest = s->fastest[i],
        .trust = s->trust[i],
    };
}

static inline void stages_set(struct stages_lanes *to, uint32_t i, struct stages s)
{
    kiln_set3(&to->position, i, s.position);
    kiln_set3(&to->velocity, i, s.velocity);
    kiln_set3(&to->at, i, s.at);
    kiln_set3(&to->moving, i, s.moving);
    kiln_set3(&to->acceleration, i, s.acceleration);
    kiln_set3(&to->first, i, s.first);
    kiln_set3(&to->early, i, s.early);
    kiln_set3(&to->changed, i, s.changed);
    kiln_set3(&to->flown, i, s.flown);
    to->pull[i] = s.pull;
    to->quadratic[i] = s.quadratic;
    to->fastest[i] = s.fastest;
    to->trust[i] = s.trust;
}

/* Takes one stage of all lanes. `stage` is a constant in each loop. */
#define TAKE_STAGE(stage, count)                                                                   \
    for (uint32_t i = 0; i < KILN_LANES; i++)                                                      \
    stages_set(s, i, stages_take(stages_get(s, i), effect_at(b, i), stage, count, time_s))

static inline void take_stage(struct kiln_block *b, uint32_t stage, uint32_t count, float time_s)
{
    struct stages_lanes *s = &b->stages;
    if (count == 2 && stage == 0) {
        TAKE_STAGE(0, 2);
    } else if (count == 2) {
        TAKE_STAGE(1, 2);
    } else if (stage == 0) {
        TAKE_STAGE(0, 4);
    } else if (stage == 1) {
        TAKE_STAGE(1, 4);
    } else if (stage == 2) {
        TAKE_STAGE(2, 4);
    } else {
        TAKE_STAGE(3, 4);
    }
}

/* Integrates all lanes over the whole step, as integrate_stages does. */
static inline void fly_in_stages(const struct kiln_sim *sim, struct kiln_block *b)
{
    const float time_s = sim->step->derived.dt_s;
    const uint32_t integration = sim->step->integration, count = stages_count(integration);
    struct stages_lanes *s = &b->stages;
    for (uint32_t i = 0; i < KILN_LANES; i++)
        stages_set(s, i, stages_start(particle_position(record_at(b, i)), kiln_get3(&b->start, i)));
    for (uint32_t stage = 0; stage < count; stage++) {
        b->at = s->at;
        add_forces(sim, b, &s->moving);
        take_stage(b, stage, count, time_s);
        if (sim->step->forces_do & FORCES_LIMIT)
            limit_speed(sim, b, &s->moving);
    }
    for (uint32_t i = 0; i < KILN_LANES; i++)
        kiln_set3(&b->position, i, stages_arrive(stages_get(s, i), integration, time_s));
    b->velocity = s->moving;
}

/* Returns whether particles of the system may rest, as STEP_RESTS does. */
static inline bool may_rest(const struct kiln_sim *sim)
{
    const struct kiln_family_params *family = &sim->step->family;
    return family->then >= THEN_STOP || (family->keeps & FAMILY_KEEPS_NORMALS) != 0;
}

/* Returns whether lane i has a particle that an impact has stopped. */
static inline uint32_t rests_at(const struct kiln_sim *sim, const struct kiln_block *b, uint32_t i)
{
    return may_rest(sim) && (b->lanes.words[7][i] & KILN_PARTICLE_STOPPED) != 0;
}

/* Puts particles that an impact has stopped back to where they are, or on with the colliders that
 * they ride, as step_rest does. */
static inline void stay_at_rest(const struct kiln_sim *sim, struct kiln_block *b)
{
    if (!may_rest(sim))
        return;
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        if (!rests_at(sim, b, i))
            continue;
        const struct kiln_particle p = record_at(b, i);
        float3 position = particle_position(p), velocity = {0.0f, 0.0f, 0.0f};
        if (p.velocity_birth.y != 0) {
            const struct ride_motion motion = ride_motion_of(sim, p.velocity_birth.y - 1);
            velocity = ride_velocity(sim, motion, position);
            position = ride(motion, 0.0f, 1.0f, position);
        }
        kiln_set3(&b->start, i, velocity);
        kiln_set3(&b->position, i, position);
        kiln_set3(&b->velocity, i, velocity);
    }
}

/* Gives particles that rest back the words in which their rest is, as step_at_rest does; headings
 * turn with the colliders that they ride. before:
 * the records before the step. */
static inline void rest_on(const struct kiln_sim *sim, struct kiln_block *b,
                           const struct kiln_particle *before)
{
    if (!may_rest(sim))
        return;
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        if (!rests_at(sim, b, i))
            continue;
        b->lanes.words[4][i] = before[i].velocity_birth.x;
        b->lanes.words[5][i] = before[i].velocity_birth.y;
        b->lanes.words[6][i] = before[i].velocity_birth.z;
        if (before[i].velocity_birth.y != 0) {
            const struct ride_motion motion = ride_motion_of(sim, before[i].velocity_birth.y - 1);
            b->lanes.words[6][i] = ride_heading(motion, 0.0f, 1.0f, before[i].velocity_birth.z);
        }
    }
}

static inline void find_lost(const struct kiln_sim *sim, struct kiln_block *b)
{
    const struct kiln_step_params *step = sim->step;
    for (uint32_t i = 0; i < KILN_LANES; i++)
        b->lost[i] = 1u ^ ((uint32_t)step_is_sane(kiln_get3(&b->position, i)) &
                           (uint32_t)step_is_sane(kiln_get3(&b->velocity, i)));
    if (step->bounded) {
        const float4 low = step->bounds_min, high = step->bounds_max;
        for (uint32_t i = 0; i < KILN_LANES; i++)
            b->lost[i] |= !step_is_between(kiln_get3(&b->position, i), low, high);
    }
    for (uint32_t k = 0; k < step->demitter_count; k++) {
        const float4 low = step->demitter_min[k], high = step->demitter_max[k];
        const struct kiln_still_frame frame = step->demitter_frames[k];
        if (still_frame_is(frame)) {
            for (uint32_t i = 0; i < KILN_LANES; i++)
                b->lost[i] |= step_is_between(still_frame_inside(frame, kiln_get3(&b->position, i)),
                                              low, high);
            continue;
        }
        for (uint32_t i = 0; i < KILN_LANES; i++)
            b->lost[i] |= step_is_between(kiln_get3(&b->position, i), low, high);
    }
}

/* Finds the slots to step alone: living particles that may touch something, births, and ends of
 * lives that leave a trace. */
static inline void find_alone(const struct kiln_sim *sim, struct kiln_block *b)
{
    memset(b->alone, 0, sizeof b->alone);
    if (sim->step->collide != COLLIDE_OFF)
        find_touching_any(sim, b);
    const uint32_t traced = sim->step->family.traced != 0;
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        const uint32_t alive = particle_is_alive(record_at(b, i));
        const uint32_t ends = b->lanes.age_s[i] >= b->lanes.life_s[i];
        const uint32_t flies = 1u ^ rests_at(sim, b, i);
        const uint32_t touches = b->alone[i] & (0u - (alive & (1u ^ ends) & flies));
        const uint32_t leaves = (alive & ends & traced) ? ALONE_LEAVES : touches;
        b->alone[i] = b->born[i] ? ALONE_BORN : leaves;
    }
}

/* Computes step_particle for the slots that are not stepped alone. */
static inline void move(struct kiln_block *b)
{
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        struct kiln_particle p = record_at(b, i);
        struct kiln_particle moved =
            step_with_motion(p, kiln_get3(&b->position, i), kiln_get3(&b->velocity, i));
        bool stays = !particle_is_alive(p) || b->alone[i] != 0;
        bool dies = b->lanes.age_s[i] >= b->lanes.life_s[i] || b->lost[i] != 0;
        uint32_t alive_mask = dies ? 0u : ~0u;
        const uint4 *place = &moved.position_serial, *speed = &moved.velocity_birth;
        b->lanes.words[0][i] = stays ? b->lanes.words[0][i] : place->x & alive_mask;
        b->lanes.words[1][i] = stays ? b->lanes.words[1][i] : place->y & alive_mask;
        b->lanes.words[2][i] = stays ? b->lanes.words[2][i] : place->z & alive_mask;
        b->lanes.words[3][i] = stays ? b->lanes.words[3][i] : place->w & alive_mask;
        b->lanes.words[4][i] = stays ? b->lanes.words[4][i] : speed->x & alive_mask;
        b->lanes.words[5][i] = stays ? b->lanes.words[5][i] : speed->y & alive_mask;
        b->lanes.words[6][i] = stays ? b->lanes.words[6][i] : speed->z & alive_mask;
        b->lanes.words[7][i] = stays ? b->lanes.words[7][i] : speed->w & alive_mask;
    }
}

/* Computes step_turn for the slots that are not stepped alone. */
static inline void turn(const struct kiln_sim *sim, struct kiln_block *b, uint32_t first_slot)
{
    const uint32_t slots = slots_left(sim, first_slot);
    const float time_s = sim->step->derived.dt_s;
    uint4 *words = sim->spin_words + ((size_t)sim->step->first_spin + first_slot) * 2;
    memset(&b->rate, 0, sizeof b->rate);
    memset(b->pose, 0, sizeof b->pose);
    for (uint32_t i = 0; i < slots; i++) {
        const float4 pose = spin_pose(words[(size_t)i * 2 + 1]);
        kiln_set3(&b->rate, i, spin_rate(words[(size_t)i * 2]));
        b->pose[0][i] = pose.x;
        b->pose[1][i] = pose.y;
        b->pose[2][i] = pose.z;
        b->pose[3][i] = pose.w;
    }
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        const float4 pose = {b->pose[0][i], b->pose[1][i], b->pose[2][i], b->pose[3][i]};
        const float4 rotated = spin_integrate(pose, kiln_get3(&b->rate, i), time_s);
        b->pose[0][i] = rotated.x;
        b->pose[1][i] = rotated.y;
        b->pose[2][i] = rotated.z;
        b->pose[3][i] = rotated.w;
    }
    for (uint32_t i = 0; i < slots; i++) {
        const float4 pose = {b->pose[0][i], b->pose[1][i], b->pose[2][i], b->pose[3][i]};
        if (!particle_is_alive(record_at(b, i)) || b->alone[i])
            continue;
        words[(size_t)i * 2] = spin_words_of(kiln_get3(&b->rate, i));
        words[(size_t)i * 2 + 1] = spin_pose_words(pose);
    }
}

/* ---- births ---------------------------------------------------------------------------------- */

/* Marks the slots, of the first `count`, that particles are born in. Returns whether there are any.
 */
static inline bool find_births(const struct kiln_sim *sim, uint32_t first_slot, uint32_t count,
                               struct kiln_block *b)
{
    const uint32_t births = sim->step->birth_count;
    uint32_t any = 0;
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        b->born[i] = i < count && step_birth_index(sim, first_slot + i) < births;
        any |= b->born[i];
    }
    if (any != 0 && sim->step->emit.cells != 0)
        kiln_slots_fetch(sim, first_slot, b);
    return any != 0;
}

/* Marks the slots whose child is born of its parent. Returns whether there are any. */
static bool find_children(const struct kiln_slots *slots, uint32_t first_slot, uint32_t count,
                          struct kiln_block *b)
{
    const struct kiln_sim *sim = &slots->sim;
    uint32_t any = 0;
    memset(b->born, 0, sizeof b->born);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t slot = first_slot + i;
        const struct kiln_trace *parent = kiln_slots_parent(slots, slot);
        /* asked first, since a trace is copied for family_event_of, and few have an event */
        b->born[i] = family_may_happen(sim, parent->serial_event.y) &&
                     family_event_of(sim, *parent, slot).happens;
        any |= b->born[i];
    }
    return any != 0;
}

/* ---- loops ----------------------------------------------------------------------------------- */

/* Steps a block. `records` points to the record of first_slot, which those of the block follow. */
__attribute__((flatten)) static void step_block(const struct kiln_sim *sim, uint32_t first_slot,
                                                struct kiln_particle *records, struct kiln_block *b)
{
    kiln_lanes_load(&b->lanes, records);
    find_ages(sim, b);
    start_moving(sim, b, first_slot);
    if (sim->step->integration >= INTEGRATE_TRAPEZOID)
        fly_in_stages(sim, b);
    else
        fly(sim, b);
    push_on(sim, b, first_slot);
    carry_on_lanes(sim, b);
    stay_at_rest(sim, b);
    find_lost(sim, b);
    find_alone(sim, b);
    move(b);
    rest_on(sim, b, records);
    if (sim->step->spins)
        turn(sim, b, first_slot);
    kiln_lanes_store(&b->lanes, records);
}

/* Steps `count` slots, at most KILN_LANES, from first_slot on. */
static void step_and_finish(const struct kiln_slots *slots, uint32_t first_slot, uint32_t count,
                            struct kiln_block *b)
{
    const bool traced = slots->sim.step->family.traced != 0, whole = count == KILN_LANES;
    struct kiln_particle *records = slots->records + first_slot, before[KILN_LANES];
    struct kiln_particle rest[KILN_LANES]; /* the slots and empty ones, unless they are a block */
    if (traced)
        memcpy(before, records, count * sizeof *before);
    if (!whole) {
        memset(rest, 0, sizeof rest);
        memcpy(rest, records, count * sizeof *rest);
    }
    step_block(&slots->sim, first_slot, whole ? records : rest, b);
    if (!whole)
        memcpy(records, rest, count * sizeof *rest);
    for (uint32_t i = 0; i < count; i++) {
        if (traced || b->alone[i] != ALONE_NOT)
            kiln_slots_finish(slots, b, i, first_slot + i, traced ? before[i] : records[i]);
    }
}

static bool are_some_alive(const struct kiln_particle *records, uint32_t count)
{
    bool alive = false;
    for (uint32_t i = 0; i < count; i++)
        alive |= particle_is_alive(records[i]);
    return alive;
}

void STEP_SLOTS(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_slots *slots = context;
    const struct kiln_family_params *family = &slots->sim.step->family;
    struct kiln_block block;
    for (uint32_t first = (uint32_t)begin; first < end; first += KILN_LANES) {
        const uint32_t left = (uint32_t)end - first, count = left < KILN_LANES ? left : KILN_LANES;
        const bool born = kiln_slots_are_children(slots)
                              ? find_children(slots, first, count, &block)
                              : find_births(&slots->sim, first, count, &block);
        if (born || are_some_alive(slots->records + first, count)) {
            step_and_finish(slots, first, count, &block);
            continue;
        }
        for (uint32_t i = 0; i < count && family->traced; i++)
            slots->traces[family->traces + first + i] = trace_nothing();
    }
}
