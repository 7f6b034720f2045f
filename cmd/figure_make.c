/* Reads the options of `kiln figure sheet`, `triptych` and `strip`, and has the library draw the
 * figure. The functions of these commands call figure_make. `kiln figure --check` and `--update`
 * (cmd/figure.c) call it with the arguments of the command in a figure's sidecar, and with `check`
 * set.
 *
 * So a figure may depend on the arguments that list_command keeps and on the files that they name,
 * and on nothing else: standard input is refused. Renaming or removing an option breaks the
 * sidecars that name it. */
#include "figure_make.h"

#include <stdlib.h>
#include <string.h>

#include "length.h"
#include "overrides.h"
#include "report.h"
#include "signals.h"

/* Owns the lists that struct kiln_figure_params points to while a figure is drawn. */
struct lists {
    struct overrides overrides;
    struct value_list techniques, labels;
    struct kiln_figure_sweep *sweeps;
    struct kiln_figure_inset *insets;
    const char **command;
    struct frame_list frames;
};

static void lists_free(struct lists *lists)
{
    overrides_free(&lists->overrides);
    value_list_free(&lists->techniques);
    value_list_free(&lists->labels);
    free(lists->sweeps);
    free(lists->insets);
    free(lists->command);
    frame_list_free(&lists->frames);
}

static bool lists_create(struct lists *lists, const struct arguments *arguments)
{
    *lists = (struct lists){0};
    lists->sweeps = calloc(arguments->use_count + 1, sizeof *lists->sweeps);
    lists->insets = calloc(arguments->use_count + 1, sizeof *lists->insets);
    lists->command = calloc(arguments->argc + 2, sizeof *lists->command);
    return lists->sweeps && lists->insets && lists->command &&
           overrides_create(&lists->overrides, arguments) &&
           value_list_create(&lists->techniques, arguments, "technique") &&
           value_list_create(&lists->labels, arguments, "label");
}

/* Reads an inset, X,Y,WxH. The four numbers are pixels; if any of them has a decimal point, all
 * four are fractions of the picture. */
static bool read_inset(const char *text, struct kiln_figure_inset *inset)
{
    char copy[96];
    double *values[] = {&inset->x, &inset->y, &inset->width, &inset->height};
    if (strlen(text) >= sizeof copy)
        return false;
    memcpy(copy, text, strlen(text) + 1);
    char *rest = copy;
    for (int i = 0; i < 4; i++) {
        char *piece = strsep(&rest, i < 2 ? "," : i == 2 ? "x" : "");
        if (!piece || !kiln_text_to_double(piece, values[i]))
            return false;
    }
    inset->parts = strchr(text, '.') != NULL;
    return true;
}

/* Reads the options that may be given several times, in the order in which they are given. Returns
 * 0, or the exit code after reporting. */
static int read_repeated(const struct command *command, const struct arguments *arguments,
                         struct lists *lists, struct kiln_figure_params *params)
{
    static const char *const sweeps[] = {[KILN_SWEEP_KEY] = "sweep",
                                         [KILN_SWEEP_TOGETHER] = "with",
                                         [KILN_SWEEP_VARIANT] = "variant"};
    for (size_t i = 0; i < arguments->use_count; i++) {
        const struct option_use *use = &arguments->uses[i];
        for (int kind = 0; kind < 3; kind++) {
            if (strcmp(use->option->name, sweeps[kind]) != 0)
                continue;
            lists->sweeps[params->sweep_count].kind = (enum kiln_sweep_kind)kind;
            lists->sweeps[params->sweep_count++].text = use->text;
        }
        if (strcmp(use->option->name, "inset") == 0 &&
            !read_inset(use->text, &lists->insets[params->inset_count++]))
            return report(
                KILN_USAGE,
                "%s: --inset: found '%s'; expected X,Y,WxH in pixels or in parts, such as "
                "320,180,160x90 or 0.4,0.25,0.2x0.2",
                command->name, use->text);
    }
    return 0;
}

/* Reads a width. A width on paper also sets the resolution and the size of the lettering. */
static int read_width(const struct command *command, const char *text,
                      struct kiln_figure_params *params)
{
    struct length width;
    bool ok = length_read(text, &width);
    if (ok && width.on_paper)
        ok = width.value >= 5 && width.value <= 2000;
    else if (ok)
        ok = width.value >= 16 && width.value <= 16384;
    if (!ok)
        return report(KILN_USAGE,
                      "%s: --width: found '%s'; expected a width on paper from 5mm to 2000mm, such "
                      "as 84mm, 3.3in or 240pt, or 16 to 16384 pixels of each picture",
                      command->name, text);
    if (!width.on_paper) {
        params->width = (uint32_t)width.value;
        return 0;
    }
    params->paper_width_mm = width.value;
    params->text_points = 8;
    if (params->dpi == 0)
        params->dpi = 300;
    return 0;
}

static int read_text_size(const struct command *command, const char *text,
                          struct kiln_figure_params *params)
{
    struct length size;
    bool ok = length_read(text, &size);
    if (ok && size.on_paper) {
        params->text_points = size.value / 25.4 * 72;
        ok = params->text_points >= 4 - 1e-9 && params->text_points <= 72 + 1e-9;
    } else if (ok) {
        params->text_points = 0;
        params->text_size = (uint32_t)size.value;
        ok = size.value >= 8 && size.value <= 64;
    }
    return ok ? 0
              : report(KILN_USAGE,
                       "%s: --text-size: found '%s'; expected 4pt to 72pt on paper, or 8 to 64 "
                       "pixels",
                       command->name, text);
}

static int read_lengths(const struct command *command, const struct arguments *arguments,
                        struct kiln_figure_params *params)
{
    const char *width = arguments_text(arguments, "width", NULL);
    const char *size = arguments_text(arguments, "text-size", NULL);
    int code = width ? read_width(command, width, params) : 0;
    return code == 0 && size ? read_text_size(command, size, params) : code;
}

static struct kiln_figure_params make_params(const struct arguments *arguments,
                                             const struct lists *lists)
{
    struct kiln_figure_params params = kiln_figure_defaults();
    params.inputs = arguments->operands;
    params.input_count = arguments->operand_count;
    params.output = arguments_text(arguments, "output", NULL);
    params.overwrite = arguments_flag(arguments, "force");
    params.scene = overrides_scene_params(&lists->overrides, arguments);
    params.sweeps = lists->sweeps;
    params.insets = lists->insets;
    params.strip = arguments_integer(arguments, "count", params.strip);
    params.columns = arguments_integer(arguments, "columns", 0);
    params.dpi = arguments_integer(arguments, "dpi", 0);
    params.alt = arguments_text(arguments, "alt", NULL);
    params.depfile = arguments_text(arguments, "depfile", NULL);
    params.title = arguments_text(arguments, "title", NULL);
    params.labels = lists->labels.items;
    params.label_count = lists->labels.count;
    params.unlabelled = arguments_flag(arguments, "no-labels");
    params.plain = arguments_flag(arguments, "plain");
    params.dark = arguments_flag(arguments, "dark");
    params.device = arguments_text(arguments, "device", NULL);
    params.techniques = lists->techniques.items;
    params.technique_count = lists->techniques.count;
    params.threads = arguments_integer(arguments, "threads", 0);
    params.stop = signals_wants_stop;
    params.log = report_log();
    return params;
}

/* Lists the arguments of the command, which the sidecar keeps for `kiln figure --check`. The name
 * of a command, such as "figure sheet", becomes two arguments. --force is left out, since it says
 * nothing about the figure. A value that reads "--force" is not left out: arguments_parse accepts
 * it only joined to its option, as in --title=--force. */
static void list_command(const struct command *command, const struct arguments *arguments,
                         struct lists *lists, struct kiln_figure_params *params)
{
    size_t count = 0;
    lists->command[count++] = "figure";
    lists->command[count++] = strchr(command->name, ' ') + 1;
    bool options_ended = false;
    for (size_t i = 0; i < arguments->argc; i++) {
        const char *argument = arguments->argv[i];
        options_ended = options_ended || strcmp(argument, "--") == 0;
        if (options_ended || strcmp(argument, "--force") != 0)
            lists->command[count++] = argument;
    }
    params->command = lists->command;
    params->command_count = count;
}

/* Finds the last frame of the scenes, for a range of frames without an end. It is an error if they
 * have different last frames. A sweep may change a scene's last frame, so the library checks the
 * frames again. */
static int find_last_frame(const struct command *command, const struct arguments *arguments,
                           const struct lists *lists, uint32_t *last)
{
    const struct kiln_scene_params params = overrides_scene_params(&lists->overrides, arguments);
    for (size_t i = 0; i < arguments->operand_count; i++) {
        const char *path = arguments->operands[i];
        if (!kiln_is_scene_name(path))
            return report(
                KILN_USAGE,
                "%s: --frames: '%s' is a clip, whose last frame must be given by its number",
                command->name, path);
        struct kiln_error error = {0};
        struct kiln_scene *scene = kiln_scene_load(path, &params, &error);
        if (!scene)
            return report_scene_error(&error);
        struct kiln_scene_info info = kiln_scene_info_empty();
        kiln_scene_get_info(scene, &info);
        kiln_scene_destroy(&scene);
        if (i > 0 && info.frames - 1 != *last)
            return report(KILN_USAGE,
                          "%s: --frames: '%s' and '%s' have different last frames; give the number "
                          "of the frame",
                          command->name, arguments->operands[0], path);
        *last = info.frames - 1;
    }
    return 0;
}

static int read_frames(const struct command *command, const struct arguments *arguments,
                       struct lists *lists, struct kiln_figure_params *params)
{
    const struct option_use *frames = arguments_last(arguments, "frames");
    uint32_t last = UINT32_MAX - 1;
    if (!frames)
        return 0;
    int code =
        frame_spec_is_open(&frames->frames) ? find_last_frame(command, arguments, lists, &last) : 0;
    if (code == 0)
        code = frames_choose(&lists->frames, frames, command->name, arguments->operands[0], last);
    params->ranges = lists->frames.ranges;
    params->range_count = lists->frames.count;
    return code;
}

int figure_make(const struct command *command, enum kiln_figure_kind kind,
                const struct arguments *arguments, const struct figure_check *check)
{
    if (!arguments_flag(arguments, "output"))
        return report(KILN_USAGE, "%s: needs --output FILE", command->name);
    for (size_t i = 0; i < arguments->operand_count; i++) {
        if (strcmp(arguments->operands[i], "-") == 0)
            return report(
                KILN_USAGE,
                "%s: standard input is not allowed: a figure is drawn again from its files",
                command->name);
    }
    struct lists lists;
    if (!lists_create(&lists, arguments)) {
        lists_free(&lists);
        return report_no_memory();
    }
    struct kiln_figure_params params = make_params(arguments, &lists);
    params.kind = kind;
    params.check = check ? check->sidecar : NULL;
    params.update = check && check->update;
    list_command(command, arguments, &lists, &params);
    int code = read_repeated(command, arguments, &lists, &params);
    code = code ? code : read_frames(command, arguments, &lists, &params);
    code = code ? code : read_lengths(command, arguments, &params);
    struct kiln_figure_result made; /* gets the outcome of a figure that is written; not used */
    struct kiln_error error = {0};
    signals_install_for_job();
    if (code == 0 && !kiln_figure_make(&params, check ? check->result : &made, &error))
        code = error.code == KILN_USAGE ? report(KILN_USAGE, "%s: %s", command->name, error.message)
                                        : report_error(&error);
    lists_free(&lists);
    return code == KILN_INTERRUPTED && signals_received() ? 128 + signals_received() : code;
}
