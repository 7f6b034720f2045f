/* This file steps the gas of a scene: it takes the settings of a domain at the time of a step to
 * the constants of the solver, and divides the step so that gas moves at most GAS_MOST_CELLS cells
 * in each part. */
#include "sim/gas/gas.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/pages.h"
#include "scene/gas_extent.h"
#include "shared/random.h"
#include "sim/gas/kernels.h"
#include "sim/gas/motion.h"
#include "sim/gas/solids.h"
#include "sim/gas/sources.h"
#include "sim/world/force_params.h"

/* The greatest temperature: more than the hottest that a look shows. */
#define HOTTEST 1.2f
/* Part of the velocity's Laplacian, in cells, that is added in a second; most in a substep. */
#define SMOOTHING     0.6f
#define MOST_SMOOTHED 0.1f
/* Parts of a step are chosen for speeds so much greater than that of the step before. */
#define SPEED_MARGIN 1.1f

struct gas_domain {
    const struct kiln_gas_domain *settings;
    struct gas_solver solver;
    struct gas_sources sources;
    struct gas_solids solids;
    bool has_solids;
    float4 *lattice; /* sums of forces at the points of a lattice; NULL: there are no forces */
    size_t lattice_points;
    struct kiln_gas_place lattice_at, lattice_cells; /* window that the lattice is of */
    uint32_t lattice_step;
    struct gas_lattice held;  /* of that lattice */
    bool moves;               /* with a node */
    struct gas_motion motion; /* at the end of the step */
};

bool kiln_gas_stage_init(struct kiln_gas_stage *stage, struct kiln_device *device,
                         const struct kiln_scene *scene, enum kiln_gas_technique technique,
                         struct kiln_threads *threads, struct kiln_error *error)
{
    *stage = (struct kiln_gas_stage){.scene = scene, .threads = threads};
    if (scene->gas_count == 0)
        return true;
    if (technique == KILN_GAS_GL && !(stage->kernels = gas_kernels_create(device, error)))
        return false;
    stage->domains = calloc(scene->gas_count, sizeof *stage->domains);
    if (!stage->domains)
        return kiln_error_no_memory(error, "gas");
    stage->count = scene->gas_count;
    for (uint32_t i = 0; i < stage->count; i++) {
        struct gas_domain *d = &stage->domains[i];
        d->settings = &scene->gas[i];
        gas_sources_init(&d->sources, scene, i);
        gas_solids_init(&d->solids, scene, d->settings, threads);
        d->has_solids = gas_solids_wanted(scene, d->settings);
        d->moves = d->settings->attach.name && !kiln_node_stands(scene, d->settings->attach.node);
    }
    return true;
}

void kiln_gas_stage_finish(struct kiln_gas_stage *stage)
{
    for (uint32_t i = 0; i < stage->count; i++) {
        struct gas_domain *d = &stage->domains[i];
        if (d->solver.gas)
            gas_solver_finish(&d->solver);
        gas_sources_finish(&d->sources);
        gas_solids_finish(&d->solids);
        free(d->lattice);
    }
    free(stage->domains);
    gas_kernels_destroy(&stage->kernels);
    *stage = (struct kiln_gas_stage){.count = 0};
}

/* ---- constants ------------------------------------------------------------------------------- */

/* Evaluates values of a domain at a time. */
struct moment {
    const struct kiln_scene *scene;
    const struct kiln_gas_domain *domain;
    uint32_t number; /* of the domain */
    float time_s;
};

static float setting(const struct moment *m, const struct kiln_value *value)
{
    return exact_canon(
        kiln_scene_system_value(m->scene, KILN_SYSTEM_OF_GAS(m->number), value, m->time_s));
}

/* Returns the part that is left of what decays with a rate, 1/s. */
static float left_after(float rate, float dt)
{
    return exact_exp(-rate * dt);
}

static void fill_burning(struct kiln_gas_step *step, const struct moment *m)
{
    const struct kiln_gas_burn *burn = &m->domain->burn;
    const float dt = step->dt, rate = setting(m, &burn->rate);
    step->ignition = setting(m, &burn->ignition);
    step->burnt = 1.0f - left_after(rate, dt);
    step->heat = setting(m, &burn->heat);
    step->soot = setting(m, &burn->soot);
    step->expand = setting(m, &burn->expand);
    step->expansion = step->expand / dt;
    step->flame_fade = exact_div(dt, exact_max(setting(m, &burn->life), 1e-3f));
    step->flame_gain = setting(m, &burn->gain) / dt;
    step->smoke_burnt = setting(m, &burn->clear) * dt;
}

/* Returns the world's direction up in the frame of a domain, over the scale of its node. */
static float3 up_in(const struct moment *m)
{
    const struct kiln_node_frame frame = gas_frame(m->scene, &m->domain->attach, m->time_s);
    double axis[3][3];
    gas_axes(&frame, axis);
    return FLOAT3(exact_canon((float)(axis[0][1] / frame.scale)),
                  exact_canon((float)(axis[1][1] / frame.scale)),
                  exact_canon((float)(axis[2][1] / frame.scale)));
}

static struct kiln_gas_step constants_of(const struct moment *m, float dt, float kept)
{
    const struct kiln_gas_domain *d = m->domain;
    struct kiln_gas_step step = {.dt = dt, .cell = d->shape.cell, .hottest = HOTTEST};
    const float3 up = up_in(m);
    const float rise = setting(m, &d->buoyancy) * dt, sink = setting(m, &d->weight) * dt;
    step.cells_a_velocity = dt / step.cell;
    step.rise = FLOAT4(up.x * rise, up.y * rise, up.z * rise, 0.0f);
    step.sink = FLOAT4(up.x * sink, up.y * sink, up.z * sink, 0.0f);
    step.slow = left_after(setting(m, &d->drag), dt);
    step.smoke_left = left_after(setting(m, &d->decay), dt) * kept;
    step.cool = setting(m, &d->cool_glow) * dt;
    step.cool_even = setting(m, &d->cool_even) * dt;
    step.confinement = 0.5f * setting(m, &d->vorticity) * dt;
    step.smoothing = exact_min(SMOOTHING * dt, MOST_SMOOTHED);
    step.keep_velocity = d->burn.enabled;
    if (d->burn.enabled)
        fill_burning(&step, m);
    else
        step.ignition = 2.0f * HOTTEST;
    return step;
}

static struct gas_stir stir_of(const struct moment *m, float dt, uint32_t seed)
{
    const struct kiln_gas_turbulence *t = &m->domain->turbulence;
    const float size = exact_max(setting(m, &t->size), 1e-3f);
    const float strength = setting(m, &t->strength);
    return (struct gas_stir){
        .strength = strength * dt,
        .scale = m->domain->shape.cell / size,
        .rise = setting(m, &t->speed) * m->time_s / size,
        .octaves = t->octaves,
        .seed = random_mix(seed),
    };
}

/* What the parts of a step of a domain share. */
struct run {
    struct kiln_gas_stage *stage;
    struct gas_domain *domain;
    uint32_t number;
    struct kiln_gas *gas;
    const struct kiln_sim *sim;
    const struct kiln_gas_forces *forces;
    uint32_t step;
    float start_s;
    float done; /* part of the step that is done, after the substep */
};

/* ---- forces ---------------------------------------------------------------------------------- */

/* Returns the points of the lattice over a window. */
static struct kiln_grid grid_of(const struct kiln_gas *gas)
{
    const struct kiln_gas_shape *shape = &gas->shape;
    const float apart = shape->cell * (float)GAS_LATTICE;
    return (struct kiln_grid){
        .origin = FLOAT4(shape->corner.x + (float)gas->at.x * shape->cell,
                         shape->corner.y + (float)gas->at.y * shape->cell,
                         shape->corner.z + (float)gas->at.z * shape->cell, 0.0f),
        .high = FLOAT4(apart, apart, apart, 0.0f),
        .size = UINT4((uint32_t)gas->cells.x / GAS_LATTICE + 1,
                      (uint32_t)gas->cells.y / GAS_LATTICE + 1,
                      (uint32_t)gas->cells.z / GAS_LATTICE + 1, 0),
    };
}

static bool is_place(struct kiln_gas_place a, struct kiln_gas_place b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Returns how fast the motion of a domain changes in a step, in its axes at the step's end: by its
 * velocities at both ends in the world. */
static struct gas_motion change_of(const struct run *run)
{
    const struct kiln_node_step at =
        kiln_node_step_at(run->stage->scene, run->domain->settings->attach.node, run->step);
    struct kiln_node_frame change = at.on;
    const double dt = (double)run->stage->scene->dt_s;
    for (int c = 0; c < 3; c++) {
        change.velocity[c] = (at.on.velocity[c] - at.start.velocity[c]) / dt;
        change.spin[c] = (at.on.spin[c] - at.start.spin[c]) / dt;
    }
    return gas_motion_of(&change);
}

/* Adds what air feels in a domain that moves: the negative acceleration of the domain at each
 * point; and to the pull of a wind, whose air moves in the world, that of the air that is at rest
 * there. */
static void add_inertia(const struct run *run, const struct kiln_grid *grid, float4 *words,
                        struct gas_lattice *lattice)
{
    const struct gas_motion now = run->domain->motion, change = change_of(run);
    float4 *word = words;
    for (uint32_t z = 0; z < grid->size.z; z++)
        for (uint32_t y = 0; y < grid->size.y; y++)
            for (uint32_t x = 0; x < grid->size.x; x++, word++) {
                const double p[3] = {(double)(grid->origin.x + (float)x * grid->high.x),
                                     (double)(grid->origin.y + (float)y * grid->high.y),
                                     (double)(grid->origin.z + (float)z * grid->high.z)};
                double across[3], outwards[3], turning[3];
                gas_cross(now.spin, p, across);
                gas_cross(now.spin, across, outwards);
                gas_cross(change.spin, p, turning);
                const double pull = (double)word->w;
                float more[3];
                for (int c = 0; c < 3; c++)
                    more[c] = (float)(change.velocity[c] + outwards[c] + turning[c] +
                                      pull * (now.velocity[c] + across[c]));
                word->x -= more[0];
                word->y -= more[1];
                word->z -= more[2];
            }
    for (int c = 0; c < 3; c++)
        lattice->twice_spin[c] = (float)(2.0 * now.spin[c]);
}

static bool has_lattice(const struct gas_domain *d)
{
    return d->settings->force_count > 0 || d->moves;
}

/* Returns the drag of a domain in a step, 1/s. */
static float drag_of(const struct run *run)
{
    const struct kiln_scene *scene = run->stage->scene;
    const struct moment m = {scene, run->domain->settings, run->number,
                             kiln_scene_time(scene, run->step)};
    return setting(&m, &m.domain->drag);
}

/* Adds the drag of a domain to the pull of its forces: it holds all air, also where there is no
 * gas.
 */
static void add_drag(float4 *words, size_t points, float drag)
{
    for (size_t i = 0; i < points; i++)
        words[i].w += drag;
}

/* Fills the lattice of forces, unless it is that of the step and the window already. */
static bool fill_lattice(const struct run *run, struct gas_lattice *lattice)
{
    struct gas_domain *d = run->domain;
    const struct kiln_gas *gas = run->gas;
    const uint32_t step = run->step;
    const struct kiln_grid grid = grid_of(gas);
    const size_t points = (size_t)grid.size.x * grid.size.y * grid.size.z;
    *lattice = (struct gas_lattice){.points = NULL};
    if (!has_lattice(d) || gas->cells.x == 0)
        return true;
    if (d->lattice_step != step || !is_place(d->lattice_at, gas->at) ||
        !is_place(d->lattice_cells, gas->cells)) {
        if (d->lattice_points != points) {
            free(d->lattice);
            d->lattice = kiln_alloc_pages(points * sizeof *d->lattice);
            d->lattice_points = d->lattice ? points : 0;
        }
        if (!d->lattice)
            return false;
        memset(d->lattice, 0, points * sizeof *d->lattice);
        if (d->settings->force_count > 0)
            run->forces->fill(run->forces->context, run->sim, run->number, &grid, step, d->lattice);
        add_drag(d->lattice, points, drag_of(run));
        d->held = (struct gas_lattice){
            .points = d->lattice, .row = grid.size.x, .plane = grid.size.x * grid.size.y};
        if (d->moves)
            add_inertia(run, &grid, d->lattice, &d->held);
        gas_new_air_bounds(&d->held, gas, &d->solver.rest, drag_of(run));
        d->lattice_step = step;
        d->lattice_at = gas->at;
        d->lattice_cells = gas->cells;
    }
    *lattice = d->held;
    return true;
}

/* ---- a step ---------------------------------------------------------------------------------- */

static bool add_sources(void *context, const struct gas_pass *pass, gas_brick_place at)
{
    const struct run *run = context;
    return gas_sources_add(&run->domain->sources, pass, run->domain->solver.advect, at);
}

static bool brings(void *context, uint32_t source, struct gas_brought *brought)
{
    const struct run *run = context;
    return gas_sources_brings(&run->domain->sources, source, brought);
}

static bool reach(void *context, const struct gas_pass *pass, uint32_t source, gas_brick_place at,
                  float4 *cells)
{
    const struct run *run = context;
    const struct gas_domain *d = run->domain;
    return gas_sources_reach(&d->sources, pass, d->solver.advect, source, at, cells);
}

/* Returns the clip time after a part of the step. */
static float time_of(const struct run *run, float part)
{
    const float end_s = kiln_scene_time(run->stage->scene, run->step);
    return part >= 1.0f ? end_s : run->start_s + (end_s - run->start_s) * part;
}

static bool move_solids(struct run *run, const struct gas_levels *levels, float part)
{
    return gas_solids_move(&run->domain->solids, run->gas, levels, run->sim, part,
                           time_of(run, part));
}

static void show_walls(const struct run *run, struct gas_pass *pass)
{
    const struct gas_solids *solids = &run->domain->solids;
    pass->walls = solids->walls;
    pass->walls_made = solids->made;
    pass->emptied = solids->emptied;
    pass->emptied_count = solids->emptied_count;
}

static bool move_walls(void *context, struct gas_pass *pass, const struct gas_levels *levels)
{
    struct run *run = context;
    if (!move_solids(run, levels, run->done))
        return false;
    show_walls(run, pass);
    return true;
}

static bool report(struct run *run, enum gas_failure failure, struct kiln_error *error)
{
    const struct kiln_gas_shape *shape = &run->gas->shape;
    struct kiln_gas_place cell = {0, 0, 0};
    if (failure == GAS_STEPPED || failure == GAS_STOPPED)
        return failure == GAS_STEPPED;
    if (failure == GAS_NO_MEMORY)
        return kiln_error_no_memory(error, "gas.%s", run->domain->settings->name);
    if (kiln_gas_fetch(run->gas, error))
        gas_solver_find_wrong(&run->domain->solver, &cell);
    return kiln_error_set(
        error, KILN_DEVICE_FAILED,
        "gas.%s: found a number that is not finite in step %u at (%.3g, %.3g, %.3g) m; smaller "
        "values of its sources and forces, or more substeps, may help",
        run->domain->settings->name, run->step,
        (double)(shape->corner.x + ((float)cell.x + 0.5f) * shape->cell),
        (double)(shape->corner.y + ((float)cell.y + 0.5f) * shape->cell),
        (double)(shape->corner.z + ((float)cell.z + 0.5f) * shape->cell));
}

/* Returns how many parts the rest of a step needs so that nothing moves too far in one. */
static uint32_t parts_of(const struct kiln_gas *gas, float rest_s, uint32_t most)
{
    const float cells = SPEED_MARGIN * gas->fastest * rest_s / gas->shape.cell;
    const float parts = exact_clamp(cells / (float)GAS_MOST_CELLS, 0.0f, (float)most);
    const uint32_t whole = (uint32_t)parts;
    return whole + (parts > (float)whole ? 1 : 0);
}

/* Returns the length of the next part of a step, in parts of the step. left: parts that may come.
 */
static float next_part(const struct run *run, float dt, uint32_t left)
{
    const struct kiln_gas_domain *settings = run->domain->settings;
    const float rest = 1.0f - run->done;
    if (left <= 1)
        return rest;
    if (settings->substeps > 0)
        return rest / (float)left;
    const double rate = (double)run->stage->scene->rate.num / run->stage->scene->rate.den;
    const double least = ceil(settings->rate / rate * (double)rest - 1e-6);
    uint32_t parts = parts_of(run->gas, rest * dt, left);
    parts = (double)parts < least ? (uint32_t)least : parts;
    parts = parts < 1 ? 1 : parts > left ? left : parts;
    return rest / (float)parts;
}

/* Returns how air moves in a domain that is at rest in the world. */
static struct gas_rest rest_of(const struct gas_domain *d)
{
    struct gas_rest rest;
    for (int c = 0; c < 3; c++) {
        rest.velocity[c] = exact_canon((float)-d->motion.velocity[c]);
        rest.spin[c] = exact_canon((float)-d->motion.spin[c]);
    }
    return rest;
}

/* Lets the air that the window has just reached move as forces have moved it. Where a domain moves,
 * air that no window had before is at rest. */
static void blow_new_air(const struct run *run, const struct gas_lattice *forces, float part)
{
    const struct gas_domain *d = run->domain;
    const struct kiln_scene *scene = run->stage->scene;
    const float blown_s = d->moves ? 0.0f : time_of(run, part) - kiln_scene_time(scene, 0);
    if (d->solver.reached && d->settings->force_count > 0 && forces->points)
        gas_new_air_blown(run->gas, d->solver.old_at, d->solver.old_cells, &d->solver.rest, forces,
                          blown_s, drag_of(run));
}

/* Wakes the bricks that gas and sources reach, and finds the walls at the beginning of a substep.
 * They are found anew at the beginning of each step: a run that begins there then has the same. */
static bool begin(struct run *run, struct gas_pass *pass, float part, struct kiln_error *error)
{
    struct gas_domain *d = run->domain;
    struct gas_region regions[KILN_MAX_GAS_SOURCES];
    for (uint32_t i = 0; i < d->sources.count; i++)
        regions[i] = d->sources.source[i].region;
    d->solver.rest = rest_of(d);
    *pass = (struct gas_pass){.gas = run->gas};
    const enum gas_failure failure = gas_solver_prepare(&d->solver, regions, d->sources.count,
                                                        d->has_solids, has_lattice(d), error);
    if (failure != GAS_STEPPED)
        return report(run, failure, error);
    const bool ok = fill_lattice(run, &pass->forces) &&
                    (!d->has_solids || run->gas->cells.x == 0 ||
                     (part > 0.0f && gas_solids_are_of(&d->solids, run->gas)) ||
                     move_solids(run, &d->solver.levels, part));
    if (ok)
        blow_new_air(run, &pass->forces, part);
    if (d->has_solids && run->gas->cells.x > 0)
        show_walls(run, pass);
    return ok || report(run, GAS_NO_MEMORY, error);
}

static void warn(struct run *run)
{
    struct kiln_gas_stage *stage = run->stage;
    const struct kiln_gas_domain *settings = run->domain->settings;
    const double left = run->domain->solver.left_over;
    if (settings->residual <= 0.0 || left <= settings->residual || stage->warned[run->number])
        return;
    stage->warned[run->number] = true;
    snprintf(stage->warning, sizeof stage->warning,
             "gas.%s.pressure.residual: step %u left %.2g of the divergence, more than %.2g; more "
             "`cycles` leave less",
             settings->name, run->step, left, settings->residual);
}

static bool run_domain(struct run *run, float dt, struct kiln_error *error)
{
    struct gas_domain *d = run->domain;
    const struct kiln_gas_domain *settings = d->settings;
    const struct gas_hooks hooks = {.context = run,
                                    .add = add_sources,
                                    .brings = brings,
                                    .reach = reach,
                                    .move_walls = d->has_solids ? move_walls : NULL};
    const uint32_t most = settings->substeps > 0 ? settings->substeps : KILN_MAX_SUBSTEPS;
    gas_solver_begin_ways(&d->solver, run->start_s, time_of(run, 1.0f));
    for (uint32_t left = most; left > 0 && run->done < 1.0f; left--) {
        const float part = next_part(run, dt, left), begins = run->done;
        struct gas_pass pass;
        if (!begin(run, &pass, begins, error))
            return false;
        run->done = left == 1 || part >= 1.0f - begins ? 1.0f : begins + part;
        const struct moment m = {run->stage->scene, settings, run->number, time_of(run, run->done)};
        struct kiln_gas_step step = constants_of(&m, part * dt, run->gas->kept);
        if (has_lattice(d))
            step.slow = 1.0f; /* the lattice has the drag */
        pass.step = &step;
        pass.stir = stir_of(&m, step.dt, run->stage->scene->seed + 0x73746972u + run->number);
        gas_sources_set_time(&d->sources, step.dt);
        const enum gas_failure failure =
            gas_solver_step(&d->solver, &pass, &hooks, settings->cycles, settings->residual, error);
        if (failure != GAS_STEPPED)
            return report(run, failure, error);
    }
    warn(run);
    return true;
}

/* Lets the colliders of a step be asked on the host. */
static bool fill_sim(struct kiln_sim *sim, const struct kiln_scene *scene,
                     const struct kiln_sim_params *params, struct kiln_error *error)
{
    struct kiln_sim_grids *grids = params->grids;
    *sim = (struct kiln_sim){.step = &params->systems[0],
                             .surroundings = &params->surroundings,
                             .value_keys = scene->keys};
    if (grids->words.size > 0 &&
        !(sim->grid_words = kiln_buffer_host(&grids->words, KILN_READ, error)))
        return false;
    return grids->volumes.count == 0 ||
           (sim->volume_words = kiln_buffer_host(&grids->volumes.words, KILN_READ, error));
}

bool kiln_gas_stage_step(struct kiln_gas_stage *stage, struct kiln_pool *pool,
                         const struct kiln_sim_params *params, const struct kiln_gas_forces *forces,
                         uint32_t step, struct kiln_error *error)
{
    struct kiln_sim sim;
    enum kiln_simd simd;
    if (stage->count == 0)
        return true;
    if (!fill_sim(&sim, stage->scene, params, error) || !kiln_simd_choose(&simd, error))
        return false;
    for (uint32_t i = 0; i < stage->count; i++) {
        struct gas_domain *d = &stage->domains[i];
        if (!d->settings->enabled)
            continue;
        if (!d->solver.gas &&
            !gas_solver_init(&d->solver, &pool->gas[i], stage->threads, simd, stage->kernels))
            return kiln_error_no_memory(error, "gas.%s", d->settings->name);
        struct run run = {
            .stage = stage,
            .domain = d,
            .number = i,
            .gas = &pool->gas[i],
            .sim = &sim,
            .forces = forces,
            .step = step,
            .start_s = kiln_scene_time(stage->scene, step - 1),
        };
        if (d->moves) {
            const struct kiln_node_step at =
                kiln_node_step_at(stage->scene, d->settings->attach.node, step);
            d->motion = gas_motion_of(&at.on);
        }
        if (!gas_sources_set(&d->sources, pool, step, error) ||
            !run_domain(&run, stage->scene->dt_s, error))
            return false;
    }
    return true;
}

const char *kiln_gas_stage_warning(struct kiln_gas_stage *stage)
{
    if (stage->told || !stage->warning[0])
        return NULL;
    stage->told = true;
    return stage->warning;
}

void kiln_gas_stage_seconds(struct kiln_gas_stage *stage, double seconds[])
{
    for (int k = 0; k < GAS_TIMERS; k++)
        seconds[k] = 0.0;
    for (uint32_t i = 0; i < stage->count; i++) {
        struct gas_solver *solver = &stage->domains[i].solver;
        for (int k = 0; k < GAS_TIMERS; k++)
            seconds[k] += solver->seconds[k];
        solver->measures = true;
    }
}

/* ---- memory ---------------------------------------------------------------------------------- */

void kiln_gas_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    for (uint32_t i = 0; i < scene->gas_count; i++) {
        const struct kiln_gas_domain *d = &scene->gas[i];
        const struct kiln_gas_place n = kiln_gas_extent(scene, i).cells;
        const uint64_t cells = (uint64_t)n.x * (uint64_t)n.y * (uint64_t)n.z;
        const bool blows = d->force_count > 0 || d->attach.name;
        if (!d->enabled)
            continue;
        kiln_footprint_add(footprint, KILN_FOOTPRINT_GAS, 1,
                           gas_solver_bytes(n, gas_solids_wanted(scene, d), blows));
        kiln_footprint_add(footprint, KILN_FOOTPRINT_GAS, blows ? cells / 8 : 0, sizeof(float4));
        kiln_footprint_add(footprint, KILN_FOOTPRINT_GAS, footprint->threads,
                           sizeof(struct gas_workspace));
    }
}
