/* lib/scene/small_steps.c: warnings of steps that are too small for the positions that they are
 * added to. If it failed, slow particles far from the origin would be too slow, or stand still,
 * without a word; or ordinary scenes would have warnings. */
#include <dirent.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "scene/small_steps.h"
#include "support/cmocka.h"
#include "support/errors.h"

#define FAR                                                                                        \
    "kiln: 1\n"                                                                                    \
    "output: {fps: 50, frames: 100}\n"                                                             \
    "simulation: {rate: 1000}\n"                                                                   \
    "systems:\n"                                                                                   \
    "  slow:\n"                                                                                    \
    "    emit: {rate: 1, life: 1 s, speed: 0.01,\n"                                                \
    "           from: {point: {origin: [100, 0, 0], direction: [1, 0, 0], angle: 0}}}\n"

/* Counts warnings and keeps the last one. */
struct warnings {
    int count;
    char last[KILN_MESSAGE_SIZE];
};

static void keep_warning(void *user, enum kiln_log_level level, const char *line)
{
    struct warnings *warnings = user;
    assert_int_equal(level, KILN_LOG_WARNING);
    warnings->count++;
    snprintf(warnings->last, sizeof warnings->last, "%s", line);
}

static struct kiln_scene_params params_of(struct warnings *warnings, const char *const *overrides)
{
    struct kiln_scene_params params = kiln_scene_defaults();
    *warnings = (struct warnings){0};
    params.log = (struct kiln_log){keep_warning, warnings};
    params.overrides = overrides;
    while (overrides[params.override_count])
        params.override_count++;
    return params;
}

static void load_far(struct warnings *warnings, const char *const *overrides)
{
    const struct kiln_scene_params params = params_of(warnings, overrides);
    struct kiln_error error = {0};
    struct kiln_scene *scene = kiln_scene_parse(FAR, strlen(FAR), "far.yaml", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    kiln_scene_destroy(&scene);
}

static void slow_systems_far_away_have_a_warning(void **state)
{
    (void)state;
    struct warnings warnings;
    load_far(&warnings, (const char *[]){NULL});
    assert_int_equal(warnings.count, 1);
    expect_message(warnings.last,
                   "far.yaml:6:39: systems.slow.emit.speed: a step of particles at 0.01 m/s is "
                   "1e-05 m, and positions 100 m from the origin are multiples of 7.6e-06 m, so "
                   "that their speed is up to 38 %% off; at 1000 steps a second, speeds from 0.381 "
                   "m/s on are true to 1 %% there: lower simulation.rate, or move the scene to the "
                   "origin");
    load_far(&warnings,
             (const char *[]){"output.fps=30", "simulation.rate=60", "systems.slow.emit.speed=0.2",
                              "systems.slow.emit.from.point.origin=[90000, 0, 0]", NULL});
    assert_int_equal(warnings.count, 1);
    expect_message(warnings.last,
                   "--set systems.slow.emit.speed: a step of particles at 0.2 m/s is 0.0033 m, and "
                   "positions 90000 m from the origin are multiples of 0.0078 m, so that they may "
                   "not move at all; at 60 steps a second, speeds from 23.4 m/s on are true to 1 "
                   "%% there: lower simulation.rate, or move the scene to the origin");
    load_far(&warnings, (const char *[]){"systems.slow.emit.speed=0",
                                         "systems.slow.forces=[wind: [0.05, 0, 0]]", NULL});
    assert_int_equal(warnings.count, 1);
    expect_message(warnings.last,
                   "--set systems.slow.forces: a step of particles at 0.05 m/s is 5e-05 m, and "
                   "positions 100 m from the origin are multiples of 7.6e-06 m, so that their "
                   "speed is up to 7.6 %% off; at 1000 steps a second, speeds from 0.381 m/s on "
                   "are true to 1 %% there: lower simulation.rate, or move the scene to the "
                   "origin");
}

/* Overrides of the scene, of which each makes it one without a warning. */
static const char *const harmless[] = {
    "systems.slow.emit.speed=0.4",
    "systems.slow.emit.speed=[0.01, 2]",
    "systems.slow.emit.speed={keys: {0: 0, 1 s: 1}}",
    "systems.slow.emit.speed=0",
    "systems.slow.enabled=false",
    "simulation={rate: 50}", /* with the origin at 10 m */
    "systems.slow.emit.from={point: {origin: [0, 0, 0]}}",
    "systems.slow.emit.from={point: {origin: [100, 0, 0], direction: [0, 1, 0], angle: 0}}",
    "systems.slow.forces=[gravity: [0, -9.81, 0]]",
    "systems.slow.forces=[wind: [5, 0, 0]]",
    "systems.slow.forces=[curl: 1]",
    "systems.slow.forces=[vortex: 1]",
    "systems.slow.forces=[attract: 1]",
    "systems.slow.interact=[collide: {radius: 1 cm}]",
};

static void other_systems_have_none(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof harmless / sizeof *harmless; i++) {
        struct warnings warnings;
        const bool nearer = strncmp(harmless[i], "simulation", 10) == 0;
        load_far(&warnings,
                 (const char *[]){harmless[i],
                                  nearer ? "systems.slow.emit.from.point.origin=[10, 0, 0]" : NULL,
                                  NULL});
        if (warnings.count > 0)
            fail_msg("%s: %s", harmless[i], warnings.last);
    }
}

static void no_scene_of_the_gallery_has_one(void **state)
{
    (void)state;
    struct dirent **entries;
    const int count = scandir(KILN_SOURCE_DIR "/scenes", &entries, NULL, alphasort);
    int loaded = 0;
    assert_true(count > 0);
    for (int i = 0; i < count; i++) {
        const char *end = strrchr(entries[i]->d_name, '.');
        if (end && strcmp(end, ".yaml") == 0) {
            struct warnings warnings;
            const struct kiln_scene_params params = params_of(&warnings, (const char *[]){NULL});
            struct kiln_error error = {0};
            char path[512];
            snprintf(path, sizeof path, KILN_SOURCE_DIR "/scenes/%s", entries[i]->d_name);
            struct kiln_scene *scene = kiln_scene_load(path, &params, &error);
            if (!scene || warnings.count > 0)
                fail_msg("%s", scene ? warnings.last : error.message);
            kiln_scene_destroy(&scene);
            loaded++;
        }
        free(entries[i]);
    }
    free(entries);
    assert_true(loaded > 10);
}

/* Steps a position as a simulation does; the error is the part of the way that is lost or gained.
 */
static double error_of(float start, float speed, int rate)
{
    const float dt_s = (float)(1.0 / rate);
    float x = start;
    for (int i = 0; i < rate; i++)
        x += speed * dt_s;
    return fabs(((double)x - (double)start) / (double)speed - 1.0);
}

static void the_speed_that_is_named_is_true_to_a_hundredth(void **state)
{
    (void)state;
    static const float starts[] = {9.0f, 100.0f, 1500.0f, 90000.0f};
    static const int rates[] = {24, 60, 1000};
    for (int i = 0; i < 12; i++) {
        const float start = starts[i / 3];
        const float speed = (float)kiln_small_steps_true_speed(start, rates[i % 3]);
        double worst = 0;
        for (int k = 0; k < 50; k++) /* speeds whose last bits differ */
            worst = fmax(worst, error_of(start, speed * (1.0f + (float)k * 0.0007f), rates[i % 3]));
        assert_true(worst <= 0.0101);
        assert_true(worst > 0.004);
    }
    assert_true(error_of(100.0f, 0.01f, 1000) > 0.2);
    assert_true(error_of(90000.0f, 0.2f, 60) == 1.0);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(slow_systems_far_away_have_a_warning),
        cmocka_unit_test(other_systems_have_none),
        cmocka_unit_test(no_scene_of_the_gallery_has_one),
        cmocka_unit_test(the_speed_that_is_named_is_true_to_a_hundredth),
    };
    return cmocka_run_group_tests_name("small steps", tests, NULL, NULL);
}
