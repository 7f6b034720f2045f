/* Runs kiln encode, which encodes images from files into a clip. */
#include <inttypes.h>
#include <unistd.h>

#include "command.h"
#include "event.h"
#include "jobs.h"
#include "limits.h"
#include "progress.h"
#include "report.h"
#include "sandbox.h"
#include "signals.h"

static const char *const tonemaps[] = {"none", "agx", "aces"};

static const struct option options[] = {
    {.name = "output",
     .letter = 'o',
     .kind = OPTION_TEXT,
     .placeholder = "FILE",
     .access = ACCESS_WRITE,
     .help = "The clip; the suffix chooses the format (see 'kiln help outputs')."},
    {.name = "fps",
     .kind = OPTION_RATIO,
     .placeholder = "RATE",
     .help = "Frames a second, such as 30 or 30000/1001.",
     .fallback = "the rate that the images state"},
    QUALITY_OPTION,
    {.name = "tonemap",
     .kind = OPTION_CHOICE,
     .placeholder = "none|agx|aces",
     .help =
         "Tone mapping of EXR and HDR images, like post.tonemap of a scene. They need it; other "
         "images do not take it."},
    {.name = "exposure",
     .kind = OPTION_NUMBER,
     .placeholder = "STOPS",
     .help = "Exposure in stops of EXR and HDR images before tone mapping.",
     .fallback = "0",
     .min = -20,
     .max = 20},
    {.name = "force", .kind = OPTION_FLAG, .help = "Replace a file that exists."},
    {.name = "progress",
     .kind = OPTION_CHOICE,
     .placeholder = "tty|lines|none",
     .help = "How to show progress on standard error: a moving line, or a line now and then.",
     .fallback = "tty on a terminal, else lines"},
    LIMITS_OPTION,
    TIMEOUT_OPTION,
    SANDBOX_OPTION,
    {.name = "quiet", .letter = 'q', .kind = OPTION_FLAG, .help = "Print nothing but errors."},
    EVENTS_OPTION,
    HELP_OPTION,
};

static enum progress_mode choose_progress(const struct arguments *arguments)
{
    static const enum progress_mode modes[] = {PROGRESS_TTY, PROGRESS_LINES, PROGRESS_NONE};
    const bool terminal = isatty(STDERR_FILENO) == 1;
    return arguments_flag(arguments, "quiet")
               ? PROGRESS_NONE
               : modes[arguments_choice(arguments, "progress", terminal ? 0 : 1)];
}

struct encoding {
    const char *output;
    struct progress progress;
};

static void show(void *user, const struct kiln_progress *frame)
{
    struct encoding *encoding = user;
    progress_show(&encoding->progress, encoding->output, frame);
    progress_write_openjd(encoding->output, frame, 0, 1);
}

static void print_result(const char *output, const struct kiln_frame_range *frames, bool quiet)
{
    const uint32_t count = frames->last - frames->first + 1;
    struct kiln_json json = event_begin("result");
    kiln_json_string(&json, "output", output);
    kiln_json_uint(&json, "frames", count);
    kiln_json_pair(&json, "range", frames->first, frames->last);
    event_end(&json);
    if (quiet)
        return;
    print_name(output);
    printf(": %" PRIu32 " frame%s, %" PRIu32 "-%" PRIu32 "\n", count, count == 1 ? "" : "s",
           frames->first, frames->last);
}

static int run(const struct arguments *arguments)
{
    const struct option_use *output = arguments_last(arguments, "output");
    const struct option_use *tonemap = arguments_last(arguments, "tonemap");
    if (!output)
        return report(KILN_USAGE, "encode: needs --output FILE");
    const int code = quality_check(arguments, "encode", output->text);
    if (code)
        return code;
    struct encoding encoding = {.output = output->text};
    struct kiln_encode_params params = kiln_encode_defaults();
    params.frames = arguments->operands[0];
    params.output = output->text;
    params.fps = arguments_text(arguments, "fps", NULL);
    params.tonemap = tonemap ? tonemaps[tonemap->choice] : NULL;
    params.exposure = (float)arguments_number(arguments, "exposure", 0);
    params.quality = arguments_integer(arguments, "quality", params.quality);
    params.overwrite = arguments_flag(arguments, "force");
    params.progress = show;
    params.stop = signals_wants_stop;
    params.user = &encoding;
    params.budget = arguments->budget;
    params.log = report_log();
    progress_start(&encoding.progress, choose_progress(arguments));
    signals_install_for_job();

    struct kiln_frame_range frames;
    struct kiln_error error = {0};
    const bool ok = kiln_encode(&params, &frames, &error);
    progress_clear(&encoding.progress);
    if (!ok)
        return error.code == KILN_INTERRUPTED ? signals_report(params.output, "%s", "")
                                              : report_error(&error);
    print_result(params.output, &frames, arguments_flag(arguments, "quiet"));
    return 0;
}

const struct command encode_command = {
    .name = "encode",
    .summary = "make a clip of images",
    .operands = "FRAMES",
    .description =
        "FRAMES is a numbered pattern like --output of 'kiln render', or a folder, whose images "
        "are taken in the order of their names. PNG images by kiln, of the depth that the format "
        "takes, give the bytes of a clip that 'kiln render' writes at once with the same "
        "--quality. EXR and HDR images are tone-mapped with --tonemap.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = 1,
    .access = ACCESS_READ,
    .run = run,
};
