/* This file keeps an order of all slots from frame to frame and runs a part of a full sort in each
 * frame. Equal keys are ordered by the particles' systems and serials, as in every technique. So
 * while particles and camera are at rest, the kept order reaches the same list as the other
 * techniques within less than two full sorts. */
#include "sort/kept.h"

#include <string.h>

#include "base/error.h"
#include "gpu/program.h"
#include "shared/sort_layout.h"

enum { PAIR_BYTES = 8 };

/* Uniform locations of shaders/sort/kept.glsl and kept_rank.comp. */
enum { AT_EYE = 6, AT_FORWARD = 7, AT_SYSTEM_COUNT = 8, AT_SYSTEMS = 9 };

bool kiln_kept_init(struct kiln_kept *kept, struct kiln_device *device,
                    struct kiln_oddeven *oddeven, uint32_t frames, struct kiln_error *error)
{
    *kept = (struct kiln_kept){.device = device, .oddeven = oddeven, .frames = frames};
    kiln_buffer_init(&kept->pairs, device, 0, "kept order");
    kiln_buffer_init(&kept->counts, device, 0, "counts of the living");
    const struct kiln_network_kernel kernels[] = {
        {"sort/network_pad.comp", NULL, &kept->pad_program},
        {"sort/kept_rank.comp", NULL, &kept->rank_program},
        {"sort/kept_slot.comp", NULL, &kept->slot_program},
        {"sort/alive_count.comp", "#define KEPT 1\n", &kept->count_program},
        {"sort/alive_list.comp", "#define KEPT 1\n", &kept->list_program},
    };
    return kiln_scan_init(&kept->scan, device, error) &&
           kiln_network_programs(device, kernels, sizeof kernels / sizeof *kernels, error);
}

void kiln_kept_finish(struct kiln_kept *kept)
{
    kiln_scan_finish(&kept->scan);
    kiln_buffer_finish(&kept->pairs);
    kiln_buffer_finish(&kept->counts);
    const GLuint programs[] = {kept->pad_program, kept->rank_program, kept->slot_program,
                               kept->count_program, kept->list_program};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        glDeleteProgram(programs[i]);
    *kept = (struct kiln_kept){.device = NULL};
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
    glUniform1ui(AT_SYSTEM_COUNT, pool->system_count);
    glUniform3uiv(AT_SYSTEMS, KILN_MAX_SYSTEMS, systems[0]);
}

static bool bind(struct kiln_kept *kept, struct kiln_pool *pool, struct kiln_error *error)
{
    GLuint pairs = kiln_buffer_gl(&kept->pairs, KILN_READ_WRITE, error);
    GLuint records = pairs ? kiln_buffer_gl(&pool->records, KILN_READ, error) : 0;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_PAIRS, pairs);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_RECORDS, records);
    return records != 0;
}

/* Runs a program over all pairs that replaces slots by ranks (rank_program) or ranks by slots
 * (slot_program). Ranks are sorted, since they follow the order of serials. */
static void convert(struct kiln_kept *kept, GLuint program, const struct kiln_pool *pool)
{
    glUseProgram(program);
    set_systems(pool);
    kiln_network_dispatch(kept->device, program, &pool->slot_count, 1, pool->slot_count,
                          SORT_GROUP_SIZE);
}

bool kiln_kept_sort(struct kiln_kept *kept, struct kiln_pool *pool, float3 eye, float3 forward,
                    struct kiln_error *error)
{
    if (pool->slot_count == 0)
        return true;
    const uint32_t padded = kiln_network_padded(pool->slot_count);
    kiln_buffer_reserve(&kept->pairs, (size_t)padded * PAIR_BYTES);
    if (!bind(kept, pool, error))
        return false;
    const uint32_t passes = kiln_oddeven_passes(padded);
    uint32_t first = 0, end = passes;
    if (kept->started) {
        first = passes * kept->turn / kept->frames;
        end = passes * (kept->turn + 1) / kept->frames;
        kept->turn = (kept->turn + 1) % kept->frames;
    } else {
        kiln_network_dispatch(kept->device, kept->pad_program, (uint32_t[]){0, padded}, 2, padded,
                              SORT_GROUP_SIZE);
    }
    kept->started = true;
    glUseProgram(kept->rank_program);
    glUniform3f(AT_EYE, eye.x, eye.y, eye.z);
    glUniform3f(AT_FORWARD, forward.x, forward.y, forward.z);
    convert(kept, kept->rank_program, pool);
    kiln_oddeven_run_passes(kept->oddeven, padded, first, end);
    convert(kept, kept->slot_program, pool);
    return kiln_device_check(kept->device, "sort: kept order", error);
}

bool kiln_kept_save(struct kiln_kept *kept, const struct kiln_pool *pool, uint32_t *slots,
                    uint32_t *turn, struct kiln_error *error)
{
    *turn = KILN_SORT_NOT_BEGUN;
    memset(slots, 0, pool->slot_count * sizeof *slots);
    if (!kept->started)
        return true;
    const uint32_t(*pairs)[2] = kiln_buffer_host(&kept->pairs, KILN_READ, error);
    for (uint32_t i = 0; pairs && i < pool->slot_count; i++)
        slots[i] = pairs[i][1];
    *turn = kept->turn;
    return pairs != NULL;
}

bool kiln_kept_restore(struct kiln_kept *kept, const struct kiln_pool *pool, const uint32_t *slots,
                       uint32_t turn, struct kiln_error *error)
{
    kept->started = false;
    kept->turn = 0;
    if (turn == KILN_SORT_NOT_BEGUN)
        return true;
    const uint32_t padded = kiln_network_padded(pool->slot_count);
    kiln_buffer_reserve(&kept->pairs, (size_t)padded * PAIR_BYTES);
    uint32_t(*pairs)[2] = kiln_buffer_host(&kept->pairs, KILN_OVERWRITE, error);
    if (!pairs)
        return false;
    for (uint32_t i = 0; i < padded; i++) {
        pairs[i][0] = UINT32_MAX; /* the next kiln_kept_sort computes the keys */
        pairs[i][1] = i < pool->slot_count ? slots[i] : i;
        if (i < pool->slot_count && slots[i] >= pool->slot_count)
            return kiln_error_set(error, KILN_INVALID_INPUT, "a saved order of %u slots names %u",
                                  pool->slot_count, slots[i]);
    }
    kept->turn = turn % kept->frames;
    kept->started = true;
    return true;
}

/* Counts or lists the living particles of the chosen systems, depending on the program. */
static void visit(struct kiln_kept *kept, GLuint program, const struct kiln_pool *pool,
                  const struct kiln_sort_params *params)
{
    glUseProgram(program);
    set_systems(pool);
    glUniform1ui(3, pool->slot_count);
    glUniform1ui(4, params->systems);
    glUniform1ui(5, params->order == KILN_SORT_FRONT_TO_BACK);
    kiln_device_dispatch(kept->device, pool->slot_count, SORT_BLOCK);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

bool kiln_kept_list(struct kiln_kept *kept, struct kiln_pool *pool,
                    const struct kiln_sort_params *params, struct kiln_buffer *entries,
                    uint32_t *count, struct kiln_error *error)
{
    *count = 0;
    if (pool->slot_count == 0)
        return true;
    const uint32_t blocks = (pool->slot_count - 1) / SORT_BLOCK + 1;
    kiln_buffer_reserve(&kept->counts, blocks * sizeof(uint32_t));
    GLuint counts = kiln_buffer_gl(&kept->counts, KILN_OVERWRITE, error);
    GLuint list = counts ? kiln_buffer_gl(entries, KILN_READ_WRITE, error) : 0;
    if (!list || !bind(kept, pool, error))
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_COUNTS, counts);
    visit(kept, kept->count_program, pool, params);
    if (!kiln_scan_run(&kept->scan, counts, blocks, error))
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_COUNTS, counts);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_ENTRIES, list);
    visit(kept, kept->list_program, pool, params);
    return kiln_device_check(kept->device, "sort: list", error) &&
           kiln_scan_total(&kept->scan, count, error);
}
