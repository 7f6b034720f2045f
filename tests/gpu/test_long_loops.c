/* Checks compute kernels that loop over many gravity sources, cells, neighbours or key frames. The
 * software GL of Mesa, llvmpipe, silently ends the loops of an invocation after 65,535 iterations
 * in all (KILN_SOFTWARE_ITERATIONS). Even for longer loops a kernel must compute what the technique
 * `cpu` computes, or report an error. If this fails, large scenes are simulated wrongly without a
 * warning. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "gpu/program.h"
#include "support/balls.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"

static struct scene_fixture fixture; /* too large for a stack */

/* Checks that a technique and `cpu` compute the same particles in `steps` steps. place: NULL, or a
 * function that writes particles into a run and sets it to step BALLS_FIRST_STEP. */
static void expect_as_on_cpu(struct kiln_device *device, enum kiln_simulate_technique technique,
                             void (*place)(struct simulation *run), uint32_t steps)
{
    struct simulation cpu, other;
    simulation_start(&cpu, &fixture.scene, NULL, 2);
    simulation_start_with(&other, &fixture.scene, device, technique, 1);
    if (place) {
        place(&cpu);
        place(&other);
    }
    simulation_run(&cpu, steps);
    simulation_run(&other, steps);
    assert_memory_equal(simulation_records(&cpu), simulation_records(&other),
                        cpu.pool.slot_count * sizeof(struct kiln_particle));
    simulation_end(&cpu);
    simulation_end(&other);
}

/* ---- gravity -------------------------------------------------------------------------------- */

enum { SOURCES = 70001, TRACERS = 300 };

/* Places SOURCES particles in the first system, and in the second system TRACERS particles, which
 * the first system attracts. */
static void place_stars(struct simulation *run)
{
    uint32_t seed = 5;
    for (uint32_t i = 0; i < SOURCES + TRACERS; i++) {
        const float x = balls_random(&seed), y = balls_random(&seed), z = balls_random(&seed);
        balls_place(run, i, FLOAT3(x, y, z), FLOAT3(0.1f * z, 0.0f, 0.0f));
    }
    run->pool.systems[0].next_serial = SOURCES;
    run->pool.systems[1].next_serial = TRACERS;
}

/* Every tracer is attracted by all of more sources than llvmpipe has iterations. */
static void all_sources_pull(void **state)
{
    balls_init(&fixture, SOURCES, 0.01f);
    fixture.scene.systems[0].interaction_count = 0;
    struct kiln_system *tracers = fixture_add_system(&fixture, "tracers", 0.0f);
    tracers->emit.life = fixture_range(1000.0f, 1000.0f);
    tracers->capacity = TRACERS;
    struct kiln_interaction *gravity = fixture_add_gravity(tracers, 1e-4f);
    gravity->of_other = true;
    gravity->source = 0;
    expect_as_on_cpu(*state, KILN_SIMULATE_INPLACE, place_stars, 3);
}

/* ---- cells ---------------------------------------------------------------------------------- */

/* The kernel that scans the counts of a table of cells gives the right prefix sums for the largest
 * table that is allowed (MAX_CELLS, lib/sim/crowd/interact.c). */
static void the_largest_table_of_cells_is_scanned(void **state)
{
    enum { CELLS = 1 << 24 };
    struct kiln_error error = {0};
    struct kiln_buffer cells;
    const GLuint program = kiln_program_create(
        *state, &(struct kiln_program_params){.compute = "sim/crowd/interact_scan.comp"}, &error);
    kiln_buffer_init(&cells, *state, CELLS * sizeof(uint32_t), "cells");
    uint32_t *counts = kiln_buffer_host(&cells, KILN_OVERWRITE, &error);
    assert_true(program && counts);
    for (uint32_t i = 0; i < CELLS; i++)
        counts[i] = i % 5 == 0 ? i % 3 : 0;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, INTERACT_BIND_CELLS,
                     kiln_buffer_gl(&cells, KILN_READ_WRITE, &error));
    glUseProgram(program);
    glUniform1ui(INTERACT_AT_CELL_COUNT, CELLS);
    glDispatchCompute(1, 1, 1);
    const uint32_t *begins = kiln_buffer_host(&cells, KILN_READ, &error);
    assert_non_null(begins);
    uint32_t before = 0, wrong = 0;
    for (uint32_t i = 0; i < CELLS; i++) {
        wrong += begins[i] != before;
        before += i % 5 == 0 ? i % 3 : 0;
    }
    assert_int_equal(wrong, 0);
    kiln_buffer_finish(&cells);
    glDeleteProgram(program);
}

static uint32_t crowd; /* number of balls that place_crowd places */

/* Places all balls within one cell, from 0.1 to 0.9 m along each axis. A cell is wider than 1 m,
 * since init_crowd allows 60 m/s, which is 1 m a step. */
static void place_crowd(struct simulation *run)
{
    uint32_t seed = 11;
    for (uint32_t i = 0; i < crowd; i++) {
        const float x = balls_random(&seed), y = balls_random(&seed), z = balls_random(&seed);
        balls_place(run, i, FLOAT3(0.5f + 0.4f * x, 0.5f + 0.4f * y, 0.5f + 0.4f * z),
                    FLOAT3(y, z, x));
    }
}

static void init_crowd(uint32_t count)
{
    crowd = count;
    balls_init(&fixture, count, 0.02f)->fastest = fixture_constant(60.0f);
}

/* Software GL finds all colliding pairs among 1500 balls in one cell. It would silently end the
 * search among 66000 balls, so kiln reports an error instead. */
static void a_crowd_in_a_cell_is_searched_or_refused(void **state)
{
    struct kiln_device *device = *state;
    init_crowd(1500);
    expect_as_on_cpu(device, KILN_SIMULATE_INPLACE, place_crowd, 2);
    if (!device->info.software)
        return;
    struct simulation run;
    struct kiln_error error = {0};
    init_crowd(66000);
    simulation_start(&run, &fixture.scene, device, 1);
    place_crowd(&run);
    assert_false(kiln_simulate_step(run.simulate, &run.pool, ++run.step, &error));
    expect_error(&error, KILN_DEVICE_FAILED,
                 "systems.balls.interact: a particle has 66000 others near enough to collide with; "
                 "software GL tests at most 65000: use --technique simulate=cpu, a smaller "
                 "`radius` or a lower `fastest`");
    simulation_end(&run);
}

/* ---- keys ----------------------------------------------------------------------------------- */

/* Births look up values among 1000 key frames, nearly as many as a scene may have
 * (KILN_MAX_VALUE_KEYS): the height of the emitter and the greatest speed. */
static void births_find_their_keys(void **state)
{
    enum { KEYS = 1000 };
    static float points[KEYS][2];
    fixture_init(&fixture);
    struct kiln_system *s = fixture_add_system(&fixture, "trail", 9000.0f);
    s->capacity = 9000;
    for (uint32_t i = 0; i < KEYS; i++) {
        points[i][0] = 0.0002f * (float)i;
        points[i][1] = 0.01f * (float)(i * i % 97);
    }
    s->emit.origin.y = fixture_keys(&fixture, KILN_CLOCK_TIME, KEYS, points);
    s->emit.speed.max = s->emit.origin.y;
    s->emit.inherit = fixture_constant(0.5f);
    fixture_finish(&fixture, 20);
    expect_as_on_cpu(*state, KILN_SIMULATE_FEEDBACK, NULL, 20);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(all_sources_pull),
        test_on_device(the_largest_table_of_cells_is_scanned),
        test_on_device(a_crowd_in_a_cell_is_searched_or_refused),
        test_on_device(births_find_their_keys),
    };
    return cmocka_run_group_tests_name("long loops", tests, simulation_device_open,
                                       test_device_close);
}
