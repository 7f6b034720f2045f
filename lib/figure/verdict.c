/* Judges a figure from its sidecar and a fresh drawing: first by hashes; then, if another device,
 * driver or processor drew it, by the metrics of kiln compare. It also words the reason. */
#include "figure/verdict.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/thread.h"
#include "compare/metric.h"

static void say_stale(struct kiln_figure_result *result, const char *reason)
{
    result->stale = true;
    snprintf(result->reason, sizeof result->reason, "%s", reason);
}

/* ---- By hashes ------------------------------------------------------------------------------ */

/* The stages of a panel that have a hash, from the scene to the pixels. */
enum thing { SCENE, SIMULATION, PICTURE };

static const char *hash_of(const struct kiln_panel *panel, enum thing thing)
{
    return thing == SCENE ? panel->scene_hash : thing == SIMULATION ? panel->state : panel->hash;
}

/* Marks the figure as stale and names the first panel in which the hash of `thing` differs; false
 * when there is none. */
static bool explain_thing(const struct kiln_record *record, const struct kiln_panels *panels,
                          enum thing thing, struct kiln_figure_result *result)
{
    static const char *const things[] = {"scene", "simulation", "picture"};
    for (size_t i = 0; i < record->panel_count; i++) {
        const struct kiln_panel *is = &panels->items[i];
        if (strcmp(hash_of(&record->panels[i], thing), hash_of(is, thing)) == 0)
            continue;
        const char *quote = *is->label ? "'" : "";
        result->stale = true;
        snprintf(result->reason, sizeof result->reason, "the %s has changed%s%s%.200s%s",
                 things[thing], *is->label ? " in " : "", quote, is->label, quote);
        return true;
    }
    return false;
}

/* Explains changes that do not depend on the device; false when there are none. */
static bool explain_cause(const struct kiln_record *record, const struct kiln_panels *panels,
                          struct kiln_figure_result *result)
{
    if (record->panel_count != panels->count) {
        say_stale(result, "it has other panels now");
        return true;
    }
    return explain_thing(record, panels, SCENE, result) ||
           explain_thing(record, panels, SIMULATION, result);
}

/* ---- By metrics ------------------------------------------------------------------------------ */

/* Returns the device, driver or processor that drew the figure, whichever first differs from the
 * present one; NULL if none differs. The processor counts only for devices whose pixels depend on
 * it. */
static const char *other_maker(const struct kiln_record *record, const struct kiln_maker *maker)
{
    if (strcmp(record->device, maker->device) != 0)
        return record->device;
    if (strcmp(record->driver, maker->driver) != 0)
        return record->driver;
    bool same_everywhere = strcmp(record->device, KILN_DEVICE_CPU) == 0;
    return !same_everywhere && strcmp(record->cpu, maker->cpu) != 0 ? record->cpu : NULL;
}

/* Loads the figure's file, and the fresh drawing after a round trip through the same format, so
 * that both have the losses of the format. */
static bool load_both(const struct kiln_figure_now *now, struct kiln_subject *subjects[2],
                      struct kiln_threads *threads, struct kiln_error *error)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    struct kiln_asset_image *images[2] = {kiln_asset_image_load(NULL, now->path, error), NULL};
    if (images[0] && now->format->of_pixels(now->pixels, NULL, &bytes, &size, error))
        images[1] = kiln_asset_image_parse(bytes, size, now->path, error);
    for (int i = 0; i < 2 && images[1]; i++)
        subjects[i] = kiln_subject_create(images[i], NULL, now->path, threads, error);
    kiln_asset_image_destroy(&images[0]);
    kiln_asset_image_destroy(&images[1]);
    free(bytes);
    return subjects[0] && subjects[1];
}

static void say_worst(const struct kiln_metric_set *set, const struct kiln_compare_frame *frame,
                      const char *maker, struct kiln_figure_result *result)
{
    char found[160] = "";
    size_t length = 0;
    for (size_t i = 0; i < set->count && length < sizeof found; i++) {
        if (!set->columns[i].limited)
            continue;
        length += (size_t)snprintf(found + length, sizeof found - length, "%s%s %.4f of %g",
                                   length ? ", " : "", set->columns[i].name, frame->values[i],
                                   set->columns[i].limit);
        result->stale = result->stale || frame->beyond[i];
    }
    snprintf(result->reason, sizeof result->reason, "drawn by '%.200s', %s limits: %s", maker,
             result->stale ? "beyond the" : "within the", found);
}

/* Compares the figure's file with the fresh drawing, by the default limits of kiln compare. */
static bool judge_by_eye(const struct kiln_figure_now *now, const char *maker,
                         struct kiln_figure_result *result, struct kiln_error *error)
{
    static const char *const limits[] = {KILN_COMPARE_DEFAULT_LIMITS};
    const struct kiln_compare_params usual = kiln_compare_defaults();
    const struct kiln_measure_params params = {.pixels_per_degree = usual.pixels_per_degree,
                                               .threshold = usual.threshold,
                                               .window = usual.window};
    struct kiln_subject *subjects[2] = {NULL, NULL};
    struct kiln_measurement measurement = {0};
    struct kiln_metric_set set;
    struct kiln_compare_frame frame = {0};
    struct kiln_threads *threads = kiln_threads_create(now->threads);
    bool ok = threads || kiln_error_set(error, KILN_DEVICE_FAILED, "cannot start threads");
    ok = ok && kiln_metric_set_make(&set, limits, 1, error) &&
         load_both(now, subjects, threads, error);
    bool fit = ok && kiln_subject_match(subjects[0], subjects[1], error);
    if (fit) {
        ok = kiln_measurement_take(&measurement, subjects[0], subjects[1], &params, threads,
                                   error) &&
             kiln_metric_set_judge(&set, &measurement, &frame, error);
        if (ok)
            say_worst(&set, &frame, maker, result);
    } else if (ok) {
        say_stale(result, "it has another size now");
    }
    kiln_measurement_finish(&measurement);
    kiln_subject_destroy(&subjects[0]);
    kiln_subject_destroy(&subjects[1]);
    kiln_threads_destroy(&threads);
    return ok;
}

bool kiln_figure_judge(const struct kiln_record *record, const struct kiln_figure_now *now,
                       struct kiln_figure_result *result, struct kiln_error *error)
{
    if (strcmp(now->hash, record->pixels) == 0 || explain_cause(record, now->panels, result))
        return true;
    const char *maker = other_maker(record, &now->panels->maker);
    if (!maker) {
        if (!explain_thing(record, now->panels, PICTURE, result))
            say_stale(result, "its layout or its lettering has changed");
        return true;
    }
    if (now->format->of_pixels)
        return judge_by_eye(now, maker, result, error);
    snprintf(result->reason, sizeof result->reason,
             "drawn by '%.200s'; scene and simulation are the same, and pictures within vectors "
             "are not compared",
             maker);
    return true;
}
