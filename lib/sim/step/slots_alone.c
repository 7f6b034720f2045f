/* This file finishes the steps of slots that slots_simd.c does not step in vectors: births,
 * particles that may have met a collider, and ends of lives that leave a trace. Such slots are few
 * and each goes its own way, so this code exists once and not for each level of vectors. */
#include "shared/step_family.h"
#include "sim/step/slots_block.h"

/* ---- births on meshes and images ------------------------------------------------------------- */

/* Returns the words of a cell of what a shape is born on (shared/source.h), or 0 where no cell is
 * chosen by its turn. */
static uint32_t words_of_cell(uint32_t shape)
{
    switch (shape) {
    case EMIT_TRIANGLES:
        return SOURCE_TRIANGLE_WORDS;
    case EMIT_POSED:
        return SOURCE_POSED_WORDS;
    case EMIT_COLUMNS:
        return SOURCE_COLUMN_WORDS;
    case EMIT_IMAGE:
        return SOURCE_PIXEL_WORDS;
    default:
        return 0;
    }
}

static void fetch(const float4 *cell, uint32_t words)
{
    __builtin_prefetch(cell);
    __builtin_prefetch(cell + words - 1);
}

/* A mesh of 100,000 triangles takes more than a cache, so births that wait for one cell after the
 * other take 1.2 times as long. */
void kiln_slots_fetch(const struct kiln_sim *sim, uint32_t first_slot, const struct kiln_block *b)
{
    const struct kiln_emit_params *emit = &sim->step->emit;
    const uint32_t words = words_of_cell(emit->shape);
    uint32_t streams[KILN_LANES], turns[KILN_LANES], count = 0;
    if (words == 0)
        return;
    const float4 *cells = sim->grid_words + emit->first_word;
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        if (!b->born[i])
            continue;
        const uint32_t serial = sim->step->first_serial + step_birth_index(sim, first_slot + i);
        streams[count] = particle_stream(
            sim->step->derived, (struct kiln_particle){.position_serial = UINT4(0, 0, 0, serial)});
        turns[count] = source_turn(streams[count], emit->cells);
        fetch(cells + (size_t)turns[count++] * words, words);
    }
    for (uint32_t i = 0; i < count; i++) {
        const float4 *cell = cells + (size_t)turns[i] * words;
        const bool image = emit->shape == EMIT_IMAGE, columns = emit->shape == EMIT_COLUMNS;
        const float share = image ? cell->z : cell->w;
        const float other = image ? cell->w : columns ? cell[1].y : cell[1].w;
        const uint32_t chosen = source_choose(streams[i], turns[i], share, exact_uint(other));
        fetch(cells + (size_t)chosen * words, words);
    }
}

/* ---- ends of steps --------------------------------------------------------------------------- */

/* Returns the way that the particle of lane i has flown. p: as it was before the step. */
static inline struct step_way flown_way(const struct kiln_block *b, uint32_t i,
                                        struct kiln_particle p)
{
    return (struct step_way){
        .start = {.position = particle_position(p), .velocity = kiln_get3(&b->start, i)},
        .end = {.position = kiln_get3(&b->position, i),
                .velocity = kiln_get3(&b->velocity, i),
                .since = 1.0f},
        .first = collide_no_touch(),
    };
}

/* Continues step_particle for a particle that has flown and may touch something. */
static struct kiln_particle step_touching(const struct kiln_sim *sim, const struct kiln_block *b,
                                          uint32_t i, uint32_t slot, struct kiln_particle p)
{
    struct step_way way = flown_way(b, i, p);
    way.lost = true;
    if (sim->step->spins)
        way.start.spin = way.end.spin = step_spin(sim, p, slot);
    const struct value_clocks clocks = step_clocks(sim, p, b->lanes.age_s[i], b->lanes.life_s[i]);
    way = step_meet(sim, way, push_of(sim, slot), clocks);
    if (way.lost)
        return step_dead();
    if (sim->step->spins)
        step_turn(sim, p, slot, way.end.spin);
    return step_with_motion(p, way.end.position, way.end.velocity);
}

/* Returns the trace of a particle that has flown. p: as it was before the step. */
static struct kiln_trace trace_flight(const struct kiln_sim *sim, const struct kiln_block *b,
                                      uint32_t i, struct kiln_particle p)
{
    const float life_s = b->lanes.life_s[i];
    return step_trace(sim, p, flown_way(b, i, p), TRACE_ALIVE, life_s,
                      particle_progress(b->lanes.age_s[i], life_s));
}

void kiln_slots_finish(const struct kiln_slots *slots, const struct kiln_block *b, uint32_t i,
                       uint32_t slot, struct kiln_particle before)
{
    const struct kiln_sim *sim = &slots->sim;
    const struct kiln_family_params *family = &sim->step->family;
    struct kiln_particle *record = &slots->records[slot];
    struct kiln_trace trace = trace_nothing();
    const bool bounces = family->then == THEN_BOUNCE;
    if (b->alone[i] == ALONE_TOUCHES && !family->traced && bounces) {
        *record = step_touching(sim, b, i, slot, before);
    } else if (b->alone[i] != ALONE_NOT) {
        const struct kiln_trace *parent =
            kiln_slots_are_children(slots) ? kiln_slots_parent(slots, slot) : &trace;
        const struct step_result after = step_family_slot(sim, slot, before, *parent);
        *record = after.particle;
        trace = after.trace;
    } else if (family->traced && particle_is_alive(*record)) {
        trace = trace_flight(sim, b, i, before);
        if (family->travels)
            family_travel(sim, slot, false, trace);
    } else if (family->keeps & FAMILY_KEEPS_REMAINS) {
        *record = particle_remains(before);
    }
    if (family->traced)
        slots->traces[family->traces + slot] = trace;
}
