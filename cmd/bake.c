/* Runs kiln bake, which steps through a clip once and saves states of the simulation. Later runs of
 * kiln render start from these states. */
#include <inttypes.h>
#include <math.h>
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
     .placeholder = "STATES",
     .access = ACCESS_WRITE,
     .help = "The folder of the states; it is made if it is missing. Scenes may share one."},
    {.name = "every",
     .kind = OPTION_TEXT,
     .placeholder = "10s|N",
     .help = "Time or number of frames between two states.",
     .fallback = "a state at the start of each part of a clip, of two seconds"},
    FPS_OPTION,
    SEED_OPTION,
    PARAMS_OPTION,
    SET_OPTION,
    ASSET_ROOT_OPTION,
    LIMITS_OPTION,
    TIMEOUT_OPTION,
    SANDBOX_OPTION,
    DEVICE_OPTION,
    TECHNIQUE_OPTION,
    THREADS_OPTION,
    {.name = "force", .kind = OPTION_FLAG, .help = "Replace states that exist."},
    {.name = "resume",
     .kind = OPTION_FLAG,
     .help = "Keep states that are whole, and go on from the last of them."},
    JSON_OPTION("an object a line, whose \"event\" is \"state\" for each, and \"result\"."),
    {.name = "quiet",
     .letter = 'q',
     .kind = OPTION_FLAG,
     .help = "Print nothing but errors and what --json asks for."},
    EVENTS_OPTION,
    HELP_OPTION,
};

struct bake {
    const char *scene_path;
    struct kiln_bake_params params;
    struct value_list techniques;
    bool quiet;
    uint32_t states_done; /* including those that were kept */
    uint64_t steps;       /* simulation steps of the whole clip */
};

static void show_state(void *user, const struct kiln_baked *state)
{
    struct bake *bake = user;
    bake->states_done = state->done;
    if (events_are_open()) {
        struct kiln_json json = event_begin("state");
        kiln_json_string(&json, "file", state->file);
        kiln_json_uint(&json, "frame", state->frame);
        kiln_json_uint(&json, "step", state->step);
        if (state->kept)
            kiln_json_null(&json, "alive");
        else
            kiln_json_uint(&json, "alive", state->alive);
        kiln_json_uint(&json, "bytes", state->bytes);
        kiln_json_bool(&json, "kept", state->kept);
        kiln_json_uint(&json, "done", state->done);
        kiln_json_uint(&json, "total", state->frames);
        event_end(&json);
    }
    char status[64];
    snprintf(status, sizeof status, "state %" PRIu32 " of %" PRIu32 ", step %" PRIu32, state->done,
             state->frames, state->step);
    event_progress(state->step, bake->steps, status);
    if (!bake->quiet && state->kept) {
        printf("frame %" PRIu32 ": kept, %" PRIu64 " bytes\n", state->frame, state->bytes);
    } else if (!bake->quiet) {
        printf("frame %" PRIu32 ": step %" PRIu32 ", %" PRIu64 " particles, %" PRIu64 " bytes\n",
               state->frame, state->step, state->alive, state->bytes);
    }
    fflush(stdout);
}

static void print_result(const struct bake *bake, const struct kiln_bake_stats *stats)
{
    if (events_are_open()) {
        struct kiln_json json = event_begin("result");
        kiln_json_string(&json, "scene", bake->scene_path);
        kiln_json_string(&json, "output", bake->params.states);
        kiln_json_string(&json, "motion", stats->motion);
        kiln_json_uint(&json, "states", stats->states);
        kiln_json_uint(&json, "kept", stats->kept);
        kiln_json_uint(&json, "steps", stats->steps);
        kiln_json_uint(&json, "bytes", stats->bytes);
        kiln_json_time(&json, "total_s", stats->total_s);
        event_end(&json);
    }
    if (!bake->quiet) {
        print_name(bake->params.states);
        printf(": %" PRIu32 " state%s of motion %.16s after %" PRIu64 " steps in %.3f s\n",
               stats->states, stats->states == 1 ? "" : "s", stats->motion, stats->steps,
               stats->total_s);
    }
}

/* Reads --every into params.every: "10s" of clip time, or "300" frames. Returns 0, or the exit code
 * after reporting. */
static int read_every(struct bake *bake, const struct arguments *arguments,
                      const struct kiln_scene_info *info)
{
    const struct option_use *use = arguments_last(arguments, "every");
    if (!use)
        return 0;
    char digits[32] = "";
    const size_t length = strlen(use->text);
    const bool seconds = length > 1 && use->text[length - 1] == 's';
    double number = 0;
    if (length < sizeof digits)
        memcpy(digits, use->text, seconds ? length - 1 : length);
    double frames = 0;
    if (kiln_text_to_double(digits, &number))
        frames = seconds ? floor(number * info->fps_num / info->fps_den + 0.5) : number;
    if (!(frames >= 1) || frames > 1e6 || frames != floor(frames))
        return report(KILN_USAGE,
                      "bake: --every: found '%s'; expected a time of at least one frame, such as "
                      "10s, or a number of frames from 1 to 1000000",
                      use->text);
    bake->params.every = (uint32_t)frames;
    return 0;
}

static int read_options(struct bake *bake, const struct arguments *arguments)
{
    struct kiln_bake_params *params = &bake->params;
    *params = kiln_bake_defaults();
    params->states = arguments_text(arguments, "output", NULL);
    params->threads = arguments_integer(arguments, "threads", 0);
    params->overwrite = arguments_flag(arguments, "force");
    params->resume = arguments_flag(arguments, "resume");
    params->saved = show_state;
    params->stop = signals_wants_stop;
    params->user = bake;
    params->log = report_log();
    const int code = events_open_json("bake", arguments);
    bake->quiet = arguments_flag(arguments, "quiet") || events_use_stdout();
    if (code)
        return code;
    if (!params->states)
        return report(KILN_USAGE, "bake: needs --output STATES, a folder");
    if (params->overwrite && params->resume)
        return report(KILN_USAGE, "bake: --resume and --force exclude each other: --resume keeps "
                                  "the states that --force replaces");
    if (!value_list_create(&bake->techniques, arguments, "technique"))
        return report_no_memory();
    params->techniques = bake->techniques.items;
    params->technique_count = bake->techniques.count;
    return 0;
}

static int report_failure(const struct bake *bake, const struct kiln_error *error)
{
    return error->code == KILN_INTERRUPTED
               ? signals_report(bake->scene_path, " after %u states", bake->states_done)
               : report_error(error);
}

static int run_bake(struct bake *bake, const struct arguments *arguments,
                    const struct kiln_scene *scene)
{
    struct kiln_error error = {0};
    struct kiln_bake_stats stats = kiln_bake_stats_empty();
    int code = 0;
    struct kiln_device *device = open_device(arguments, &bake->techniques, &code);
    if (device && !kiln_bake(device, scene, &bake->params, &stats, &error))
        code = report_failure(bake, &error);
    if (code == 0)
        print_result(bake, &stats);
    kiln_device_close(&device);
    return code;
}

static int run(const struct arguments *arguments)
{
    struct bake bake = {.scene_path = arguments->operands[0]};
    struct overrides overrides = {0};
    struct kiln_error error = {0};
    struct kiln_scene *scene = NULL;
    int code = read_options(&bake, arguments);
    signals_install_for_job();
    if (code == 0 && !overrides_create(&overrides, arguments))
        code = report_no_memory();
    if (code == 0) {
        const struct kiln_scene_params params = overrides_scene_params(&overrides, arguments);
        scene = scene_in_load(bake.scene_path, &params, &error);
        code = scene ? 0 : report_scene_error(&error);
    }
    if (code == 0) {
        struct kiln_scene_info info = kiln_scene_info_empty();
        kiln_scene_get_info(scene, &info);
        bake.steps = info.steps;
        code = read_every(&bake, arguments, &info);
    }
    if (code == 0)
        code = json_output_claim(arguments, scene);
    if (code == 0)
        code = run_bake(&bake, arguments, scene);
    kiln_scene_destroy(&scene);
    overrides_free(&overrides);
    value_list_free(&bake.techniques);
    return code;
}

const struct command bake_command = {
    .name = "bake",
    .summary = "save states of a run, from which other runs start",
    .operands = "SCENE",
    .description =
        "Steps through the clip once and saves the state of all particles at regular times. 'kiln "
        "render --states STATES' starts at the nearest state before its frames and draws the same "
        "pictures as a run from the start. A state belongs to the motion of a scene: the camera, "
        "looks, lights and post-processing may change without a new bake. Each file appears under "
        "its name only when it is whole.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = 1,
    .access = ACCESS_READ,
    .run = run,
};
