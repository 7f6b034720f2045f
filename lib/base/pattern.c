/* Parses the pattern of an output's file name, such as "frame_####.png", and makes the name of each
 * frame from it. The user's text is parsed piece by piece, and is never handed to printf as a
 * format. Comments here call the place for a frame's number, such as "####", a number. */
#include "base/pattern.h"

#include <string.h>

#include "base/error.h"

enum { DEFAULT_DIGITS = 4, MAX_DIGITS = 9, MAX_NAME = 255 };

/* Returns the length of a number such as "%d", "%4d" or "%04d" at text, or 0. A width of up to two
 * characters gives the digits, which are filled up with zeros in any case. */
static size_t percent_length(const char *text, uint32_t *digits)
{
    size_t width = strspn(text + 1, "0123456789");
    if (text[0] != '%' || text[1 + width] != 'd' || width > 2)
        return 0;
    uint32_t value = 0;
    for (size_t i = 1; i <= width; i++)
        value = value * 10 + (uint32_t)(text[i] - '0');
    *digits = value > 0 ? value : 1;
    return width + 2;
}

/* Returns whether the path before `name` has a number. Folders may be called "take #1", so a single
 * '#' is none there. They have no escapes, either. */
static bool folder_has_number(const char *path, const char *name)
{
    uint32_t digits = 0;
    for (const char *c = path; c < name; c++) {
        if (*c == '%' ? percent_length(c, &digits) > 0 : strncmp(c, "##", 2) == 0)
            return true;
    }
    return false;
}

/* Holds the pattern that is parsed, and where errors go. */
struct parser {
    struct kiln_path_pattern *pattern;
    const char *path; /* the whole path, for messages */
    struct kiln_error *error;
};

/* Parses the number at c. Returns its length, or 0 with the error. */
static size_t parse_number(const struct parser *parser, const char *c)
{
    struct kiln_path_pattern *pattern = parser->pattern;
    size_t length = *c == '#' ? strspn(c, "#") : percent_length(c, &pattern->digits);
    if (*c == '#') /* MAX_DIGITS + 1: too many, which is refused below */
        pattern->digits = (uint32_t)(length <= MAX_DIGITS ? length : MAX_DIGITS + 1);
    if (length == 0)
        kiln_error_set(
            parser->error, KILN_USAGE,
            "%s: '%.3s' in the file name is not allowed; write %%d, %%04d or #### for the "
            "number of the frame, %%%% for a percent sign, and %%# for a hash",
            parser->path, c);
    else if (pattern->numbered)
        kiln_error_set(parser->error, KILN_USAGE, "%s: the file name has two frame numbers",
                       parser->path);
    else if (pattern->digits > MAX_DIGITS)
        kiln_error_set(parser->error, KILN_USAGE,
                       "%s: the frame number is too wide; allowed are 1 to %d digits", parser->path,
                       MAX_DIGITS);
    else
        return length;
    return 0;
}

static bool parse_name(const struct parser *parser, const char *name)
{
    struct kiln_path_pattern *pattern = parser->pattern;
    size_t before = (size_t)(name - parser->path), after = 0;
    memcpy(pattern->before, parser->path, before);
    for (const char *c = name; *c;) {
        bool escape = strncmp(c, "%%", 2) == 0 || strncmp(c, "%#", 2) == 0;
        if (!escape && (*c == '#' || *c == '%')) {
            size_t length = parse_number(parser, c);
            if (length == 0)
                return false;
            pattern->numbered = true;
            c += length;
            continue;
        }
        c += escape;
        if (pattern->numbered)
            pattern->after[after++] = *c++;
        else
            pattern->before[before++] = *c++;
    }
    pattern->before[before] = '\0';
    pattern->after[after] = '\0';
    return true;
}

/* Adds a number to a name without one: "beam.png" becomes "beam_", digits, ".png". The name must
 * have a suffix. */
static void add_number(struct kiln_path_pattern *pattern)
{
    char *dot = strrchr(pattern->before, '.');
    memcpy(pattern->after, dot, strlen(dot) + 1);
    memcpy(dot, "_", 2); /* and its zero byte */
    pattern->numbered = true;
    pattern->digits = DEFAULT_DIGITS;
}

bool kiln_path_pattern_parse(struct kiln_path_pattern *pattern, const char *path,
                             enum kiln_numbering numbering, struct kiln_error *error)
{
    *pattern = (struct kiln_path_pattern){0};
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    size_t reserve = DEFAULT_DIGITS + 1; /* room for what add_number adds */
    if (strlen(path) + reserve >= KILN_PATH_SIZE || strlen(name) + reserve > MAX_NAME)
        return kiln_error_set(error, KILN_USAGE,
                              "%.200s...: the path is too long; allowed are %d bytes, and %d for "
                              "the file name",
                              path, KILN_PATH_SIZE - DEFAULT_DIGITS - 2,
                              MAX_NAME - DEFAULT_DIGITS - 1);
    if (folder_has_number(path, name))
        return kiln_error_set(error, KILN_USAGE,
                              "%s: the name of a folder has a frame number (## or %%d); only the "
                              "file name may have one",
                              path);
    struct parser parser = {pattern, path, error};
    if (!parse_name(&parser, name))
        return false;
    if (pattern->numbered && numbering == KILN_NUMBER_NEVER)
        return kiln_error_set(
            error, KILN_USAGE,
            "%s: a video or flipbook is one file, so its name cannot have a frame number", path);
    if (!pattern->numbered && numbering == KILN_NUMBER_ALWAYS)
        add_number(pattern);
    return true;
}

bool kiln_path_pattern_format(const struct kiln_path_pattern *pattern, uint32_t frame, char *path,
                              size_t size)
{
    int length = pattern->numbered ? snprintf(path, size, "%s%0*u%s", pattern->before,
                                              (int)pattern->digits, frame, pattern->after)
                                   : snprintf(path, size, "%s", pattern->before);
    return length >= 0 && (size_t)length < size;
}
