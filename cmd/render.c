/* Runs kiln render, which draws the frames of scenes and writes them. One scene with its output is
 * a job (jobs.c). All jobs of a call share one device, and run one after another; --batch starts
 * processes instead (batch.c).
 *
 * The main function finds render_command in the table of commands and calls its `run`; the parser,
 * the help, the man page, the completion and the sandbox read its options. kiln_render does the
 * drawing, and calls back the functions under "While a job runs". It calls write_file_event on any
 * thread, so that function must only read. */
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "batch.h"
#include "build.h"
#include "command.h"
#include "device.h"
#include "event.h"
#include "jobs.h"
#include "json_output.h"
#include "limits.h"
#include "overrides.h"
#include "pipe.h"
#include "progress.h"
#include "report.h"
#include "sandbox.h"
#include "shard.h"
#include "signals.h"
#include "stats.h"
#include "timer_thread.h"
#include "watchdog.h"

static const struct option options[] = {
    {.name = "output",
     .letter = 'o',
     .kind = OPTION_TEXT,
     .placeholder = "FILE",
     .access = ACCESS_WRITE,
     .help = "Where to write. The suffix chooses the format (see 'kiln help outputs'). '%04d' or "
             "'####' stands for the frame's number, '{scene}' for the scene file's name without "
             "its suffix. A folder gets a video named after the scene. '-' is standard output (see "
             "--pipe). 'none' renders without writing."},
    PIPE_OPTION,
    {.name = "frames",
     .kind = OPTION_FRAMES,
     .placeholder = "RANGES",
     .help = "Frames to draw, such as 0-149,200. 170- goes to the end, -30 is 0-30, 'last' is the "
             "last frame, 0-100/10 is every tenth frame. The frames are the same as in the full "
             "run. Videos need a range without gaps.",
     .fallback = "all"},
    SIZE_OPTION,
    FPS_OPTION,
    SEED_OPTION,
    PARAMS_OPTION,
    SET_OPTION,
    ASSET_ROOT_OPTION,
    DEVICE_OPTION,
    TECHNIQUE_OPTION,
    THREADS_OPTION,
    {.name = "png-bits",
     .kind = OPTION_CHOICE,
     .placeholder = "8|16",
     .help = "Bits a channel of PNG, APNG and MKV files.",
     .fallback = "8"},
    {.name = "png-effort",
     .kind = OPTION_CHOICE,
     .placeholder = "fast|small",
     .help =
         "How PNG files are compressed. 'small' files are about a tenth smaller; each takes some "
         "hundred times as long to compress. The pixels are the same.",
     .fallback = "fast"},
    {.name = "exr-bits",
     .kind = OPTION_CHOICE,
     .placeholder = "16|32",
     .help = "Bits a channel of EXR files: half or float.",
     .fallback = "16"},
    QUALITY_OPTION,
    {.name = "flipbook",
     .kind = OPTION_GRID,
     .placeholder = "COLUMNSxROWS",
     .help = "Write one PNG of this many cells, for game engines, and a .json of its layout. Each "
             "cell is a frame of --size. The cells are spread evenly over --frames, and no other "
             "frames are drawn.",
     .max = 64},
    {.name = "flipbook-alpha",
     .kind = OPTION_CHOICE,
     .placeholder = "straight|premultiplied",
     .help = "Whether the colours of a flipbook are straight, for renderers that blend light, such "
             "as kiln, or premultiplied by alpha, as a display shows them over black.",
     .fallback = "straight"},
    {.name = "flipbook-fade",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "How far from its border a cell of a flipbook with alpha fades out, in percent of its "
             "shorter side, so that no glow and no smoke shows a cut there. 0 leaves the cell as "
             "it was drawn.",
     .fallback = "10",
     .max = 50},
    {.name = "flipbook-motion",
     .kind = OPTION_FLAG,
     .help = "Also write the motion of pixels from cell to cell, as FILE_motion.png."},
    {.name = "flipbook-green",
     .kind = OPTION_CHOICE,
     .placeholder = "up|down",
     .help = "Where green of FILE_motion.png points: up as in Houdini, Unity and kiln, or down as "
             "in Unreal.",
     .fallback = "up"},
    {.name = "flipbook-padding",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Number of pixels to add on each side of a cell, so that texture filters do not read "
             "the neighbouring cells.",
     .fallback = "0",
     .max = 256},
    {.name = "manifest",
     .kind = OPTION_TEXT,
     .placeholder = "FILE",
     .access = ACCESS_WRITE,
     .help =
         "Also write a JSON file that describes the run, even one that fails: scene, device, "
         "techniques, state of each frame, times. A folder or '{scene}' works as for --output."},
    {.name = "states",
     .kind = OPTION_TEXT,
     .placeholder = "STATES",
     .access = ACCESS_READ,
     .help = "Start at the nearest state before the frames, out of a folder that 'kiln bake' made. "
             "The pictures are the same as without it."},
    {.name = "resume",
     .kind = OPTION_FLAG,
     .help = "Go on with a job that was stopped or killed, or start it. Whole files stay, and the "
             "rest is drawn (see docs/jobs.md). With --force the job starts anew."},
    SHARD_OPTION,
    {.name = "force", .kind = OPTION_FLAG, .help = "Replace files that exist."},
    {.name = "keep-going",
     .kind = OPTION_FLAG,
     .help = "After a scene that failed, render the other scenes all the same. The exit code is "
             "then the greatest of all."},
    BATCH_OPTION,
    JOBS_OPTION,
    LIMITS_OPTION,
    TIMEOUT_OPTION,
    SANDBOX_OPTION,
    {.name = "frame-timeout",
     .kind = OPTION_TIME,
     .placeholder = "TIME",
     .help = "Give up with exit code 5 when drawing a frame takes longer than this. Each frame "
             "that is simulated but not drawn adds this time to the limit of the next drawn frame. "
             "The first drawn frame includes set-up and warm-up. Loading the scenes has the same "
             "limit. Time that is spent waiting for the output does not count.",
     .fallback = "none",
     .min = 0.001,
     .max = 86400},
    {.name = "progress",
     .kind = OPTION_CHOICE,
     .placeholder = "tty|lines|ndjson|none",
     .help = "How to show progress on standard error: a moving line, or a line now and then. "
             "'ndjson' is an older spelling of --json for frames alone.",
     .fallback = "tty on a terminal, else lines"},
    {.name = "stats",
     .value_is_optional = true,
     .kind = OPTION_CHOICE,
     .placeholder = "text|json",
     .help = "Print times of each pass, particles, memory, techniques and the hash of the final "
             "state. 'json' is an older spelling of --json without frames."},
    JSON_OPTION("an object a line, whose \"event\" is \"device\", \"frame\" for each, and "
                "\"result\", with what --stats has."),
    {.name = "quiet",
     .letter = 'q',
     .kind = OPTION_FLAG,
     .help = "Print nothing but errors and what --stats and --json ask for."},
    EVENTS_OPTION,
    HELP_OPTION,
};

struct render {
    struct job_list list;
    struct kiln_render_params params;
    struct value_list techniques;
    const char **command; /* the command's arguments, for manifests */
    struct shard shard;
    bool quiet, stats;
    bool json_frames, json_stats; /* whether JSON is written for frames, and for statistics */
    enum progress_mode progress_mode;
    double frame_timeout_s;

    const struct job *job; /* the job that is running */
    struct progress progress;
    struct watchdog *watchdog;
    double began_s; /* when the job began, by now_s */
    uint32_t frames_done, frames_total;
    int64_t last_frame; /* the last frame with a time limit; -1: no frame of the job */
};

/* ---- While a job runs ----------------------------------------------------------------------- */

/* Starts the time limit of a frame (--frame-timeout). Each frame that was simulated but not drawn
 * since the last limit adds the same time again. */
static void arm_frame_timeout(struct render *render, uint32_t frame)
{
    if (!render->watchdog)
        return;
    const double limit_s = render->frame_timeout_s * (double)(frame - render->last_frame);
    watchdog_arm(render->watchdog, limit_s, "%s: frame %u", render->job->path, frame);
    render->last_frame = frame;
}

static void begin_frame(void *user, uint32_t frame)
{
    struct render *render = user;
    if (frame != render->last_frame) /* run_job has started the first frame's time before set-up */
        arm_frame_timeout(render, frame);
}

/* Stops the time limit when a frame is drawn: waiting for the output, such as a slow reader, does
 * not count. */
static void end_frame(void *user, uint32_t frame)
{
    const struct render *render = user;
    (void)frame;
    if (render->watchdog)
        watchdog_disarm(render->watchdog);
}

/* Returns whether each frame has a file of its own. If so, write_file_event writes the event of the
 * frame, and show_frame writes none. */
static bool has_files(const struct render *render)
{
    return render->job->output && !render->list.stream.format &&
           render->list.flipbook.columns == 0 && kiln_output_is_images(render->job->output);
}

static void write_frame_event(const struct render *render, const struct kiln_progress *frame,
                              const struct kiln_written *file)
{
    progress_write_event(render->job->path, frame, file);
    progress_write_openjd(render->job->path, frame, (size_t)(render->job - render->list.jobs),
                          render->list.count);
}

static void show_frame(void *user, const struct kiln_progress *frame)
{
    struct render *render = user;
    render->frames_done = frame->done;
    render->frames_total = frame->total;
    progress_show(&render->progress, render->job->path, frame);
    if (render->json_frames || (events_are_wanted() && !has_files(render)))
        write_frame_event(render, frame, NULL);
}

/* Prints the event of a file that is whole. It may be called on any thread, one call at a time. */
static void write_file_event(void *user, const struct kiln_written *file)
{
    const struct render *render = user;
    if (file->kind == KILN_WRITTEN_FRAME) {
        const double elapsed_s = now_s() - render->began_s;
        struct kiln_progress frame = {.frame = file->frames.first,
                                      .done = file->done,
                                      .total = file->total,
                                      .elapsed_s = elapsed_s,
                                      .alive = file->alive,
                                      .state = file->state};
        frame.eta_s = elapsed_s / file->done * (file->total - file->done);
        memcpy(frame.pass_ms, file->pass_ms, sizeof frame.pass_ms);
        write_frame_event(render, &frame, file);
        return;
    }
    struct kiln_json json = event_begin(file->kind == KILN_WRITTEN_PART ? "part" : "file");
    kiln_json_string(&json, "scene", render->job->path);
    kiln_json_string(&json, "file", file->file);
    kiln_json_pair(&json, "frames", file->frames.first, file->frames.last);
    kiln_json_uint(&json, "bytes", file->bytes);
    kiln_json_string(&json, "sha256", file->sha256);
    event_end(&json);
}

/* ---- From options to parameters ------------------------------------------------------------- */

/* Opens the stream of JSON if --json asks for it, or an older spelling: --progress ndjson or
 * --stats=json. */
static int open_json(struct render *render, const struct arguments *arguments)
{
    const bool frames = arguments_choice(arguments, "progress", PROGRESS_NONE) == PROGRESS_NDJSON;
    const bool result = arguments_choice(arguments, "stats", 0) == 1;
    if (frames)
        report_deprecated("render", "--progress ndjson", "--json");
    if (result)
        report_deprecated("render", "--stats=json", "--json");
    const int code = events_open_json("render", arguments);
    if (code == 0 && (frames || result))
        events_open_plain();
    const bool plain = events_are_open() && !events_are_wanted();
    const bool json = arguments_flag(arguments, "json");
    render->json_frames = plain && (json || (frames && !arguments_flag(arguments, "quiet")));
    render->stats = arguments_flag(arguments, "stats");
    render->json_stats = json || render->stats;
    return code;
}

/* Fills in the parameters that do not depend on the job. Call it after open_json, whose decisions
 * it uses. Returns false when memory is short. */
static bool read_options(struct render *render, const struct arguments *arguments)
{
    struct kiln_render_params *params = &render->params;
    *params = kiln_render_defaults();
    params->threads = arguments_integer(arguments, "threads", params->threads);
    params->quality = arguments_integer(arguments, "quality", params->quality);
    params->png_bits = arguments_choice(arguments, "png-bits", 0) == 0 ? 8 : 16;
    params->png_effort =
        (enum kiln_png_effort)arguments_choice(arguments, "png-effort", KILN_PNG_FAST);
    params->exr_bits = arguments_choice(arguments, "exr-bits", 0) == 0 ? 16 : 32;
    params->overwrite = arguments_flag(arguments, "force");
    params->resume = arguments_flag(arguments, "resume");
    params->states = arguments_text(arguments, "states", NULL);

    render->frame_timeout_s = arguments_number(arguments, "frame-timeout", 0);

    bool terminal = isatty(STDERR_FILENO) == 1;
    enum progress_mode mode = (enum progress_mode)arguments_choice(
        arguments, "progress", terminal ? PROGRESS_TTY : PROGRESS_LINES);
    render->quiet = arguments_flag(arguments, "quiet");
    render->progress_mode = render->quiet ? PROGRESS_NONE : mode;
    if (events_are_wanted())
        params->written = write_file_event;
    render->quiet = render->quiet || events_use_stdout();
    params->state_hash = render->json_stats || render->json_frames || events_are_wanted();
    params->next = begin_frame;
    params->drawn = end_frame;
    params->progress = show_frame;
    params->stop = signals_wants_stop;
    params->user = render;
    params->log = report_log();
    render->command = calloc(arguments->argc + 2, sizeof *render->command);
    if (!render->command || !value_list_create(&render->techniques, arguments, "technique"))
        return false;
    render->command[params->command_count++] = "kiln";
    render->command[params->command_count++] = "render";
    for (size_t i = 0; i < arguments->argc; i++)
        render->command[params->command_count++] = arguments->argv[i];
    params->command = render->command;
    params->build = build_name();
    params->techniques = render->techniques.items;
    params->technique_count = render->techniques.count;
    return true;
}

/* ---- Running -------------------------------------------------------------------------------- */

static void print_device_json(const struct kiln_device_info *info)
{
    struct kiln_json json = event_begin("device");
    kiln_json_uint(&json, "index", info->index);
    kiln_json_string(&json, "name", info->name);
    kiln_json_bool(&json, "software", info->software);
    event_end(&json);
}

/* Prints the device as the first line of output, so that a picture of a software device is not
 * taken for a GPU's. */
static void print_device(const struct render *render, const struct kiln_device_info *info)
{
    if (events_are_open())
        print_device_json(info);
    if (!render->quiet && !info->gl)
        printf("device: %s (%s, no OpenGL)\n", info->name, info->vectors);
    else if (!render->quiet)
        printf("device: %s%s\n", info->name, info->software ? " (software)" : "");
    fflush(stdout);
}

static void print_shard_json(const struct shard *shard)
{
    struct kiln_json json = event_begin("shard");
    kiln_json_uint(&json, "shard", shard->index + 1);
    kiln_json_uint(&json, "shards", shard->count);
    kiln_json_string(&json, "variable", shard->variable);
    event_end(&json);
}

/* Prints which shard this is, and which option or scheduler said so. */
static void print_shard(const struct render *render)
{
    const struct shard *shard = &render->shard;
    if (shard->count == 0)
        return;
    if (events_are_open())
        print_shard_json(shard);
    if (render->quiet)
        return;
    printf("shard %u of %u", shard->index + 1, shard->count);
    if (shard->variable)
        printf(", by %s=%s", shard->variable, kiln_environment(shard->variable));
    printf("\n");
    fflush(stdout);
}

static void print_job(const struct render *render, const struct kiln_render_stats *stats)
{
    const struct job_result result = {.scene = render->job->path,
                                      .output = render->job->output,
                                      .is_shard = render->shard.count > 0,
                                      .info = &render->job->info,
                                      .stats = stats};
    if (events_are_open())
        print_result_json(&result, render->json_stats);
    if (!events_use_stdout()) {
        if (!render->quiet || render->stats)
            print_result(&result);
        if (render->stats)
            print_stats_text(&result);
    }
    fflush(stdout);
}

/* Reports why a job ended early, and returns the exit code for it. */
static int report_failure(const struct render *render, const struct kiln_error *error)
{
    if (error->code != KILN_INTERRUPTED)
        return report_error(error);
    return render->frames_done > 0 && render->frames_done == render->frames_total
               ? signals_report(render->job->path, " before %s was complete", render->job->output)
               : signals_report(render->job->path, " after %u frames", render->frames_done);
}

static int run_job(struct render *render, struct kiln_device *device, const struct job *job)
{
    render->job = job;
    render->frames_done = render->frames_total = 0;
    render->params.output = render->list.stream.format ? NULL : job->output;
    render->params.stream = render->list.stream;
    render->params.manifest = job->manifest;
    render->params.ranges = job->frames.ranges;
    render->params.range_count = job->frames.count;
    render->params.flipbook = render->list.flipbook.columns > 0 ? &render->list.flipbook : NULL;
    progress_start(&render->progress, render->progress_mode);
    render->began_s = now_s();
    render->last_frame = -1;
    if (!render->params.resume && render->shard.count == 0)
        arm_frame_timeout(render, job->frames.ranges[0].first);

    struct kiln_error error = {0};
    struct kiln_render_stats stats = kiln_render_stats_empty();
    bool ok = kiln_render(device, job->scene, &render->params, &stats, &error);
    if (render->watchdog)
        watchdog_disarm(render->watchdog);
    progress_clear(&render->progress);
    if (!ok)
        return report_failure(render, &error);
    print_job(render, &stats);
    return 0;
}

/* Returns whether an exit code ends the whole call: after a signal, or when the reader is gone, no
 * other job begins. */
static bool is_end_of_all(int code)
{
    return code > 128 || code == KILN_READER_GONE;
}

static int run_jobs(struct render *render, const struct arguments *arguments)
{
    int code = 0;
    if (render->watchdog)
        watchdog_arm(render->watchdog, render->frame_timeout_s, "opening the device");
    struct kiln_device *device = open_device(arguments, &render->techniques, &code);
    if (render->watchdog)
        watchdog_disarm(render->watchdog);
    if (!device)
        return code;
    print_device(render, kiln_device_get_info(device));
    print_shard(render);
    const bool keep_going = render->list.keep_going;
    for (size_t i = 0; i < render->list.count && (code == 0 || keep_going); i++) {
        const struct job *job = &render->list.jobs[i];
        if (!job->code && !render->quiet)
            overrides_print_length(arguments, "", job->path, &job->info);
        const int ended = job->code ? job->code : run_job(render, device, job);
        code = ended > code ? ended : code;
        if (is_end_of_all(ended))
            break;
    }
    kiln_device_close(&device);
    return code;
}

/* Loads the scenes, all of which together have the time limit of a frame. */
static int load(struct render *render, const struct arguments *arguments)
{
    if (render->watchdog)
        watchdog_arm(render->watchdog, render->frame_timeout_s, "loading the scenes");
    const int code = job_list_create(&render->list, arguments);
    if (render->watchdog)
        watchdog_disarm(render->watchdog);
    return code;
}

static int run(const struct arguments *arguments)
{
    struct render render = {0};
    if (arguments_last(arguments, "batch"))
        return batch_run(arguments);
    if (arguments->operand_count == 0)
        return report(KILN_USAGE, "render: needs SCENE...");
    if (arguments_last(arguments, "jobs"))
        return report(KILN_USAGE, "render: --jobs: needs --batch");
    signals_install_for_job();
    int code = open_json(&render, arguments);
    if (code == 0 && !read_options(&render, arguments))
        code = report_no_memory();
    if (code == 0)
        code = shard_read(&render.shard, arguments);
    render.params.shard = render.list.shard = render.shard.index;
    render.params.shards = render.list.shards = render.shard.count;
    render.list.keep_going = arguments_flag(arguments, "keep-going");
    if (code == 0)
        code = pipe_read(&render.list.stream, arguments);
    if (code == 0 && render.frame_timeout_s > 0) {
        render.watchdog = watchdog_create();
        if (!render.watchdog)
            code = report(KILN_DEVICE_FAILED, "cannot start a thread for --frame-timeout");
    }
    if (code == 0)
        code = load(&render, arguments);
    if (code == 0)
        code = pipe_open(&render.list.stream);
    if (code == 0)
        code = run_jobs(&render, arguments);
    watchdog_destroy(&render.watchdog);
    job_list_free(&render.list);
    value_list_free(&render.techniques);
    free(render.command);
    return code;
}

const struct command render_command = {
    .name = "render",
    .summary = "render scenes into images or videos",
    .operands = "SCENE...",
    .description = "Renders each scene into images or a video. '-' reads a scene from standard "
                   "input, whose files lie below the working directory. Files appear under their "
                   "names only when they are whole. The first line of output names the device: a "
                   "GPU, a software device of OpenGL, or 'cpu'. Several scenes share the device. "
                   "The first scene that fails ends the call, unless --keep-going is given.\n"
                   "\n"
                   "Programs follow a job by --events ('kiln help events').",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 0, /* with --batch */
    .most_operands = SIZE_MAX,
    .access = ACCESS_READ,
    .run = run,
};
