/* Runs kiln plan, which draws one frame and estimates from it what a clip costs and what each of
 * several tasks would do. */
#include <inttypes.h>
#include <stdlib.h>

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
    {.name = "tasks",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Number of tasks that draw the clip together, as with 'kiln render --shard I/N'.",
     .fallback = "1",
     .min = 1,
     .max = 1000000},
    {.name = "states",
     .kind = OPTION_TEXT,
     .placeholder = "STATES",
     .access = ACCESS_READ,
     .help = "A folder of 'kiln bake'. The tasks start at its states."},
    {.name = "frame",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "The frame to measure.",
     .fallback = "the lightest and the heaviest frame",
     .max = UINT32_MAX},
    SIZE_OPTION,
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
    JSON_OPTION("one object."),
    {.name = "force", .kind = OPTION_FLAG, .help = "Replace a file of --json that exists."},
    EVENTS_OPTION,
    HELP_OPTION,
};

/* Holds the state of the report while the library visits the tasks in order. */
struct planning {
    const char *scene_path;
    FILE *json_out; /* output of --json, or NULL */
    struct kiln_json json;
    bool has_json; /* JSON is wanted, and its object has begun */
    double cpu_s;  /* processor time of the tasks so far, s */
};

static bool prints_text(const struct planning *planning)
{
    return planning->json_out != stdout;
}

/* ---- text ------------------------------------------------------------------------------------ */

static void print_head(const struct planning *planning, const struct kiln_plan *plan)
{
    print_name(planning->scene_path);
    printf(": %" PRIu32 " part%s of %" PRIu32 " frames, motion %.16s\n", plan->parts,
           plan->parts == 1 ? "" : "s", plan->part_frames, plan->motion);
    printf("measured at frame %" PRIu32 ": set-up %.2f, a step %.4f, a frame %.3f seconds of CPU; "
           "%.0f MiB\n",
           plan->frame, plan->setup_cpu_s, plan->step_cpu_s, plan->frame_cpu_s,
           (double)plan->memory_bytes / 1048576.0);
    printf("  %5s  %-11s  %-15s  %10s  %8s  %10s\n", "task", "parts", "frames", "from step",
           "steps", "CPU s");
}

static void print_task(const struct kiln_plan_task *task)
{
    char parts[32], frames[32];
    if (task->first_part == task->end) {
        printf("  %5" PRIu32 "  none\n", task->index + 1);
        return;
    }
    const int length = snprintf(parts, sizeof parts, "%" PRIu32, task->first_part + 1);
    if (task->end > task->first_part + 1)
        snprintf(parts + length, sizeof parts - (size_t)length, "-%" PRIu32, task->end);
    snprintf(frames, sizeof frames, "%" PRIu32 "-%" PRIu32, task->frames.first, task->frames.last);
    printf("  %5" PRIu32 "  %-11s  %-15s  %10" PRIu32 "  %8" PRIu64 "  %10.2f\n", task->index + 1,
           parts, frames, task->state_step, task->steps, task->cpu_s);
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static void begin_json(struct planning *planning, const struct kiln_plan *plan)
{
    struct kiln_json *json = &planning->json;
    planning->has_json = json_output_begin(json, planning->json_out);
    if (!planning->has_json)
        return;
    kiln_json_string(json, "scene", planning->scene_path);
    kiln_json_string(json, "motion", plan->motion);
    kiln_json_string(json, "techniques", plan->techniques);
    kiln_json_uint(json, "parts", plan->parts);
    kiln_json_uint(json, "part_frames", plan->part_frames);
    kiln_json_begin_object(json, "measured");
    kiln_json_uint(json, "frame", plan->frame);
    kiln_json_uint(json, "steps", plan->steps);
    kiln_json_rounded(json, "setup_cpu_s", plan->setup_cpu_s, 6);
    kiln_json_rounded(json, "step_cpu_s", plan->step_cpu_s, 6);
    kiln_json_rounded(json, "frame_cpu_s", plan->frame_cpu_s, 6);
    kiln_json_uint(json, "memory_bytes", plan->memory_bytes);
    kiln_json_end(json);
    kiln_json_begin_array(json, "tasks");
    kiln_json_indent_items(json, 4);
}

static void add_task(struct kiln_json *json, const struct kiln_plan_task *task)
{
    const bool empty = task->first_part == task->end;
    kiln_json_begin_object(json, NULL);
    kiln_json_uint(json, "task", task->index + 1);
    kiln_json_uint(json, "first_part", task->first_part);
    kiln_json_uint(json, "parts", task->end - task->first_part);
    if (empty) {
        kiln_json_null(json, "frames");
    } else {
        kiln_json_pair(json, "frames", task->frames.first, task->frames.last);
        kiln_json_uint(json, "from_step", task->state_step);
        kiln_json_bool(json, "from_state", task->has_state);
        kiln_json_uint(json, "steps", task->steps);
        kiln_json_rounded(json, "cpu_s", task->cpu_s, 6);
    }
    kiln_json_end(json);
}

static void end_json(struct planning *planning)
{
    struct kiln_json *json = &planning->json;
    kiln_json_end_indented(json, 2);
    kiln_json_rounded(json, "cpu_s", planning->cpu_s, 6);
    json_output_end(json);
}

static void show_task(void *user, const struct kiln_plan *plan, const struct kiln_plan_task *task)
{
    struct planning *planning = user;
    if (task->index == 0)
        begin_json(planning, plan);
    if (planning->has_json)
        add_task(&planning->json, task);
    if (prints_text(planning)) {
        if (task->index == 0)
            print_head(planning, plan);
        print_task(task);
    }
    planning->cpu_s += task->cpu_s;
}

/* ---- running --------------------------------------------------------------------------------- */

static int report_failure(const struct planning *planning, const struct kiln_error *error)
{
    return error->code == KILN_INTERRUPTED ? signals_report(planning->scene_path, "%s", "")
                                           : report_error(error);
}

static int run_plan(const struct arguments *arguments, const struct kiln_scene *scene,
                    const struct value_list *techniques)
{
    struct planning planning = {.scene_path = arguments->operands[0]};
    const struct option_use *frame = arguments_last(arguments, "frame");
    const struct kiln_plan_params params = {
        .size = sizeof params,
        .tasks = arguments_integer(arguments, "tasks", 1),
        .states = arguments_text(arguments, "states", NULL),
        .frame = frame ? (int64_t)frame->integer[0] : -1,
        .techniques = techniques->items,
        .technique_count = techniques->count,
        .threads = arguments_integer(arguments, "threads", 0),
        .stop = signals_wants_stop,
        .task = show_task,
        .user = &planning,
        .log = report_log(),
    };
    struct kiln_plan plan = kiln_plan_empty();
    struct kiln_error error = {0};
    int code = json_output_open("plan", arguments, &planning.json_out);
    code = code ? code : json_output_claim(arguments, scene);
    struct kiln_device *device = code ? NULL : open_device(arguments, techniques, &code);
    if (device && !kiln_plan_tasks(device, scene, &params, &plan, &error))
        code = report_failure(&planning, &error);
    else if (device && planning.has_json)
        end_json(&planning);
    if (code == 0 && prints_text(&planning) && params.tasks > 1)
        printf("  all of them: %.2f seconds of CPU\n", planning.cpu_s);
    kiln_device_close(&device);
    return code;
}

static int run(const struct arguments *arguments)
{
    struct overrides overrides = {0};
    struct value_list techniques = {0};
    struct kiln_error error = {0};
    struct kiln_scene *scene = NULL;
    int code = 0;
    signals_install_for_job();
    if (!overrides_create(&overrides, arguments) ||
        !value_list_create(&techniques, arguments, "technique"))
        code = report_no_memory();
    if (code == 0) {
        const struct kiln_scene_params params = overrides_scene_params(&overrides, arguments);
        scene = scene_in_load(arguments->operands[0], &params, &error);
        code = scene ? run_plan(arguments, scene, &techniques) : report_scene_error(&error);
    }
    kiln_scene_destroy(&scene);
    overrides_free(&overrides);
    value_list_free(&techniques);
    return code;
}

const struct command plan_command = {
    .name = "plan",
    .summary = "estimate what a clip costs, and divide it into tasks",
    .operands = "SCENE",
    .description =
        "Draws two frames, that with the least and that with the most work, and estimates "
        "from their times what each of N tasks would do: "
        "its parts of the clip, its frames, the steps to them, seconds of CPU and "
        "memory. Encoding is not measured.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = 1,
    .access = ACCESS_READ,
    .run = run,
};
