/* Grids: what files may say, what lies between samples, and the wind that a force makes of it. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/grid_in.h"
#include "sim/world/grids.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/scene_fixture.h"
#include "support/simulation.h"

static struct scene_fixture fixture; /* too large for a stack */

#define HEADER "kiln-grid 1\nsize 2 3 2\norigin -1 0 2.5\nspacing 0.5 1 2\ndata\n"
enum { SAMPLES = 2 * 3 * 2 };

/* A header and so many bytes of samples, which are 1, 2, 3... */
static struct kiln_grid_file *parse(const char *header, size_t bytes, float first,
                                    struct kiln_error *error)
{
    unsigned char file[1024] = {0};
    const size_t length = strlen(header);
    assert_true(length + bytes <= sizeof file);
    for (size_t i = 0; i < length; i++)
        file[i] = (unsigned char)header[i];
    for (uint32_t i = 0; i < bytes / 4; i++) {
        float value = i == 0 ? first : 1.0f + (float)i;
        memcpy(file + length + 4 * (size_t)i, &value, sizeof value);
    }
    *error = (struct kiln_error){0};
    return kiln_grid_parse(file, length + bytes, "w.grid", error);
}

static void a_grid_is_read(void **state)
{
    (void)state;
    struct kiln_error error;
    struct kiln_grid_file *grid = parse(HEADER, SAMPLES * 12, 1.0f, &error);
    assert_non_null(grid);
    assert_int_equal(grid->size[1], 3);
    assert_true(grid->origin[2] == 2.5f && grid->spacing[0] == 0.5f);
    assert_true(grid->samples[0][0] == 1.0f && grid->samples[SAMPLES - 1][2] == 36.0f);
    kiln_grid_destroy(&grid);
    assert_null(grid);
}

static void what_is_no_grid_is_refused(void **state)
{
    (void)state;
    const struct {
        const char *header;
        size_t bytes;
        float first;
        const char *message;
    } cases[] = {
        {"", 0, 1, "w.grid:1: expected a line of text of less than 128 bytes"},
        {"kiln-grid 2\n", 0, 1, "w.grid:1: expected 'kiln-grid 1', found 'kiln-grid 2'"},
        {"kiln-grid 1\nsize 2 2\n", 0, 1,
         "w.grid:2: expected 'size' and three whole numbers from 2 to 1024, found 'size 2 2'"},
        {"kiln-grid 1\nsize 2 2 2 2\n", 0, 1,
         "w.grid:2: expected 'size' and three whole numbers from 2 to 1024, found 'size 2 2 2 2'"},
        {"kiln-grid 1\nsize 1 2 2\n", 0, 1,
         "w.grid:2: expected 'size' and three whole numbers from 2 to 1024, found 'size 1 2 2'"},
        {"kiln-grid 1\nsize 2.5 2 2\n", 0, 1,
         "w.grid:2: expected 'size' and three whole numbers from 2 to 1024, found 'size 2.5 2 2'"},
        {"kiln-grid 1\nsize 2 2 2\norigin 0 nan 0\n", 0, 1,
         "w.grid:3: expected 'origin' and three numbers from -100000 to 100000, found 'origin 0 "
         "nan "
         "0'"},
        {"kiln-grid 1\nsize 2 2 2\norigin 0 0 0\nspacing 0 1 1\n", 0, 1,
         "w.grid:4: expected 'spacing' and three numbers from 0.001 to 100000, found 'spacing 0 1 "
         "1'"},
        {"kiln-grid 1\nsize 1024 1024 5\norigin 0 0 0\nspacing 1 1 1\ndata\n", 0, 1,
         "w.grid:2: 1024 x 1024 x 5 samples; allowed are at most 4194304"},
        {HEADER, SAMPLES * 12 - 1, 1, "w.grid: 143 bytes of data; 2 x 3 x 2 samples have 144"},
        {HEADER, SAMPLES * 12 + 4, 1, "w.grid: 148 bytes of data; 2 x 3 x 2 samples have 144"},
        {HEADER, SAMPLES * 12, 20000,
         "w.grid: sample 0, 0, 0: found x = 20000; allowed are numbers from -10000 to 10000"},
        {HEADER, SAMPLES * 12, NAN,
         "w.grid: sample 0, 0, 0: found x = nan; allowed are numbers from -10000 to 10000"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_error error;
        assert_null(parse(cases[i].header, cases[i].bytes, cases[i].first, &error));
        expect_error(&error, KILN_INVALID_INPUT, "%s", cases[i].message);
    }
}

/* One particle of no speed in the whirl of fixture_add_field, after so many steps of 1/60 s. */
static struct kiln_particle blown(float3 from, float pull, uint32_t steps)
{
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "one", 0.0f);
    system->emit.bursts[0] = (struct kiln_burst){.time_s = 0.0, .count = {1, 1}};
    system->emit.burst_count = 1;
    system->emit.life = fixture_range(10.0f, 10.0f);
    system->emit.speed = fixture_range(0.0f, 0.0f);
    system->emit.origin = fixture_constant3(from.x, from.y, from.z);
    fixture_add_field(system)->pull = fixture_constant(pull);
    fixture_finish(&fixture, steps);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    simulation_run(&run, steps);
    struct kiln_particle p = simulation_records(&run)[0];
    simulation_end(&run);
    return p;
}

static void assert_velocity(struct kiln_particle p, double x, double y, double z)
{
    float3 v = particle_velocity(p);
    if (fabs((double)v.x - x) > 1e-5 || fabs((double)v.y - y) > 1e-5 ||
        fabs((double)v.z - z) > 1e-5)
        fail_msg("(%g, %g, %g) instead of (%g, %g, %g)", (double)v.x, (double)v.y, (double)v.z, x,
                 y, z);
}

/* A field that is linear is found exactly, wherever between the samples. */
static void between_samples_the_field_is_linear(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 200; i++) {
        const double x = -1.5 + 3.0 * fmod(i * 0.618, 1.0), y = -0.5 + 2.4 * fmod(i * 0.414, 1.0),
                     z = -1.5 + 3.0 * fmod(i * 0.732, 1.0);
        /* So strong a pull that one step takes up the air's velocity. */
        struct kiln_particle p = blown(FLOAT3((float)x, (float)y, (float)z), 1000.0f, 1);
        assert_velocity(p, -2.0 * z, 0.5 + 0.3 * y, 2.0 * x);
    }
}

static void beyond_the_edges_it_is_that_of_the_edges(void **state)
{
    (void)state;
    assert_velocity(blown(FLOAT3(9.0f, 50.0f, -7.0f), 1000.0f, 1), 3.0, 0.5 + 0.3 * 1.9, 3.0);
    assert_velocity(blown(FLOAT3(-90.0f, -5.0f, 700.0f), 1000.0f, 1), -3.0, 0.35, -3.0);
}

/* At rest in air of velocity u, a particle has u (1 - e^(-k t)) after a step. */
static void a_pull_takes_its_time(void **state)
{
    (void)state;
    const double part = 1.0 - exp(-3.0 / 60.0);
    assert_velocity(blown(FLOAT3(1.0f, 0.0f, 0.5f), 3.0f, 1), -1.0 * part, 0.5 * part, 2.0 * part);
}

/* It says which of the kinds of wind it is. */
static void a_printed_scene_loads_again(void **state)
{
    (void)state;
    static const char text[] = "kiln: 1\nsystems: {a: {forces: [wind: {field: grid, file: "
                               "whirl.grid}, wind: {velocity: [2, 0, 0]}, wind: {field: curl}]}}\n";
    struct kiln_error error = {0};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.asset_root = KILN_SOURCE_DIR "/tests/support";
    char *printed = NULL;
    size_t length = 0;
    FILE *file = open_memstream(&printed, &length);
    struct kiln_scene *scene = kiln_scene_parse(text, sizeof text - 1, "a.yaml", &params, &error);
    assert_string_equal(error.message, "");
    assert_true(file && kiln_scene_print(scene, file) && fclose(file) == 0);
    struct kiln_scene *again = kiln_scene_parse(printed, length, "b.yaml", &params, &error);
    assert_string_equal(error.message, "");
    assert_int_equal(again->systems[0].forces[0].kind, KILN_FORCE_FIELD);
    assert_string_equal(again->hash, scene->hash);
    kiln_scene_destroy(&again);
    kiln_scene_destroy(&scene);
    free(printed);
}

static void too_many_grids_are_refused(void **state)
{
    (void)state;
    static const char grid[] = "kiln-grid 1\nsize 2 2 2\norigin 0 0 0\nspacing 1 1 1\ndata\n";
    static const char force[] = "{wind: {field: grid, file: %d.grid}}, ";
    unsigned char bytes[sizeof grid - 1 + 96] = {0};
    char text[1024];
    memcpy(bytes, grid, sizeof grid - 1);
    size_t length = (size_t)snprintf(text, sizeof text, "kiln: 1\nsystems: {many: {forces: [");
    for (int i = 0; i <= KILN_MAX_WINDS; i++) {
        char name[16];
        snprintf(name, sizeof name, "%d.grid", i);
        FILE *file = fopen(name, "wb");
        assert_true(file && fwrite(bytes, sizeof bytes, 1, file) == 1 && fclose(file) == 0);
        length += (size_t)snprintf(text + length, sizeof text - length, force, i);
    }
    struct kiln_error error = {0};
    struct kiln_scene_params params = kiln_scene_defaults();
    snprintf(text + length, sizeof text - length, "]}}\n");
    assert_null(kiln_scene_parse(text, strlen(text), "a.yaml", &params, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "a.yaml:2:350: systems.many.forces.8.wind.file: more than 8 "
                 "files of wind; no more are allowed");
    const char *without = "systems.many.forces.8.wind.file=0.grid"; /* which there is already */
    params.overrides = &without;
    params.override_count = 1;
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "a.yaml", &params, &error);
    assert_non_null(scene);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_grid_is_read),
        cmocka_unit_test(what_is_no_grid_is_refused),
        cmocka_unit_test(between_samples_the_field_is_linear),
        cmocka_unit_test(beyond_the_edges_it_is_that_of_the_edges),
        cmocka_unit_test(a_pull_takes_its_time),
        cmocka_unit_test(a_printed_scene_loads_again),
        cmocka_unit_test_setup_teardown(too_many_grids_are_refused, test_enter_folder,
                                        test_leave_folder),
    };
    return cmocka_run_group_tests_name("grid", tests, NULL, NULL);
}
