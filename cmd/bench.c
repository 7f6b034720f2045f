/* This file is the subcommand `kiln bench`, which measures how long techniques, scenes and suites
 * take on this machine. It reads the options, lets the library measure (kiln_bench.h), and prints
 * or saves the results.
 *
 * main.c runs it through bench_command, which its table of commands lists; help and completion read
 * the same struct. What is measured is decided in lib/bench. The words of --format must keep the
 * order of enum kiln_bench_format, since the number of the word is used as the format. Scripts use
 * the names of options, so an option that is renamed keeps its older name for a version. An option
 * that has no effect on what is measured must be refused by check_options. */
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "command.h"
#include "event.h"
#include "overrides.h"
#include "report.h"
#include "signals.h"

static const struct option options[] = {
    {.name = "list", .kind = OPTION_FLAG, .help = "List the suites and how long each takes."},
    {.name = "quick",
     .kind = OPTION_FLAG,
     .help = "Make few and small comparisons, of three turns each, to see that everything runs. "
             "The numbers say nothing about speed."},
    {.name = "output",
     .letter = 'o',
     .kind = OPTION_TEXT,
     .placeholder = "FOLDER",
     .help = "Also write bench.txt, .json, .csv and .md into a folder, and each curve as .dat, .gp "
             "and, where gnuplot is installed, .svg. Older files are replaced."},
    {.name = "format",
     .kind = OPTION_CHOICE,
     .placeholder = "text|json|csv|markdown",
     .help = "What to print: text, JSON or CSV with a row for each measurement, or Markdown with "
             "medians side by side.",
     .fallback = "text"},
    {.name = "repeat",
     .older_name = "repetitions",
     .lost_letter = 'n',
     .lost_to = "dry-run",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Number of turns of a comparison. In a turn, every technique draws one frame.",
     .fallback = "9",
     .min = KILN_BENCH_MIN_REPETITIONS,
     .max = KILN_BENCH_MAX_REPETITIONS},
    {.name = "seconds",
     .kind = OPTION_NUMBER,
     .placeholder = "S",
     .help = "Time limit of a comparison. A comparison that reaches it ends before its last turn, "
             "but after three turns at the earliest.",
     .fallback = "4",
     .max = 3600},
    {.name = "against",
     .kind = OPTION_TEXT,
     .placeholder = "PROGRAM",
     .help =
         "Compare this kiln with another one, mostly an earlier one, on scenes. Both render the "
         "same frames to PNG in turn, in processes of their own. The command prints the "
         "processor time and the elapsed time of a frame, the ratios of neighbours, and "
         "whether the pictures are the same."},
    {.name = "stage",
     .repeats = true,
     .splits_at_commas = true,
     .kind = OPTION_TEXT,
     .placeholder = "STAGE",
     .help = "Compare the techniques of this stage of scenes; separate several stages by commas.",
     .fallback = "all"},
    {.name = "frame",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Frame of a scene that warms up. The frames after it are measured.",
     .fallback = "the middle one",
     .max = UINT32_MAX / 2},
    {.name = "size",
     .kind = OPTION_SIZE,
     .placeholder = "WxH",
     .help = "Size of the picture in pixels for scenes and jobs: --set output.size=[W, H].",
     .scene_key = "output.size"},
    {.name = "parts",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Number of parts that the suite jobs renders the clip in. A part has two seconds, but "
             "at most 600 frames. The clip gets as many frames as the parts have together.",
     .fallback = "64, or 2 with --quick",
     .min = 2,
     .max = KILN_BENCH_MAX_PARTS},
    {.name = "cells",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Cells along an edge of the boxes of the suite gas, in multiples of 16. A box of 256 "
             "takes 3 GiB.",
     .fallback = "64, and then 128",
     .min = 32,
     .max = 512},
    PARAMS_OPTION,
    SET_OPTION,
    ASSET_ROOT_OPTION,
    {.name = "device",
     .kind = OPTION_TEXT,
     .placeholder = "DEVICE",
     .help = "A number from 'kiln devices', a part of a device's name, or 'software'.",
     .fallback = "the first GPU, or else the software device"},
    {.name = "technique",
     .repeats = true,
     .splits_at_commas = true,
     .kind = OPTION_PAIRS,
     .placeholder = "STAGE=NAME",
     .help = "How to run a stage that is not compared; separate several by commas (see 'kiln help "
             "techniques').",
     .fallback = "the technique that suits the device"},
    {.name = "threads",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Number of threads that work beside the device; 0 takes one for each core.",
     .fallback = "0",
     .max = 256},
    {.name = "quiet", .letter = 'q', .kind = OPTION_FLAG, .help = "Print no progress."},
    EVENTS_OPTION,
    HELP_OPTION,
};

/* Holds the lists that struct kiln_bench_params points to. They are freed after the bench. */
struct lists {
    struct overrides overrides;
    struct value_list techniques, stages;
    const char **suites, **scenes;
};

static void lists_free(struct lists *lists)
{
    overrides_free(&lists->overrides);
    value_list_free(&lists->techniques);
    value_list_free(&lists->stages);
    free(lists->suites);
    free(lists->scenes);
}

static bool lists_create(struct lists *lists, const struct arguments *arguments)
{
    *lists = (struct lists){0};
    lists->suites = calloc(arguments->operand_count + 1, sizeof *lists->suites);
    lists->scenes = calloc(arguments->operand_count + 1, sizeof *lists->scenes);
    return lists->suites && lists->scenes && overrides_create(&lists->overrides, arguments) &&
           value_list_create(&lists->techniques, arguments, "technique") &&
           value_list_create(&lists->stages, arguments, "stage");
}

static bool is_scene(const char *operand)
{
    const char *dot = strrchr(operand, '.');
    return dot && (strcasecmp(dot, ".yaml") == 0 || strcasecmp(dot, ".yml") == 0);
}

static void say(void *user, const char *line)
{
    const bool *quiet = user;
    char shown[KILN_MESSAGE_SIZE];
    kiln_shown(shown, sizeof shown, line);
    if (!*quiet)
        fprintf(stderr, "%s\n", shown);
}

static struct kiln_bench_params make_params(const struct arguments *arguments, struct lists *lists,
                                            bool *quiet)
{
    struct kiln_bench_params params = kiln_bench_defaults();
    for (size_t i = 0; i < arguments->operand_count; i++) {
        const char *operand = arguments->operands[i];
        if (is_scene(operand))
            lists->scenes[params.scene_count++] = operand;
        else
            lists->suites[params.suite_count++] = operand;
    }
    params.suites = lists->suites;
    params.scenes = lists->scenes;
    params.scene = overrides_scene_params(&lists->overrides, arguments);
    if (arguments_flag(arguments, "frame"))
        params.frame = arguments_integer(arguments, "frame", 0);
    params.stages = lists->stages.items;
    params.stage_count = lists->stages.count;
    params.against = arguments_text(arguments, "against", NULL);
    params.parts = arguments_integer(arguments, "parts", 0);
    params.cells = (arguments_integer(arguments, "cells", 0) + 15) / 16 * 16;
    params.device = arguments_text(arguments, "device", NULL);
    params.techniques = lists->techniques.items;
    params.technique_count = lists->techniques.count;
    params.threads = arguments_integer(arguments, "threads", params.threads);
    params.repetitions = arguments_integer(arguments, "repeat", params.repetitions);
    params.seconds = arguments_number(arguments, "seconds", params.seconds);
    params.quick = arguments_flag(arguments, "quick");
    const char *scratch = kiln_environment("TMPDIR");
    if (scratch)
        params.scratch = scratch;
    *quiet = arguments_flag(arguments, "quiet");
    params.progress = say;
    params.stop = signals_wants_stop;
    params.user = quiet;
    params.log = report_log();
    return params;
}

/* Refuses options that have no effect on what is measured. */
static int check_options(const struct arguments *arguments, const struct kiln_bench_params *params)
{
    static const struct {
        const char *name;
        bool of_jobs, of_threads; /* these suites take the option, too */
    } options_of_scenes[] = {{"against", false, false}, {"stage", false, false},
                             {"frame", false, true},    {"size", true, false},
                             {"set", true, true},       {"asset-root", true, true}};
    const bool jobs = kiln_bench_names(params, "jobs"),
               threads = kiln_bench_names(params, "threads") && params->scene_count > 0,
               scenes = params->scene_count > 0 && !jobs && !threads;
    if (params->against && params->suite_count > 0)
        return report(KILN_USAGE, "bench: --against is for scenes, not for the suite %s",
                      params->suites[0]);
    if (params->against && params->stage_count > 0)
        return report(KILN_USAGE, "bench: --against compares whole frames, so --stage cannot be "
                                  "given");
    for (size_t i = 0; i < sizeof options_of_scenes / sizeof *options_of_scenes; i++) {
        const char *name = options_of_scenes[i].name;
        if (arguments_flag(arguments, name) && !scenes && !(jobs && options_of_scenes[i].of_jobs) &&
            !(threads && options_of_scenes[i].of_threads))
            return report(KILN_USAGE, "bench: --%s is for scenes, and no scene is %s", name,
                          params->scene_count > 0 ? "measured by itself" : "given");
    }
    if (arguments_flag(arguments, "parts") && !jobs)
        return report(KILN_USAGE,
                      "bench: --parts is for the suite jobs, and the suite is not named");
    if (arguments_flag(arguments, "cells") && !kiln_bench_names(params, "gas"))
        return report(KILN_USAGE,
                      "bench: --cells is for the suite gas, and the suite is not named");
    return 0;
}

static int report_failure(const struct kiln_error *error)
{
    if (error->code == KILN_INTERRUPTED && signals_received())
        return signals_report("bench", "; nothing is written");
    return error->code == KILN_USAGE ? report(KILN_USAGE, "bench: %s", error->message)
                                     : report_error(error);
}

static int write_results(const struct kiln_bench *bench, const struct arguments *arguments)
{
    struct kiln_error error = {0};
    enum kiln_bench_format format =
        (enum kiln_bench_format)arguments_choice(arguments, "format", KILN_BENCH_TEXT);
    if (!kiln_bench_write(bench, format, stdout, &error))
        return KILN_READER_GONE; /* main.c reports that standard output failed */
    const char *folder = arguments_text(arguments, "output", NULL);
    char unplotted[KILN_MESSAGE_SIZE];
    if (folder && !kiln_bench_save(bench, folder, unplotted, &error))
        return report_error(&error);
    if (folder && *unplotted)
        report(KILN_OK, "bench: %s", unplotted);
    if (kiln_bench_measured(bench) > 0)
        return 0;
    if (arguments_flag(arguments, "against"))
        return report(KILN_FRAME_FAILED,
                      "bench: nothing could be measured; the notes of the tables say why");
    return report(KILN_NO_DEVICE, "bench: nothing could be measured on this device; the notes of "
                                  "the tables say why");
}

static void print_suite(void *user, const struct kiln_bench_suite *suite)
{
    double *minutes = user;
    *minutes += suite->minutes;
    printf("  %-10s %4.1f min  %s\n", suite->name, suite->minutes, suite->help);
}

static int list_suites(void)
{
    double minutes = 0;
    kiln_visit_benches(print_suite, &minutes);
    printf("All suites together take %.1f min on two cores without a GPU.\n", minutes);
    return 0;
}

static int run(const struct arguments *arguments)
{
    if (arguments_flag(arguments, "list"))
        return list_suites();
    struct lists lists;
    if (!lists_create(&lists, arguments)) {
        lists_free(&lists);
        return report_no_memory();
    }
    bool quiet;
    const struct kiln_bench_params params = make_params(arguments, &lists, &quiet);
    int code = check_options(arguments, &params);
    if (code == 0) {
        signals_install();
        struct kiln_error error = {0};
        const char *folder = arguments_text(arguments, "output", NULL);
        bool ready = !folder || kiln_bench_prepare(folder, &error);
        struct kiln_bench *bench = ready ? kiln_bench_run(&params, &error) : NULL;
        code = bench ? write_results(bench, arguments) : report_failure(&error);
        kiln_bench_destroy(&bench);
    }
    lists_free(&lists);
    return code;
}

const struct command bench_command = {
    .name = "bench",
    .summary = "measure techniques, scenes and suites",
    .operands = "[SCENE | SUITE]...",
    .description =
        "Measures how long frames and their stages take. For a scene (a file that ends in .yaml), "
        "it measures each technique of each stage. For a suite, it measures what 'kiln bench "
        "--list' says. Without an operand, all suites run. The techniques of a comparison draw one "
        "frame each in turn, so that anything that slows the machine down for a while slows all of "
        "them down. The command prints medians, quartiles, and the ratios of neighbours.\n"
        "\n"
        "The suite jobs takes a scene. It renders a clip of the scene in one run, and again in "
        "parts that start from saved states, each in a process of its own. It prints the processor "
        "time of both. 'jobs_ratio' has the parts and the join as a multiple of the single run and "
        "the bake, which must be at most 1.05. It also has this ratio with the bake on both sides, "
        "and as a multiple of the single run alone. 'jobs_elapsed' is the elapsed time on 1 to "
        "1,000 workers, simulated from the times of the parts.\n"
        "\n"
        "The suite threads takes scenes, too. It draws frames to PNG at two sizes with 1, 2 and 8 "
        "threads, and prints the processor time of a frame, and how much of it no other thread can "
        "share, pass by pass.\n"
        "\n"
        "Values that a paper published stand beside the measured values. Tables go to standard "
        "output, progress to standard error. No picture changes by a choice that is made here by "
        "time.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .most_operands = SIZE_MAX,
    .run = run,
};
