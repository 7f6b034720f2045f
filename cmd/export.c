/* Runs kiln export, which steps through frames of a scene and writes its gas as OpenVDB files for
 * other programs. */
#include <inttypes.h>
#include <string.h>

#include "command.h"
#include "device.h"
#include "event.h"
#include "json_output.h"
#include "limits.h"
#include "overrides.h"
#include "report.h"
#include "sandbox.h"
#include "scene_in.h"
#include "signals.h"

static const struct option options[] = {
    {.name = "output",
     .letter = 'o',
     .kind = OPTION_TEXT,
     .placeholder = "FILE",
     .files = "*.vdb",
     .access = ACCESS_WRITE,
     .help = "Where to write: a name that ends with .vdb. '%04d' or '####' stands for the frame's "
             "number, '{gas}' for the name of the domain, which the name of the files must have "
             "where several are exported."},
    {.name = "frames",
     .kind = OPTION_FRAMES,
     .placeholder = "RANGES",
     .help = "Frames to export, such as 0-149,200. 170- goes to the end, -30 is 0-30, 'last' is "
             "the last frame, 0-100/10 is every tenth frame.",
     .fallback = "all"},
    {.name = "gas",
     .kind = OPTION_TEXT,
     .placeholder = "DOMAIN",
     .help = "Export only this domain of gas.",
     .fallback = "all domains that are enabled"},
    {.name = "half",
     .kind = OPTION_FLAG,
     .help = "Write values as halves (16 bits), rounded to the nearest, instead of floats: the "
             "files have about half the size."},
    {.name = "up",
     .kind = OPTION_CHOICE,
     .placeholder = "y|z",
     .help = "The axis of the files that points up: y as in kiln and Houdini, or z as in Blender, "
             "where x, y and z of a file are x, -z and y of the scene.",
     .fallback = "y"},
    {.name = "temperature",
     .kind = OPTION_CHOICE,
     .placeholder = "kelvin|unit",
     .help = "Temperatures in kelvin, by 'look.kelvin' of the domain, or from 0 (air) to 1.",
     .fallback = "kelvin"},
    {.name = "cutoff",
     .kind = OPTION_NUMBER,
     .placeholder = "N",
     .help = "Leave out of a grid voxels whose density, temperature (0 to 1) or flame is less.",
     .fallback = "0.001",
     .min = 0,
     .max = 1},
    FPS_OPTION,
    SEED_OPTION,
    PARAMS_OPTION,
    SET_OPTION,
    ASSET_ROOT_OPTION,
    DEVICE_OPTION,
    TECHNIQUE_OPTION,
    THREADS_OPTION,
    {.name = "states",
     .kind = OPTION_TEXT,
     .placeholder = "STATES",
     .access = ACCESS_READ,
     .help = "Start at the nearest state before the frames, out of a folder that 'kiln bake' made. "
             "The files are the same as without it."},
    {.name = "force", .kind = OPTION_FLAG, .help = "Replace files that exist."},
    LIMITS_OPTION,
    TIMEOUT_OPTION,
    SANDBOX_OPTION,
    JSON_OPTION("an object a line, whose \"event\" is \"exported\" for each file, and \"result\"."),
    {.name = "quiet",
     .letter = 'q',
     .kind = OPTION_FLAG,
     .help = "Print nothing but errors and what --json asks for."},
    EVENTS_OPTION,
    HELP_OPTION,
};

struct export
{
    const char *scene_path;
    struct kiln_export_params params;
    struct value_list techniques;
    struct frame_list frames;
    bool quiet;
    uint32_t files_done;
};

static void show_file(void *user, const struct kiln_exported *file)
{
    struct export *export = user;
    export->files_done = file->done;
    if (events_are_open()) {
        struct kiln_json json = event_begin("exported");
        kiln_json_string(&json, "scene", export->scene_path);
        kiln_json_string(&json, "gas", file->gas);
        kiln_json_string(&json, "file", file->file);
        kiln_json_uint(&json, "frame", file->frame);
        kiln_json_uint(&json, "bytes", file->bytes);
        kiln_json_uint(&json, "voxels", file->voxels);
        kiln_json_uint(&json, "done", file->done);
        kiln_json_uint(&json, "total", file->total);
        kiln_json_time(&json, "elapsed_s", file->elapsed_s);
        event_end(&json);
    }
    char status[64];
    snprintf(status, sizeof status, "file %" PRIu32 " of %" PRIu32, file->done, file->total);
    event_progress(file->done, file->total, status);
    if (!export->quiet) {
        print_name(file->file);
        printf(": frame %" PRIu32 ", %" PRIu64 " voxels, %" PRIu64 " bytes\n", file->frame,
               file->voxels, file->bytes);
    }
    fflush(stdout);
}

static void print_result(const struct export *export, const struct kiln_export_stats *stats)
{
    if (events_are_open()) {
        struct kiln_json json = event_begin("result");
        kiln_json_string(&json, "scene", export->scene_path);
        kiln_json_string(&json, "output", export->params.output);
        kiln_json_string(&json, "first_file", stats->first_file);
        kiln_json_uint(&json, "frames", stats->frames);
        kiln_json_uint(&json, "files", stats->files);
        kiln_json_uint(&json, "steps", stats->steps);
        kiln_json_uint(&json, "bytes", stats->bytes);
        kiln_json_time(&json, "total_s", stats->total_s);
        event_end(&json);
    }
    if (!export->quiet) {
        print_name(export->params.output);
        printf(": %" PRIu32 " file%s, %" PRIu64 " bytes, after %" PRIu64 " steps in %.3f s\n",
               stats->files, stats->files == 1 ? "" : "s", stats->bytes, stats->steps,
               stats->total_s);
    }
}

static int read_options(struct export *export, const struct arguments *arguments)
{
    struct kiln_export_params *params = &export->params;
    *params = kiln_export_defaults();
    params->output = arguments_text(arguments, "output", NULL);
    params->gas = arguments_text(arguments, "gas", NULL);
    params->half = arguments_flag(arguments, "half");
    params->up = arguments_choice(arguments, "up", 0) == 1 ? KILN_UP_Z : KILN_UP_Y;
    params->unit = arguments_choice(arguments, "temperature", 0) == 1;
    params->cutoff = arguments_number(arguments, "cutoff", params->cutoff);
    params->states = arguments_text(arguments, "states", NULL);
    params->threads = arguments_integer(arguments, "threads", 0);
    params->overwrite = arguments_flag(arguments, "force");
    params->exported = show_file;
    params->stop = signals_wants_stop;
    params->user = export;
    params->log = report_log();
    const int code = events_open_json("export", arguments);
    export->quiet = arguments_flag(arguments, "quiet") || events_use_stdout();
    if (code)
        return code;
    if (!params->output)
        return report(KILN_USAGE, "export: needs --output FILE");
    if (!value_list_create(&export->techniques, arguments, "technique"))
        return report_no_memory();
    params->techniques = export->techniques.items;
    params->technique_count = export->techniques.count;
    return 0;
}

static int choose_frames(struct export *export, const struct arguments *arguments,
                         const struct kiln_scene *scene)
{
    const struct option_use *frames = arguments_last(arguments, "frames");
    struct kiln_scene_info info = kiln_scene_info_empty();
    kiln_scene_get_info(scene, &info);
    if (!frames)
        return 0;
    const int code =
        frames_choose(&export->frames, frames, "export", export->scene_path, info.frames - 1);
    export->params.ranges = export->frames.ranges;
    export->params.range_count = export->frames.count;
    return code;
}

/* Refuses files that would be written twice, or written and read, --json's among them. */
static int claim_files(const struct export *export, const struct arguments *arguments,
                       const struct kiln_scene *scene)
{
    struct kiln_claims *claims = kiln_claims_create();
    const char *json = json_output_path(arguments);
    struct kiln_error error = {0};
    int code = claims ? 0 : report_no_memory();
    if (code == 0 && ((json && !kiln_claims_write(claims, json, "--json", &error)) ||
                      !kiln_export_claim(scene, &export->params, claims, &error)))
        code = report_error(&error);
    kiln_claims_destroy(&claims);
    return code;
}

static int report_failure(const struct export *export, const struct kiln_error *error)
{
    return error->code == KILN_INTERRUPTED
               ? signals_report(export->scene_path, " after %u files", export->files_done)
               : report_error(error);
}

static int run_export(struct export *export, const struct arguments *arguments,
                      const struct kiln_scene *scene)
{
    struct kiln_error error = {0};
    struct kiln_export_stats stats = kiln_export_stats_empty();
    int code = 0;
    struct kiln_device *device = open_device(arguments, &export->techniques, &code);
    if (device && !kiln_export(device, scene, &export->params, &stats, &error))
        code = report_failure(export, &error);
    if (code == 0)
        print_result(export, &stats);
    kiln_device_close(&device);
    return code;
}

static int run(const struct arguments *arguments)
{
    struct export export = {.scene_path = arguments->operands[0]};
    struct overrides overrides = {0};
    struct kiln_error error = {0};
    struct kiln_scene *scene = NULL;
    int code = read_options(&export, arguments);
    signals_install_for_job();
    if (code == 0 && !overrides_create(&overrides, arguments))
        code = report_no_memory();
    if (code == 0) {
        const struct kiln_scene_params params = overrides_scene_params(&overrides, arguments);
        scene = scene_in_load(export.scene_path, &params, &error);
        code = scene ? 0 : report_scene_error(&error);
    }
    if (code == 0)
        code = choose_frames(&export, arguments, scene);
    if (code == 0)
        code = claim_files(&export, arguments, scene);
    if (code == 0)
        code = run_export(&export, arguments, scene);
    kiln_scene_destroy(&scene);
    frame_list_free(&export.frames);
    overrides_free(&overrides);
    value_list_free(&export.techniques);
    return code;
}

const struct command export_command = {
    .name = "export",
    .summary = "write gas as OpenVDB files, for other programs",
    .operands = "SCENE",
    .description =
        "Steps through the clip and writes the smoke and fire of its gas, an OpenVDB file for each "
        "frame and domain, for programs such as Houdini, Blender and Unreal. A file has the grids "
        "density, temperature, flame and vel (velocities in m/s), and Cd if smoke has colours of "
        "its own, with one voxel for each cell of the domain; a frame without gas is a file with "
        "empty grids. Each file appears under its name "
        "only when it is whole.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = 1,
    .access = ACCESS_READ,
    .run = run,
};
