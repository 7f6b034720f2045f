/* A figure from request to file: panels, layout, pixels, then the file and its sidecar, or a check
 * of those that are there. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "figure/layout.h"
#include "figure/record.h"
#include "output/temporary.h"

struct job {
    const struct kiln_figure_params *params;
    struct kiln_arena *arena;
    struct kiln_panels panels;
    struct kiln_drawing drawing;
    struct kiln_pixels pixels;
    char hash[65]; /* of them */
    struct kiln_error *error;
};

static bool no_memory(const struct job *job)
{
    return kiln_error_set(job->error, KILN_DEVICE_FAILED, "%s: out of memory", job->params->output);
}

enum format { PNG, SVG, PDF, NO_FORMAT };

static enum format format_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    if (!dot)
        return NO_FORMAT;
    return strcasecmp(dot, ".png") == 0   ? PNG
           : strcasecmp(dot, ".svg") == 0 ? SVG
           : strcasecmp(dot, ".pdf") == 0 ? PDF
                                          : NO_FORMAT;
}

static bool sidecar_path(const struct job *job, char path[KILN_PATH_SIZE])
{
    int length = snprintf(path, KILN_PATH_SIZE, "%s%s", job->params->output, KILN_RECORD_SUFFIX);
    return (length >= 0 && length < KILN_PATH_SIZE) ||
           kiln_error_set(job->error, KILN_IO, "%s: the path is too long", job->params->output);
}

/* What can be refused before anything is rendered. */
static bool check_request(const struct job *job)
{
    const struct kiln_figure_params *params = job->params;
    if (!params->output || format_of(params->output) == NO_FORMAT)
        return kiln_error_set(job->error, KILN_USAGE,
                              "%s: a figure is PNG, SVG or PDF; the name must end in .png, .svg or "
                              ".pdf",
                              params->output ? params->output : "");
    if (params->text_size < 8 || params->text_size > 64)
        return kiln_error_set(job->error, KILN_USAGE, "text of %u pixels; allowed are 8 to 64",
                              params->text_size);
    if (params->input_count == 0)
        return kiln_error_set(job->error, KILN_USAGE, "a figure of nothing");
    char sidecar[KILN_PATH_SIZE];
    return params->check || (sidecar_path(job, sidecar) &&
                             kiln_target_check(params->output, params->overwrite, job->error) &&
                             kiln_target_check(sidecar, true, job->error));
}

static bool draw(struct job *job)
{
    const struct kiln_figure_params *params = job->params;
    job->panels =
        (struct kiln_panels){.arena = job->arena, .paper = kiln_layout_paper(params->dark)};
    job->drawing = (struct kiln_drawing){.arena = job->arena};
    bool ok = params->kind == KILN_FIGURE_SHEET
                  ? kiln_panels_of_sheet(&job->panels, params, job->error)
              : params->kind == KILN_FIGURE_STRIP
                  ? kiln_panels_of_strip(&job->panels, params, job->error)
                  : kiln_panels_of_triptych(&job->panels, params, job->error);
    if (!ok || !kiln_layout_make(&job->drawing, &job->panels, params, job->error) ||
        !kiln_drawing_rasterise(&job->drawing, &job->pixels, job->error))
        return false;
    size_t size = (size_t)job->pixels.width * job->pixels.height * 4;
    return kiln_hash_sha256(job->pixels.rgba, size, job->hash) || no_memory(job);
}

/* ---- Writing -------------------------------------------------------------------------------- */

/* The path from one folder to another that it lies in, or else the other's own. */
static const char *way_up(struct kiln_arena *arena, const char *from, const char *to)
{
    size_t length = strlen(to);
    if (strncmp(from, to, length) != 0 || (from[length] != '/' && from[length]))
        return kiln_arena_format(arena, "%s", to);
    const char *way = "";
    for (const char *c = from + length; way && *c; c++) {
        if (*c == '/')
            way = kiln_arena_format(arena, "%s%s", way, *way ? "/.." : "..");
    }
    return way && !*way ? "." : way;
}

/* The path from the folder of the figure to the working directory. */
static bool find_folder(const struct job *job, const char **folder)
{
    const char *output = job->params->output, *slash = strrchr(output, '/');
    size_t length = slash > output ? (size_t)(slash - output) : 1;
    const char *name = slash ? kiln_arena_text(job->arena, output, length) : ".";
    char *here = realpath(".", NULL), *there = name ? realpath(name, NULL) : NULL;
    *folder = here && there ? way_up(job->arena, there, here) : NULL;
    free(here);
    free(there);
    return *folder || no_memory(job);
}

static bool write_sidecar(struct job *job, const uint8_t *bytes, size_t size)
{
    char file[65], path[KILN_PATH_SIZE];
    struct kiln_record record = {.version = KILN_VERSION,
                                 .command_count = job->params->command_count,
                                 .device = job->panels.device,
                                 .width = job->drawing.width,
                                 .height = job->drawing.height,
                                 .pixels = job->hash,
                                 .file = file,
                                 .panels = job->panels.items,
                                 .panel_count = job->panels.count};
    record.command = kiln_arena_alloc(job->arena, record.command_count + 1, sizeof(char *));
    if (!record.command || !kiln_hash_sha256(bytes, size, file))
        return no_memory(job);
    for (size_t i = 0; i < record.command_count; i++)
        record.command[i] = job->params->command[i];
    struct kiln_text text = {0};
    bool ok = sidecar_path(job, path) && find_folder(job, &record.folder) &&
              kiln_record_write(&record, &text, job->error) &&
              kiln_temporary_write_file(path, text.data, text.length, job->error);
    kiln_text_free(&text);
    return ok;
}

static bool write_figure(struct job *job)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    enum format format = format_of(job->params->output);
    bool ok = format == PNG   ? kiln_pixels_png(&job->pixels, &bytes, &size, job->error)
              : format == SVG ? kiln_drawing_svg(&job->drawing, &bytes, &size, job->error)
                              : kiln_drawing_pdf(&job->drawing, &bytes, &size, job->error);
    ok = ok && kiln_temporary_write_file(job->params->output, bytes, size, job->error) &&
         write_sidecar(job, bytes, size);
    free(bytes);
    return ok;
}

/* ---- Checking ------------------------------------------------------------------------------- */

static void say_stale(struct kiln_figure_result *result, const char *reason)
{
    result->stale = true;
    snprintf(result->reason, sizeof result->reason, "%s", reason);
}

/* What a panel has of each thing that can change, from the scene to the pixels. */
static const char *hash_of(const struct kiln_panel *panel, int thing)
{
    return thing == 0 ? panel->scene_hash : thing == 1 ? panel->state : panel->hash;
}

/* Names the first panel whose thing is another one; false when there is none. */
static bool explain_thing(const struct job *job, const struct kiln_record *record, int thing,
                          struct kiln_figure_result *result)
{
    static const char *const things[] = {"scene", "simulation", "picture"};
    for (size_t i = 0; i < record->panel_count; i++) {
        const struct kiln_panel *is = &job->panels.items[i];
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

static void explain(const struct job *job, const struct kiln_record *record,
                    struct kiln_figure_result *result)
{
    if (record->panel_count != job->panels.count)
        say_stale(result, "it has other panels now");
    else if (!explain_thing(job, record, 0, result) && !explain_thing(job, record, 1, result) &&
             !explain_thing(job, record, 2, result))
        say_stale(result, "its layout or its lettering has changed");
}

static bool check_figure(struct job *job, struct kiln_figure_result *result)
{
    struct kiln_record *record = kiln_record_read(job->arena, job->params->check, job->error);
    char file[65];
    if (!record)
        return false;
    if (access(job->params->output, F_OK) != 0) {
        say_stale(result, "the figure is not there");
        return true;
    }
    if (!kiln_hash_sha256_file(job->params->output, file))
        return kiln_error_set(job->error, KILN_IO, "%s: the file cannot be read",
                              job->params->output);
    if (strcmp(file, record->file) != 0) {
        say_stale(result, "the file is not the one that was written with its sidecar");
        return true;
    }
    if (!draw(job))
        return false;
    if (strcmp(job->hash, record->pixels) != 0)
        explain(job, record, result);
    return true;
}

bool kiln_figure_make(const struct kiln_figure_params *params, struct kiln_figure_result *result,
                      struct kiln_error *error)
{
    *result = (struct kiln_figure_result){0};
    struct job job = {.params = params, .arena = kiln_arena_create(), .error = error};
    bool ok = (job.arena || no_memory(&job)) && check_request(&job);
    if (ok)
        ok = params->check ? check_figure(&job, result) : draw(&job) && write_figure(&job);
    result->width = job.drawing.width;
    result->height = job.drawing.height;
    result->panels = (uint32_t)job.panels.count;
    free(job.pixels.rgba);
    kiln_arena_destroy(&job.arena);
    return ok;
}
