/* The table of output formats, found by suffix. */
#include "output/formats.h"

#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "base/text.h"

static const struct kiln_format *const formats[] = {
    &kiln_format_png, &kiln_format_exr, &kiln_format_mp4,  &kiln_format_webm, &kiln_format_mkv,
    &kiln_format_mov, &kiln_format_gif, &kiln_format_apng, &kiln_format_webp,
};
enum { FORMAT_COUNT = sizeof formats / sizeof *formats };

static void list_suffixes(char *out, size_t size)
{
    size_t length = 0;
    for (size_t i = 0; i < FORMAT_COUNT; i++)
        length += (size_t)snprintf(out + length, size - length, "%s%s", i > 0 ? ", " : "",
                                   formats[i]->suffix);
}

const struct kiln_format *kiln_format_find(const char *path, struct kiln_error *error)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    const char *suffix = strrchr(name, '.');
    char list[128];
    list_suffixes(list, sizeof list);
    if (!suffix || suffix == name) {
        kiln_error_set(error, KILN_USAGE,
                       "%s: the output needs a file name with a suffix that tells its format: %s",
                       *path ? path : "''", list);
        return NULL;
    }
    const char *suffixes[FORMAT_COUNT];
    for (size_t i = 0; i < FORMAT_COUNT; i++) {
        suffixes[i] = formats[i]->suffix;
        if (strcasecmp(suffix, suffixes[i]) == 0)
            return formats[i];
    }
    const char *nearest = kiln_text_nearest(suffix, suffixes, FORMAT_COUNT);
    kiln_error_set(error, KILN_USAGE, "%s: unknown output format '%s'%s%s%s; allowed are %s", path,
                   suffix, nearest ? " (did you mean '" : "", nearest ? nearest : "",
                   nearest ? "'?)" : "", list);
    return NULL;
}

bool kiln_write_outputs(FILE *out)
{
    fprintf(out, "Output formats, by the suffix of the output:\n\n");
    for (size_t i = 0; i < FORMAT_COUNT; i++)
        fprintf(out, "  %-6s %s: %s\n", formats[i]->suffix, formats[i]->name, formats[i]->help);
    fprintf(out,
            "\nImages are numbered: frame_####.png and frame_%%04d.png both give frame_0000.png;\n"
            "without a number in the name of several frames, _0000 is added before the suffix.\n"
            "A percent sign or hash of the name itself is written as %%%% or %%#.\n"
            "Missing folders are made. A file appears under its name only when it is whole.\n");
    return !ferror(out);
}
