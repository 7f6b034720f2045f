/* lib/scene/light_notes.c: the warning of a fire that sheds far more light than it shows. If it
 * failed, ordinary fires would have warnings, or a light of any strength would have none. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "asset/atlas/builtin.h"
#include "scene/light_notes.h"
#include "support/cmocka.h"
#include "support/errors.h"

enum { CELLS = 16, EDGE = 32 };

/* The brightness of the cool parts of a cell beside that of its hot parts: 0.72 to the fourth
 * power, since they have 0.72 of the temperature (draw/moment/looks.c). */
static const double COOL = 0.26873856;

/* Returns the mean light of the cells of an atlas, in parts of a square that is hot and opaque. */
static double mean_light(const char *name)
{
    float *pixels = malloc((size_t)EDGE * EDGE * 4 * sizeof *pixels);
    struct kiln_builtin_scratch *scratch = kiln_builtin_scratch_create();
    struct kiln_builtin builtin = {0};
    enum kiln_simd simd = KILN_SIMD_PLAIN;
    struct kiln_error error = {0};
    double sum = 0;
    assert_true(pixels && scratch);
    assert_true(kiln_simd_choose(&simd, &error));
    assert_true(kiln_builtin_open(&builtin, name, CELLS, simd));
    for (uint32_t cell = 0; cell < CELLS; cell++) {
        kiln_builtin_cell(&builtin, cell, EDGE, scratch, pixels);
        for (size_t i = 0; i < EDGE * EDGE; i++) {
            const double heat = (double)pixels[4 * i + 2], alpha = (double)pixels[4 * i + 3];
            sum += alpha * (COOL + (1 - COOL) * heat);
        }
    }
    kiln_builtin_close(&builtin);
    free(scratch);
    free(pixels);
    return sum / ((double)CELLS * EDGE * EDGE);
}

static void atlases_show_as_much_as_is_said(void **state)
{
    (void)state;
    static const char *const names[] = {"fire", "flame", "tongue", "spark",
                                        "star", "smoke", "puff"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char atlas[32];
        snprintf(atlas, sizeof atlas, "builtin:%s", names[i]);
        const double shed = 0.25 * 0.5 * (1 + COOL), shown = mean_light(names[i]);
        const double said = (double)kiln_light_times(atlas);
        print_message("%s: %.2f times, %.2f are said\n", names[i], shed / shown, said);
        assert_true(fabs(said - shed / shown) < 0.12 * said);
    }
    assert_true(kiln_light_times("/some/file.png") == 1.0f);
}

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

static int count_warnings(const char *look, struct warnings *warnings)
{
    char text[512];
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_error error = {0};
    *warnings = (struct warnings){0};
    params.log = (struct kiln_log){keep_warning, warnings};
    snprintf(text, sizeof text, "kiln: 1\nsystems:\n  fire:\n    emit: {rate: 1}\n    look: {%s}\n",
             look);
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "fire.yaml", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    kiln_scene_destroy(&scene);
    return warnings->count;
}

static void much_light_has_a_warning(void **state)
{
    (void)state;
    struct warnings warnings;
    assert_int_equal(
        count_warnings("atlas: 'builtin:fire', temperature: 1800, light: 40", &warnings), 0);
    assert_int_equal(
        count_warnings("atlas: 'builtin:tongue', temperature: 1800, light: 7", &warnings), 0);
    assert_int_equal(count_warnings("shape: sphere, temperature: 1800, light: 90", &warnings), 0);
    assert_int_equal(
        count_warnings("atlas: 'builtin:fire', temperature: 1800, light: 680", &warnings), 1);
    expect_message(warnings.last,
                   "fire.yaml:5:61: systems.fire.look.light: sheds about 1360 times as much light "
                   "as the particles show; a flame that is to light that much is brighter, larger "
                   "or denser");
    assert_int_equal(
        count_warnings("atlas: ['builtin:fire', 'builtin:tongue'], light: [0, 0, {keys: "
                       "{0 s: 1, 1 s: 200}}]",
                       &warnings),
        1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(atlases_show_as_much_as_is_said),
        cmocka_unit_test(much_light_has_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
