/* This file gathers the particles of smoke into a compact array of balls. It divides a system's
 * slots into chunks; the array has each chunk's living particles in order. */
#include "draw/light/smoke.h"

#include <assert.h>
#include <stdlib.h>

#include "base/error.h"
#include "draw/light/light_blocks.h"

static const float CELL_COVER = 0.6f; /* cover in the middle of an atlas's cell */

struct gather_job {
    kiln_appearance_find *find;
    const struct kiln_light_loops *loops;
    struct kiln_appearance_system system;
    float shadow;
    struct kiln_puff *puffs; /* of the system */
    uint32_t *counts;
};

static uint32_t gather_block(const struct gather_job *job, uint32_t first, struct kiln_puff *puffs)
{
    struct kiln_appearance_block block;
    float extinction[KILN_LANES];
    job->find(&job->system, first, &block);
    job->loops->find_extinction(&block, CELL_COVER, job->shadow, extinction);
    uint32_t count = 0;
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        if (block.radius[i] > 0.0f && block.opacity[i] > 0.0f)
            puffs[count++] =
                (struct kiln_puff){kiln_get3(&block.position, i), block.radius[i], extinction[i]};
    }
    return count;
}

static_assert(KILN_SMOKE_CHUNK % KILN_LANES == 0, "chunks are of whole blocks");

static void gather_slots(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct gather_job *job = context;
    size_t chunk = begin / KILN_SMOKE_CHUNK;
    struct kiln_puff *puffs = job->puffs + chunk * KILN_SMOKE_CHUNK;
    uint32_t count = 0;
    for (size_t slot = begin; slot < end; slot += KILN_LANES)
        count += gather_block(job, (uint32_t)slot, puffs + count);
    job->counts[chunk] = count;
}

/* Returns the strength of a system's shadow; 0 if it throws none. */
static float shadow_of(const struct kiln_moment *moment, uint32_t system)
{
    const struct kiln_system *s = &moment->scene->systems[system];
    if (!kiln_system_is_smoke(s))
        return 0.0f;
    return kiln_scene_system_value(moment->scene, system, &s->look.shadow, moment->view.clock.x);
}

static uint32_t chunks_of(const struct kiln_pool *pool, uint32_t system)
{
    return (kiln_pool_used(&pool->systems[system]) + KILN_SMOKE_CHUNK - 1) / KILN_SMOKE_CHUNK;
}

static bool make_room(struct kiln_smoke *smoke, uint32_t chunks, struct kiln_error *error)
{
    if (chunks <= smoke->capacity)
        return true;
    uint32_t capacity = chunks + chunks / 4;
    kiln_smoke_finish(smoke);
    smoke->puffs = malloc((size_t)capacity * KILN_SMOKE_CHUNK * sizeof *smoke->puffs);
    smoke->counts = malloc(capacity * sizeof *smoke->counts);
    if (!smoke->puffs || !smoke->counts) {
        kiln_smoke_finish(smoke);
        kiln_error_no_memory(error, "the lighting");
        return false;
    }
    smoke->capacity = capacity;
    return true;
}

bool kiln_smoke_gather(struct kiln_smoke *smoke, const struct kiln_moment *moment,
                       struct kiln_threads *threads, struct kiln_error *error)
{
    uint32_t chunks = 0, systems = moment->scene->system_count;
    for (uint32_t i = 0; i < systems; i++) {
        if (shadow_of(moment, i) > 0.0f)
            chunks += chunks_of(moment->pool, i);
    }
    if (!make_room(smoke, chunks, error))
        return false;
    smoke->chunk_count = 0;
    for (uint32_t i = 0; i < systems; i++) {
        float shadow = shadow_of(moment, i);
        if (!(shadow > 0.0f) || chunks_of(moment->pool, i) == 0)
            continue;
        struct gather_job job = {
            .find = KILN_SIMD_PICK(kiln_appearance_find, moment->simd),
            .loops = KILN_SIMD_PICK(kiln_light_loops, moment->simd),
            .system = kiln_appearance_system(moment, i),
            .shadow = shadow,
            .puffs = smoke->puffs + (size_t)smoke->chunk_count * KILN_SMOKE_CHUNK,
            .counts = smoke->counts + smoke->chunk_count,
        };
        kiln_threads_for(threads, job.system.used, KILN_SMOKE_CHUNK, gather_slots, &job);
        smoke->chunk_count += chunks_of(moment->pool, i);
    }
    return true;
}

void kiln_smoke_finish(struct kiln_smoke *smoke)
{
    free(smoke->puffs);
    free(smoke->counts);
    *smoke = (struct kiln_smoke){.puffs = NULL};
}
