/* This file writes the grids of baked winds (Heinz 2019, 2.2.5), on the host in vectors
 * (bake_simd.c), or by a kernel for all techniques in GL. Both compute what shared/bake.h does, so
 * the grids have the same bits.
 *
 * A grid that is written every few steps is written in the steps 1, 1 + every, and so on. A run
 * that begins elsewhere, from a saved state, first writes the grid of the last of these steps. */
#include "sim/step/bakes.h"

#include "base/text.h"
#include "scene/baked.h"
#include "sim/step/uses.h"
#include "sim/world/colliders.h"
#include "sim/world/force_params.h"

enum { POINTS_AT_A_TIME = 1024 };

static uint32_t bake_count(const struct kiln_sim_grids *grids)
{
    return grids->wind_count - grids->file_count;
}

static void add_define(struct kiln_text *defines, const char *name, bool wanted)
{
    if (wanted)
        kiln_text_add(defines, "#define %s 1\n", name);
}

static bool init_on_device(struct kiln_bakes *bakes, const struct kiln_sim_grids *grids,
                           struct kiln_error *error)
{
    const struct kiln_scene *scene = bakes->scene;
    const struct kiln_program_params files = {.compute = "sim/step/bake.comp"};
    struct kiln_text defines = {0};
    bakes->group_size =
        bakes->device->work_group_size ? bakes->device->work_group_size : SIM_GROUP_SIZE;
    kiln_text_add(&defines, "#define SIM_GROUP_SIZE %u\n", bakes->group_size);
    add_define(&defines, "SURROUNDINGS_STORED", kiln_sim_stores_surroundings(scene));
    add_define(&defines, "KEYS_STORED", grids->key_words > 0);
    add_define(&defines, "FORCES_ALL", kiln_sim_bakes_need_all_forces(scene, grids));
    kiln_sim_add_bake_uses(&defines, scene, grids);
    bakes->program = kiln_program_create_defined(bakes->device, &files, &defines, error);
    return bakes->program != 0;
}

/* Returns whether forces are summed up on the host: baked winds without a device, or those of gas.
 */
static bool needs_host(const struct kiln_bakes *bakes, const struct kiln_sim_grids *grids)
{
    const struct kiln_scene *scene = bakes->scene;
    bool any = bake_count(grids) > 0 && !bakes->device;
    for (uint32_t i = 0; i < scene->gas_count; i++)
        any = any || scene->gas[i].force_count > 0;
    return any;
}

bool kiln_bakes_init(struct kiln_bakes *bakes, struct kiln_device *device,
                     const struct kiln_scene *scene, const struct kiln_sim_grids *grids,
                     struct kiln_error *error)
{
    uint32_t found = 0, baked = 0; /* baked: those that kernels of GL write */
    *bakes = (struct kiln_bakes){.scene = scene, .device = device};
    kiln_buffer_init(&bakes->block, device, sizeof bakes->params, "baked wind");
    for (uint32_t i = 0; i < scene->system_count; i++) {
        for (uint32_t k = 0; k < scene->systems[i].force_count; k++) {
            const struct kiln_force *force = &scene->systems[i].forces[k];
            baked += force->kind == KILN_FORCE_BAKED;
            if (kiln_force_is_baked(force))
                bakes->system[found++] = i; /* in the order of grids->baked */
        }
    }
    for (uint32_t i = 0; i < scene->gas_count; i++) {
        for (uint32_t k = 0; k < scene->gas[i].force_count; k++)
            if (kiln_force_is_baked(&scene->gas[i].forces[k]))
                bakes->system[found++] = KILN_SYSTEM_OF_GAS(i);
    }
    if (needs_host(bakes, grids)) {
        enum kiln_simd simd;
        if (!kiln_simd_choose(&simd, error))
            return false;
        bakes->bake_points = KILN_SIMD_PICK(kiln_bake_points, simd);
    }
    return !device || baked == 0 || init_on_device(bakes, grids, error);
}

void kiln_bakes_finish(struct kiln_bakes *bakes)
{
    if (bakes->program)
        glDeleteProgram(bakes->program);
    kiln_buffer_finish(&bakes->block);
    *bakes = (struct kiln_bakes){.program = 0};
}

/* ---- writing --------------------------------------------------------------------------------- */

/* Fills in the parameters of forces that a step evaluates without particles. of: has the keys of
 * the values; system: the number of the system that the values are of. */
static void fill_forces(struct kiln_bakes *bakes, const struct kiln_sim_params *params,
                        const struct kiln_derived_params *of, uint32_t system,
                        const struct kiln_force *forces, uint32_t count, uint32_t step)
{
    const struct kiln_scene *scene = bakes->scene;
    const struct kiln_sim_moment moment = {scene, system, kiln_sim_forces_s(scene, step)};
    bakes->params = (struct kiln_step_params){
        .derived = *of,
        .step = step,
        .force_count = count,
        .integration = (uint)scene->integration,
        .noise_seed = random_noise_key(scene->seed),
        .time_s = kiln_scene_time(scene, step - 1),
    };
    for (uint32_t k = 0; k < count; k++)
        bakes->params.forces[k] = kiln_sim_force_params(&moment, params->grids, &forces[k]);
}

/* Returns the keys of the values of a domain of gas. */
static struct kiln_derived_params derived_of_gas(const struct kiln_scene *scene, uint32_t system)
{
    const struct value_clocks clocks = kiln_scene_clocks(scene, system, 0.0f);
    return (struct kiln_derived_params){.random_key = clocks.system, .scene_key = clocks.scene};
}

/* Returns whether a baked wind is one that moves gas. */
static bool is_of_gas(const struct kiln_bakes *bakes, uint32_t i)
{
    return bakes->system[i] >= KILN_SYSTEM_OF_GAS(0);
}

/* Fills in the parameters of baked wind i in a step, and returns the frame of its grid. */
static struct kiln_still_frame fill_params(struct kiln_bakes *bakes,
                                           const struct kiln_sim_params *params, uint32_t i,
                                           uint32_t step)
{
    const struct kiln_force *baked = params->grids->baked[i];
    const uint32_t system = bakes->system[i];
    const struct kiln_derived_params derived = is_of_gas(bakes, i)
                                                   ? derived_of_gas(bakes->scene, system)
                                                   : params->systems[system].derived;
    fill_forces(bakes, params, &derived, system, baked->of.at, baked->of.count, step);
    return kiln_sim_frame(bakes->scene, &baked->attach, kiln_sim_forces_s(bakes->scene, step));
}

static bool write_on_host(struct kiln_bakes *bakes, const struct kiln_sim_params *params,
                          const struct kiln_grid *grid, struct kiln_still_frame node,
                          struct kiln_threads *threads, struct kiln_error *error)
{
    float4 *words = kiln_buffer_host(&params->grids->words, KILN_READ_WRITE, error);
    if (!words)
        return false;
    struct kiln_bake_work work = {
        .sim = {.step = &bakes->params,
                .surroundings = &params->surroundings,
                .value_keys = bakes->scene->keys,
                .grid_words = words},
        .grid = *grid,
        .node = node,
        .words = words,
    };
    kiln_threads_for(threads, (size_t)grid->size.x * grid->size.y * grid->size.z, POINTS_AT_A_TIME,
                     bakes->bake_points, &work);
    return true;
}

static bool write_in_gl(struct kiln_bakes *bakes, const struct kiln_sim_params *params,
                        uint32_t number, struct kiln_still_frame node, struct kiln_error *error)
{
    const struct kiln_grid *grid = &params->surroundings.grids[number];
    const GLuint words = kiln_buffer_gl(&params->grids->words, KILN_READ_WRITE, error);
    const GLuint block = kiln_buffer_upload(&bakes->block, &bakes->params, error);
    if (!words || !block)
        return false;
    glUseProgram(bakes->program);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_GRIDS, words);
    glBindBufferBase(GL_UNIFORM_BUFFER, SIM_BIND_STEP, block);
    glUniform1ui(SIM_AT_GRID, number);
    glUniform4f(SIM_AT_NODE, node.at.x, node.at.y, node.at.z, node.at.w);
    glUniform4f(SIM_AT_NODE_TURN, node.turn.x, node.turn.y, node.turn.z, node.turn.w);
    kiln_device_dispatch(bakes->device, grid->size.x * grid->size.y * grid->size.z,
                         bakes->group_size);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return kiln_device_check(bakes->device, "baked wind", error);
}

void kiln_bakes_of_gas(struct kiln_bakes *bakes, const struct kiln_sim_params *params,
                       const struct kiln_sim *around, struct kiln_threads *threads, uint32_t domain,
                       const struct kiln_grid *grid, uint32_t step, float4 *words)
{
    const struct kiln_scene *scene = bakes->scene;
    const struct kiln_gas_domain *gas = &scene->gas[domain];
    const struct kiln_derived_params derived = derived_of_gas(scene, KILN_SYSTEM_OF_GAS(domain));
    fill_forces(bakes, params, &derived, KILN_SYSTEM_OF_GAS(domain), gas->forces, gas->force_count,
                step);
    struct kiln_bake_work work = {
        .sim = {.step = &bakes->params,
                .surroundings = &params->surroundings,
                .value_keys = scene->keys,
                .grid_words = around->grid_words},
        .grid = *grid,
        .node = kiln_sim_frame(scene, &gas->attach, kiln_sim_forces_s(scene, step)),
        .words = words,
    };
    kiln_threads_for(threads, (size_t)grid->size.x * grid->size.y * grid->size.z, POINTS_AT_A_TIME,
                     bakes->bake_points, &work);
}

/* Writes the grids of all baked winds that move gas, or of all others, where they hold another
 * time.
 */
static bool write_grids(struct kiln_bakes *bakes, const struct kiln_sim_params *params,
                        struct kiln_threads *threads, bool of_gas, uint32_t step,
                        struct kiln_error *error)
{
    const struct kiln_sim_grids *grids = params->grids;
    for (uint32_t i = 0; i < bake_count(grids); i++) {
        const uint32_t number = grids->file_count + i;
        if (grids->baked[i]->kind == KILN_FORCE_GAS || is_of_gas(bakes, i) != of_gas)
            continue; /* the gas writes it, or the other call */
        const uint32_t wanted = kiln_baked_step(grids->baked[i], step);
        if (bakes->written[i] == wanted)
            continue;
        const struct kiln_still_frame node = fill_params(bakes, params, i, wanted);
        const bool ok = bakes->device && !of_gas
                            ? write_in_gl(bakes, params, number, node, error)
                            : write_on_host(bakes, params, &params->surroundings.grids[number],
                                            node, threads, error);
        if (!ok)
            return false;
        bakes->written[i] = wanted;
    }
    return true;
}

bool kiln_bakes_step_gas(struct kiln_bakes *bakes, const struct kiln_sim_params *params,
                         struct kiln_threads *threads, uint32_t step, struct kiln_error *error)
{
    return write_grids(bakes, params, threads, true, step, error);
}

bool kiln_bakes_step(struct kiln_bakes *bakes, const struct kiln_sim_params *params,
                     struct kiln_threads *threads, uint32_t step, struct kiln_error *error)
{
    return write_grids(bakes, params, threads, false, step, error);
}
