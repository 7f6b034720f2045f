/* Makes a figure from a request: makes its panels, lays them out, rasterises them, and writes the
 * file, its sidecar and its depfile. If the request names a sidecar to check, it draws the figure
 * again instead, and judges whether the file is what the sidecar says. */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asset/image/image.h"
#include "base/error.h"
#include "base/file.h"
#include "base/file_in.h"
#include "base/hash.h"
#include "base/temporary.h"
#include "figure/depfile.h"
#include "figure/layout.h"
#include "figure/lettering.h"
#include "figure/record.h"
#include "figure/verdict.h"
#include "kiln_program.h"

enum { LONGEST_ALT = 65533 }; /* bytes; the most that a comment of JPEG holds */

struct job {
    const struct kiln_figure_params *params;
    const struct kiln_figure_format *format;
    struct kiln_arena *arena;
    struct kiln_claims *claims;
    struct kiln_panels panels;
    struct kiln_drawing drawing;
    struct kiln_pixels pixels;
    char hash[65]; /* SHA-256 of the pixels */
    uint8_t *file; /* bytes of the figure that is checked */
    size_t file_size;
    struct kiln_error *error;
};

static bool no_memory(const struct job *job)
{
    return kiln_error_no_memory(job->error, "%s", job->params->output);
}

static bool sidecar_path(const struct job *job, char path[KILN_PATH_SIZE])
{
    int length = snprintf(path, KILN_PATH_SIZE, "%s%s", job->params->output, KILN_RECORD_SUFFIX);
    return (length >= 0 && length < KILN_PATH_SIZE) ||
           kiln_error_set(job->error, KILN_IO, "%s: the path is too long", job->params->output);
}

/* Returns whether a path leads to the file that `other` describes. */
static bool is_same_file(const char *path, const struct stat *other)
{
    struct stat status;
    return stat(path, &status) == 0 && status.st_dev == other->st_dev &&
           status.st_ino == other->st_ino;
}

/* Returns whether to write the depfile. A sidecar may come from anywhere, so a figure that is
 * redrawn by its command replaces no file but its own: the depfile must exist and be the
 * figure's. */
static bool wants_depfile(const struct job *job)
{
    const struct kiln_figure_params *params = job->params;
    return params->depfile &&
           (!params->update || kiln_depfile_is_of(params->depfile, params->output));
}

/* Checks that the figure and its other files may be written. Declares the inputs as read; other
 * files that the figure is made of are declared when they are read, before anything is written. */
static bool check_target(const struct job *job)
{
    const struct kiln_figure_params *params = job->params;
    char sidecar[KILN_PATH_SIZE];
    for (size_t i = 0; i < params->input_count; i++) {
        if (!kiln_claims_read(job->claims, params->inputs[i], "a file that it is made of",
                              job->error))
            return false;
    }
    const char *depfile = wants_depfile(job) ? params->depfile : NULL;
    bool overwrite = params->overwrite || params->update;
    return sidecar_path(job, sidecar) &&
           kiln_claims_write(job->claims, params->output, "the figure", job->error) &&
           kiln_claims_write(job->claims, sidecar, "the figure's sidecar", job->error) &&
           (!depfile || kiln_claims_write(job->claims, depfile, "--depfile", job->error)) &&
           kiln_target_check(params->output, overwrite, job->error) &&
           kiln_target_check(sidecar, overwrite, job->error) &&
           (!depfile || kiln_target_check(depfile, overwrite, job->error));
}

static bool check_sizes(const struct kiln_figure_params *params, struct kiln_error *error)
{
    double paper = params->paper_width_mm, points = params->text_points;
    if (points != 0 && !(points >= 4 - 1e-9 && points <= 72 + 1e-9))
        return kiln_error_set(error, KILN_USAGE,
                              "--text-size: found %g points; allowed are 4 to 72", points);
    if (params->text_size < 8 || params->text_size > 64)
        return kiln_error_set(error, KILN_USAGE,
                              "--text-size: found %u pixels; allowed are 8 to 64",
                              params->text_size);
    if (params->dpi != 0 && (params->dpi < 36 || params->dpi > 2400))
        return kiln_error_set(error, KILN_USAGE, "--dpi: found %u; allowed are 36 to 2400",
                              params->dpi);
    if (paper != 0 && !(paper >= 5 && paper <= 2000))
        return kiln_error_set(error, KILN_USAGE, "--width: found %g mm; allowed are 5 to 2000",
                              paper);
    if (paper != 0 && (params->width != 0 || params->dpi == 0))
        return kiln_error_set(
            error, KILN_USAGE,
            "--width on paper needs --dpi, and cannot be combined with a width in pixels");
    return true;
}

/* Checks all of a request that can be checked before anything is rendered. */
static bool check_request(struct job *job)
{
    const struct kiln_figure_params *params = job->params;
    if (!params->output)
        return kiln_error_set(job->error, KILN_USAGE, "the figure has no file name");
    job->format = kiln_figure_format_find(params->output, job->error);
    if (!job->format)
        return false;
    if (!check_sizes(params, job->error))
        return false;
    if (params->plain && (params->title || params->label_count > 0))
        return kiln_error_set(job->error, KILN_USAGE,
                              "--plain leaves no room for a title or labels");
    if (params->input_count == 0)
        return kiln_error_set(job->error, KILN_USAGE,
                              "the figure has no pictures; it needs one or more");
    if (params->alt && strlen(params->alt) > LONGEST_ALT)
        return kiln_error_set(job->error, KILN_USAGE, "--alt: found %zu bytes; allowed are %d",
                              strlen(params->alt), (int)LONGEST_ALT);
    return kiln_lettering_check_request(params, job->error) && (params->check || check_target(job));
}

static bool draw(struct job *job)
{
    const struct kiln_figure_params *params = job->params;
    job->panels = (struct kiln_panels){
        .arena = job->arena, .paper = kiln_layout_paper(params->dark), .claims = job->claims};
    job->drawing = (struct kiln_drawing){.arena = job->arena};
    bool ok = params->kind == KILN_FIGURE_SHEET
                  ? kiln_panels_of_sheet(&job->panels, params, job->error)
              : params->kind == KILN_FIGURE_STRIP
                  ? kiln_panels_of_strip(&job->panels, params, job->error)
                  : kiln_panels_of_triptych(&job->panels, params, job->error);
    for (size_t i = 0; ok && i < job->panels.count && i < params->label_count; i++)
        job->panels.items[i].label = params->labels[i];
    if (!ok || !kiln_layout_make(&job->drawing, &job->panels, params, job->error) ||
        !kiln_drawing_rasterise(&job->drawing, &job->pixels, job->error))
        return false;
    size_t size = (size_t)job->pixels.width * job->pixels.height * 4;
    kiln_hash_sha256(job->pixels.rgba, size, job->hash);
    return true;
}

/* ---- Writing -------------------------------------------------------------------------------- */

/* Returns the relative path from a folder up to `to`, a folder that contains it, such as "../..";
 * if `to` does not contain it, returns `to`. */
static const char *relative_path_up(struct kiln_arena *arena, const char *from, const char *to)
{
    size_t length = strlen(to);
    if (strncmp(from, to, length) != 0 || (from[length] != '/' && from[length]))
        return kiln_arena_format(arena, "%s", to);
    const char *path = "";
    for (const char *c = from + length; path && *c; c++) {
        if (*c == '/')
            path = kiln_arena_format(arena, "%s%s", path, *path ? "/.." : "..");
    }
    return path && !*path ? "." : path;
}

/* Finds the path from the folder of the figure to the working directory. */
static bool find_folder(const struct job *job, const char **folder)
{
    const char *output = job->params->output, *slash = strrchr(output, '/');
    size_t length = slash > output ? (size_t)(slash - output) : 1;
    const char *name = slash ? kiln_arena_text(job->arena, output, length) : ".";
    if (!name)
        return no_memory(job);
    char *working_folder = realpath(".", NULL),
         *output_folder = working_folder ? realpath(name, NULL) : NULL;
    if (!output_folder) {
        kiln_error_set_errno(job->error, KILN_IO, errno, "%s: the folder cannot be found",
                             working_folder ? name : "the working directory");
        free(working_folder);
        return false;
    }
    *folder = relative_path_up(job->arena, output_folder, working_folder);
    free(working_folder);
    free(output_folder);
    return *folder || no_memory(job);
}

static bool make_sidecar(struct job *job, const uint8_t *bytes, size_t size, struct kiln_text *text)
{
    char file[65];
    struct kiln_record record = {.version = KILN_VERSION,
                                 .command_count = job->params->command_count,
                                 .device = job->panels.renderer.device,
                                 .driver = job->panels.renderer.driver,
                                 .cpu = job->panels.renderer.cpu,
                                 .width = job->drawing.width,
                                 .height = job->drawing.height,
                                 .alt = job->params->alt,
                                 .pixels = job->hash,
                                 .file = file,
                                 .panels = job->panels.items,
                                 .panel_count = job->panels.count};
    record.command = kiln_arena_alloc(job->arena, record.command_count + 1, sizeof(char *));
    if (!record.command)
        return no_memory(job);
    kiln_hash_sha256(bytes, size, file);
    for (size_t i = 0; i < record.command_count; i++)
        record.command[i] = job->params->command[i];
    return find_folder(job, &record.folder) && kiln_record_write(&record, text, job->error);
}

/* Writes a temporary file; kiln_temporary_commit_all gives it its name later. */
static bool begin_file(struct kiln_temporary *file, const char *path, const void *bytes,
                       size_t size, struct kiln_error *error)
{
    return kiln_make_parent_folders(path, error) && kiln_temporary_open(file, path, error) &&
           (kiln_temporary_write(file, bytes, size) || kiln_temporary_fail(file, error));
}

/* Writes the figure and its other files. Either all get their names or none does, and the figure
 * gets its name last: a figure that exists has its sidecar and depfile, for make and for
 * readers. */
static bool write_files(struct job *job, const uint8_t *bytes, size_t size)
{
    const struct kiln_figure_params *params = job->params;
    struct kiln_temporary depfile = {0}, sidecar = {0}, figure = {0};
    struct kiln_temporary *all[] = {&depfile, &sidecar, &figure};
    struct kiln_text rules = {0}, record = {0};
    char path[KILN_PATH_SIZE];
    size_t first = wants_depfile(job) ? 0 : 1;
    bool ok = begin_file(&figure, params->output, bytes, size, job->error) &&
              sidecar_path(job, path) && make_sidecar(job, bytes, size, &record) &&
              begin_file(&sidecar, path, record.data, record.length, job->error) &&
              (first > 0 ||
               (kiln_depfile_make(params->output, job->claims, &rules, job->error) &&
                begin_file(&depfile, params->depfile, rules.data, rules.length, job->error))) &&
              kiln_temporary_commit_all(all + first, 3 - first, true, job->error);
    for (size_t i = 0; i < 3; i++)
        kiln_temporary_discard(all[i]);
    kiln_text_free(&rules);
    kiln_text_free(&record);
    return ok;
}

static bool write_figure(struct job *job)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    bool ok = job->format->of_pixels
                  ? job->format->of_pixels(
                        &job->pixels, &(struct kiln_imprint){job->params->dpi, job->params->alt},
                        &bytes, &size, job->error)
                  : job->format->of_drawing(&job->drawing, &bytes, &size, job->error);
    ok = ok && write_files(job, bytes, size);
    free(bytes);
    return ok;
}

/* ---- Checking ------------------------------------------------------------------------------- */

static void mark_stale(struct kiln_figure_result *result, const char *reason)
{
    result->stale = true;
    snprintf(result->reason, sizeof result->reason, "%s", reason);
}

/* Returns whether the checked sidecar belongs to the figure that its command makes. A sidecar that
 * was copied or renamed does not. */
static bool is_own_sidecar(const struct job *job)
{
    char sidecar[KILN_PATH_SIZE];
    struct stat given;
    return sidecar_path(job, sidecar) && stat(job->params->check, &given) == 0 &&
           is_same_file(sidecar, &given);
}

/* Reads the figure's file once, for its hash and its pixels. A figure may come from a stranger, so
 * it must be a plain file, of no more bytes than a picture has. */
static bool read_figure(struct job *job)
{
    const char *path = job->params->output;
    const int file = open(path, KILN_FILE_FLAGS | O_NOFOLLOW);
    if (file < 0 && errno == ELOOP)
        return kiln_error_set(job->error, KILN_INVALID_INPUT,
                              "%s: the figure is a link; allowed is a plain file", path);
    if (file < 0)
        return kiln_error_set_errno(job->error, KILN_IO, errno, "%s: the figure cannot be opened",
                                    path);
    if (kiln_file_check(file, path, "figure", "PNG, JPEG, SVG or PDF", &job->file_size,
                        job->error) &&
        kiln_file_check_size(path, "figure", job->file_size, KILN_MAX_IMAGE_BYTES, job->error))
        job->file = kiln_file_read_bytes(file, path, "figure", job->file_size, job->error);
    close(file);
    return job->file != NULL;
}

/* Marks the figure as stale if its file is missing, or is not the one that its sidecar
 * describes. */
static bool check_file(struct job *job, const struct kiln_record *record,
                       struct kiln_figure_result *result)
{
    char file[65];
    struct stat status;
    if (lstat(job->params->output, &status) != 0 && errno == ENOENT) {
        mark_stale(result, "the figure is missing");
        return true;
    }
    if (!read_figure(job))
        return false;
    kiln_hash_sha256(job->file, job->file_size, file);
    if (strcmp(file, record->file) != 0)
        mark_stale(result, "the file is not the one that was written together with its sidecar");
    return true;
}

static bool check_figure(struct job *job, struct kiln_figure_result *result)
{
    struct kiln_record *record = kiln_record_read(job->arena, job->params->check, job->error);
    bool update = job->params->update;
    if (!record)
        return false;
    if (!is_own_sidecar(job)) {
        result->stale = true;
        snprintf(result->reason, sizeof result->reason, "the command makes another file, '%.300s'",
                 job->params->output);
        return true;
    }
    if (!check_file(job, record, result))
        return false;
    if (result->stale && !update)
        return true;
    if ((update && !check_target(job)) || !draw(job))
        return false;
    const struct kiln_fresh_figure fresh = {.panels = &job->panels,
                                            .pixels = &job->pixels,
                                            .hash = job->hash,
                                            .format = job->format,
                                            .path = job->params->output,
                                            .file = job->file,
                                            .file_size = job->file_size,
                                            .threads = job->params->threads};
    if (!result->stale && !kiln_figure_judge(record, &fresh, result, job->error))
        return false;
    result->redrawn = result->stale && update;
    return !result->redrawn || write_figure(job);
}

bool kiln_figure_make(const struct kiln_figure_params *params, struct kiln_figure_result *result,
                      struct kiln_error *error)
{
    *result = (struct kiln_figure_result){0};
    struct job job = {.params = params, .arena = kiln_arena_create(), .error = error};
    job.claims = kiln_claims_create();
    bool ok = ((job.arena && job.claims) || no_memory(&job)) && check_request(&job);
    if (ok)
        ok = params->check ? check_figure(&job, result) : draw(&job) && write_figure(&job);
    result->width = job.drawing.width;
    result->height = job.drawing.height;
    result->panels = (uint32_t)job.panels.count;
    free(job.pixels.rgba);
    free(job.file);
    kiln_claims_destroy(&job.claims);
    kiln_arena_destroy(&job.arena);
    return ok;
}
