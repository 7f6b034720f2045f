/* Renders the panels of figures from scenes. Panels that differ only by their frame are rendered in
 * one run. As in tests, every stage that can run on the processor does, so that a figure is the
 * same on every machine if possible. */
#include "figure/panels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/cpu.h"
#include "base/error.h"
#include "base/hash.h"
#include "figure/inset.h"
#include "figure/lettering.h"
#include "figure/sweep.h"
#include "frame/technique.h"
#include "scene/scene.h"
#include "scene/work.h"

bool kiln_panel_take_pixels(struct kiln_panels *panels, struct kiln_panel *panel, uint32_t width,
                            uint32_t height, const uint8_t *rgba, struct kiln_error *error)
{
    size_t count = (size_t)width * height;
    uint8_t *out = kiln_arena_alloc(panels->arena, count, 4);
    if (!out)
        return kiln_error_no_memory(error, "a panel of %u x %u", width, height);
    for (size_t i = 0; i < count; i++) {
        uint32_t alpha = rgba[4 * i + 3];
        for (int c = 0; c < 3; c++) {
            uint32_t paper = (panels->paper >> (16 - 8 * c)) & 255;
            out[4 * i + (size_t)c] =
                (uint8_t)((rgba[4 * i + (size_t)c] * alpha + paper * (255 - alpha) + 127) / 255);
        }
        out[4 * i + 3] = 255;
    }
    panel->pixels = (struct kiln_pixels){width, height, out};
    kiln_hash_sha256(out, count * 4, panel->hash);
    return true;
}

bool kiln_is_scene_name(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && (strcasecmp(dot, ".yaml") == 0 || strcasecmp(dot, ".yml") == 0);
}

struct rendering {
    struct kiln_panels *panels;
    const struct kiln_figure_params *params;
    const struct kiln_choices *choices;
    struct kiln_device *device;
    struct kiln_scene *scene; /* the scene of the current run */
    bool *in_run;             /* for each panel, whether the current run renders it */
    struct kiln_error *error;
    struct kiln_error failure; /* the first error of a callback */
};

static bool no_memory(const struct rendering *r)
{
    return kiln_error_no_memory(r->error, "the panels of a figure");
}

/* ---- A run ---------------------------------------------------------------------------------- */

static bool load_scene(struct rendering *r, const struct kiln_choice *choice)
{
    struct kiln_scene_params params = r->params->scene;
    size_t count = params.override_count + choice->override_count;
    const char **overrides = kiln_arena_alloc(r->panels->arena, count + 1, sizeof *overrides);
    if (!overrides) {
        no_memory(r);
        return false;
    }
    for (size_t i = 0; i < params.override_count; i++)
        overrides[i] = params.overrides[i];
    for (size_t i = 0; i < choice->override_count; i++)
        overrides[params.override_count + i] = choice->overrides[i];
    params.overrides = overrides;
    params.override_count = count;
    kiln_scene_destroy(&r->scene);
    r->scene = kiln_scene_load(r->params->inputs[choice->scene], &params, r->error);
    return r->scene && kiln_scene_claim(r->scene, r->panels->claims, r->error);
}

static bool choose_frame(const struct rendering *r, const struct kiln_choice *choice,
                         struct kiln_panel *panel)
{
    struct kiln_scene_info info = kiln_scene_facts(r->scene);
    double rate = (double)info.fps_num / info.fps_den;
    double number = choice->moment == KILN_MOMENT_TIME    ? floor(choice->when * rate + 0.5)
                    : choice->moment == KILN_MOMENT_FRAME ? choice->when
                                                          : info.frames / 2;
    if (number >= info.frames) {
        kiln_error_set(r->error, KILN_USAGE, "frame %.0f: '%s' has frames 0-%u", number,
                       r->params->inputs[choice->scene], info.frames - 1);
        return false;
    }
    panel->label = choice->label;
    panel->source = r->params->inputs[choice->scene];
    memcpy(panel->scene_hash, info.hash, sizeof panel->scene_hash);
    panel->has_frame = true;
    panel->frame = (uint32_t)number;
    panel->time_s = number / rate;
    return true;
}

static bool same_run(const struct kiln_choice *a, const struct kiln_choice *b)
{
    if (a->scene != b->scene || a->override_count != b->override_count)
        return false;
    for (size_t i = 0; i < a->override_count; i++) {
        if (strcmp(a->overrides[i], b->overrides[i]) != 0)
            return false;
    }
    return true;
}

static void take_picture(void *user, const struct kiln_frame_layer *view)
{
    struct rendering *r = user;
    for (size_t i = 0; i < r->panels->count; i++) {
        struct kiln_panel *panel = &r->panels->items[i];
        if (r->in_run[i] && panel->frame == view->frame && r->failure.code == KILN_OK)
            kiln_panel_take_pixels(r->panels, panel, view->width, view->height, view->pixels,
                                   &r->failure);
    }
}

static void take_state(void *user, const struct kiln_progress *progress)
{
    struct rendering *r = user;
    for (size_t i = 0; i < r->panels->count; i++) {
        struct kiln_panel *panel = &r->panels->items[i];
        if (r->in_run[i] && panel->frame == progress->frame)
            snprintf(panel->state, sizeof panel->state, "%08x%08x", progress->state.lane[0],
                     progress->state.lane[1]);
    }
}

static bool should_stop(void *user)
{
    const struct rendering *r = user;
    return r->failure.code != KILN_OK || (r->params->stop && r->params->stop(r->params->user));
}

static int compare_ranges(const void *a, const void *b)
{
    uint32_t x = ((const struct kiln_frame_range *)a)->first;
    uint32_t y = ((const struct kiln_frame_range *)b)->first;
    return (x > y) - (x < y);
}

/* Lists the frames of the current run in ascending order, each once. */
static struct kiln_frame_range *list_frames(const struct rendering *r, size_t *count)
{
    struct kiln_frame_range *list =
        kiln_arena_alloc(r->panels->arena, r->panels->count, sizeof *list);
    size_t listed = 0;
    for (size_t i = 0; list && i < r->panels->count; i++) {
        uint32_t frame = r->panels->items[i].frame;
        if (r->in_run[i])
            list[listed++] = (struct kiln_frame_range){frame, frame};
    }
    *count = 0;
    if (!list)
        return NULL;
    qsort(list, listed, sizeof *list, compare_ranges);
    for (size_t i = 0; i < listed; i++) {
        if (*count == 0 || list[*count - 1].first != list[i].first)
            list[(*count)++] = list[i];
    }
    return list;
}

static bool render_run(struct rendering *r)
{
    const struct kiln_figure_params *figure = r->params;
    struct kiln_technique_list pinned;
    kiln_techniques_combination(0, &pinned);
    size_t count = KILN_STAGE_COUNT + figure->technique_count;
    const char **techniques = kiln_arena_alloc(r->panels->arena, count, sizeof *techniques);
    struct kiln_render_params params = kiln_render_defaults();
    params.ranges = list_frames(r, &params.range_count);
    if (!techniques || !params.ranges)
        return no_memory(r);
    for (size_t i = 0; i < count; i++)
        techniques[i] =
            i < KILN_STAGE_COUNT ? pinned.flags[i] : figure->techniques[i - KILN_STAGE_COUNT];
    params.techniques = techniques;
    params.technique_count = count;
    params.threads = figure->threads;
    params.state_hash = true;
    params.picture = take_picture;
    params.progress = take_state;
    params.stop = should_stop;
    params.user = r;
    params.log = figure->log;
    bool ok = kiln_render(r->device, r->scene, &params, NULL, r->error);
    if (r->failure.code != KILN_OK)
        *r->error = r->failure;
    return ok && r->failure.code == KILN_OK;
}

/* Renders the panel `first`, which has no pixels yet, and all panels that share a run with it. */
static bool make_run(struct rendering *r, size_t first)
{
    const struct kiln_choice *choices = r->choices->items;
    if (!load_scene(r, &choices[first]))
        return false;
    for (size_t i = 0; i < r->panels->count; i++) {
        r->in_run[i] = i >= first && same_run(&choices[first], &choices[i]);
        if (r->in_run[i] && !choose_frame(r, &choices[i], &r->panels->items[i]))
            return false;
    }
    return render_run(r);
}

/* Checks that the font has the characters of the labels that kiln gives to panels, if they are
 * shown. */
static bool check_labels(const struct rendering *r)
{
    bool own = r->params->label_count == 0 && !r->params->unlabelled && !r->params->plain;
    for (size_t i = 0; own && i < r->choices->count; i++) {
        if (!kiln_lettering_check_label(r->choices->items[i].label, i, r->error))
            return false;
    }
    return true;
}

/* Loads every scene once before the device is opened, so that a faulty scene, or an inset outside
 * of its picture, is found before minutes of rendering. */
static bool check_runs(struct rendering *r)
{
    for (size_t i = 0; i < r->choices->count; i++) {
        struct kiln_panel panel;
        bool known = i > 0 && same_run(&r->choices->items[i - 1], &r->choices->items[i]);
        if ((!known && !load_scene(r, &r->choices->items[i])) ||
            !choose_frame(r, &r->choices->items[i], &panel) ||
            !kiln_insets_check(r->params, r->scene->width, r->scene->height, r->error))
            return false;
    }
    return true;
}

static bool open_device(struct rendering *r)
{
    struct kiln_device_params params = kiln_techniques_device(
        r->params->device, r->params->techniques, r->params->technique_count);
    params.log = r->params->log;
    r->device = kiln_device_open(&params, r->error);
    if (!r->device)
        return false;
    const struct kiln_device_info *info = kiln_device_get_info(r->device);
    struct kiln_renderer *renderer = &r->panels->renderer;
    snprintf(renderer->device, sizeof renderer->device, "%s", info->name);
    snprintf(renderer->driver, sizeof renderer->driver, "%s, %s", info->gl_version, info->vendor);
    kiln_cpu_name(renderer->cpu);
    return true;
}

static bool render_panels(struct kiln_panels *panels, const struct kiln_figure_params *params,
                          const struct kiln_choices *choices, struct kiln_error *error)
{
    struct rendering r = {.panels = panels, .params = params, .choices = choices, .error = error};
    panels->count = choices->count;
    panels->items = kiln_arena_alloc(panels->arena, panels->count, sizeof *panels->items);
    r.in_run = kiln_arena_alloc(panels->arena, panels->count, sizeof *r.in_run);
    bool ok = (panels->items && r.in_run) || no_memory(&r);
    if (ok && params->label_count > 0 && params->label_count != panels->count)
        ok = kiln_error_set(error, KILN_USAGE, "found %zu labels where %zu are needed",
                            params->label_count, panels->count);
    ok = ok && check_labels(&r) && check_runs(&r) && open_device(&r);
    for (size_t i = 0; ok && i < panels->count; i++)
        ok = panels->items[i].pixels.rgba || make_run(&r, i);
    kiln_scene_destroy(&r.scene);
    kiln_device_close(&r.device);
    return ok;
}

/* ---- Sheets --------------------------------------------------------------------------------- */

bool kiln_panels_of_sheet(struct kiln_panels *panels, const struct kiln_figure_params *params,
                          struct kiln_error *error)
{
    struct kiln_choices choices;
    if (!kiln_choices_make(panels->arena, params, &choices, error))
        return false;
    size_t square = 1;
    while (square * square < choices.count)
        square++;
    panels->columns = choices.axis_count > 1 && choices.last_axis <= 8 ? choices.last_axis : square;
    return render_panels(panels, params, &choices, error);
}
