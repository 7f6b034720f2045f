/* Writes the manifest of a job as JSON, with one line for each frame. job/job.c opens it before the
 * first frame, and finishes it when the job has ended or failed. job/join.c does both for a job
 * whose shards are joined.
 *
 * The member `result` must be the same, byte for byte, for every run that completes the job. So
 * what describes a run (its machine, techniques and times) belongs into `run` and not into
 * `result`. A manifest replaces an older one only if that begins as kiln_manifest_finish writes it,
 * so the members "kiln" and "failed" must stay the first two.
 *
 * The text goes to a temporary file piece by piece, so that memory never holds more than one piece.
 * Nothing in the manifest depends on the locale. */
#include "job/manifest.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/json.h"
#include "base/temporary.h"
#include "scene/scene.h"
#include "scene/work.h"

struct kiln_manifest {
    struct kiln_temporary file;
    struct kiln_manifest_params params;
    struct kiln_text text; /* the piece that is being written */
    struct kiln_json json; /* writes into the text */
};

/* Writes the piece in memory to the temporary file, and empties it. */
static bool flush(struct kiln_manifest *manifest, struct kiln_error *error)
{
    struct kiln_text *text = &manifest->text;
    bool whole = !manifest->json.failed;
    bool good = whole && kiln_temporary_write(&manifest->file, text->data, text->length);
    text->length = 0;
    if (good)
        return true;
    if (!whole)
        return kiln_error_no_memory(error, "the manifest of %s", manifest->file.target);
    return kiln_temporary_fail(&manifest->file, error);
}

static void add_state(struct kiln_json *json, const struct kiln_state_hash *state, uint64_t alive)
{
    kiln_json_format(json, "state", "%08x%08x", state->lane[0], state->lane[1]);
    kiln_json_uint(json, "alive", alive);
}

/* Adds the text of the scene, with every default spelled out. */
static void add_scene_text(struct kiln_json *json, const struct kiln_scene *scene)
{
    char *printed = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&printed, &size);
    bool good = memory && kiln_scene_print(scene, memory);
    json->failed |= !memory || fclose(memory) != 0 || !good;
    kiln_json_string(json, "text", printed);
    free(printed);
}

char *kiln_manifest_scene(const struct kiln_scene *scene)
{
    struct kiln_text text = {0};
    struct kiln_json json = kiln_json_to_text(&text);
    const struct kiln_scene_info info = kiln_scene_facts(scene);
    kiln_json_begin_object(&json, NULL);
    kiln_json_string(&json, "file", scene->name);
    kiln_json_string(&json, "hash", info.hash);
    kiln_json_uint(&json, "seed", scene->seed);
    kiln_json_pair(&json, "size", info.width, info.height);
    kiln_json_pair(&json, "fps", info.fps_num, info.fps_den);
    kiln_json_uint(&json, "frames", info.frames);
    kiln_json_uint(&json, "steps_per_frame", info.steps_per_frame);
    kiln_json_uint(&json, "warmup_steps", info.warmup_steps);
    kiln_json_uint(&json, "systems", info.system_count);
    kiln_json_uint(&json, "particle_capacity", info.particle_capacity);
    kiln_json_indent_next(&json, 6);
    add_scene_text(&json, scene);
    kiln_json_end(&json);
    if (!json.failed && !text.failed)
        return text.data;
    kiln_text_free(&text);
    return NULL;
}

/* Returns whether a file begins as kiln_manifest_finish writes it. With `failed`, only the manifest
 * of a run that failed counts, and only if this version of kiln wrote it; otherwise the manifest of
 * any version counts. */
static bool is_manifest(const char *path, bool failed)
{
    static const char start[] = "{\n  \"kiln\": \"" KILN_VERSION "\",\n  \"failed\": true";
    static const char any[] = "{\n  \"kiln\": \"";
    const size_t length = failed ? sizeof start - 1 : sizeof any - 1;
    char found[sizeof start];
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
    const ssize_t count = file >= 0 ? read(file, found, length) : -1;
    if (file >= 0)
        close(file);
    return count == (ssize_t)length && memcmp(found, start, length) == 0;
}

struct kiln_manifest *kiln_manifest_open(const struct kiln_manifest_params *params,
                                         struct kiln_error *error)
{
    const bool replaces = params->overwrite || is_manifest(params->path, !params->again);
    if (!kiln_target_check(params->path, replaces, error) ||
        !kiln_make_parent_folders(params->path, error))
        return NULL;
    struct kiln_manifest *manifest = calloc(1, sizeof *manifest);
    if (!manifest) {
        kiln_error_no_memory(error, "the manifest of %s", params->path);
        return NULL;
    }
    manifest->params = *params;
    manifest->params.overwrite = replaces;
    kiln_temporary_sweep(params->path);
    if (!kiln_temporary_open(&manifest->file, params->path, error)) {
        kiln_manifest_close(&manifest);
        return NULL;
    }
    manifest->json = kiln_json_to_text(&manifest->text);
    return manifest;
}

/* Adds the line of a frame to the result, and writes it to the file. */
static bool add_frame(struct kiln_manifest *manifest, const struct kiln_records *records,
                      uint32_t index, struct kiln_error *error)
{
    struct kiln_json *json = &manifest->json;
    const struct kiln_record *record = &records->items[index];
    const struct kiln_output_params *files = manifest->params.files;
    const uint32_t frame = kiln_records_frame(records, index);
    char path[KILN_PATH_SIZE];
    if (files && !kiln_output_file(files, frame, path, error))
        return false;
    kiln_json_begin_object(json, NULL);
    kiln_json_uint(json, "frame", frame);
    kiln_json_string(json, "file", files ? path : NULL);
    if (record->bytes > 0) {
        kiln_json_uint(json, "bytes", record->bytes);
        kiln_json_string(json, "sha256", record->sha256);
    }
    add_state(json, &record->state, record->alive);
    kiln_json_end(json);
    return flush(manifest, error);
}

/* Returns whether a frame belongs into the result. For a run that failed, only frames whose files
 * are whole do; where no files are written, frames that were drawn. */
static bool is_there(const struct kiln_manifest *manifest, const struct kiln_record *record,
                     const struct kiln_error *failure)
{
    return !failure || (manifest->params.files ? record->whole : record->has_state);
}

/* Writes the member `result`, which is the same for every run that completed the job, however often
 * the job was killed before. */
static bool add_result(struct kiln_manifest *manifest, const struct kiln_records *records,
                       const struct kiln_error *failure, struct kiln_error *error)
{
    struct kiln_json *json = &manifest->json;
    uint32_t missing = 0;
    kiln_json_begin_object(json, "result");
    kiln_json_indent_items(json, 4);
    kiln_json_raw(json, "scene", manifest->params.scene);
    kiln_json_string(json, "output", manifest->params.output);
    kiln_json_begin_array(json, "frames");
    kiln_json_indent_items(json, 6);
    for (uint32_t i = 0; i < records->count; i++) {
        if (!is_there(manifest, &records->items[i], failure))
            missing++;
        else if (!add_frame(manifest, records, i, error))
            return false;
    }
    kiln_json_end_indented(json, 4);
    kiln_json_uint(json, "missing", missing);
    kiln_json_begin_array(json, "files");
    kiln_json_indent_items(json, 6);
    for (uint32_t i = 0; i < records->file_count; i++) {
        kiln_json_begin_object(json, NULL);
        kiln_json_string(json, "file", records->files[i].path);
        kiln_json_uint(json, "bytes", records->files[i].bytes);
        kiln_json_string(json, "sha256", records->files[i].sha256);
        kiln_json_end(json);
    }
    kiln_json_end_indented(json, 4);
    kiln_json_end_indented(json, 2);
    return true;
}

/* Adds the times of the frames that this run drew to the member `run`. */
static bool add_times(struct kiln_manifest *manifest, const struct kiln_records *records,
                      struct kiln_error *error)
{
    struct kiln_json *json = &manifest->json;
    kiln_json_begin_array(json, "frames");
    kiln_json_indent_items(json, 6);
    for (uint32_t i = 0; i < records->count; i++) {
        const struct kiln_record *record = &records->items[i];
        double pass_ms[KILN_PASS_COUNT];
        if (!record->drawn)
            continue;
        for (int pass = 0; pass < KILN_PASS_COUNT; pass++)
            pass_ms[pass] = (double)record->pass_ms[pass];
        kiln_json_begin_object(json, NULL);
        kiln_json_uint(json, "frame", kiln_records_frame(records, i));
        kiln_attempt_add_passes(json, pass_ms);
        kiln_json_end(json);
        if (!flush(manifest, error))
            return false;
    }
    kiln_json_end_indented(json, 4);
    return true;
}

/* Writes the members that describe this run, and the earlier runs that the journals list. */
static bool add_runs(struct kiln_manifest *manifest, const struct kiln_records *records,
                     const struct kiln_render_stats *stats, const struct kiln_error *failure,
                     struct kiln_error *error)
{
    struct kiln_json *json = &manifest->json;
    kiln_json_begin_object(json, "run");
    kiln_json_indent_items(json, 4);
    kiln_attempt_describe(json, manifest->params.run, stats, failure);
    if (!add_times(manifest, records, error))
        return false;
    kiln_json_end_indented(json, 2);
    kiln_json_begin_array(json, "runs_before");
    kiln_json_indent_items(json, 4);
    if (records->runs.length > 0)
        kiln_json_raw(json, NULL, records->runs.data);
    kiln_json_end_indented(json, 2);
    return true;
}

bool kiln_manifest_finish(struct kiln_manifest *manifest, const struct kiln_records *records,
                          const struct kiln_render_stats *stats, const struct kiln_error *failure,
                          struct kiln_error *error)
{
    struct kiln_json *json = &manifest->json;
    kiln_json_begin_object(json, NULL);
    kiln_json_indent_items(json, 2);
    kiln_json_string(json, "kiln", KILN_VERSION);
    kiln_json_bool(json, "failed", failure != NULL);
    bool ok = add_result(manifest, records, failure, error) &&
              add_runs(manifest, records, stats, failure, error);
    if (ok) {
        kiln_json_end_indented(json, 0);
        kiln_json_finish(json);
        ok = flush(manifest, error);
    }
    if (ok)
        return kiln_temporary_commit(&manifest->file, manifest->params.overwrite, error);
    kiln_temporary_discard(&manifest->file);
    return false;
}

void kiln_manifest_close(struct kiln_manifest **manifest)
{
    if (!*manifest)
        return;
    kiln_temporary_discard(&(*manifest)->file);
    kiln_text_free(&(*manifest)->text);
    free(*manifest);
    *manifest = NULL;
}
