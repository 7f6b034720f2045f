/* Compares this program with another one, mostly an earlier kiln, for `kiln bench --against`. Both
 * render the same frames of a scene to PNG files, each in a process of its own, in turn. What slows
 * the machine down for a while slows both down, so the ratios of neighbours hold where times do
 * not. Every second pair begins with the other program.
 *
 * Each process reports when a frame's file is whole. The time of a frame is taken between the first
 * and the last of the frames, so that neither the start of the program nor the steps before the
 * first frame count. A program that does not know --events reports nothing; then whole processes
 * are compared instead, of both programs. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "bench/process.h"
#include "bench/suite.h"
#include "scene/work.h"

enum {
    FRAMES = 9, /* of a process: the first one is not timed */
    QUICK_FRAMES = 5,
    OWN_ARGUMENTS = 16
};
/* How long a process of the other program may take: this long, and so many times as long as the
 * process of this program. The first one may have to fill the cache of atlases. */
static const double patience_s = 15, quick_patience_s = 2, patience_times = 20;

enum program { NEW, OLD, PROGRAMS };
static const char *const program_names[PROGRAMS] = {"new", "old"};

enum value { CPU, CLOCK, VALUES };
static const char *const value_names[VALUES] = {"CPU time", "elapsed"};

struct duel {
    const struct kiln_bench_run *run;
    const char *path; /* of the scene */
    struct kiln_scene_info info;
    struct kiln_frame_range frames;
    uint32_t clip_frames; /* frames that the clip needs; 0: it has enough */
    char folder[KILN_PATH_SIZE];
    const char *folders[PROGRAMS];  /* below `folder` */
    const char *pictures[PROGRAMS]; /* patterns of the files in them */
    bool reports_events;            /* both programs know --events */
    uint32_t turns;
    double ms[VALUES][PROGRAMS][KILN_BENCH_MAX_REPETITIONS]; /* of a frame, or of a process */
};

static bool no_memory(struct kiln_error *error)
{
    return kiln_error_no_memory(error, "measurements");
}

static double patience_of(const struct kiln_bench_run *run)
{
    return run->params->quick ? quick_patience_s : patience_s;
}

/* ---- Processes ------------------------------------------------------------------------------- */

struct arguments {
    struct kiln_arena *arena;
    const char **items;
    size_t count;
    bool failed; /* memory was short */
};

static void add(struct arguments *arguments, const char *name, const char *value)
{
    const char *text = kiln_arena_format(arguments->arena, "--%s=%s", name, value);
    arguments->items[arguments->count++] = text;
    arguments->failed |= !text;
}

static void add_range(struct arguments *arguments, struct kiln_frame_range range)
{
    char text[32];
    snprintf(text, sizeof text, "%u-%u", range.first, range.last);
    add(arguments, "frames", text);
}

/* Fills in the arguments of a process that renders the frames: only options that every kiln knows,
 * and those that the caller gave. */
static void fill_arguments(const struct duel *duel, enum program program,
                           struct arguments *arguments)
{
    const struct kiln_bench_params *params = duel->run->params;
    char text[32];
    arguments->items[arguments->count++] = "render";
    arguments->items[arguments->count++] = "--quiet";
    add(arguments, "output", duel->pictures[program]);
    add_range(arguments, duel->frames);
    if (params->device)
        add(arguments, "device", params->device);
    if (params->threads > 0) {
        snprintf(text, sizeof text, "%u", params->threads);
        add(arguments, "threads", text);
    }
    if (params->scene.asset_root)
        add(arguments, "asset-root", params->scene.asset_root);
    for (size_t i = 0; i < params->technique_count; i++)
        add(arguments, "technique", params->techniques[i]);
    for (size_t i = 0; i < params->scene.override_count; i++)
        add(arguments, "set", params->scene.overrides[i]);
    if (duel->clip_frames > 0) {
        snprintf(text, sizeof text, "output.frames=%u", duel->clip_frames);
        add(arguments, "set", text);
    }
    arguments->items[arguments->count++] = "--";
    arguments->items[arguments->count++] = duel->path;
}

/* Renders the frames once. */
static bool render(const struct duel *duel, enum program program, double timeout_s,
                   struct kiln_process *process, struct kiln_error *error)
{
    const struct kiln_bench_params *params = duel->run->params;
    struct arguments arguments = {.arena = duel->run->bench->arena};
    arguments.items = calloc(OWN_ARGUMENTS + params->technique_count + params->scene.override_count,
                             sizeof *arguments.items);
    if (!arguments.items)
        return no_memory(error);
    fill_arguments(duel, program, &arguments);
    *process = (struct kiln_process){.program = program == OLD ? params->against : NULL,
                                     .reports_events = duel->reports_events,
                                     .timeout_s = timeout_s};
    const bool ok = !arguments.failed ? kiln_process_run(duel->run, arguments.items, process, error)
                                      : no_memory(error);
    free(arguments.items);
    return ok;
}

/* Takes the times of a process. */
static void take_times(struct duel *duel, enum program program, const struct kiln_process *process)
{
    const enum kiln_process_point last =
        duel->reports_events ? KILN_PROCESS_LAST : KILN_PROCESS_END;
    double cpu_s = process->cpu_s[last], clock_s = process->clock_s[last];
    uint32_t frames = 1;
    if (duel->reports_events) {
        frames = duel->frames.last - duel->frames.first;
        cpu_s -= process->cpu_s[KILN_PROCESS_FIRST];
        clock_s -= process->clock_s[KILN_PROCESS_FIRST];
    }
    duel->ms[CPU][program][duel->turns] = 1e3 * cpu_s / frames;
    duel->ms[CLOCK][program][duel->turns] = 1e3 * clock_s / frames;
}

/* ---- Pictures -------------------------------------------------------------------------------- */

/* Holds the result of comparing the pictures. */
struct verdict {
    uint32_t pictures, equal;
    char text[KILN_MESSAGE_SIZE];
};

static void count_equal(void *user, const struct kiln_compare_result *result,
                        const struct kiln_compare_frame *frame)
{
    struct verdict *verdict = user;
    (void)result;
    verdict->pictures++;
    verdict->equal += frame->measured && frame->equal;
}

/* Says in a sentence whether the pictures are the same, or how far they are apart. */
static bool compare_pictures(const struct duel *duel, struct verdict *verdict,
                             struct kiln_error *error)
{
    struct kiln_compare_params params = kiln_compare_defaults();
    struct kiln_compare_result result = kiln_compare_result_empty();
    params.reference = duel->pictures[OLD];
    params.test = duel->pictures[NEW];
    params.frame = count_equal;
    params.user = verdict;
    if (!kiln_compare(&params, &result, error))
        return false;
    if (verdict->equal == verdict->pictures) {
        snprintf(verdict->text, sizeof verdict->text, "All %u pictures are the same.",
                 verdict->pictures);
        return true;
    }
    size_t used = (size_t)snprintf(verdict->text, sizeof verdict->text,
                                   "%u of %u pictures differ, %s the limits of kiln "
                                   "compare; at worst",
                                   verdict->pictures - verdict->equal, verdict->pictures,
                                   result.same ? "within" : "beyond");
    for (size_t i = 0; i < result.column_count && used < sizeof verdict->text; i++)
        used +=
            (size_t)snprintf(verdict->text + used, sizeof verdict->text - used, "%s %s %.4g%s%s",
                             i > 0 ? "," : "", result.columns[i].name, result.worst[i],
                             *result.columns[i].unit ? " " : "", result.columns[i].unit);
    if (used < sizeof verdict->text)
        snprintf(verdict->text + used, sizeof verdict->text - used, ".");
    return true;
}

/* ---- Turns ----------------------------------------------------------------------------------- */

static void remove_pictures(const struct duel *duel)
{
    for (int program = 0; program < PROGRAMS; program++)
        kiln_process_remove_folder(duel->folders[program]);
}

/* Renders with one program, whose name stands in front of its error. */
static bool take_run(struct duel *duel, enum program program, double timeout_s,
                     struct kiln_process *process, struct kiln_error *error)
{
    struct kiln_error failure = {0};
    if (render(duel, program, timeout_s, process, &failure)) {
        take_times(duel, program, process);
        return true;
    }
    return kiln_error_set(error, failure.code, "%s: %s", program_names[program], failure.message);
}

/* Draws once with both programs: fills caches, finds out whether the other program knows --events,
 * and compares the pictures. Returns false when one of them cannot render the scene. */
static bool warm_up(struct duel *duel, double *timeout_s, struct verdict *verdict,
                    struct kiln_error *error)
{
    struct kiln_process process;
    duel->reports_events = true;
    if (!take_run(duel, NEW, 0, &process, error))
        return false;
    *timeout_s = patience_of(duel->run) + patience_times * process.elapsed_s;
    bool ok = take_run(duel, OLD, *timeout_s, &process, error);
    if (!ok && error->code == KILN_USAGE && strstr(process.last_line, "--events")) {
        duel->reports_events = false;
        *error = (struct kiln_error){0};
        ok = take_run(duel, OLD, *timeout_s, &process, error);
    }
    ok = ok && compare_pictures(duel, verdict, error);
    remove_pictures(duel);
    return ok;
}

static bool take_turns(struct duel *duel, double timeout_s, struct kiln_error *error)
{
    const struct kiln_bench_run *run = duel->run;
    const double start_s = kiln_clock_seconds();
    for (duel->turns = 0; duel->turns < run->bench->repetitions; duel->turns++) {
        if (duel->turns >= KILN_BENCH_MIN_REPETITIONS &&
            kiln_clock_seconds() - start_s > run->params->seconds)
            break;
        for (uint32_t i = 0; i < PROGRAMS; i++) {
            const enum program program = (enum program)((duel->turns + i) % PROGRAMS);
            struct kiln_process process;
            if (!take_run(duel, program, timeout_s, &process, error))
                return false;
        }
        remove_pictures(duel);
    }
    return true;
}

/* ---- Results --------------------------------------------------------------------------------- */

static bool add_row(const struct duel *duel, enum value value, enum program program,
                    struct kiln_error *error)
{
    const double *own = duel->ms[value][program], *old = duel->ms[value][OLD];
    struct kiln_bench_row row = {.x = duel->frames.first,
                                 .measure = value_names[value],
                                 .technique = program_names[program],
                                 .spread = kiln_spread_of(own, duel->turns)};
    if (program != OLD)
        row.faster = kiln_spread_of_ratios(old, own, duel->turns);
    return kiln_bench_add_row(duel->run->bench, &row, error);
}

static bool add_ratio(const struct duel *duel, enum value value, struct kiln_error *error)
{
    const struct kiln_spread ratio =
        kiln_spread_of_ratios(duel->ms[value][NEW], duel->ms[value][OLD], duel->turns);
    return kiln_bench_add_note(duel->run->bench, error, "%s, new / old: %.3f (%.3f to %.3f).",
                               value_names[value], ratio.median, ratio.first_quartile,
                               ratio.third_quartile);
}

static bool add_results(const struct duel *duel, const struct verdict *verdict,
                        struct kiln_error *error)
{
    for (int value = 0; value < VALUES; value++) {
        if (!add_row(duel, (enum value)value, OLD, error) ||
            !add_row(duel, (enum value)value, NEW, error))
            return false;
    }
    return add_ratio(duel, CPU, error) && add_ratio(duel, CLOCK, error) &&
           kiln_bench_add_note(duel->run->bench, error, "%s", verdict->text) &&
           kiln_bench_add_note(duel->run->bench, error, "%u x %u pixels, frames %u-%u; %s.",
                               duel->info.width, duel->info.height, duel->frames.first,
                               duel->frames.last,
                               duel->reports_events
                                   ? "times are of a frame"
                                   : "times are of the whole process, since old knows no --events");
}

/* Measures, and adds a note in place of rows if a program fails. Only a stop is an error. */
static bool measure(struct duel *duel, struct kiln_error *error)
{
    struct kiln_error failure = {0};
    struct verdict verdict = {0};
    double timeout_s;
    if (warm_up(duel, &timeout_s, &verdict, &failure) && take_turns(duel, timeout_s, &failure))
        return add_results(duel, &verdict, error);
    if (failure.code == KILN_INTERRUPTED) {
        *error = failure;
        return false;
    }
    return kiln_bench_add_note(duel->run->bench, error, "Not measured: %s", failure.message);
}

/* ---- The scene ------------------------------------------------------------------------------- */

static bool choose_frames(struct duel *duel, struct kiln_error *error)
{
    const struct kiln_bench_params *params = duel->run->params;
    struct kiln_scene *scene = kiln_scene_load(duel->path, &params->scene, error);
    if (!scene)
        return false;
    duel->info = kiln_scene_facts(scene);
    kiln_scene_destroy(&scene);
    duel->frames.first = params->frame < 0 ? duel->info.frames / 2 : (uint32_t)params->frame;
    duel->frames.last = duel->frames.first + (params->quick ? QUICK_FRAMES : FRAMES) - 1;
    duel->clip_frames = duel->frames.last < duel->info.frames ? 0 : duel->frames.last + 1;
    return true;
}

static bool make_folder(struct duel *duel, struct kiln_error *error)
{
    const char *scratch = duel->run->params->scratch;
    struct kiln_arena *arena = duel->run->bench->arena;
    if (!kiln_path_join(duel->folder, scratch, "kiln-bench-XXXXXX", error))
        return false;
    if (!mkdtemp(duel->folder))
        return kiln_error_set_errno(error, KILN_IO, errno, "%s: no folder can be made there",
                                    scratch);
    bool ok = true;
    for (int i = 0; i < PROGRAMS; i++) {
        duel->folders[i] = kiln_arena_format(arena, "%s/%s", duel->folder, program_names[i]);
        duel->pictures[i] =
            kiln_arena_format(arena, "%s/%s/%%04d.png", duel->folder, program_names[i]);
        ok = ok && duel->folders[i] && duel->pictures[i];
    }
    return ok || no_memory(error);
}

static bool compare_scene(const struct kiln_bench_run *run, const char *path, const char *title,
                          struct kiln_error *error)
{
    struct duel *duel = calloc(1, sizeof *duel);
    if (!duel)
        return no_memory(error);
    duel->run = run;
    duel->path = path;
    const struct kiln_bench_part part = {.name = path,
                                         .title = title,
                                         .sweep = "frame",
                                         .unit = "ms",
                                         .reference = program_names[OLD]};
    kiln_bench_say(run, "this program and %s", run->params->against);
    bool ok = choose_frames(duel, error) && kiln_bench_begin(run, &part, error);
    if (ok) {
        ok = make_folder(duel, error) && measure(duel, error);
        kiln_process_remove_folder(duel->folder);
    }
    free(duel);
    return ok;
}

/* Fills in the first words of --version, such as "kiln 0.1.0 (ff9c9a5)". KILN_USAGE when the
 * program is not a kiln. */
static bool find_version(const struct kiln_bench_run *run, char version[KILN_MESSAGE_SIZE],
                         struct kiln_error *error)
{
    const char *program = run->params->against;
    const char *arguments[] = {"--version", NULL};
    struct kiln_process process = {.program = program, .timeout_s = patience_of(run)};
    struct kiln_error failure = {0};
    const bool ok = kiln_process_run(run, arguments, &process, &failure);
    if (failure.code == KILN_INTERRUPTED) {
        *error = failure;
        return false;
    }
    if (!ok)
        return kiln_error_set(error, KILN_USAGE, "--against: %s: %s", program, failure.message);
    if (strncmp(process.last_line, "kiln ", 5) != 0)
        return kiln_error_set(error, KILN_USAGE,
                              "--against: %s is not a kiln: its --version is '%.80s'", program,
                              process.last_line);
    snprintf(version, KILN_MESSAGE_SIZE, "%s", process.last_line);
    return true;
}

bool kiln_bench_against(const struct kiln_bench_run *run, struct kiln_error *error)
{
    const struct kiln_bench_params *params = run->params;
    char version[KILN_MESSAGE_SIZE];
    if (!find_version(run, version, error))
        return false;
    const char *title = kiln_arena_format(run->bench->arena, "this program (new) and %s, %s (old)",
                                          params->against, version);
    bool ok = title || no_memory(error);
    for (size_t i = 0; i < params->scene_count && ok; i++) {
        struct kiln_bench_run of_scene = *run;
        of_scene.suite = params->scenes[i];
        ok = compare_scene(&of_scene, params->scenes[i], title, error);
    }
    return ok;
}
