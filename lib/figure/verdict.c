/* Judges a figure from its sidecar and a fresh drawing: first by hashes; then, if another device,
 * driver or processor drew it, by the metrics of kiln compare. It also words the reason. */
#include "figure/verdict.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/thread.h"
#include "compare/metric.h"

static void mark_stale(struct kiln_figure_result *result, const char *reason)
{
    result->stale = true;
    snprintf(result->reason, sizeof result->reason, "%s", reason);
}

/* ---- By hashes ------------------------------------------------------------------------------ */

/* The stages of a panel that have a hash, from the scene to the pixels. */
enum stage { SCENE, SIMULATION, PICTURE };

static const char *hash_of(const struct kiln_panel *panel, enum stage stage)
{
    return stage == SCENE ? panel->scene_hash : stage == SIMULATION ? panel->state : panel->hash;
}

/* Marks the figure as stale and names the first panel in which the hash of `thing` differs; false
 * when there is none. */
static bool explain_stage(const struct kiln_record *record, const struct kiln_panels *panels,
                          enum stage stage, struct kiln_figure_result *result)
{
    static const char *const stages[] = {"scene", "simulation", "picture"};
    for (size_t i = 0; i < record->panel_count; i++) {
        const struct kiln_panel *panel = &panels->items[i];
        if (strcmp(hash_of(&record->panels[i], stage), hash_of(panel, stage)) == 0)
            continue;
        const char *quote = *panel->label ? "'" : "";
        result->stale = true;
        snprintf(result->reason, sizeof result->reason, "the %s has changed%s%s%.200s%s",
                 stages[stage], *panel->label ? " in " : "", quote, panel->label, quote);
        return true;
    }
    return false;
}

/* Explains changes that do not depend on the device; false when there are none. */
static bool explain_cause(const struct kiln_record *record, const struct kiln_panels *panels,
                          struct kiln_figure_result *result)
{
    if (record->panel_count != panels->count) {
        mark_stale(result, "it has other panels now");
        return true;
    }
    return explain_stage(record, panels, SCENE, result) ||
           explain_stage(record, panels, SIMULATION, result);
}

/* ---- By metrics ------------------------------------------------------------------------------ */

/* Returns the device, driver or processor that drew the figure, whichever first differs from the
 * present one; NULL if none differs. The processor counts only for devices whose pixels depend on
 * it. */
static const char *other_renderer(const struct kiln_record *record,
                                  const struct kiln_renderer *renderer)
{
    if (strcmp(record->device, renderer->device) != 0)
        return record->device;
    if (strcmp(record->driver, renderer->driver) != 0)
        return record->driver;
    bool same_everywhere = strcmp(record->device, KILN_DEVICE_CPU) == 0;
    return !same_everywhere && strcmp(record->cpu, renderer->cpu) != 0 ? record->cpu : NULL;
}

/* Loads the figure's file, and the fresh drawing after a round trip through the same format, so
 * that both have the losses of the format. */
static bool load_both(const struct kiln_fresh_figure *fresh,
                      struct kiln_compare_picture *pictures[2], struct kiln_threads *threads,
                      struct kiln_error *error)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    struct kiln_asset_image *images[2] = {
        kiln_asset_image_parse(fresh->file, fresh->file_size, fresh->path, error), NULL};
    if (images[0] && fresh->format->of_pixels(fresh->pixels, NULL, &bytes, &size, error))
        images[1] = kiln_asset_image_parse(bytes, size, fresh->path, error);
    for (int i = 0; i < 2 && images[1]; i++)
        pictures[i] = kiln_compare_picture_create(images[i], NULL, fresh->path, threads, error);
    kiln_asset_image_destroy(&images[0]);
    kiln_asset_image_destroy(&images[1]);
    free(bytes);
    return pictures[0] && pictures[1] && kiln_compare_pictures_agree(pictures, error);
}

static void say_worst(const struct kiln_metric_set *set, const struct kiln_compare_layer *layer,
                      const char *renderer, struct kiln_figure_result *result)
{
    char found[160] = "";
    size_t length = 0;
    for (size_t i = 0; i < set->count && length < sizeof found; i++) {
        if (!set->columns[i].limited)
            continue;
        length += (size_t)snprintf(found + length, sizeof found - length, "%s%s %.4f of %g",
                                   length ? ", " : "", set->columns[i].name, layer->values[i],
                                   set->columns[i].limit);
        result->stale = result->stale || layer->beyond[i];
    }
    snprintf(result->reason, sizeof result->reason, "drawn by '%.200s', %s limits: %s", renderer,
             result->stale ? "beyond the" : "within the", found);
}

/* Compares the figure's file with the fresh drawing, by the default limits of kiln compare. */
static bool judge_by_metrics(const struct kiln_fresh_figure *fresh, const char *renderer,
                             struct kiln_figure_result *result, struct kiln_error *error)
{
    static const char *const limits[] = {KILN_COMPARE_DEFAULT_LIMITS};
    const struct kiln_compare_params defaults = kiln_compare_defaults();
    const struct kiln_measure_params params = {.pixels_per_degree = defaults.pixels_per_degree,
                                               .threshold = defaults.threshold,
                                               .window = defaults.window};
    struct kiln_compare_picture *pictures[2] = {NULL, NULL};
    struct kiln_measurement measurement = {0};
    struct kiln_metric_set set;
    struct kiln_compare_layer layer = {0};
    struct kiln_threads *threads = kiln_threads_create(fresh->threads);
    bool ok = threads || kiln_error_set(error, KILN_DEVICE_FAILED, "cannot start threads");
    ok = ok && kiln_metric_set_make(&set, limits, 1, error) &&
         load_both(fresh, pictures, threads, error);
    bool fit = ok && kiln_compare_picture_match(pictures[0], pictures[1], error);
    if (fit) {
        ok = kiln_measurement_take(&measurement, pictures[0], pictures[1], &params, threads,
                                   error) &&
             kiln_metric_set_judge(&set, &measurement, &layer, error);
        if (ok)
            say_worst(&set, &layer, renderer, result);
    } else if (ok) {
        mark_stale(result, "it has another size now");
    }
    kiln_measurement_finish(&measurement);
    kiln_compare_picture_destroy(&pictures[0]);
    kiln_compare_picture_destroy(&pictures[1]);
    kiln_threads_destroy(&threads);
    return ok;
}

bool kiln_figure_judge(const struct kiln_record *record, const struct kiln_fresh_figure *fresh,
                       struct kiln_figure_result *result, struct kiln_error *error)
{
    if (strcmp(fresh->hash, record->pixels) == 0 || explain_cause(record, fresh->panels, result))
        return true;
    const char *renderer = other_renderer(record, &fresh->panels->renderer);
    if (!renderer) {
        if (!explain_stage(record, fresh->panels, PICTURE, result))
            mark_stale(result, "its layout or its lettering has changed");
        return true;
    }
    if (fresh->format->of_pixels)
        return judge_by_metrics(fresh, renderer, result, error);
    snprintf(result->reason, sizeof result->reason,
             "drawn by '%.200s'; scene and simulation are the same, and pictures within vectors "
             "are not compared",
             renderer);
    return true;
}
