/* Opens and closes the output of --json. The file belongs to the process, as standard output does,
 * so it is a variable of this file. */
#include "json_output.h"

#include <string.h>

#include "event.h"
#include "report.h"

static struct kiln_text_file *file;

static bool is_named_as_state(const char *path)
{
    const size_t length = strlen(path), suffix = strlen(KILN_STATE_SUFFIX);
    return length >= suffix && strcmp(path + length - suffix, KILN_STATE_SUFFIX) == 0;
}

const char *json_output_path(const struct arguments *arguments)
{
    const char *path = arguments_text(arguments, "json", NULL);
    return path && strcmp(path, "-") != 0 ? path : NULL;
}

int json_output_open(const char *command, const struct arguments *arguments, FILE **out)
{
    const struct option_use *use = arguments_last(arguments, "json");
    struct kiln_error error = {0};
    *out = NULL;
    if (!use)
        return 0;
    if (events_are_wanted())
        return report(KILN_USAGE,
                      "%s: --json and --events exclude each other; events of ndjson have all that "
                      "--json has",
                      command);
    if (!json_output_path(arguments)) {
        *out = stdout;
        return 0;
    }
    if (is_named_as_state(use->text))
        return report(KILN_USAGE,
                      "%s: --json: '%s' is a name of a state (" KILN_STATE_SUFFIX
                      "), which only 'kiln bake' writes",
                      command, use->text);
    file = kiln_text_file_open(use->text, arguments_flag(arguments, "force"), &error);
    if (!file)
        return report_error(&error);
    *out = kiln_text_file_stream(file);
    return 0;
}

int json_output_claim(const struct arguments *arguments, const struct kiln_scene *scene)
{
    const char *path = json_output_path(arguments);
    const char *output = arguments_text(arguments, "output", NULL);
    const struct kiln_render_params none = kiln_render_defaults();
    struct kiln_error error = {0};
    if (!path)
        return 0;
    struct kiln_claims *claims = kiln_claims_create();
    int code = claims ? 0 : report_no_memory();
    if (code == 0 && !((!output || kiln_claims_write(claims, output, "--output", &error)) &&
                       kiln_render_claim(scene, &none, claims, &error) &&
                       kiln_claims_write(claims, path, "--json", &error)))
        code = report_error(&error);
    kiln_claims_destroy(&claims);
    return code;
}

bool json_output_begin(struct kiln_json *json, FILE *out)
{
    if (events_are_wanted()) {
        *json = event_begin("result");
    } else if (out) {
        *json = kiln_json_to_file(out);
        kiln_json_begin_object(json, NULL);
        kiln_json_indent_items(json, 2);
    }
    return out || events_are_wanted();
}

void json_output_end(struct kiln_json *json)
{
    if (events_are_wanted()) {
        event_end(json);
    } else {
        kiln_json_end_indented(json, 0);
        kiln_json_finish(json);
    }
}

int json_output_close(int code)
{
    struct kiln_error error = {0};
    if (!file || kiln_text_file_close(&file, exit_code_has_result(code), &error))
        return code;
    return report_error(&error);
}
