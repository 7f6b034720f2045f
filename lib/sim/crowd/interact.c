/* This file gathers the pushes of all systems whose particles interact. It works out what each
 * system needs and how far ahead its collisions are looked for, then calls the host's code or the
 * GL kernels. Where the scene does not say how far ahead, bounds of the velocities decide
 * (shared/interact_speeds.h). */
#include "sim/crowd/interact.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>

#include "base/error.h"
#include "shared/interact_speeds.h"
#include "sim/crowd/papers/papers.h"

static_assert(sizeof(struct kiln_interact_params) == 288, "std140");
static_assert(offsetof(struct kiln_interact_params, spins) == 264, "std140");
static_assert(offsetof(struct kiln_interact_params, radius) == 96, "std140");
static_assert(offsetof(struct kiln_interact_params, flock) == 176, "std140");
static_assert(sizeof(struct kiln_flock_params) == 80, "std140");
static_assert(sizeof(struct kiln_body) == 32, "std430");

/* Cells are wider than two radii by this factor. It covers the rounding of positions up to 2^18
 * cells from the origin when their cell is found. */
static const float CELL_SLACK = 1.0f + 1.0f / 64.0f;

/* MOST_AHEAD: the most that `fastest: auto` looks ahead in a step, in widths of a particle. UNSEEN:
 * the part of a width that two particles may overlap unnoticed without a warning. */
static const float MOST_AHEAD = 2.0f, UNSEEN = 0.1f;

/* The size of an entry of a body, a uvec4 in GL. */
enum { ENTRY_BYTES = 16 };

/* The ways to find the partners of bodies that collide. */
static const struct kiln_contact_row *const CONTACTS[KILN_CONTACT_MODES] = {
    [KILN_CONTACT_EXACT] = &kiln_contact_exact_row,
    [KILN_CONTACT_STAGGERED] = &kiln_contact_staggered_row,
};

const struct kiln_contact_row *kiln_contact_row(enum kiln_contact_mode mode)
{
    return CONTACTS[mode];
}

/* The hash table of cells is sparse, so that few entries hold particles of different places, and
 * takes no more than 64 MiB. */
enum { CELLS_A_PARTICLE = 2, MAX_CELLS = 1 << 24 };

uint32_t kiln_interact_entries(uint32_t count)
{
    uint32_t entries = 64;
    while (entries < count)
        entries *= 2;
    return entries;
}

static uint32_t count_cells(uint32_t particles)
{
    return kiln_interact_entries(
        particles < MAX_CELLS / CELLS_A_PARTICLE ? particles * CELLS_A_PARTICLE : MAX_CELLS);
}

static void add_collisions(struct kiln_interact_work *work, const struct kiln_scene *scene,
                           uint32_t system)
{
    const struct kiln_interaction *collide =
        kiln_scene_interaction(scene, system, KILN_INTERACT_COLLIDE);
    if (!collide)
        return;
    const struct kiln_look *look = &scene->systems[system].look;
    struct kiln_interact_params *params = &work->params;
    work->collides = true;
    work->mode = collide->mode;
    work->rounds = collide->rounds;
    params->cell_mask = count_cells(scene->systems[system].capacity) - 1;
    work->width_m = 2.0f * kiln_scene_contact_radius(scene, system);
    work->fastest = kiln_scene_system_value(scene, system, &collide->fastest, params->time_s);
    params->as_drawn = collide->as_drawn;
    params->restitution =
        kiln_scene_system_value(scene, system, &collide->restitution, params->time_s);
    params->apart = kiln_scene_system_value(scene, system, &collide->apart, params->time_s);
    params->radius = collide->radius;
    params->size = look->size;
    params->scale = look->scale;
    params->friction = kiln_scene_system_value(scene, system, &collide->friction, params->time_s);
}

/* Fills in the parameters that all kinds of interaction of a system share. */
static struct kiln_interact_params params_of(const struct kiln_step_params *step)
{
    return (struct kiln_interact_params){.derived = step->derived,
                                         .base = step->base,
                                         .used = step->used,
                                         .first_push = step->first_push,
                                         .first_spin = step->first_spin,
                                         .step = step->step - 1,
                                         .time_s = step->time_s};
}

static void add_gravity(struct kiln_interact_work *work, const struct kiln_scene *scene,
                        const struct kiln_sim_params *params, uint32_t system)
{
    const struct kiln_interaction *gravity =
        kiln_scene_interaction(scene, system, KILN_INTERACT_GRAVITY);
    if (!gravity)
        return;
    const float softening_m =
        kiln_scene_system_value(scene, system, &gravity->softening, work->params.time_s);
    work->pulls = true;
    work->params.adds = work->collides;
    work->params.softening_square = softening_m * softening_m;
    work->of_other = gravity->of_other;
    work->sources = params_of(&params->systems[gravity->of_other ? gravity->source : system]);
    work->sources.strength = gravity->strength;
}

/* Returns the square of the cosine of half an angle, with the cosine's sign. A full turn gives -2,
 * which no rounding reaches. */
static float view_of(float angle)
{
    const float cosine = exact_sincos(0.5f * angle).cosine;
    return angle > 6.28318f ? -2.0f : cosine * exact_abs(cosine);
}

static struct kiln_flock_params flock_at(const struct kiln_scene *scene, uint32_t system,
                                         const struct kiln_flock *flock, float time_s)
{
    const float radius = kiln_scene_system_value(scene, system, &flock->radius, time_s);
    const float horizon_s = kiln_scene_system_value(scene, system, &flock->horizon, time_s);
    const float slowest = kiln_scene_system_value(scene, system, &flock->slowest, time_s);
    const float fastest = kiln_scene_system_value(scene, system, &flock->fastest, time_s);
    struct kiln_flock_params params = {
        .radius = radius,
        .radius_square = radius * radius,
        .per_radius = 1.0f / radius,
        .per_space = 1.0f / kiln_scene_system_value(scene, system, &flock->space, time_s),
        .speed = 2.0f * fastest,
        .per_speed = 0.5f / fastest,
        .horizon_s = horizon_s,
        .per_horizon = 1.0f / horizon_s,
        .view = view_of(kiln_scene_system_value(scene, system, &flock->view, time_s)),
        .separation = kiln_scene_system_value(scene, system, &flock->separation, time_s),
        .avoidance = kiln_scene_system_value(scene, system, &flock->avoidance, time_s),
        .cohesion = kiln_scene_system_value(scene, system, &flock->cohesion, time_s),
        .all_cohesion = kiln_scene_system_value(scene, system, &flock->all_cohesion, time_s),
        .alignment = kiln_scene_system_value(scene, system, &flock->alignment, time_s),
        .all_alignment = kiln_scene_system_value(scene, system, &flock->all_alignment, time_s),
        .strongest = kiln_scene_system_value(scene, system, &flock->acceleration, time_s),
        .slowest = slowest < fastest ? slowest : fastest,
        .fastest = fastest,
    };
    params.looks = params.separation > 0.0f || params.avoidance > 0.0f || params.cohesion > 0.0f ||
                   params.alignment > 0.0f;
    return params;
}

static void add_flock(struct kiln_interact_work *work, const struct kiln_scene *scene,
                      uint32_t system)
{
    const struct kiln_interaction *flock =
        kiln_scene_interaction(scene, system, KILN_INTERACT_FLOCK);
    if (!flock)
        return;
    struct kiln_interact_params *params = &work->params;
    work->flocks = true;
    params->adds = scene->systems[system].interaction_count > 1;
    params->flock = flock_at(scene, system, &flock->flock, params->time_s);
    params->cell_mask = count_cells(scene->systems[system].capacity) - 1;
    params->cells_per_metre = 1.0f / (params->flock.radius * CELL_SLACK);
}

/* Fills in the work of a system: its flock, or its collisions and gravity. The cells of a flock
 * have another size than those of collisions, so a system that has both has two works. */
static struct kiln_interact_work work_of(const struct kiln_scene *scene,
                                         const struct kiln_sim_params *params, uint32_t system,
                                         bool flock)
{
    struct kiln_interact_work work = {.system = scene->systems[system].name,
                                      .params = params_of(&params->systems[system])};
    work.params.spins = params->systems[system].spins && !flock;
    if (flock) {
        add_flock(&work, scene, system);
    } else {
        add_collisions(&work, scene, system);
        add_gravity(&work, scene, params, system);
    }
    return work;
}

static bool choose_loops(struct kiln_interact *interact, struct kiln_error *error)
{
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error))
        return false;
    interact->gravity = KILN_SIMD_PICK(kiln_gravity_loops, simd);
    interact->flock = KILN_SIMD_PICK(kiln_flock_loops, simd);
    return true;
}

/* Returns the capacity of the largest system that interacts or whose particles pull another's. */
static uint32_t largest_system(const struct kiln_scene *scene)
{
    uint32_t largest = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        if (scene->systems[i].interaction_count == 0)
            continue;
        const struct kiln_interaction *gravity =
            kiln_scene_interaction(scene, i, KILN_INTERACT_GRAVITY);
        const uint32_t other =
            gravity && gravity->of_other ? scene->systems[gravity->source].capacity : 0;
        const uint32_t own = scene->systems[i].capacity;
        largest = own > largest ? own : largest;
        largest = other > largest ? other : largest;
    }
    return largest;
}

/* Returns the number of bodies to allocate. Balls that spin take two each
 * (shared/interact_layout.h). */
static size_t count_bodies(const struct kiln_scene *scene, uint32_t largest)
{
    size_t most = largest;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const size_t own = 2 * (size_t)scene->systems[i].capacity;
        if (kiln_scene_system_spins(scene, i) && own > most)
            most = own;
    }
    return most;
}

/* Holds the sizes of buffers, in elements. */
struct sizes {
    uint64_t pushes, bodies, cells, entries, partners, order, accelerations;
};

static struct sizes sizes_of(const struct kiln_scene *scene)
{
    const uint32_t largest = largest_system(scene);
    struct sizes sizes = {
        .bodies = count_bodies(scene, largest),
        .cells = (largest ? count_cells(largest) : 0) + (uint64_t)1,
        .entries = largest ? 2 * (uint64_t)kiln_interact_entries(largest) : 0,
        .partners = largest,
        .order = 2 * (uint64_t)largest,
        .accelerations = (uint64_t)largest + KILN_GRAVITY_BLOCK,
    };
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const uint64_t capacity = scene->systems[i].capacity;
        sizes.pushes += scene->systems[i].interaction_count > 0 ? 2 * capacity : 0;
    }
    return sizes;
}

bool kiln_interact_init(struct kiln_interact *interact, struct kiln_device *device,
                        const struct kiln_scene *scene, struct kiln_threads *threads,
                        struct kiln_error *error)
{
    *interact = (struct kiln_interact){.scene = scene, .device = device, .threads = threads};
    const struct sizes sizes = sizes_of(scene);
    const size_t bodies = sizes.bodies * sizeof(struct kiln_body);
    kiln_buffer_init(&interact->pushes, device, sizes.pushes * sizeof(float4), "pushes");
    kiln_buffer_init(&interact->bodies, device, bodies, "bodies");
    kiln_buffer_init(&interact->second, device, bodies + KILN_FLOCK_ROOM, "bodies, second");
    interact->half = (uint32_t)(sizes.entries / 2);
    kiln_buffer_init(&interact->cells, device, sizes.cells * sizeof(uint32_t), "cells of bodies");
    kiln_buffer_init(&interact->partners, device, sizes.partners * sizeof(uint32_t), "partners");
    kiln_buffer_init(&interact->entries, device, sizes.entries * ENTRY_BYTES, "bodies in grids");
    kiln_buffer_init(&interact->order, device, sizes.order * sizeof(uint32_t), "order of a grid");
    kiln_buffer_init(&interact->contact_scratch, NULL, 0, "scratch of contacts");
    kiln_buffer_init(&interact->accelerations, NULL, sizes.accelerations * sizeof(float3),
                     "accelerations");
    kiln_buffer_init(&interact->block, device, sizeof(struct kiln_interact_params),
                     "interaction parameters");
    if (!device)
        return choose_loops(interact, error);
    if (!device->info.software && bodies > (uint64_t)device->info.max_storage_block_bytes)
        return kiln_error_set(
            error, KILN_DEVICE_FAILED,
            "systems: particles that interact need %zu bytes in one piece; %s allows %" PRId64
            "; use simulate=cpu",
            bodies, device->info.name, (int64_t)device->info.max_storage_block_bytes);
    return sizes.partners == 0 || kiln_interact_gl_init(interact, error);
}

void kiln_interact_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct sizes sizes = sizes_of(scene);
    const uint64_t bytes = sizes.pushes * sizeof(float4) +
                           2 * sizes.bodies * sizeof(struct kiln_body) +
                           (sizes.cells + sizes.partners + sizes.order) * sizeof(uint32_t) +
                           sizes.entries * ENTRY_BYTES + sizes.accelerations * sizeof(float3);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, 1, bytes);
}

void kiln_interact_finish(struct kiln_interact *interact)
{
    kiln_buffer_finish(&interact->pushes);
    kiln_buffer_finish(&interact->bodies);
    kiln_buffer_finish(&interact->second);
    kiln_buffer_finish(&interact->cells);
    kiln_buffer_finish(&interact->partners);
    kiln_buffer_finish(&interact->entries);
    kiln_buffer_finish(&interact->order);
    kiln_buffer_finish(&interact->contact_scratch);
    kiln_buffer_finish(&interact->accelerations);
    kiln_buffer_finish(&interact->block);
    for (size_t i = 0; i < KILN_INTERACT_KERNELS; i++) {
        if (interact->programs[i])
            glDeleteProgram(interact->programs[i]);
    }
    for (size_t mode = 0; mode < KILN_CONTACT_MODES; mode++) {
        for (size_t i = 0; i < KILN_CONTACT_PROGRAMS; i++) {
            if (interact->contact_programs[mode][i])
                glDeleteProgram(interact->contact_programs[mode][i]);
        }
    }
    *interact = (struct kiln_interact){.device = NULL};
}

/* Sets how far ahead collisions are searched: as the scene says, or as far as the velocities need,
 * which differ by up to `spread` m/s. The distance is limited, since cells grow with it. */
static void foresee(struct kiln_interact *interact, struct kiln_interact_work *work, float spread)
{
    struct kiln_interact_params *params = &work->params;
    const float dt_s = params->derived.dt_s, most = MOST_AHEAD * work->width_m / dt_s;
    float fastest = work->fastest;
    const bool found = fastest < 0.0f;
    if (found)
        fastest = spread < most ? spread : most;
    params->cells_per_metre = 1.0f / ((work->width_m + fastest * dt_s) * CELL_SLACK);
    params->ahead_s = fastest > 0.0f ? dt_s : 0.0f;
    params->fastest_square = fastest * fastest;
    if (interact->warning[0] || spread <= fastest || spread * dt_s <= UNSEEN * work->width_m)
        return;
    char key[160];
    const double wanted = ceil((double)spread * 10) / 10;
    snprintf(key, sizeof key, "systems.%s.interact: collide.fastest", work->system);
    if (found)
        snprintf(interact->warning, sizeof interact->warning,
                 "%s: step %u: velocities differ by up to %.1f m/s, but auto looks ahead for only "
                 "%.1f m/s, so particles may pass through each other; use a higher "
                 "simulation.rate, or fastest: %.1f m/s, which takes longer",
                 key, (unsigned)params->step + 1, wanted, (double)most, wanted);
    else
        snprintf(interact->warning, sizeof interact->warning,
                 "%s: step %u: velocities differ by up to %.1f m/s, but fastest is %g m/s, so "
                 "particles may pass through each other; set fastest: %s%.1f m/s",
                 key, (unsigned)params->step + 1, wanted, (double)fastest,
                 spread < most ? "auto or " : "", wanted);
}

/* Returns the largest difference of two velocities of living particles, m/s, rounded up. It is the
 * diagonal of the box around all velocities, since no two particles approach each other faster. */
static float spread_of(const uint32_t bounds[SPEEDS_BOUNDS])
{
    double square = 0;
    for (uint32_t i = 0; i < SPEEDS_BOUNDS; i += 2) {
        const double extent = (double)speeds_value(bounds[i]) + (double)speeds_value(bounds[i + 1]);
        square += bounds[i] ? extent * extent : 0;
    }
    return (float)(sqrt(square) * (1 + 1e-6));
}

/* Finds how far ahead collisions are searched, if the system has collisions. */
static bool find_ahead(struct kiln_interact *interact, struct kiln_interact_work *work,
                       struct kiln_pool *pool, struct kiln_buffer *keys, struct kiln_error *error)
{
    if (!work->collides)
        return true;
    uint32_t bounds[SPEEDS_BOUNDS] = {0};
    if (!kiln_contact_row(work->mode)->looks_ahead) {
        foresee(interact, work, 0.0f);
        return true;
    }
    if (interact->device ? !kiln_interact_gl_speeds(interact, work, pool, keys, bounds, error)
                         : !kiln_interact_cpu_speeds(interact, work, pool, bounds, error))
        return false;
    foresee(interact, work, spread_of(bounds));
    return true;
}

const char *kiln_interact_warning(struct kiln_interact *interact)
{
    if (!interact->warning[0] || interact->warned)
        return NULL;
    interact->warned = true;
    return interact->warning;
}

bool kiln_interact_gather(struct kiln_interact *interact, const struct kiln_sim_params *params,
                          struct kiln_pool *pool, struct kiln_buffer *keys,
                          struct kiln_error *error)
{
    bool ok = true;
    for (uint32_t i = 0; ok && i < params->system_count; i++) {
        if (!params->systems[i].pushed || params->systems[i].used == 0)
            continue;
        for (int flock = 0; ok && flock < 2; flock++) {
            struct kiln_interact_work work = work_of(interact->scene, params, i, flock);
            ok = find_ahead(interact, &work, pool, keys, error) &&
                 (interact->device ? kiln_interact_gl(interact, &work, pool, keys, error)
                                   : kiln_interact_cpu(interact, &work, pool, error));
        }
    }
    return ok;
}
