/* Opens and closes the file of --json. It belongs to the process, as standard output does. */
#include "json_output.h"

#include <string.h>

#include "event.h"
#include "report.h"

static struct kiln_text_file *file;

const char *json_output_path(const struct arguments *arguments)
{
    const char *path = arguments_text(arguments, "json", NULL);
    return path && strcmp(path, "-") != 0 ? path : NULL;
}

int json_output_open(const struct arguments *arguments, FILE **out)
{
    const struct option_use *use = arguments_last(arguments, "json");
    struct kiln_error error = {0};
    *out = NULL;
    if (!use)
        return 0;
    if (!json_output_path(arguments)) {
        if (events_take_stdout())
            return report(KILN_USAGE, "--json and --events exclude each other on standard output; "
                                      "give one of them a file");
        *out = stdout;
        return 0;
    }
    file = kiln_text_file_open(use->text, arguments_flag(arguments, "force"), &error);
    if (!file)
        return report_error(&error);
    *out = kiln_text_file_stream(file);
    return 0;
}

int json_output_close(int code)
{
    struct kiln_error error = {0};
    const bool has_result = code == 0 || code == KILN_FRAME_FAILED;
    if (!file || kiln_text_file_close(&file, has_result, &error))
        return code;
    return report_error(&error);
}
