/* Baked winds hold the sums of their forces at the points of a grid. If this fails, particles in a
 * baked wind move otherwise than in its forces, or a run that begins at a saved state reads a grid
 * of another time than a whole run does. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/baked.h"
#include "shared/bake.h"
#include "sim/step/bakes.h"
#include "support/bad_scenes.h"
#include "support/cmocka.h"
#include "support/parts.h"
#include "support/pools.h"
#include "support/scenes.h"
#include "support/simulation.h"

/* ---- fields ---------------------------------------------------------------------------------- */

/* The forces of a scene's only system in one step. */
struct world {
    struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_sim_params *params;
    struct kiln_sim_grids grids;
    struct kiln_bakes bakes;
    struct kiln_pool pool;
    struct kiln_sim sim;
};

static void world_step(struct world *w, uint32_t step)
{
    struct kiln_error error = {0};
    if (!kiln_sim_params_step(w->params, w->scene, &w->pool, step, &error) ||
        !kiln_bakes_step(&w->bakes, w->params, w->threads, step, &error))
        fail_msg("%s", error.message);
    w->sim = (struct kiln_sim){
        .step = &w->params->systems[0],
        .surroundings = &w->params->surroundings,
        .value_keys = w->scene->keys,
        .grid_words = w->grids.count ? kiln_buffer_host(&w->grids.words, KILN_READ, &error) : NULL,
    };
}

/* Opens a scene with some nodes and forces, in its first step. */
static void world_open(struct world *w, const char *nodes, const char *forces)
{
    struct kiln_error error = {0};
    char text[2048];
    snprintf(text, sizeof text,
             "kiln: 1\nseed: 5\noutput: {fps: 60, frames: 60}\n%ssystems: {a: {emit: {rate: 9}, "
             "forces: [%s]}}\n",
             nodes, forces);
    memset(w, 0, sizeof *w);
    w->scene = load_scene(text, NULL);
    w->threads = kiln_threads_create(2);
    w->params = calloc(1, sizeof *w->params);
    assert_true(w->threads && w->params);
    assert_true(kiln_sim_grids_init(&w->grids, NULL, w->scene, w->threads, &error));
    kiln_sim_params_init(w->params, w->scene, &w->grids);
    assert_true(kiln_bakes_init(&w->bakes, NULL, w->scene, &w->grids, &error));
    pool_init_of(&w->pool, NULL, w->scene);
    world_step(w, 1);
}

static void world_close(struct world *w)
{
    kiln_bakes_finish(&w->bakes);
    kiln_sim_grids_finish(&w->grids);
    kiln_pool_finish(&w->pool);
    kiln_threads_destroy(&w->threads);
    free(w->params);
    kiln_scene_destroy(&w->scene);
}

static struct force_effect effect_at(const struct world *w, float3 place)
{
    const struct kiln_derived_params derived = w->sim.step->derived;
    const struct value_clocks clocks =
        value_clocks_at(w->sim.step->time_s, derived.random_key, derived.scene_key);
    return forces_sum(&w->sim, place, FLOAT3(0.0f, 0.0f, 0.0f), clocks);
}

static double difference(struct force_effect a, struct force_effect b)
{
    const double way = (double)float3_length(float3_sub(a.acceleration, b.acceleration));
    return fmax(way, fabs((double)(a.pull - b.pull)));
}

#define BOX "box: {center: [0.5, 1, 0], size: [4, 4, 2]}"

/* Forces of all kinds, whose values vary over time. */
#define ALL                                                                                        \
    "gravity: {acceleration: {keys: {0 s: [0, -9, 0], 1 s: [3, 0, 0]}}}, drag: 0.5, "              \
    "wind: {velocity: [1, 2, 3], pull: {noise: [0.5, 2], per: system, seed: 3}}, "                 \
    "wind: {velocity: [0.01, 0, 0], mode: add}, "                                                  \
    "curl: {strength: 2, scale: 1.5, octaves: 3, drift: [1, 0, 0], pull: 2}, "                     \
    "vortex: {position: [0.3, 0, 0.2], speed: 3, radius: 0.7, inward: 1, lift: 2, pull: 3, "       \
    "  profile: lamb_oseen, region: {box: {center: [0, 1, 0], size: [3, 3, 3]}, falloff: 1 m}}, "  \
    "attract: {attach: n, position: [0, 3, 0], strength: 2, radius: 1}"
#define NODES "nodes: {n: {position: [0.2, 0.1, 0], rotation: [10 deg, 40 deg, 0], scale: 1.2}}\n"

/* At the points of the grid a baked wind is its forces, in a node and in the world, in every step
 * with every: 1. */
static void points_have_the_forces(void **state)
{
    (void)state;
    static const char *const places[] = {"", "attach: n, "};
    for (size_t k = 0; k < 2; k++) {
        struct world direct, baked;
        char text[1024];
        snprintf(text, sizeof text, "wind: {baked: {%s" BOX ", cells: 8, of: [" ALL "]}}",
                 places[k]);
        world_open(&direct, NODES, ALL);
        world_open(&baked, NODES, text);
        for (uint32_t step = 2; step < 9; step++) {
            world_step(&direct, step);
            world_step(&baked, step);
            const struct kiln_grid grid = baked.params->surroundings.grids[0];
            const struct kiln_still_frame node = baked.sim.step->forces[0].frame;
            assert_true(grid.size.x == 9 && grid.size.y == 9 && grid.size.z == 5);
            for (uint32_t i = 0; i < 9 * 9 * 5; i++) {
                const float3 place = bake_place(grid, node, i % 9, i / 9 % 9, i / 81);
                const double away = difference(effect_at(&direct, place), effect_at(&baked, place));
                if (!(away < 2e-4))
                    fail_msg("step %u, point %u: %g away", step, i, away);
            }
        }
        world_close(&direct);
        world_close(&baked);
    }
}

/* What is the same everywhere stays so, also between the points and outside of the box. */
static void even_winds_are_exact(void **state)
{
    (void)state;
    struct world direct, baked;
    world_open(&direct, "", "gravity: [0, -9, 0], wind: {velocity: [1, 2, 3], pull: 2}");
    world_open(&baked, "",
               "wind: {field: baked, " BOX ", of: [gravity: [0, -9, 0], wind: {velocity: "
               "[1, 2, 3], pull: 2}]}");
    for (int i = 0; i < 1000; i++) {
        const float3 place =
            FLOAT3(0.013f * (float)(i % 100 - 30), 0.31f * (float)(i % 37), 0.1f * (float)(i - 9));
        assert_true(difference(effect_at(&direct, place), effect_at(&baked, place)) < 1e-5);
    }
    world_close(&direct);
    world_close(&baked);
}

/* The winds of `kiln bench forces`, and of docs/wind.md. */
#define FIELDS                                                                                     \
    "curl: {scale: 1.5, octaves: 3, drift: [0, 0.5, 0]}, "                                         \
    "vortex: {position: [-1, 0, 0], inward: 0.3}, vortex: {position: [1, 0, 0], lift: 0.5}"

/* Returns the root of the mean square of the error between the points, as a part of that of the
 * forces. */
static double error_of(const char *force, int cells)
{
    struct world direct, baked;
    char text[512];
    double errors = 0, forces = 0;
    snprintf(text, sizeof text, "wind: {field: baked, box: {size: [4, 4, 4]}, cells: %d, of: [%s]}",
             cells, force);
    world_open(&direct, "", force);
    world_open(&baked, "", text);
    for (uint32_t i = 0; i < 8000; i++) {
        const float3 place = FLOAT3(3.98f * (random_unit(7, 3 * i) - 0.5f),
                                    3.98f * (random_unit(7, 3 * i + 1) - 0.5f),
                                    3.98f * (random_unit(7, 3 * i + 2) - 0.5f));
        const struct force_effect a = effect_at(&direct, place);
        const double away = difference(a, effect_at(&baked, place));
        errors += away * away;
        forces += (double)float3_dot(a.acceleration, a.acceleration);
    }
    world_close(&direct);
    world_close(&baked);
    return sqrt(errors / forces);
}

/* docs/wind.md has these numbers: the error by how many cells wide the smallest eddies are. */
static void the_error_falls_as_the_square_of_the_cells(void **state)
{
    (void)state;
    static const struct {
        int cells;
        double most, times; /* how many times as large as the next error, at least */
    } cases[] = {{8, 0.56, 2.8}, {16, 0.19, 3.3}, {32, 0.055, 3.7}, {64, 0.0145, 0}};
    double before = 0;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double error = error_of("curl: {strength: 1, scale: 1}", cases[i].cells);
        print_message("%2d cells an eddy: %.2g %%\n", cases[i].cells / 4, 100 * error);
        assert_true(error < cases[i].most && error > 0.8 * cases[i].most);
        assert_true(i == 0 || before > cases[i - 1].times * error);
        before = error;
    }
    assert_true(error_of("vortex: {radius: 0.5, profile: lamb_oseen}", 32) < 0.02);
    const double coarse = error_of(FIELDS, 21), fine = error_of(FIELDS, 43);
    print_message("the winds of docs/wind.md: %.2g %% with 32 cells along 6 m, %.2g %% with 64\n",
                  100 * coarse, 100 * fine);
    assert_true(coarse < 0.15 && fine < 0.045);
}

enum { DRIFTING = 1000 };

/* How far particles in baked winds are from those in the winds, and how far they have come: means,
 * m, after one and after two seconds. */
struct drift {
    double away[2], way[2];
};

static struct drift drift_of(const char *grid)
{
    static const char head[] =
        "kiln: 1\noutput: {fps: 60, frames: 240}\nsystems: {a: {emit: {bursts: {0 s: %d}, life: 9 "
        "s, speed: 0, from: {box: {origin: [0, 2, 0], size: [3, 3, 3]}}}, forces: [%s]}}\n";
    char text[2][1024], winds[768];
    struct kiln_scene *scenes[2];
    struct simulation runs[2];
    float3 begin[DRIFTING];
    struct drift drift = {.away = {0}};
    snprintf(winds, sizeof winds,
             "wind: {baked: {box: {center: [0, 2, 0], size: [6, 6, 6]}, %s, of: [" FIELDS "]}}",
             grid);
    snprintf(text[0], sizeof text[0], head, DRIFTING, FIELDS);
    snprintf(text[1], sizeof text[1], head, DRIFTING, winds);
    for (int i = 0; i < 2; i++) {
        scenes[i] = load_scene(text[i], NULL);
        simulation_start(&runs[i], scenes[i], NULL, 2);
        simulation_run(&runs[i], 1);
    }
    for (int k = 0; k < DRIFTING; k++)
        begin[k] = particle_position(simulation_records(&runs[0])[k]);
    for (uint32_t second = 0; second < 2; second++) {
        for (int i = 0; i < 2; i++)
            simulation_run(&runs[i], second == 0 ? 59 : 60);
        for (int k = 0; k < DRIFTING; k++) {
            const float3 at = particle_position(simulation_records(&runs[0])[k]);
            const float3 there = particle_position(simulation_records(&runs[1])[k]);
            drift.way[second] += (double)float3_length(float3_sub(at, begin[k])) / DRIFTING;
            drift.away[second] += (double)float3_length(float3_sub(at, there)) / DRIFTING;
        }
    }
    for (int i = 0; i < 2; i++) {
        simulation_end(&runs[i]);
        kiln_scene_destroy(&scenes[i]);
    }
    return drift;
}

/* docs/wind.md has these numbers, too. */
static void particles_stay_near_those_of_the_forces(void **state)
{
    (void)state;
    static const struct {
        const char *grid;
        double most; /* m after a second */
    } cases[] = {
        {"cells: 32", 0.028},
        {"cells: 64", 0.008},
        {"cells: 32, every: 4", 0.029},
        {"cells: 64, every: 4", 0.011},
    };
    for (size_t i = 0; i < (test_is_full() ? sizeof cases / sizeof *cases : 1); i++) {
        const struct drift drift = drift_of(cases[i].grid);
        print_message("%s: %.2g m after %.2g m, %.2g m after %.2g m\n", cases[i].grid,
                      drift.away[0], drift.way[0], drift.away[1], drift.way[1]);
        assert_true(drift.away[0] < cases[i].most);
    }
}

/* The kernel for vectors writes what bake_sample computes, at each width, whichever pieces of the
 * grid it writes at once. */
static void vectors_write_the_same_bits(void **state)
{
    (void)state;
    struct world w;
    world_open(&w, NODES, "wind: {baked: {attach: n, " BOX ", cells: 9, of: [" ALL "]}}");
    const struct kiln_grid grid = w.params->surroundings.grids[0];
    const struct kiln_still_frame node = w.sim.step->forces[0].frame;
    const uint32_t count = grid.size.x * grid.size.y * grid.size.z, third = count / 3;
    struct kiln_sim sim = w.sim;
    sim.step = &w.bakes.params;
    float4 *expected = aligned_alloc(16, count * sizeof *expected);
    assert_non_null(expected);
    for (uint32_t i = 0; i < count; i++)
        expected[i] = bake_sample(&sim, grid, node, i);
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        float4 *words = calloc(count, sizeof *words);
        assert_non_null(words);
        struct kiln_bake_work work = {.sim = sim, .grid = grid, .node = node, .words = words};
        if (kiln_simd_has(simd)) {
            KILN_SIMD_PICK(kiln_bake_points, simd)(&work, 0, third, 0);
            KILN_SIMD_PICK(kiln_bake_points, simd)(&work, third, count, 0);
            assert_memory_equal(words, expected, count * sizeof *words);
        }
        free(words);
    }
    free(expected);
    world_close(&w);
}

/* ---- time ------------------------------------------------------------------------------------ */

#define FALLS                                                                                      \
    "kiln: 1\n"                                                                                    \
    "output: {fps: 60, frames: 60}\n"                                                              \
    "systems:\n"                                                                                   \
    "  a:\n"                                                                                       \
    "    emit: {bursts: {0 s: 1}, life: 9 s, speed: 0, from: {point: {}}}\n"                       \
    "    forces:\n"                                                                                \
    "      - wind: {baked: {box: {size: [9, 9, 9]}, cells: 4, every: 4,\n"                         \
    "          of: [gravity: {keys: {0 s: [0, 0, 0], 1 s: [0, -60, 0]}}]}}\n"

/* An acceleration of t m/s^2 a second, which is looked at every fourth step. */
static void every_fourth_step_is_written(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(FALLS, NULL);
    struct simulation run;
    double speed = 0;
    simulation_start(&run, scene, NULL, 1);
    for (uint32_t step = 1; step <= 30; step++) {
        const double start_s = (step - 1 - (step - 1) % 4) / 60.0;
        speed -= 60 * start_s / 60;
        simulation_run(&run, 1);
        const float3 v = particle_velocity(simulation_records(&run)[0]);
        if (!(fabs((double)v.y - speed) < 1e-4))
            fail_msg("step %u: %g m/s, not %g", step, (double)v.y, speed);
    }
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

static const char SMOKE[] =
    "kiln: 1\n"
    "output: {fps: 60, frames: 60}\n"
    "simulation: {warmup: 0.25 s}\n"
    "nodes: {n: {position: {keys: {0 s: [0, 0, 0], 1 s: [1, 0, 0]}}}}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 900, life: 1 s, from: {box: {size: [2, 2, 2]}}}\n"
    "    forces:\n"
    "      - wind: {baked: {box: {size: [3, 3, 3]}, cells: 12, every: 5, attach: n,\n"
    "          of: [curl: {strength: 4, drift: [3, 0, 0], pull: 4}, vortex: {attach: n}]}}\n"
    "      - wind: {baked: {box: {size: [4, 4, 4]}, cells: 6, every: 7, of: [curl: {octaves: "
    "2}]}}\n";

/* A run that goes on from a state between two writings has the states of the whole run. */
static void resumed_runs_read_the_same_grids(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(SMOKE, NULL);
    for (uint32_t from = 1; from < 16; from += 2) {
        struct kiln_error error = {0};
        struct simulation whole, rest;
        uint64_t alive, rest_alive;
        simulation_start(&whole, scene, NULL, 2);
        simulation_start(&rest, scene, NULL, 1);
        simulation_run(&whole, from);
        assert_true(kiln_pool_copy(&rest.pool, &whole.pool, &error));
        rest.step = from;
        simulation_run(&whole, 30);
        simulation_run(&rest, 30);
        const struct kiln_state_hash a = simulation_hash(&whole, &alive);
        const struct kiln_state_hash b = simulation_hash(&rest, &rest_alive);
        assert_true(alive > 400 && alive == rest_alive);
        if (a.lane[0] != b.lane[0] || a.lane[1] != b.lane[1])
            fail_msg("from step %u: another state", from);
        simulation_end(&whole);
        simulation_end(&rest);
    }
    kiln_scene_destroy(&scene);
}

/* ---- grids, text ----------------------------------------------------------------------------- */

static void cells_are_about_cubes(void **state)
{
    (void)state;
    static const struct {
        float edges[3];
        uint32_t cells, size[3];
    } cases[] = {
        {{4, 4, 4}, 32, {33, 33, 33}},
        {{4, 2, 1}, 32, {33, 17, 9}},
        {{0.3f, 0.1f, 0.2f}, 9, {10, 4, 7}},
        {{1000, 0.001f, 1}, 100, {101, 2, 2}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct kiln_force baked = {
            .box_size = {.x = {.constant = cases[i].edges[0]},
                         .y = {.constant = cases[i].edges[1]},
                         .z = {.constant = cases[i].edges[2]}},
            .cells = cases[i].cells,
        };
        uint32_t size[3];
        kiln_baked_samples(&baked, size);
        assert_memory_equal(size, cases[i].size, sizeof size);
    }
}

static void a_printed_scene_is_the_same(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(SMOKE, NULL);
    char *text = print_scene(scene);
    struct kiln_scene *again = load_scene(text, NULL);
    assert_string_equal(scene->hash, again->hash);
    char *text_again = print_scene(again);
    assert_string_equal(text, text_again);
    free(text);
    free(text_again);
    kiln_scene_destroy(&again);
    kiln_scene_destroy(&scene);
}

#define HEAD  "kiln: 1\nsystems: {a: {forces: [{wind: {field: baked, "
#define BOXED HEAD "box: {size: [1, 1, 1]}, "

static const struct bad winds[] = {
    {HEAD "of: [curl: 1]}}]}}\n",
     ":2:31: systems.a.forces.0.wind.box: the key is missing and must be given"},
    {HEAD "box: {}, of: [curl: 1]}}]}}\n",
     ":2:51: systems.a.forces.0.wind.box.size: the key is missing and must be given"},
    {HEAD "box: {size: [1, 0, 1]}, of: [curl: 1]}}]}}\n",
     ":2:62: systems.a.forces.0.wind.box.size.1: 0 is out of range; allowed is from 0.001 m to "
     "100000 m"},
    {BOXED "of: []}}]}}\n",
     ":2:74: systems.a.forces.0.wind.of: found 0 forces; allowed is from 1 to 12"},
    {BOXED "of: curl}}]}}\n",
     ":2:74: systems.a.forces.0.wind.of: expected a list of 1 to 12: {gravity, drag, curl, "
     "attract, vortex or wind: {...}}, found 'curl'"},
    {BOXED "of: [limit: 1]}}]}}\n", ":2:75: systems.a.forces.0.wind.of.0.limit: unknown kind "
                                    "(there are: gravity, drag, curl, attract, vortex, wind)"},
    {BOXED "of: [wind: {field: baked}]}}]}}\n",
     ":2:89: systems.a.forces.0.wind.of.0.wind.field: unknown word 'baked' (there are: uniform, "
     "curl, vortex, grid)"},
    {BOXED "of: [drag: {quadratic: 1}]}}]}}\n",
     ":2:82: systems.a.forces.0.wind.of.0.drag.quadratic: unknown key (there are: strength, "
     "attach, region)"},
    {BOXED "of: [curl: {attach: n}]}}]}}\n",
     ":2:90: systems.a.forces.0.wind.of.0.curl.attach: unknown node 'n' (there are none)"},
    {BOXED "of: [curl: {region: {}}]}}]}}\n",
     ":2:90: systems.a.forces.0.wind.of.0.curl.region: must have one of `box` and `sphere`, found "
     "neither"},
    {BOXED "cells: 256, of: [curl: 1]}}]}}\n",
     ":2:77: systems.a.forces.0.wind.cells: wind, terrain and meshes that move particles have "
     "16974593 samples altogether; a scene has at most 4194304"},
};

BAD_TEST(winds)

/* The same keys in the other form, and a value of a particle in each kind of force. */
#define INSIDE "kiln: 1\nsystems: {a: {forces: [{wind: {baked: {"
#define WIDE   INSIDE "box: {size: [1, 1, 1]}, "

static const struct bad sizes[] = {
    {WIDE "cells: 1000000000, of: [curl: 1]}}}]}}\n",
     ":2:71: systems.a.forces.0.wind.baked.cells: 1000000000 is out of range; allowed is from 1 to "
     "256"},
    {WIDE "cells: 0, of: [curl: 1]}}}]}}\n",
     ":2:71: systems.a.forces.0.wind.baked.cells: 0 is out of range; allowed is from 1 to 256"},
    {WIDE "every: 0, of: [curl: 1]}}}]}}\n",
     ":2:71: systems.a.forces.0.wind.baked.every: 0 is out of range; allowed is from 1 to 1000"},
    {WIDE "every: 1001, of: [curl: 1]}}}]}}\n",
     ":2:71: systems.a.forces.0.wind.baked.every: 1001 is out of range; allowed is from 1 to 1000"},
    {WIDE "cells: 256, of: [curl: 1]}}}]}}\n",
     ":2:71: systems.a.forces.0.wind.baked.cells: wind, terrain and meshes that move particles "
     "have 16974593 samples altogether; a scene has at most 4194304"},
    {WIDE "attach: n, of: [curl: 1]}}}]}}\n",
     ":2:72: systems.a.forces.0.wind.baked.attach: unknown node 'n' (there are none)"},
    {WIDE "region: {}, of: [curl: 1]}}}]}}\n",
     ":2:72: systems.a.forces.0.wind.baked.region: must have one of `box` and `sphere`, found "
     "neither"},
    {WIDE "of: [curl: 1]}, attach: n}}]}}\n",
     ":2:80: systems.a.forces.0.wind.attach: must not stand beside `baked`, which chooses the "
     "kind; "
     "its keys stand inside of it, such as wind.baked.attach"},
    {"kiln: 1\nsystems: {a: {forces: [{wind: {field: baked, cells: 4, baked: {every: 2}}}]}}\n",
     ":2:56: systems.a.forces.0.wind.baked: must not stand beside `field`, which chooses the kind; "
     "its keys stand beside it, too, such as wind.every"},
    {WIDE "of: [1, 2]}}}]}}\n", ":2:69: systems.a.forces.0.wind.baked.of.0: expected {gravity, "
                                "drag, curl, attract, vortex or wind: {...}}, found '1'"},
    {WIDE
     "of: [drag, drag, drag, drag, drag, drag, drag, drag, drag, drag, drag, drag, drag]}}}]}}\n",
     ":2:68: systems.a.forces.0.wind.baked.of: found 13 forces; allowed is from 1 to 12"},
    {INSIDE "box: {size: [0, 0, 0]}, of: [curl: 1]}}}]}}\n",
     ":2:53: systems.a.forces.0.wind.baked.box.size.0: 0 is out of range; allowed is from 0.001 m "
     "to 100000 m"},
    {INSIDE "box: {size: [-1, 1, 1]}, of: [curl: 1]}}}]}}\n",
     ":2:53: systems.a.forces.0.wind.baked.box.size.0: -1 is out of range; allowed is from 0.001 m "
     "to 100000 m"},
    {INSIDE "box: {size: [1e9, 1, 1]}, of: [curl: 1]}}}]}}\n",
     ":2:53: systems.a.forces.0.wind.baked.box.size.0: 1e9 is out of range; allowed is from 0.001 "
     "m to 100000 m"},
    {INSIDE "box: {size: {keys: {0 s: [1, 1, 1]}}}, of: [curl: 1]}}}]}}\n",
     ":2:53: systems.a.forces.0.wind.baked.box.size.keys: cannot vary over time here; allowed is a "
     "constant"},
    {INSIDE "box: {center: [.nan, 0, 0], size: [1, 1, 1]}, of: [curl: 1]}}}]}}\n",
     ":2:55: systems.a.forces.0.wind.baked.box.center.0: .nan is not a finite number"},
    {"kiln: 1\nsystems: {a: {forces: [{wind: {baked: 32}}]}}\n",
     ":2:39: systems.a.forces.0.wind.baked: expected a mapping of keys, found '32'"},
    {"kiln: 1\nsystems: {a: {forces: [{wind: {baked: {}, pull: 2}}]}}\n",
     ":2:43: systems.a.forces.0.wind.pull: must not stand beside `baked`, which chooses the kind; "
     "its keys stand inside of it, such as wind.baked.box"},
};

BAD_TEST(sizes)

#define ONE "{wind: {baked: {cells: 1, box: {size: [1, 1, 1]}, of: [drag: 1]}}}"

static const struct bad numbers[] = {
    {"kiln: 1\nsystems:\n  a: {forces: [" ONE ", " ONE ", " ONE ", " ONE ", " ONE "]}\n"
     "  b: {forces: [" ONE ", " ONE ", " ONE ", " ONE "]}\n",
     ":4:243: systems.b.forces.3.wind.baked.cells: more than 8 baked winds; no more are allowed"},
};

BAD_TEST(numbers)

static const struct bad clocks[] = {
    {WIDE "of: [curl: {strength: {life: [1, 2]}}]}}}]}}\n",
     ":2:87: systems.a.forces.0.wind.baked.of.0.curl.strength.life: cannot vary over life here; "
     "allowed is a constant or a mapping with keys or noise"},
    {WIDE "of: [vortex: {radius: {height: {0 m: 1, 1 m: 2}}}]}}}]}}\n",
     ":2:87: systems.a.forces.0.wind.baked.of.0.vortex.radius.height: cannot vary over height "
     "here; allowed is a constant or a mapping with keys or noise"},
    {WIDE "of: [curl: {scale: {random: [1, 2]}}]}}}]}}\n",
     ":2:84: systems.a.forces.0.wind.baked.of.0.curl.scale.random: cannot vary over random here; "
     "allowed is a constant or a mapping with keys or noise"},
    {WIDE "of: [attract: {strength: {speed: {0: 1, 1: 2}}}]}}}]}}\n",
     ":2:90: systems.a.forces.0.wind.baked.of.0.attract.strength.speed: cannot vary over speed "
     "here; allowed is a constant or a mapping with keys or noise"},
    {WIDE "of: [gravity: {age: {0 s: [0, 0, 0], 1 s: [1, 0, 0]}}]}}}]}}\n",
     ":2:79: systems.a.forces.0.wind.baked.of.0.gravity.acceleration.age: cannot vary over age "
     "here; allowed is a constant or a mapping with keys or noise"},
    {WIDE "of: [drag: {strength: {noise: [1, 2], per: particle}}]}}}]}}\n",
     ":2:107: systems.a.forces.0.wind.baked.of.0.drag.strength: a noise of each particle is not "
     "possible here; allowed is per: system"},
    {WIDE "of: [wind: {pull: {choose: [1, 2]}}]}}}]}}\n",
     ":2:83: systems.a.forces.0.wind.baked.of.0.wind.pull.choose: cannot vary over choose here; "
     "allowed is a constant or a mapping with keys or noise"},
};

BAD_TEST(clocks)

/* ---- memory ---------------------------------------------------------------------------------- */

static uint64_t memory_of(int cells)
{
    char text[256];
    struct kiln_footprint footprint = {.threads = 1};
    snprintf(
        text, sizeof text,
        "kiln: 1\nsystems: {a: {forces: [{wind: {baked: {box: {size: [4, 2, 4]}, cells: %d, of: "
        "[drag: 1]}}}]}}\n",
        cells);
    struct kiln_scene *scene = load_scene(text, NULL);
    kiln_sim_grids_footprint(scene, &footprint);
    kiln_scene_destroy(&scene);
    return kiln_footprint_total(&footprint);
}

static void a_sample_takes_16_bytes(void **state)
{
    (void)state;
    assert_true(memory_of(32) == 33 * 17 * 33 * 16);
    assert_true(memory_of(100) == 101 * 51 * 101 * 16);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_have_the_forces),
        cmocka_unit_test(even_winds_are_exact),
        cmocka_unit_test(the_error_falls_as_the_square_of_the_cells),
        cmocka_unit_test(particles_stay_near_those_of_the_forces),
        cmocka_unit_test(vectors_write_the_same_bits),
        cmocka_unit_test(every_fourth_step_is_written),
        cmocka_unit_test(resumed_runs_read_the_same_grids),
        cmocka_unit_test(cells_are_about_cubes),
        cmocka_unit_test(a_printed_scene_is_the_same),
        cmocka_unit_test(bad_winds),
        cmocka_unit_test(bad_sizes),
        cmocka_unit_test(bad_numbers),
        cmocka_unit_test(bad_clocks),
        cmocka_unit_test(a_sample_takes_16_bytes),
    };
    return cmocka_run_group_tests_name("baked", tests, NULL, NULL);
}
