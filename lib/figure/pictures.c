/* Makes panels from pictures that exist: a triptych has two pictures and their error map, a strip
 * has frames of a clip. Pictures are shown as kiln compare shows them: light is clamped to white,
 * and alpha is blended over black. A strip of a scene is rendered as a sheet of its frames in a
 * row. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/ranges.h"
#include "compare/footage.h"
#include "compare/magma.h"
#include "compare/measure.h"
#include "figure/inset.h"
#include "figure/panels.h"
#include "scene/work.h"

static bool take_picture(struct kiln_panels *panels, struct kiln_panel *panel,
                         const struct kiln_compare_picture *picture, struct kiln_error *error)
{
    size_t count = (size_t)picture->width * picture->height;
    uint8_t *rgba = malloc(count * 4);
    if (!rgba)
        return kiln_error_no_memory(error, "%s", panel->source);
    for (size_t i = 0; i < count; i++) {
        for (size_t c = 0; c < 3; c++) {
            float level = picture->levels[3 * i + c];
            level = level > 0.0f ? level : 0.0f;
            rgba[4 * i + c] = (uint8_t)(level < 255.0f ? level + 0.5f : 255.0f);
        }
        rgba[4 * i + 3] = 255;
    }
    bool ok = kiln_panel_take_pixels(panels, panel, picture->width, picture->height, rgba, error);
    free(rgba);
    return ok;
}

/* ---- Triptychs ------------------------------------------------------------------------------ */

static bool take_map(struct kiln_panels *panels, struct kiln_panel *panel,
                     const struct kiln_measurement *measurement, struct kiln_error *error)
{
    size_t count = (size_t)measurement->width * measurement->height;
    uint8_t *rgba = malloc(count * 4);
    if (!rgba)
        return kiln_error_no_memory(error, "an error map");
    for (size_t i = 0; i < count; i++) {
        kiln_magma_color(measurement->errors[i], rgba + 4 * i);
        rgba[4 * i + 3] = 255;
    }
    bool ok =
        kiln_panel_take_pixels(panels, panel, measurement->width, measurement->height, rgba, error);
    free(rgba);
    panel->is_map = true;
    panel->label = kiln_arena_format(panels->arena, "FLIP %.4f", measurement->flip.mean);
    return ok && (panel->label || kiln_error_no_memory(error, "an error map"));
}

static bool measure(struct kiln_panels *panels, struct kiln_compare_picture *const pictures[2],
                    struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_measurement measurement = {0};
    const struct kiln_compare_params defaults = kiln_compare_defaults();
    struct kiln_measure_params params = {.hdr = pictures[0]->hdr,
                                         .pixels_per_degree = defaults.pixels_per_degree,
                                         .threshold = defaults.threshold,
                                         .window = defaults.window};
    bool ok =
        kiln_measurement_take(&measurement, pictures[0], pictures[1], &params, threads, error) &&
        take_picture(panels, &panels->items[0], pictures[0], error) &&
        take_picture(panels, &panels->items[1], pictures[1], error) &&
        take_map(panels, &panels->items[2], &measurement, error);
    kiln_measurement_finish(&measurement);
    if (!ok && error->code == KILN_FRAME_FAILED) { /* different sizes are wrong input */
        struct kiln_error cause = *error;
        kiln_error_set(error, KILN_INVALID_INPUT, "%s: %.900s", panels->items[1].source,
                       cause.message);
    }
    return ok;
}

static struct kiln_compare_picture *load_picture(const char *path, struct kiln_threads *threads,
                                                 struct kiln_error *error)
{
    struct kiln_asset_image *image = kiln_asset_image_load(NULL, path, error);
    struct kiln_compare_picture *picture =
        image ? kiln_compare_picture_create(image, NULL, path, threads, error) : NULL;
    kiln_asset_image_destroy(&image);
    return picture;
}

static bool compare(struct kiln_panels *panels, const struct kiln_figure_params *params,
                    struct kiln_threads *threads, struct kiln_error *error)
{
    const char *const *paths = params->inputs;
    struct kiln_compare_picture *pictures[2] = {load_picture(paths[0], threads, error), NULL};
    if (pictures[0])
        pictures[1] = load_picture(paths[1], threads, error);
    bool ok = pictures[0] && pictures[1];
    if (ok && pictures[0]->hdr != pictures[1]->hdr)
        ok = kiln_error_set(error, KILN_INVALID_INPUT,
                            "%s and %s: one has floats and the other has integers", paths[0],
                            paths[1]);
    ok = ok && kiln_insets_check(params, pictures[0]->width, pictures[0]->height, error) &&
         measure(panels, pictures, threads, error);
    kiln_compare_picture_destroy(&pictures[0]);
    kiln_compare_picture_destroy(&pictures[1]);
    return ok;
}

bool kiln_panels_of_triptych(struct kiln_panels *panels, const struct kiln_figure_params *params,
                             struct kiln_error *error)
{
    if (params->input_count != 2)
        return kiln_error_set(error, KILN_USAGE, "found %zu pictures; a triptych needs two",
                              params->input_count);
    static const char *const labels[3] = {"reference", "result", ""};
    panels->items = kiln_arena_alloc(panels->arena, 3, sizeof *panels->items);
    if (!panels->items)
        return kiln_error_no_memory(error, "a triptych");
    panels->count = panels->columns = 3;
    for (size_t i = 0; i < 3; i++) {
        panels->items[i].label = labels[i];
        panels->items[i].source = params->inputs[i < 2 ? i : 1];
        panels->items[i].time_s = -1;
    }
    struct kiln_threads *threads = kiln_threads_create(params->threads);
    bool ok = threads ? compare(panels, params, threads, error)
                      : kiln_error_set(error, KILN_DEVICE_FAILED, "cannot start threads");
    kiln_threads_destroy(&threads);
    return ok;
}

/* ---- Strips --------------------------------------------------------------------------------- */

static bool is_wanted(const struct kiln_frame_range *ranges, size_t count, uint32_t number)
{
    for (size_t i = 0; i < count; i++) {
        if (number >= ranges[i].first && number <= ranges[i].last)
            return true;
    }
    return false;
}

static bool take_frame(struct kiln_panels *panels, const struct kiln_figure_params *params,
                       struct kiln_footage *footage, uint32_t number, struct kiln_threads *threads,
                       struct kiln_error *error)
{
    struct kiln_panel *panel = &panels->items[panels->count];
    panel->source = kiln_footage_path(footage);
    panel->has_frame = true;
    panel->frame = number;
    panel->time_s = -1;
    panel->label = kiln_arena_format(panels->arena, "frame %u", number);
    struct kiln_asset_image *image = kiln_footage_take(footage, error);
    struct kiln_compare_picture *picture =
        image ? kiln_compare_picture_create(image, NULL, panel->source, threads, error) : NULL;
    bool ok = panel->label && picture &&
              kiln_insets_check(params, picture->width, picture->height, error) &&
              take_picture(panels, panel, picture, error);
    kiln_compare_picture_destroy(&picture);
    kiln_asset_image_destroy(&image);
    panels->count += ok;
    if (!panel->label)
        kiln_error_no_memory(error, "a strip");
    return ok;
}

/* Finds the number of the next frame: its own where the kind of footage has numbers, else its
 * position. False at the end. */
static bool next_number(struct kiln_footage *footage, uint32_t position, uint32_t *number)
{
    struct kiln_footage_frame frame;
    if (!kiln_footage_peek(footage, &frame))
        return false;
    bool numbers = kiln_footage_kind(footage) >= KILN_FOOTAGE_NUMBERED;
    *number = numbers ? frame.number : position;
    return true;
}

/* Counts the frames of a clip, and lists `wanted` of them at even distances, by their numbers. To
 * count its frames, a video is decoded. */
static bool choose_evenly(const char *path, uint32_t wanted, struct kiln_frame_range *ranges,
                          size_t *count, struct kiln_error *error)
{
    uint32_t numbers_size = 1024, total = 0, number;
    uint32_t *numbers = malloc(numbers_size * sizeof *numbers);
    struct kiln_footage *footage = kiln_footage_open(path, "beauty", error);
    bool memory = numbers != NULL;
    while (footage && memory && next_number(footage, total, &number)) {
        if (total == numbers_size) {
            numbers_size *= 2;
            uint32_t *grown = realloc(numbers, numbers_size * sizeof *numbers);
            memory = grown != NULL;
            if (!grown)
                break;
            numbers = grown;
        }
        numbers[total++] = number;
        kiln_footage_skip(footage);
    }
    *count = wanted < total ? wanted : total;
    for (uint32_t i = 0; i < *count; i++) {
        uint64_t place = *count > 1 ? (uint64_t)i * (total - 1) / (*count - 1) : total / 2;
        ranges[i] = (struct kiln_frame_range){numbers[place], numbers[place]};
    }
    free(numbers);
    bool ok = footage != NULL;
    kiln_footage_close(&footage);
    if (ok && !memory)
        return kiln_error_no_memory(error, "a strip");
    return ok && (*count > 0 || kiln_error_set(error, KILN_INVALID_INPUT, "%s: no frames", path));
}

static bool take_frames(struct kiln_panels *panels, const struct kiln_figure_params *params,
                        const struct kiln_frame_range *ranges, size_t count,
                        struct kiln_error *error)
{
    struct kiln_threads *threads = kiln_threads_create(1);
    struct kiln_footage *footage = kiln_footage_open(params->inputs[0], "beauty", error);
    uint32_t number, most = (uint32_t)panels->count;
    bool ok =
        footage && kiln_footage_claim(footage, "a frame that it is made of", panels->claims, error);
    if (ok && !threads)
        ok = kiln_error_set(error, KILN_DEVICE_FAILED, "cannot start threads");
    panels->count = 0;
    for (uint32_t position = 0; ok && panels->count < most; position++) {
        if (!next_number(footage, position, &number))
            break;
        if (is_wanted(ranges, count, number))
            ok = take_frame(panels, params, footage, number, threads, error);
        else
            kiln_footage_skip(footage);
    }
    kiln_footage_close(&footage);
    kiln_threads_destroy(&threads);
    return ok;
}

static bool strip_of_clip(struct kiln_panels *panels, const struct kiln_figure_params *params,
                          struct kiln_error *error)
{
    struct kiln_frame_range *even = kiln_arena_alloc(panels->arena, params->strip, sizeof *even);
    const struct kiln_frame_range *ranges = params->ranges;
    size_t count = params->range_count;
    const char *path = params->inputs[0];
    if (!even)
        return kiln_error_no_memory(error, "a strip");
    if (count == 0) {
        if (!choose_evenly(path, params->strip, even, &count, error))
            return false;
        ranges = even;
    }
    panels->count += (size_t)kiln_ranges_count(ranges, count);
    if (panels->count > 1024)
        return kiln_error_set(error, KILN_USAGE, "found %zu frames; a figure has up to 1024 panels",
                              panels->count);
    size_t wanted = panels->count;
    panels->items = kiln_arena_alloc(panels->arena, wanted, sizeof *panels->items);
    if (!panels->items)
        return kiln_error_no_memory(error, "a strip");
    if (!take_frames(panels, params, ranges, count, error))
        return false;
    panels->columns = panels->count;
    return panels->count == wanted ||
           kiln_error_set(error, KILN_USAGE, "%s: found %zu of the %zu frames that were asked for",
                          path, panels->count, wanted);
}

/* Makes a strip of a scene as a sheet of its frames in one row. */
static bool strip_of_scene(struct kiln_panels *panels, const struct kiln_figure_params *params,
                           struct kiln_error *error)
{
    struct kiln_figure_params sheet = *params;
    if (params->range_count == 0) {
        struct kiln_scene *scene = kiln_scene_load(params->inputs[0], &params->scene, error);
        if (!scene)
            return false;
        uint32_t frames = kiln_scene_facts(scene).frames;
        kiln_scene_destroy(&scene);
        uint32_t count = params->strip < frames ? params->strip : frames;
        struct kiln_frame_range *even = kiln_arena_alloc(panels->arena, count, sizeof *even);
        if (!even)
            return kiln_error_no_memory(error, "a strip");
        for (uint32_t i = 0; i < count; i++) {
            uint64_t frame = count > 1 ? (uint64_t)i * (frames - 1) / (count - 1) : frames / 2;
            even[i] = (struct kiln_frame_range){(uint32_t)frame, (uint32_t)frame};
        }
        sheet.ranges = even;
        sheet.range_count = count;
    }
    if (!kiln_panels_of_sheet(panels, &sheet, error))
        return false;
    for (size_t i = 0; i < panels->count; i++) {
        struct kiln_panel *panel = &panels->items[i];
        panel->label = kiln_arena_format(panels->arena, "%.2f s", panel->time_s);
        if (!panel->label)
            return kiln_error_no_memory(error, "a strip");
    }
    panels->columns = panels->count;
    return true;
}

bool kiln_panels_of_strip(struct kiln_panels *panels, const struct kiln_figure_params *params,
                          struct kiln_error *error)
{
    if (params->input_count != 1)
        return kiln_error_set(error, KILN_USAGE, "found %zu clips; a strip needs one",
                              params->input_count);
    if (params->strip < 1 || params->strip > 1024)
        return kiln_error_set(error, KILN_USAGE, "found %u frames; a strip has 1 to 1024",
                              params->strip);
    return kiln_is_scene_name(params->inputs[0]) ? strip_of_scene(panels, params, error)
                                                 : strip_of_clip(panels, params, error);
}
