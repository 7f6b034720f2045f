/* JSON, one line a frame, straight to a temporary file: the text in memory is never longer than one
 * piece. Nothing here depends on the locale. */
#include "output/manifest.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/temporary.h"
#include "base/text.h"
#include "scene/scene.h"

struct kiln_manifest {
    struct kiln_temporary file;
    bool overwrite;
    bool has_frames;
    struct kiln_text text; /* the piece that is being written */
};

/* Sends the piece to the file. */
static bool flush(struct kiln_manifest *manifest, struct kiln_error *error)
{
    struct kiln_text *text = &manifest->text;
    bool whole = !text->failed;
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

static void add_string(struct kiln_text *text, const char *key, const char *value)
{
    kiln_text_add(text, "\"%s\": ", key);
    if (value)
        kiln_text_add_json(text, value);
    else
        kiln_text_add(text, "null");
}

/* To three decimals, as whole numbers, since printf's point belongs to the locale. */
static void add_thousandths(struct kiln_text *text, const char *key, double value)
{
    uint64_t thousandths = value > 0 && value < 1e15 ? (uint64_t)(value * 1000.0 + 0.5) : 0;
    kiln_text_add(text, "\"%s\": %" PRIu64 ".%03u", key, thousandths / 1000,
                  (unsigned)(thousandths % 1000));
}

static void add_passes(struct kiln_text *text, const double pass_ms[KILN_PASS_COUNT])
{
    kiln_text_add(text, "\"ms\": {");
    for (int i = 0; i < KILN_PASS_COUNT; i++) {
        kiln_text_add(text, i > 0 ? ", " : "");
        add_thousandths(text, kiln_pass_name((enum kiln_pass)i), pass_ms[i]);
    }
    kiln_text_add(text, "}");
}

static void add_state(struct kiln_text *text, const struct kiln_state_hash *state, uint64_t alive)
{
    kiln_text_add(text, "\"state\": \"%08x%08x\", \"alive\": %" PRIu64, state->lane[0],
                  state->lane[1], alive);
}

static bool add_scene(struct kiln_text *text, const struct kiln_scene *scene)
{
    char *printed = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&printed, &size);
    if (!memory)
        return false;
    bool good = kiln_scene_print(scene, memory);
    good = fclose(memory) == 0 && good;
    struct kiln_scene_info info = kiln_scene_info(scene);
    kiln_text_add(text, "  \"scene\": {");
    add_string(text, "file", scene->name);
    kiln_text_add(text, ", ");
    add_string(text, "hash", info.hash);
    kiln_text_add(text,
                  ", \"seed\": %u, \"size\": [%u, %u], \"fps\": [%u, %u], \"frames\": %u, "
                  "\"steps_per_frame\": %u, \"warmup_steps\": %u, \"systems\": %u, "
                  "\"particle_capacity\": %" PRIu64 ",\n    ",
                  scene->seed, info.width, info.height, info.fps_num, info.fps_den, info.frames,
                  info.steps_per_frame, info.warmup_steps, info.system_count,
                  info.particle_capacity);
    add_string(text, "text", good ? printed : "");
    kiln_text_add(text, "},\n");
    free(printed);
    return good;
}

static void add_device(struct kiln_text *text, const struct kiln_device_info *device)
{
    kiln_text_add(text, "  \"device\": ");
    if (!device) {
        kiln_text_add(text, "null,\n");
        return;
    }
    kiln_text_add(text, "{");
    add_string(text, "name", device->name);
    kiln_text_add(text, ", ");
    add_string(text, "vendor", device->vendor);
    kiln_text_add(text, ", ");
    add_string(text, "gl_version", device->gl_version);
    kiln_text_add(text, ", ");
    add_string(text, "platform", device->platform);
    kiln_text_add(text, ", \"software\": %s, \"exact\": %s},\n",
                  device->software ? "true" : "false", device->exact ? "true" : "false");
}

/* "simulate=cpu sort=cpu" as an object. */
static void add_techniques(struct kiln_text *text, const char *techniques)
{
    kiln_text_add(text, "  \"techniques\": {");
    bool first = true;
    while (*techniques) {
        size_t length = strcspn(techniques, " ");
        const char *equals = memchr(techniques, '=', length);
        if (equals) {
            size_t stage = (size_t)(equals - techniques);
            kiln_text_add(text, "%s\"%.*s\": \"%.*s\"", first ? "" : ", ", (int)stage, techniques,
                          (int)(length - stage - 1), equals + 1);
            first = false;
        }
        techniques += length + strspn(techniques + length, " ");
    }
    kiln_text_add(text, "},\n");
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
    struct kiln_text *text = &manifest->text;
    kiln_text_add(text, "{\n  \"kiln\": \"%s\",\n", KILN_VERSION);
    if (!add_scene(text, params->scene))
        text->failed = true;
    add_device(text, params->device);
    add_techniques(text, params->techniques);
    kiln_text_add(text, "  ");
    add_string(text, "output", params->output);
    kiln_text_add(text, ",\n  \"frames\": [");
    if (!flush(manifest, error))
        kiln_manifest_close(&manifest);
    return manifest;
}

bool kiln_manifest_add(struct kiln_manifest *manifest, const struct kiln_progress *progress,
                       const char *file, struct kiln_error *error)
{
    struct kiln_text *text = &manifest->text;
    kiln_text_add(text, "%s\n    {\"frame\": %u, ", manifest->has_frames ? "," : "",
                  progress->frame);
    add_string(text, "file", file);
    kiln_text_add(text, ", ");
    add_state(text, &progress->state, progress->alive);
    kiln_text_add(text, ", ");
    add_passes(text, progress->pass_ms);
    kiln_text_add(text, "}");
    manifest->has_frames = true;
    return flush(manifest, error);
}

bool kiln_manifest_finish(struct kiln_manifest *manifest, const struct kiln_render_stats *stats,
                          struct kiln_error *error)
{
    struct kiln_text *text = &manifest->text;
    kiln_text_add(text, "%s],\n  \"totals\": {\"frames\": %u, \"steps\": %" PRIu64 ", ",
                  manifest->has_frames ? "\n  " : "", stats->frames, stats->steps);
    add_thousandths(text, "setup_s", stats->setup_s);
    kiln_text_add(text, ", ");
    add_thousandths(text, "total_s", stats->total_s);
    kiln_text_add(text, ", ");
    add_state(text, &stats->state, stats->alive);
    kiln_text_add(text, ", \"particle_bytes\": %" PRIu64 ",\n    ", stats->particle_bytes);
    add_passes(text, stats->pass_ms);
    kiln_text_add(text, "}\n}\n");
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
