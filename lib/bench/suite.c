/* Holds what suites share: messages of progress, settings and scenes, lanes of a stage, rows of a
 * comparison, and the growth of curves. */
#include "bench/suite.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/embedded.h"
#include "base/error.h"
#include "base/text.h"

void kiln_bench_say(const struct kiln_bench_run *run, const char *format, ...)
{
    if (!run->params->progress)
        return;
    char text[256], line[384];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    snprintf(line, sizeof line, "%s: %s", run->suite, text);
    run->params->progress(run->params->user, line);
}

/* ---- Scenes ---------------------------------------------------------------------------------- */

void kiln_set(const struct kiln_bench_run *run, struct kiln_settings *settings, const char *text)
{
    const char *copy = kiln_arena_text(run->bench->arena, text, strlen(text));
    if (settings->count < KILN_MAX_SETTINGS)
        settings->items[settings->count] = copy;
    settings->count++;
}

void kiln_set_number(const struct kiln_bench_run *run, struct kiln_settings *settings,
                     const char *key, double value)
{
    char number[32], text[128];
    kiln_text_from_double(number, value);
    snprintf(text, sizeof text, "%s=%s", key, number);
    kiln_set(run, settings, text);
}

void kiln_set_picture(const struct kiln_bench_run *run, struct kiln_settings *settings,
                      uint32_t width, uint32_t height)
{
    char text[64];
    uint32_t divisor = run->params->quick ? 8 : 1;
    snprintf(text, sizeof text, "output.size=[%u, %u]", width / divisor, height / divisor);
    kiln_set(run, settings, text);
}

void kiln_set_small_picture(const struct kiln_bench_run *run, struct kiln_settings *settings)
{
    static const char *const texts[] = {"output.size=[64, 36]", "post.bloom.kind=none",
                                        "systems.*.look.lit=0", "systems.*.look.shadow=0",
                                        "systems.*.look.light=[0, 0, 0]"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        kiln_set(run, settings, texts[i]);
}

struct kiln_scene *kiln_bench_load_scene(const struct kiln_bench_run *run, const char *name,
                                         const struct kiln_settings *settings,
                                         struct kiln_error *error)
{
    bool whole = settings->count < KILN_MAX_SETTINGS;
    for (size_t i = 0; i < settings->count && whole; i++)
        whole = settings->items[i] != NULL;
    const char *text = kiln_embedded_find(kiln_embedded_scenes, name);
    if (!whole || !text) {
        if (text)
            kiln_error_no_memory(error, "the settings of %s", run->suite);
        else
            kiln_error_set(error, KILN_DEVICE_FAILED, "%s: its scene is not in the library",
                           run->suite);
        return NULL;
    }
    struct kiln_settings all = *settings;
    if (run->params->quick) /* the scenes' own atlases take longer to make than a quick run */
        kiln_set(run, &all, "systems.*.look.atlas=builtin:spark");
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = all.items;
    params.override_count = all.count;
    params.asset_root = settings->asset_root;
    return kiln_scene_parse(text, strlen(text), name, &params, error);
}

size_t kiln_lanes_of_stage(const struct kiln_bench_run *run, const char *stage,
                           struct kiln_lane lanes[KILN_MAX_LANES], struct kiln_error *error)
{
    struct kiln_techniques automatic;
    if (!kiln_techniques_choose(kiln_device_get_info(run->device), run->params->techniques,
                                run->params->technique_count, &automatic, error))
        return 0;
    for (size_t s = 0; s < KILN_STAGE_COUNT; s++) {
        if (strcmp(kiln_stage_name(s), stage) != 0)
            continue;
        const char *names[KILN_MAX_TECHNIQUES];
        size_t found = kiln_stage_techniques(s, names), count = 0;
        for (int pass = 0; pass < 2; pass++) {
            for (size_t i = 0; i < found && count < KILN_MAX_LANES; i++) {
                bool chosen = strcmp(names[i], automatic.choices[s].name) == 0;
                char text[KILN_TECHNIQUE_SIZE];
                if (chosen) /* a flag may say more than the name: "oddeven:8" */
                    kiln_technique_describe(&automatic, s, text, sizeof text);
                else
                    snprintf(text, sizeof text, "%s=%s", stage, names[i]);
                char *name = kiln_arena_text(run->bench->arena, text, strlen(text));
                if (name && chosen != (pass == 1))
                    lanes[count++] = (struct kiln_lane){.name = name, .techniques = name};
            }
        }
        return count;
    }
    kiln_error_set(error, KILN_USAGE, "there is no stage '%s'", stage);
    return 0;
}

/* ---- Rows ------------------------------------------------------------------------------------ */

bool kiln_bench_begin(const struct kiln_bench_run *run, const struct kiln_bench_part *part,
                      struct kiln_error *error)
{
    struct kiln_bench_part started = *part;
    started.suite = run->suite;
    return kiln_bench_add_part(run->bench, &started, error) != NULL;
}

bool kiln_bench_publish(const struct kiln_bench_run *run, double x, const char *measure,
                        const char *technique, double value, const char *source,
                        struct kiln_error *error)
{
    struct kiln_bench_row row = {.x = x,
                                 .measure = measure,
                                 .technique = technique,
                                 .spread = kiln_spread_of(&value, 1),
                                 .source = source};
    return kiln_bench_add_row(run->bench, &row, error);
}

/* Converts the times of a measure to the unit of the part: ms, or frames a second. */
static void take_values(const struct kiln_samples *samples, int measure, bool rates,
                        double values[KILN_BENCH_MAX_REPETITIONS])
{
    for (uint32_t i = 0; i < samples->count; i++) {
        double ms = samples->ms[measure][i];
        values[i] = !rates ? ms : ms > 0.0 ? 1e3 / ms : 0.0;
    }
}

static bool add_measure(const struct kiln_bench_run *run, const struct kiln_comparison *c,
                        const struct kiln_samples *samples, int measure, struct kiln_error *error)
{
    double values[KILN_BENCH_MAX_REPETITIONS];
    for (size_t i = 0; i < c->lane_count; i++) {
        if (samples[i].problem)
            continue;
        take_values(&samples[i], measure, c->rates, values);
        struct kiln_bench_row row = {.x = c->lanes[i].x > 0.0 ? c->lanes[i].x : c->x,
                                     .measure = c->as ? c->as : kiln_measure_name(measure),
                                     .technique = c->lanes[i].name,
                                     .spread = kiln_spread_of(values, samples[i].count)};
        if (i > 0 && !samples[0].problem)
            row.faster = kiln_spread_of_ratios(samples[0].ms[measure], samples[i].ms[measure],
                                               samples[i].count);
        if (!kiln_bench_add_row(run->bench, &row, error))
            return false;
    }
    return true;
}

bool kiln_bench_add_samples(const struct kiln_bench_run *run, const struct kiln_comparison *c,
                            const struct kiln_samples *samples, struct kiln_error *error)
{
    for (int measure = 0; measure < KILN_MEASURE_COUNT; measure++) {
        if ((c->measures >> measure & 1u) && !add_measure(run, c, samples, measure, error))
            return false;
    }
    for (size_t i = 0; i < c->lane_count; i++) {
        if (samples[i].problem && !kiln_bench_add_note(run->bench, error, "Not measured: %s: %s.",
                                                       c->lanes[i].name, samples[i].problem))
            return false;
    }
    return true;
}

bool kiln_compare_lanes(const struct kiln_bench_run *run, const struct kiln_comparison *c,
                        struct kiln_error *error)
{
    struct kiln_scene *scene = kiln_bench_load_scene(run, c->scene, c->settings, error);
    struct kiln_samples *samples = calloc(c->lane_count, sizeof *samples);
    bool ok = scene && samples;
    if (scene && !samples)
        kiln_error_no_memory(error, "measurements");
    ok = ok && kiln_contest_run(run, scene, 0, c->lanes, c->lane_count, samples, error) &&
         kiln_bench_add_samples(run, c, samples, error);
    free(samples);
    kiln_scene_destroy(&scene);
    return ok;
}

bool kiln_compare_cloud(const struct kiln_bench_run *run, struct kiln_settings *settings,
                        double particles, const char *as, double x, struct kiln_error *error)
{
    static const struct kiln_lane cpu = {.name = "simulate=cpu", .techniques = "simulate=cpu"};
    kiln_set_number(run, settings, "systems.*.emit.rate", particles / 2);
    kiln_set_small_picture(run, settings);
    const struct kiln_comparison comparison = {.scene = "bench/cloud.yaml",
                                               .settings = settings,
                                               .lanes = &cpu,
                                               .lane_count = 1,
                                               .measures = KILN_MEASURE(simulate),
                                               .as = as,
                                               .x = x};
    kiln_bench_say(run, "%s", as);
    return kiln_compare_lanes(run, &comparison, error);
}

/* ---- Growth ---------------------------------------------------------------------------------- */

static bool same_curve(const struct kiln_bench_row *a, const struct kiln_bench_row *b)
{
    return strcmp(a->measure, b->measure) == 0 && strcmp(a->technique, b->technique) == 0;
}

/* Fits the power of growth over the half of the points with the larger x. In the other half, fixed
 * costs would count too much. */
static double growth_of(const struct kiln_bench_part *part, size_t first)
{
    enum { MOST = 64 };
    double x[MOST], y[MOST];
    size_t count = 0;
    for (size_t i = first; i < part->row_count && count < MOST; i++) {
        if (same_curve(&part->rows[first], &part->rows[i])) {
            x[count] = part->rows[i].x;
            y[count++] = part->rows[i].spread.median;
        }
    }
    size_t half = count / 2;
    return kiln_growth(x + half, y + half, count - half);
}

bool kiln_bench_note_growth(const struct kiln_bench_run *run, struct kiln_error *error)
{
    struct kiln_bench_part *part = &run->bench->parts[run->bench->part_count - 1];
    char text[512];
    size_t used = 0;
    for (size_t i = 0; i < part->row_count; i++) {
        bool first = true;
        for (size_t k = 0; k < i; k++)
            first = first && !same_curve(&part->rows[i], &part->rows[k]);
        double power = first ? growth_of(part, i) : (double)NAN;
        if (!isfinite(power) || used >= sizeof text)
            continue;
        int length = snprintf(text + used, sizeof text - used, "%s%s by the power %.2f",
                              used ? ", " : "", part->rows[i].measure, power);
        used += length > 0 ? (size_t)length : 0;
    }
    return used == 0 ||
           kiln_bench_add_note(run->bench, error, "Growth with %s over the larger half: %s.",
                               part->sweep, text);
}
