/* This file keeps an order of all slots from frame to frame and runs a part of a full sort in each
 * frame (Kolb, Latta and Rezk-Salama 2004; UberFlow, 4.3 and 5; Heinz 2019, 2.4.1). The order holds
 * every slot of the pool exactly once, whether or not a particle was born into it, so no particle
 * can be lost or drawn twice. The list of living particles is made from it. Equal keys are ordered
 * by the particles' systems and serials, as in every technique. So while particles and camera are
 * at rest, the kept order reaches the same list as the other techniques within less than two full
 * sorts. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gpu/program.h"
#include "shared/papers/sort_layout.h"
#include "sort/papers/oddeven.h"
#include "sort/papers/papers.h"

enum { PAIR_BYTES = 8 };

/* The word of a saved history where no part of a sort has run; otherwise, the word is next_part. */
#define NOT_BEGUN UINT32_MAX

struct spread {
    struct kiln_device *device;
    struct kiln_oddeven *oddeven; /* its passes sort the order */
    uint32_t part_count;          /* frames over which the passes of a full sort are divided */
    uint32_t next_part; /* index of the part of the full sort that runs next, below part_count */
    bool started;       /* false until the first sort, which runs all passes */
    GLuint pad_program, rank_program, slot_program, count_program, list_program;
    struct kiln_scan scan;
    struct kiln_buffer pairs, counts;
};

static void destroy(void *technique)
{
    struct spread *spread = technique;
    kiln_oddeven_destroy(&spread->oddeven);
    kiln_scan_finish(&spread->scan);
    kiln_buffer_finish(&spread->pairs);
    kiln_buffer_finish(&spread->counts);
    const GLuint programs[] = {spread->pad_program, spread->rank_program, spread->slot_program,
                               spread->count_program, spread->list_program};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        glDeleteProgram(programs[i]);
    free(spread);
}

static bool create_parts(struct spread *spread, struct kiln_error *error)
{
    const struct kiln_network_kernel kernels[] = {
        {"sort/network_pad.comp", NULL, &spread->pad_program},
        {"sort/papers/spread_rank.comp", NULL, &spread->rank_program},
        {"sort/papers/spread_slot.comp", NULL, &spread->slot_program},
        {"sort/papers/spread_count.comp", NULL, &spread->count_program},
        {"sort/papers/spread_list.comp", NULL, &spread->list_program},
    };
    spread->oddeven = kiln_oddeven_create(spread->device, error);
    return spread->oddeven && kiln_scan_init(&spread->scan, spread->device, error) &&
           kiln_network_programs(spread->device, kernels, sizeof kernels / sizeof *kernels, error);
}

static void *create(const struct kiln_sort_setup *setup, struct kiln_error *error)
{
    if (setup->frames < 1 || setup->frames > KILN_SORT_MAX_SPREAD) {
        kiln_error_set(error, KILN_USAGE, "a sort can be spread over 1 to %d frames, not %u",
                       KILN_SORT_MAX_SPREAD, setup->frames);
        return NULL;
    }
    struct spread *spread = calloc(1, sizeof *spread);
    if (!spread) {
        kiln_error_no_memory(error, "the sort");
        return NULL;
    }
    spread->device = setup->device;
    spread->part_count = setup->frames;
    kiln_buffer_init(&spread->pairs, setup->device, 0, "kept order");
    kiln_buffer_init(&spread->counts, setup->device, 0, "counts of the living");
    if (create_parts(spread, error))
        return spread;
    destroy(spread);
    return NULL;
}

/* Sets the uniforms of the current program that describe where the systems' slots lie. */
static void set_systems(const struct kiln_pool *pool)
{
    uint32_t systems[KILN_MAX_SYSTEMS][3] = {{0}};
    for (uint32_t i = 0; i < pool->system_count; i++) {
        const struct kiln_pool_system *system = &pool->systems[i];
        uint32_t used = kiln_pool_used(system);
        systems[i][0] = system->base;
        systems[i][1] = system->capacity;
        systems[i][2] = used ? (uint32_t)((system->next_serial - used) % system->capacity) : 0;
    }
    glUniform1ui(SORT_AT_SYSTEM_COUNT, pool->system_count);
    glUniform3uiv(SORT_AT_SYSTEMS, KILN_MAX_SYSTEMS, systems[0]);
}

static bool bind(struct spread *spread, struct kiln_pool *pool, struct kiln_error *error)
{
    GLuint pairs = kiln_buffer_gl(&spread->pairs, KILN_READ_WRITE, error);
    GLuint records = pairs ? kiln_buffer_gl(&pool->records, KILN_READ, error) : 0;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_PAIRS, pairs);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_RECORDS, records);
    return records != 0;
}

/* Runs a program over all pairs that replaces slots by ranks (rank_program) or ranks by slots
 * (slot_program). Ranks are sorted, since they follow the order of serials. */
static void run_over_pairs(struct spread *spread, GLuint program, const struct kiln_pool *pool)
{
    glUseProgram(program);
    set_systems(pool);
    const struct kiln_network_uniform uniform = {SORT_AT_COUNT, pool->slot_count};
    kiln_network_dispatch(spread->device, program, &uniform, 1, pool->slot_count, SORT_GROUP_SIZE);
}

/* Runs one frame's share of the passes, with keys from the particles and the camera as they are
 * now. */
static bool advance(void *technique, struct kiln_pool *pool, float3 eye, float3 forward,
                    struct kiln_error *error)
{
    struct spread *spread = technique;
    if (pool->slot_count == 0)
        return true;
    const uint32_t padded = kiln_network_padded(pool->slot_count);
    kiln_buffer_reserve(&spread->pairs, (size_t)padded * PAIR_BYTES);
    if (!bind(spread, pool, error))
        return false;
    const uint32_t passes = kiln_oddeven_passes(padded);
    uint32_t first = 0, end = passes;
    if (spread->started) {
        first = passes * spread->next_part / spread->part_count;
        end = passes * (spread->next_part + 1) / spread->part_count;
        spread->next_part = (spread->next_part + 1) % spread->part_count;
    } else {
        const struct kiln_network_uniform uniforms[] = {{SORT_AT_COUNT, 0},
                                                        {SORT_AT_PADDED, padded}};
        kiln_network_dispatch(spread->device, spread->pad_program, uniforms, 2, padded,
                              SORT_GROUP_SIZE);
    }
    spread->started = true;
    glUseProgram(spread->rank_program);
    glUniform3f(SORT_AT_EYE, eye.x, eye.y, eye.z);
    glUniform3f(SORT_AT_FORWARD, forward.x, forward.y, forward.z);
    run_over_pairs(spread, spread->rank_program, pool);
    kiln_oddeven_run_passes(spread->oddeven, padded, first, end);
    run_over_pairs(spread, spread->slot_program, pool);
    return kiln_device_check(spread->device, "sort: kept order", error);
}

/* The word of a slot is the slot at its place in the order. */
static bool save(void *technique, const struct kiln_pool *pool, struct kiln_history_words *words,
                 struct kiln_error *error)
{
    struct spread *spread = technique;
    words->of_whole = NOT_BEGUN;
    memset(words->of_slots, 0, pool->slot_count * sizeof *words->of_slots);
    if (!spread->started)
        return true;
    const uint32_t(*pairs)[2] = kiln_buffer_host(&spread->pairs, KILN_READ, error);
    for (uint32_t i = 0; pairs && i < pool->slot_count; i++)
        words->of_slots[i] = pairs[i][1];
    words->of_whole = spread->next_part;
    return pairs != NULL;
}

static bool restore(void *technique, const struct kiln_pool *pool,
                    const struct kiln_history_words *words, struct kiln_error *error)
{
    struct spread *spread = technique;
    const uint32_t *slots = words->of_slots;
    spread->started = false;
    spread->next_part = 0;
    if (words->of_whole == NOT_BEGUN)
        return true;
    const uint32_t padded = kiln_network_padded(pool->slot_count);
    kiln_buffer_reserve(&spread->pairs, (size_t)padded * PAIR_BYTES);
    uint32_t(*pairs)[2] = kiln_buffer_host(&spread->pairs, KILN_OVERWRITE, error);
    if (!pairs)
        return false;
    for (uint32_t i = 0; i < padded; i++) {
        pairs[i][0] = UINT32_MAX; /* the next call of advance computes the keys */
        pairs[i][1] = i < pool->slot_count ? slots[i] : i;
        if (i < pool->slot_count && slots[i] >= pool->slot_count)
            return kiln_error_set(error, KILN_INVALID_INPUT, "a saved order of %u slots names %u",
                                  pool->slot_count, slots[i]);
    }
    spread->next_part = words->of_whole % spread->part_count;
    spread->started = true;
    return true;
}

/* Counts or lists the living particles of the chosen systems, depending on the program. */
static void run_over_slots(struct spread *spread, GLuint program, const struct kiln_pool *pool,
                           const struct kiln_sort_params *params)
{
    glUseProgram(program);
    set_systems(pool);
    glUniform1ui(SORT_AT_USED, pool->slot_count);
    glUniform1ui(SORT_AT_CHOSEN, (uint32_t)params->systems);
    glUniform1ui(SORT_AT_REVERSE, params->order == KILN_SORT_FRONT_TO_BACK);
    kiln_device_dispatch(spread->device, pool->slot_count, SORT_BLOCK);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

/* Lists the living particles in the kept order, without sorting it. */
static bool list_kept(struct spread *spread, struct kiln_pool *pool,
                      const struct kiln_sort_params *params, struct kiln_buffer *entries,
                      uint32_t *count, struct kiln_error *error)
{
    *count = 0;
    if (pool->slot_count == 0)
        return true;
    const uint32_t blocks = (pool->slot_count - 1) / SORT_BLOCK + 1;
    kiln_buffer_reserve(&spread->counts, blocks * sizeof(uint32_t));
    GLuint counts = kiln_buffer_gl(&spread->counts, KILN_OVERWRITE, error);
    GLuint list = counts ? kiln_buffer_gl(entries, KILN_READ_WRITE, error) : 0;
    if (!list || !bind(spread, pool, error))
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_COUNTS, counts);
    run_over_slots(spread, spread->count_program, pool, params);
    if (!kiln_scan_run(&spread->scan, counts, blocks, error))
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_COUNTS, counts);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_ENTRIES, list);
    run_over_slots(spread, spread->list_program, pool, params);
    return kiln_device_check(spread->device, "sort: list", error) &&
           kiln_scan_total(&spread->scan, count, error);
}

static bool run(void *technique, struct kiln_pool *pool, const struct kiln_sort_params *params,
                struct kiln_buffer *entries, uint32_t *count, struct kiln_error *error)
{
    struct spread *spread = technique;
    if (params->order != KILN_SORT_BY_SERIAL)
        return list_kept(spread, pool, params, entries, count, error);
    return kiln_network_run(kiln_oddeven_network(spread->oddeven), pool, params, entries, count,
                            error);
}

/* The padded pairs, and the list. */
static uint64_t bytes(uint32_t slots)
{
    return (uint64_t)kiln_network_padded(slots) * PAIR_BYTES + sizeof(uint32_t) * (uint64_t)slots;
}

static const struct kiln_history_kind history = {
    .advance = advance, .save = save, .restore = restore};

const struct kiln_sort_row kiln_sort_spread_row = {.in_gl = true,
                                                   .create = create,
                                                   .destroy = destroy,
                                                   .run = run,
                                                   .bytes = bytes,
                                                   .history = &history};
