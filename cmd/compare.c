/* Runs kiln compare, which tells whether two pictures, folders or videos look the same. main.c
 * finds compare_command in its table and calls run once.
 *
 * This file turns options into parameters. lib/compare/ does the comparison, and compare_report.c
 * prints the results. Scripts depend on the exit codes in the description below. The choices of
 * --range stand in the order of enum kiln_compare_mode, since a choice's number is used as the
 * mode. */
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "compare_report.h"
#include "event.h"
#include "json_output.h"
#include "report.h"
#include "signals.h"

static const struct option options[] = {
    {.name = "tolerance",
     .older_name = "limit",
     .older_letter = 'l',
     .repeats = true,
     .splits_at_commas = true,
     .kind = OPTION_PAIRS,
     .placeholder = "METRIC=VALUE",
     .help = "The worst value of a metric that passes, its limit; separate several by commas (see "
             "'kiln help metrics').",
     .fallback = KILN_COMPARE_DEFAULT_LIMITS},
    {.name = "diff",
     .letter = 'd',
     .kind = OPTION_TEXT,
     .placeholder = "FILE",
     .help =
         "Write a PNG of reference, test and FLIP's error map side by side. For several frames, "
         "'%04d' or '####' stands for the frame's number. A folder gets one file for each frame."},
    {.name = "error-map",
     .kind = OPTION_TEXT,
     .placeholder = "FILE",
     .help =
         "Write a PNG of FLIP's error map alone, in the pictures' size. Names work as for --diff."},
    {.name = "force",
     .kind = OPTION_FLAG,
     .help = "Replace files of --diff, --error-map and --json that exist."},
    {.name = "ignore",
     .letter = 'i',
     .repeats = true,
     .kind = OPTION_RECT,
     .placeholder = "X,Y,WxH",
     .help = "Do not judge this rectangle. Its pixels of the test are taken from the reference."},
    {.name = "mask",
     .repeats = true,
     .kind = OPTION_TEXT,
     .placeholder = "FILE",
     .help = "Do not judge the places where this picture is black. It must have the same size."},
    {.name = "layer",
     .kind = OPTION_TEXT,
     .placeholder = "LAYER",
     .help = "Layer of EXR files to compare, such as beauty, depth or fire.",
     .fallback = "all layers"},
    {.name = "data-limit",
     .kind = OPTION_NUMBER,
     .placeholder = "NUMBER",
     .help = "The largest difference that passes of two numbers in layers of data, such as depths.",
     .fallback = "0",
     .max = 1e30},
    {.name = "range",
     .kind = OPTION_CHOICE,
     .placeholder = "auto|ldr|hdr",
     .help = "How FLIP judges light: ldr clamps it at white, hdr judges several exposures of the "
             "reference.",
     .fallback = "auto: hdr if one of the pictures is EXR or HDR"},
    {.name = "ppd",
     .kind = OPTION_NUMBER,
     .placeholder = "N",
     .help = "Number of pixels in a degree of the viewer's field of view.",
     .fallback = "67.0206, a 0.7 m wide screen of 3840 pixels from 0.7 m",
     .min = 4,
     .max = 400},
    {.name = "threshold",
     .kind = OPTION_NUMBER,
     .placeholder = "LEVELS",
     .help = "Threshold in 1/255 of sRGB's range. Pixels that differ by more count as differing.",
     .fallback = "2",
     .min = 0,
     .max = 255},
    {.name = "window",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help =
         "Edge in pixels of the window that is searched for where differing pixels are densest.",
     .fallback = "32",
     .min = 1,
     .max = 16384},
    {.name = "threads",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Number of threads; 0 takes one for each core.",
     .fallback = "0",
     .max = 256},
    JSON_OPTION("an object a line, whose \"event\" is \"frame\" or \"result\"."),
    {.name = "stats", .kind = OPTION_FLAG, .help = "Also print the time that it took."},
    {.name = "quiet",
     .letter = 'q',
     .kind = OPTION_FLAG,
     .help = "Print nothing but errors and what --json asks for."},
    EVENTS_OPTION,
    HELP_OPTION,
};

static void show_frame(void *user, const struct kiln_compare_result *result,
                       const struct kiln_compare_frame *frame)
{
    compare_report_frame(user, result, frame);
}

/* Stops the comparison also when standard output cannot be written: nobody would see its result. */
static bool wants_stop(void *user)
{
    return signals_wants_stop(user) || ferror(stdout);
}

static struct kiln_compare_params read_params(const struct arguments *arguments)
{
    struct kiln_compare_params params = kiln_compare_defaults();
    params.log = report_log();
    params.reference = arguments->operands[0];
    params.test = arguments->operands[1];
    const struct option_use *diff = arguments_last(arguments, "diff");
    const struct option_use *error_map = arguments_last(arguments, "error-map");
    const struct option_use *layer = arguments_last(arguments, "layer");
    const struct option_use *data_limit = arguments_last(arguments, "data-limit");
    const struct option_use *range = arguments_last(arguments, "range");
    const struct option_use *ppd = arguments_last(arguments, "ppd");
    const struct option_use *threshold = arguments_last(arguments, "threshold");
    const struct option_use *window = arguments_last(arguments, "window");
    const struct option_use *threads = arguments_last(arguments, "threads");
    params.diff = diff ? diff->text : NULL;
    params.error_map = error_map ? error_map->text : NULL;
    params.layer = layer ? layer->text : params.layer;
    params.data_limit = data_limit ? data_limit->number : params.data_limit;
    params.mode = range ? (enum kiln_compare_mode)range->choice : params.mode;
    params.pixels_per_degree = ppd ? ppd->number : params.pixels_per_degree;
    params.threshold = threshold ? threshold->number : params.threshold;
    params.window = window ? (uint32_t)window->integer[0] : params.window;
    params.threads = threads ? (uint32_t)threads->integer[0] : params.threads;
    params.overwrite = arguments_last(arguments, "force") != NULL;
    params.frame = show_frame;
    params.stop = wants_stop;
    return params;
}

static int report_failure(const struct kiln_error *error)
{
    int number = signals_received();
    if (error->code != KILN_INTERRUPTED)
        return report_error(error);
    if (number == 0) /* wants_stop found that the reader is gone; report_finish reports it */
        return KILN_READER_GONE;
    return report((enum kiln_code)(128 + number), "compare: %s", error->message);
}

/* Reads --tolerance, --ignore and --mask, which may be repeated. --tolerance is the only option of
 * kind OPTION_PAIRS, and --ignore the only one of OPTION_RECT. Both arrays have room for as many
 * items as options were given. */
static void read_lists(const struct arguments *arguments, const char **limits,
                       struct kiln_compare_mask *masks, struct kiln_compare_params *params)
{
    for (size_t i = 0; i < arguments->use_count; i++) {
        const struct option_use *use = &arguments->uses[i];
        if (use->option->kind == OPTION_PAIRS)
            limits[params->limit_count++] = use->text;
        else if (use->option->kind == OPTION_RECT)
            masks[params->mask_count++] = (struct kiln_compare_mask){sizeof *masks,
                                                                     (uint32_t)use->integer[0],
                                                                     (uint32_t)use->integer[1],
                                                                     (uint32_t)use->integer[2],
                                                                     (uint32_t)use->integer[3],
                                                                     NULL};
        else if (strcmp(use->option->name, "mask") == 0)
            masks[params->mask_count++] =
                (struct kiln_compare_mask){.size = sizeof *masks, .picture = use->text};
    }
    params->limits = limits;
    params->masks = masks;
    params->mask_stride = sizeof *masks;
}

static int run(const struct arguments *arguments)
{
    struct kiln_compare_params params = read_params(arguments);
    const bool is_quiet = arguments_flag(arguments, "quiet");
    const int code = events_open_json("compare", arguments);
    if (code)
        return code;
    struct compare_report printed = {.reference = params.reference,
                                     .test = params.test,
                                     .json = events_are_open(),
                                     .quiet = is_quiet || events_use_stdout(),
                                     .stats = arguments_last(arguments, "stats") != NULL};
    const char **limits = calloc(arguments->use_count + 1, sizeof *limits);
    struct kiln_compare_mask *masks = calloc(arguments->use_count + 1, sizeof *masks);
    if (!limits || !masks) {
        free(limits);
        free(masks);
        return report_no_memory();
    }
    read_lists(arguments, limits, masks, &params);
    params.user = &printed;
    signals_install();
    struct kiln_compare_result result = kiln_compare_result_empty();
    struct kiln_error error = {0};
    bool ok =
        kiln_compare_with_output(&params, json_output_path(arguments), "--json", &result, &error);
    free(limits);
    free(masks);
    compare_report_result(&printed, &result);
    if (!ok)
        return report_failure(&error);
    return result.same ? 0 : KILN_FRAME_FAILED;
}

const struct command compare_command = {
    .name = "compare",
    .summary = "tell whether two pictures, folders or videos look the same",
    .operands = "REFERENCE TEST",
    .description =
        "Compares the test with the reference by FLIP (how different they look when one flips "
        "between them), SSIM, PSNR and differences of levels, and judges them by limits. Each "
        "operand is a picture, a video, a folder of pictures, or a pattern such as frame_%04d.png "
        "or frame_####.png. Pictures of folders are paired by name, pictures of patterns by "
        "number. Frames of a video are numbered from 0. A missing or extra frame is a difference, "
        "and so is another size. Alpha is judged on black and on white. Of EXR files, every layer "
        "is judged: colours by the limits, data such as depths by their numbers; a missing or "
        "extra layer is a difference.\n"
        "\n"
        "Exit code 0: the same within the limits; 1: different; 2: usage; 3: something cannot be "
        "read or has values that are not finite outside of masks; 6: --diff or --error-map cannot "
        "be written. --tolerance replaces all default limits.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 2,
    .most_operands = 2,
    .run = run,
};
