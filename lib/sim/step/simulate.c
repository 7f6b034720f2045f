/* This file runs the simulation stage; the loop over a clip (frame/loop.c) calls it once a step. A
 * step makes the volumes of moving meshes, counts births on the host, computes the forces of
 * particles on each other (pushes), moves the particles by the chosen technique, and lets particles
 * paint the meshes that they hit. */
#include "sim/step/simulate.h"

#include <stdlib.h>

#include "base/error.h"
#include "shared/trace.h"
#include "sim/crowd/interact.h"
#include "sim/paint/paint.h"
#include "sim/step/cpu.h"
#include "sim/step/feedback.h"
#include "sim/step/hash.h"
#include "sim/step/inplace.h"
#include "sim/step/newborn.h"
#include "sim/step/pingpong.h"
#include "sim/step/texels.h"

struct kiln_simulate {
    const struct kiln_scene *scene;
    enum kiln_simulate_technique technique;
    struct kiln_threads *threads;
    struct kiln_sim_params params;
    struct kiln_sim_grids grids;
    /* struct kiln_trace: what particles did in the present step, for the births of their children
     * and for paint. Each step rewrites it, so it is not part of the state. */
    struct kiln_buffer traces;
    struct kiln_interact interact;
    struct kiln_paint paint;
    struct kiln_newborn newborn;
    /* the loop for this processor's width of vectors; only for technique `cpu` */
    kiln_slots_step *step_slots;
    /* the following two are for all techniques in GL */
    struct kiln_sim_blocks blocks;
    struct kiln_sim_hash hash;
    /* each of the following is for the technique of its name */
    struct kiln_sim_programs inplace;
    struct kiln_pingpong pingpong;
    struct kiln_feedback feedback;
    struct kiln_texels texels;
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
    switch (s->technique) {
    case KILN_SIMULATE_CPU:
        break;
    case KILN_SIMULATE_INPLACE:
        return kiln_inplace_init(&s->inplace, device, s->scene, &s->params, error);
    case KILN_SIMULATE_PINGPONG:
        return kiln_pingpong_init(&s->pingpong, device, s->scene, &s->params, error);
    case KILN_SIMULATE_FEEDBACK:
        return kiln_feedback_init(&s->feedback, device, s->scene, &s->params, error);
    case KILN_SIMULATE_TEXELS:
        return kiln_texels_init(&s->texels, device, s->scene, &s->params, error);
    }
    return false;
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
                                           struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_simulate *simulate = calloc(1, sizeof *simulate);
    if (!simulate) {
        kiln_error_no_memory(error, "the simulation");
        return NULL;
    }
    simulate->scene = scene;
    simulate->technique = technique;
    simulate->threads = threads;
    /* the side where the buffers lie; NULL: the host */
    struct kiln_device *side = technique == KILN_SIMULATE_CPU ? NULL : device;
    bool ok = kiln_sim_grids_init(&simulate->grids, side, scene, threads, error);
    kiln_sim_params_init(&simulate->params, scene, &simulate->grids);
    kiln_buffer_init(&simulate->traces, side,
                     (size_t)simulate->params.trace_count * sizeof(struct kiln_trace), "traces");
    ok = ok &&
         kiln_interact_init(&simulate->interact, side, scene, &simulate->params, threads, error) &&
         kiln_paint_init(&simulate->paint, scene, threads, error);
    ok = ok && (technique == KILN_SIMULATE_CPU ? choose_loop(simulate, error)
                                               : init_on_device(simulate, device, error));
    if (!ok)
        kiln_simulate_destroy(&simulate);
    return simulate;
}

void kiln_simulate_destroy(struct kiln_simulate **simulate)
{
    struct kiln_simulate *s = *simulate;
    if (!s)
        return;
    if (s->blocks.device) { /* kiln_sim_blocks_init makes the first of these GL objects */
        kiln_texels_finish(&s->texels);
        kiln_feedback_finish(&s->feedback);
        kiln_pingpong_finish(&s->pingpong);
        kiln_sim_programs_finish(&s->inplace);
        kiln_sim_hash_finish(&s->hash);
        kiln_sim_blocks_finish(&s->blocks);
    }
    kiln_newborn_finish(&s->newborn);
    kiln_paint_finish(&s->paint);
    kiln_interact_finish(&s->interact);
    kiln_buffer_finish(&s->traces);
    kiln_sim_grids_finish(&s->grids);
    free(s);
    *simulate = NULL;
}

static bool move_particles(struct kiln_simulate *s, struct kiln_pool *pool, uint32_t step,
                           struct kiln_error *error)
{
    if (!kiln_volumes_step(&s->grids.volumes, s->scene, step, s->threads, error) ||
        !kiln_sim_params_step(&s->params, s->scene, pool, step, error))
        return false;
    const bool host = s->technique == KILN_SIMULATE_CPU;
    struct kiln_buffer *pushes = &s->interact.pushes;
    if (!kiln_interact_gather(&s->interact, &s->params, pool, host ? NULL : &s->blocks.keys, error))
        return false;
    if (!host &&
        !kiln_sim_blocks_upload(&s->blocks, &s->params, &s->traces, pushes, &pool->spins, error))
        return false;
    switch (s->technique) {
    case KILN_SIMULATE_CPU:
        return kiln_sim_cpu_step(s->step_slots, s->threads, &s->params, s->scene->keys, pool,
                                 &s->traces, pushes, error);
    case KILN_SIMULATE_INPLACE:
        return kiln_inplace_step(&s->inplace, &s->blocks, &s->params, pool, error);
    case KILN_SIMULATE_PINGPONG:
        return kiln_pingpong_step(&s->pingpong, &s->blocks, &s->params, pool, error);
    case KILN_SIMULATE_FEEDBACK:
        return kiln_feedback_step(&s->feedback, &s->blocks, &s->params, pool, error);
    case KILN_SIMULATE_TEXELS:
        return kiln_texels_step(&s->texels, &s->blocks, &s->params, pool, step, error);
    }
    return false;
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
    const bool host = simulate->technique == KILN_SIMULATE_CPU;
    const bool ok = host ? kiln_sim_cpu_hash(simulate->threads, pool, hash, alive, error)
                         : kiln_sim_hash_run(&simulate->hash, pool, hash, alive, error);
    if (ok)
        kiln_paint_hash(pool, hash);
    return ok;
}

const char *kiln_simulate_warning(struct kiln_simulate *simulate)
{
    return kiln_interact_warning(&simulate->interact);
}

size_t kiln_simulate_slot_bytes(enum kiln_simulate_technique technique)
{
    size_t copies = 1;
    if (technique == KILN_SIMULATE_PINGPONG || technique == KILN_SIMULATE_FEEDBACK)
        copies = 2;
    else if (technique == KILN_SIMULATE_TEXELS)
        copies = 3;
    return copies * sizeof(struct kiln_particle);
}
