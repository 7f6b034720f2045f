/* JSON, one line a frame, straight to a temporary file: the text in memory is never longer than one
 * piece. Nothing here depends on the locale. */
#include "output/manifest.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/json.h"
#include "base/temporary.h"
#include "scene/scene.h"

struct kiln_manifest {
    struct kiln_temporary file;
    bool overwrite;
    struct kiln_text text; /* the piece that is being written */
    struct kiln_json json; /* into it */
};

/* Sends the piece to the file. */
static bool flush(struct kiln_manifest *manifest, struct kiln_error *error)
{
    struct kiln_text *text = &manifest->text;
    bool whole = !manifest->json.failed;
    bool good = whole && kiln_temporary_write(&manifest->file, text->data, text->length);
    text->length = 0;
    if (good)
        return true;
    if (!whole)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: no memory for the manifest",
                              manifest->file.target);
    return kiln_error_set_errno(error, KILN_IO, manifest->file.failure,
                                "%s: the file cannot be written", manifest->file.target);
}

static void add_passes(struct kiln_json *json, const double pass_ms[KILN_PASS_COUNT])
{
    kiln_json_begin_object(json, "ms");
    for (int i = 0; i < KILN_PASS_COUNT; i++)
        kiln_json_time(json, kiln_pass_name((enum kiln_pass)i), pass_ms[i]);
    kiln_json_end(json);
}

static void add_state(struct kiln_json *json, const struct kiln_state_hash *state, uint64_t alive)
{
    kiln_json_format(json, "state", "%08x%08x", state->lane[0], state->lane[1]);
    kiln_json_uint(json, "alive", alive);
}

/* The text of the scene, with every default. */
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

static void add_scene(struct kiln_json *json, const struct kiln_scene *scene)
{
    struct kiln_scene_info info = kiln_scene_info(scene);
    kiln_json_begin_object(json, "scene");
    kiln_json_string(json, "file", scene->name);
    kiln_json_string(json, "hash", info.hash);
    kiln_json_uint(json, "seed", scene->seed);
    kiln_json_pair(json, "size", info.width, info.height);
    kiln_json_pair(json, "fps", info.fps_num, info.fps_den);
    kiln_json_uint(json, "frames", info.frames);
    kiln_json_uint(json, "steps_per_frame", info.steps_per_frame);
    kiln_json_uint(json, "warmup_steps", info.warmup_steps);
    kiln_json_uint(json, "systems", info.system_count);
    kiln_json_uint(json, "particle_capacity", info.particle_capacity);
    kiln_json_line(json, 4);
    add_scene_text(json, scene);
    kiln_json_end(json);
}

static void add_device(struct kiln_json *json, const struct kiln_device_info *device)
{
    if (!device) {
        kiln_json_null(json, "device");
        return;
    }
    kiln_json_begin_object(json, "device");
    kiln_json_string(json, "name", device->name);
    kiln_json_string(json, "vendor", device->vendor);
    kiln_json_string(json, "gl_version", device->gl_version);
    kiln_json_string(json, "platform", device->platform);
    kiln_json_bool(json, "software", device->software);
    kiln_json_bool(json, "exact", device->exact);
    kiln_json_end(json);
}

/* "simulate=cpu sort=cpu" as an object. */
static void add_techniques(struct kiln_json *json, const char *techniques)
{
    kiln_json_begin_object(json, "techniques");
    while (*techniques) {
        size_t length = strcspn(techniques, " ");
        const char *equals = memchr(techniques, '=', length);
        if (equals) {
            char stage[32];
            size_t stage_length = (size_t)(equals - techniques);
            snprintf(stage, sizeof stage, "%.*s", (int)stage_length, techniques);
            kiln_json_format(json, stage, "%.*s", (int)(length - stage_length - 1), equals + 1);
        }
        techniques += length + strspn(techniques + length, " ");
    }
    kiln_json_end(json);
}

struct kiln_manifest *kiln_manifest_open(const struct kiln_manifest_params *params,
                                         struct kiln_error *error)
{
    if (!kiln_target_check(params->path, params->overwrite, error) ||
        !kiln_make_parent_folders(params->path, error))
        return NULL;
    struct kiln_manifest *manifest = calloc(1, sizeof *manifest);
    if (!manifest) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: no memory for the manifest", params->path);
        return NULL;
    }
    manifest->overwrite = params->overwrite;
    if (!kiln_temporary_open(&manifest->file, params->path, error)) {
        kiln_manifest_close(&manifest);
        return NULL;
    }
    struct kiln_json *json = &manifest->json;
    *json = kiln_json_to_text(&manifest->text);
    kiln_json_begin_object(json, NULL);
    kiln_json_lines(json, 2);
    kiln_json_string(json, "kiln", KILN_VERSION);
    add_scene(json, params->scene);
    add_device(json, params->device);
    add_techniques(json, params->techniques);
    kiln_json_string(json, "output", params->output);
    kiln_json_begin_array(json, "frames");
    kiln_json_lines(json, 4);
    if (!flush(manifest, error))
        kiln_manifest_close(&manifest);
    return manifest;
}

bool kiln_manifest_add(struct kiln_manifest *manifest, const struct kiln_progress *progress,
                       const char *file, struct kiln_error *error)
{
    struct kiln_json *json = &manifest->json;
    kiln_json_begin_object(json, NULL);
    kiln_json_uint(json, "frame", progress->frame);
    kiln_json_string(json, "file", file);
    add_state(json, &progress->state, progress->alive);
    add_passes(json, progress->pass_ms);
    kiln_json_end(json);
    return flush(manifest, error);
}

bool kiln_manifest_finish(struct kiln_manifest *manifest, const struct kiln_render_stats *stats,
                          struct kiln_error *error)
{
    struct kiln_json *json = &manifest->json;
    kiln_json_end_line(json, 2);
    kiln_json_begin_object(json, "totals");
    kiln_json_uint(json, "frames", stats->frames);
    kiln_json_uint(json, "steps", stats->steps);
    kiln_json_time(json, "setup_s", stats->setup_s);
    kiln_json_time(json, "total_s", stats->total_s);
    add_state(json, &stats->state, stats->alive);
    kiln_json_uint(json, "particle_bytes", stats->particle_bytes);
    kiln_json_line(json, 4);
    add_passes(json, stats->pass_ms);
    kiln_json_end(json);
    kiln_json_end_line(json, 0);
    kiln_json_finish(json);
    if (flush(manifest, error))
        return kiln_temporary_commit(&manifest->file, manifest->overwrite, error);
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
