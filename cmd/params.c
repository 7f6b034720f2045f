/* Runs kiln params, which lists the parameters of a scene, for people as lines and for programs as
 * JSON, of which a form can be made.
 *
 * The main function finds params_command in the table of commands and calls its `run`. */
#include <stdlib.h>

#include "command.h"
#include "event.h"
#include "json_output.h"
#include "limits.h"
#include "overrides.h"
#include "report.h"
#include "sandbox.h"
#include "scene_in.h"
#include "signals.h"

static const struct option options[] = {
    PARAMS_OPTION,
    SET_OPTION,
    ASSET_ROOT_OPTION,
    LIMITS_OPTION,
    TIMEOUT_OPTION,
    SANDBOX_OPTION,
    JSON_OPTION("an object with the parameters, and the JSON schema of files for --params."),
    {.name = "force", .kind = OPTION_FLAG, .help = "Replace a file that exists."},
    EVENTS_OPTION,
    HELP_OPTION,
};

/* The parameters of a scene, in new memory. */
struct list {
    struct kiln_scene_param *params;
    size_t count;
};

static bool list_create(struct list *list, const struct kiln_scene *scene)
{
    list->count = kiln_scene_list_params(scene, NULL, 0, 0);
    list->params = calloc(list->count + 1, sizeof *list->params);
    for (size_t i = 0; list->params && i < list->count; i++)
        list->params[i].size = sizeof *list->params;
    if (list->params)
        kiln_scene_list_params(scene, list->params, sizeof *list->params, list->count);
    return list->params != NULL;
}

static const char *space_of(const struct kiln_scene_param *param)
{
    return *param->unit && *param->value != '"' && *param->value != '[' ? " " : "";
}

static void print_limit(const char *word, double limit, const struct kiln_scene_param *param)
{
    printf("%s%.10g%s%s", word, limit, *param->unit ? " " : "", param->unit);
}

/* Prints a parameter as a line: its name, kind, value and range, and its help below. */
static void print_text(const struct kiln_scene_param *param)
{
    char shown[KILN_PATH_SIZE];
    const char *space = space_of(param);
    kiln_shown(shown, sizeof shown, param->value);
    printf("%s: %s %s%s%s", param->name, kiln_param_kind_name(param->kind), shown, space,
           *space ? param->unit : "");
    if (param->has_min)
        print_limit(", from ", param->min, param);
    if (param->has_max)
        print_limit(param->has_min ? " to " : ", to ", param->max, param);
    for (size_t i = 0; i < param->word_count; i++) {
        kiln_shown(shown, sizeof shown, param->words[i]);
        printf("%s%s", i == 0 ? ": " : ", ", shown);
    }
    printf("\n");
    if (*param->help) {
        kiln_shown(shown, sizeof shown, param->help);
        printf("    %s\n", shown);
    }
}

static void add_param(struct kiln_json *json, const struct kiln_scene_param *param)
{
    kiln_json_begin_object(json, NULL);
    kiln_json_string(json, "name", param->name);
    kiln_json_string(json, "kind", kiln_param_kind_name(param->kind));
    if (*param->unit)
        kiln_json_string(json, "unit", param->unit);
    kiln_json_raw(json, "default", param->fallback);
    kiln_json_raw(json, "value", param->value);
    if (param->has_min)
        kiln_json_number(json, "min", param->min);
    if (param->has_max)
        kiln_json_number(json, "max", param->max);
    if (param->word_count > 0)
        kiln_json_strings(json, "of", param->words, param->word_count);
    kiln_json_string(json, "help", param->help);
    kiln_json_string(json, "place", param->place);
    kiln_json_end(json);
}

/* Adds the schema of a mapping that gives parameters values. */
static void add_schema(struct kiln_json *json, const struct list *list)
{
    kiln_json_begin_object(json, "schema");
    kiln_json_string(json, "$schema", "http://json-schema.org/draft-07/schema#");
    kiln_json_string(json, "type", "object");
    kiln_json_bool(json, "additionalProperties", false);
    kiln_json_begin_object(json, "properties");
    for (size_t i = 0; i < list->count; i++)
        kiln_json_raw(json, list->params[i].name, list->params[i].schema);
    kiln_json_end(json);
    kiln_json_end(json);
}

static void print_json(FILE *out, const char *path, const struct list *list)
{
    struct kiln_json json;
    if (!json_output_begin(&json, out))
        return;
    kiln_json_string(&json, "scene", path);
    kiln_json_begin_array(&json, "params");
    kiln_json_indent_items(&json, 4);
    for (size_t i = 0; i < list->count; i++)
        add_param(&json, &list->params[i]);
    kiln_json_end_indented(&json, 2);
    add_schema(&json, list);
    json_output_end(&json);
}

static int run(const struct arguments *arguments)
{
    FILE *out = NULL;
    struct overrides overrides;
    struct list list = {.params = NULL};
    struct kiln_error error = {0};
    struct kiln_scene *scene = NULL;
    const char *path = arguments->operands[0];
    signals_install_for_job();
    if (!overrides_create(&overrides, arguments))
        return report_no_memory();
    const struct kiln_scene_params params = overrides_scene_params(&overrides, arguments);
    int code = json_output_open("params", arguments, &out);
    if (code == 0) {
        scene = scene_in_load(path, &params, &error);
        code = scene ? json_output_claim(arguments, scene) : report_scene_error(&error);
    }
    if (code == 0 && !list_create(&list, scene))
        code = report_no_memory();
    if (code == 0)
        print_json(out, path, &list);
    for (size_t i = 0; code == 0 && out != stdout && i < list.count; i++)
        print_text(&list.params[i]);
    free(list.params);
    kiln_scene_destroy(&scene);
    overrides_free(&overrides);
    return code;
}

const struct command params_command = {
    .name = "params",
    .summary = "list the parameters of a scene",
    .operands = "SCENE",
    .description =
        "Lists the parameters that a scene declares, with their kinds, values, ranges and help. "
        "'-' reads the scene from standard input. With --json, a program gets them together with a "
        "JSON schema of the values that they may have, and can make a form of both.\n"
        "\n"
        "Commands that load scenes take values by --set params.NAME=VALUE, or by --params FILE.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = 1,
    .access = ACCESS_READ,
    .run = run,
};
