/* This file runs the simulation stage; the loop over a clip (frame/loop.c) calls it once a step. A
 * step makes the volumes of moving meshes, counts births on the host, steps gas, computes the
 * forces of particles on each other (pushes), writes the grids of baked winds, moves the particles
 * by the chosen technique, and lets particles paint the meshes that they hit. */
#include "sim/step/simulate.h"

#include <stdlib.h>

#include "base/error.h"
#include "shared/trace.h"
#include "sim/crowd/interact.h"
#include "sim/gas/gas.h"
#include "sim/gas/wind.h"
#include "sim/paint/paint.h"
#include "sim/step/bakes.h"
#include "sim/step/cpu.h"
#include "sim/step/hash.h"
#include "sim/step/newborn.h"
#include "sim/step/papers/papers.h"

/* The techniques in GL. Technique `cpu`, which steps the pool on the host, has no row. */
static const struct kiln_simulate_row *const ROWS[] = {
    [KILN_SIMULATE_INPLACE] = &kiln_simulate_inplace_row,
    [KILN_SIMULATE_PINGPONG] = &kiln_simulate_pingpong_row,
    [KILN_SIMULATE_FEEDBACK] = &kiln_simulate_feedback_row,
    [KILN_SIMULATE_TEXELS] = &kiln_simulate_texels_row,
};

struct kiln_simulate {
    const struct kiln_scene *scene;
    const struct kiln_simulate_row *row; /* NULL: technique `cpu` */
    struct kiln_threads *threads;
    struct kiln_sim_params params;
    struct kiln_sim_grids grids;
    struct kiln_bakes bakes;
    struct kiln_gas_stage gas;
    /* struct kiln_trace: what particles did in the present step, for the births of their children
     * and for paint. Each step rewrites it, so it is not part of the state. */
    struct kiln_buffer traces;
    struct kiln_interact interact;
    struct kiln_paint paint;
    struct kiln_newborn newborn;
    /* the loop for this processor's width of vectors; only for technique `cpu` */
    kiln_slots_step *step_slots;
    /* the following are for techniques in GL */
    struct kiln_sim_blocks blocks;
    struct kiln_sim_hash hash;
    void *technique; /* of the size that the row says */
};

static bool init_on_device(struct kiln_simulate *s, struct kiln_device *device,
                           struct kiln_error *error)
{
    if (!device)
        return kiln_error_set(error, KILN_USAGE, "without a device, only simulate=cpu is allowed");
    if (!device->info.exact)
        return kiln_error_set(error, KILN_USAGE,
                              "%s computes inexactly and cannot simulate; use simulate=cpu",
                              device->info.name);
    if (!kiln_sim_blocks_init(&s->blocks, device, s->scene, error) ||
        !kiln_sim_hash_init(&s->hash, device, error))
        return false;
    s->technique = calloc(1, s->row->size);
    if (!s->technique)
        return kiln_error_no_memory(error, "the simulation");
    return s->row->init(s->technique, device, s->scene, &s->params, error);
}

static bool choose_loop(struct kiln_simulate *s, struct kiln_error *error)
{
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error))
        return false;
    s->step_slots = KILN_SIMD_PICK(kiln_slots_step, simd);
    return true;
}

struct kiln_simulate *kiln_simulate_create(struct kiln_device *device,
                                           const struct kiln_scene *scene,
                                           enum kiln_simulate_technique technique,
                                           enum kiln_gas_technique gas,
                                           struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_simulate *simulate = calloc(1, sizeof *simulate);
    if (!simulate) {
        kiln_error_no_memory(error, "the simulation");
        return NULL;
    }
    simulate->scene = scene;
    simulate->row = ROWS[technique];
    simulate->threads = threads;
    /* the side where the buffers lie; NULL: the host */
    struct kiln_device *side = simulate->row ? device : NULL;
    bool ok = kiln_sim_grids_init(&simulate->grids, side, scene, threads, error);
    kiln_sim_params_init(&simulate->params, scene, &simulate->grids);
    kiln_buffer_init(&simulate->traces, side,
                     (size_t)simulate->params.trace_count * sizeof(struct kiln_trace), "traces");
    ok = ok && kiln_bakes_init(&simulate->bakes, side, scene, &simulate->grids, error) &&
         kiln_gas_stage_init(&simulate->gas, device, scene, gas, threads, error) &&
         kiln_interact_init(&simulate->interact, side, scene, threads, error) &&
         kiln_paint_init(&simulate->paint, scene, threads, error);
    ok = ok &&
         (simulate->row ? init_on_device(simulate, device, error) : choose_loop(simulate, error));
    if (!ok)
        kiln_simulate_destroy(&simulate);
    return simulate;
}

void kiln_simulate_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        if (kiln_sim_is_traced(scene, i))
            kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, scene->systems[i].capacity,
                               sizeof(struct kiln_trace));
    }
    kiln_sim_grids_footprint(scene, footprint);
    kiln_gas_footprint(scene, footprint);
    kiln_interact_footprint(scene, footprint);
    kiln_paint_footprint(scene, footprint);
}

void kiln_simulate_destroy(struct kiln_simulate **simulate)
{
    struct kiln_simulate *s = *simulate;
    if (!s)
        return;
    if (s->blocks.device) { /* kiln_sim_blocks_init makes the first of these GL objects */
        if (s->technique)
            s->row->finish(s->technique);
        free(s->technique);
        kiln_sim_hash_finish(&s->hash);
        kiln_sim_blocks_finish(&s->blocks);
    }
    kiln_newborn_finish(&s->newborn);
    kiln_paint_finish(&s->paint);
    kiln_interact_finish(&s->interact);
    kiln_buffer_finish(&s->traces);
    kiln_gas_stage_finish(&s->gas);
    kiln_bakes_finish(&s->bakes);
    kiln_sim_grids_finish(&s->grids);
    free(s);
    *simulate = NULL;
}

/* Returns the buffer in GL that has the scene's keys at its start. */
static struct kiln_buffer *find_keys(struct kiln_simulate *s)
{
    return s->grids.key_words > 0 ? &s->grids.words : &s->blocks.keys;
}

/* Fills in the forces of a domain of gas. */
static void blow_on_gas(void *context, const struct kiln_sim *around, uint32_t domain,
                        const struct kiln_grid *grid, uint32_t step, float4 *words)
{
    struct kiln_simulate *s = context;
    kiln_bakes_of_gas(&s->bakes, &s->params, around, s->threads, domain, grid, step, words);
}

static bool move_gas(struct kiln_simulate *s, struct kiln_pool *pool, uint32_t step,
                     struct kiln_error *error)
{
    const struct kiln_gas_forces forces = {s, blow_on_gas};
    return kiln_bakes_step_gas(&s->bakes, &s->params, s->threads, step, error) &&
           kiln_gas_stage_step(&s->gas, pool, &s->params, &forces, step, error) &&
           kiln_gas_winds_write(s->scene, pool, &s->params, s->threads, step, error);
}

static bool move_particles(struct kiln_simulate *s, struct kiln_pool *pool, uint32_t step,
                           struct kiln_error *error)
{
    if (!kiln_volumes_step(&s->grids.volumes, s->scene, step, s->threads, error) ||
        !kiln_sim_params_step(&s->params, s->scene, pool, step, error) ||
        !move_gas(s, pool, step, error))
        return false;
    const bool host = s->row == NULL;
    struct kiln_buffer *pushes = &s->interact.pushes;
    if (!kiln_interact_gather(&s->interact, &s->params, pool, host ? NULL : find_keys(s), error))
        return false;
    if (host)
        return kiln_bakes_step(&s->bakes, &s->params, s->threads, step, error) &&
               kiln_sim_cpu_step(s->step_slots, s->threads, &s->params, s->scene->keys, pool,
                                 &s->traces, pushes, error);
    return kiln_sim_blocks_upload(&s->blocks, &s->params, &s->traces, pushes, &pool->spins,
                                  error) &&
           kiln_bakes_step(&s->bakes, &s->params, s->threads, step, error) &&
           s->row->step(s->technique, &s->blocks, &s->params, pool, step, error);
}

bool kiln_simulate_step(struct kiln_simulate *simulate, struct kiln_pool *pool, uint32_t step,
                        struct kiln_error *error)
{
    return move_particles(simulate, pool, step, error) &&
           kiln_paint_step(&simulate->paint, &simulate->params, pool, &simulate->traces, error);
}

bool kiln_simulate_show_births(struct kiln_simulate *simulate, struct kiln_pool *pool,
                               uint32_t step, struct kiln_error *error)
{
    return kiln_newborn_show(&simulate->newborn, &simulate->params, simulate->scene, pool, step,
                             error);
}

bool kiln_simulate_hide_births(struct kiln_simulate *simulate, struct kiln_pool *pool,
                               struct kiln_error *error)
{
    return kiln_newborn_hide(&simulate->newborn, pool, error);
}

bool kiln_simulate_hash(struct kiln_simulate *simulate, struct kiln_pool *pool,
                        struct kiln_state_hash *hash, uint64_t *alive, struct kiln_error *error)
{
    const bool host = simulate->row == NULL;
    bool ok = host ? kiln_sim_cpu_hash(simulate->threads, pool, hash, alive, error)
                   : kiln_sim_hash_run(&simulate->hash, pool, hash, alive, error);
    if (ok)
        kiln_paint_hash(pool, hash);
    for (uint32_t i = 0; ok && i < pool->gas_count; i++) {
        ok = kiln_gas_fetch(&pool->gas[i], error);
        kiln_gas_hash(&pool->gas[i], i, hash);
    }
    return ok;
}

void kiln_simulate_gas_seconds(struct kiln_simulate *simulate, double seconds[])
{
    kiln_gas_stage_seconds(&simulate->gas, seconds);
}

const char *kiln_simulate_warning(struct kiln_simulate *simulate)
{
    const char *warning = kiln_gas_stage_warning(&simulate->gas);
    return warning ? warning : kiln_interact_warning(&simulate->interact);
}

size_t kiln_simulate_slot_bytes(enum kiln_simulate_technique technique)
{
    const size_t copies = ROWS[technique] ? ROWS[technique]->copies : 1;
    return copies * sizeof(struct kiln_particle);
}
