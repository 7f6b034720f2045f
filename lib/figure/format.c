/* Holds the table of formats of figures, which has a row for each suffix, and finds a format in it.
 */
#include "figure/format.h"

#include <string.h>
#include <strings.h>

#include "base/error.h"

static const struct kiln_figure_format formats[] = {
    {".png", .of_pixels = kiln_pixels_png},   {".jpg", .of_pixels = kiln_pixels_jpeg},
    {".jpeg", .of_pixels = kiln_pixels_jpeg}, {".svg", .of_drawing = kiln_drawing_svg},
    {".pdf", .of_drawing = kiln_drawing_pdf},
};
enum { FORMATS = sizeof formats / sizeof *formats };

const struct kiln_figure_format *kiln_figure_format_find(const char *path, struct kiln_error *error)
{
    const char *dot = strrchr(path, '.');
    char suffixes[64] = "";
    size_t length = 0;
    for (size_t i = 0; i < FORMATS; i++) {
        if (dot && strcasecmp(dot, formats[i].suffix) == 0)
            return &formats[i];
        const char *before = i == 0 ? "" : i + 1 < FORMATS ? ", " : " or ";
        length += (size_t)snprintf(suffixes + length, sizeof suffixes - length, "%s%s", before,
                                   formats[i].suffix);
    }
    kiln_error_set(error, KILN_USAGE, "%s: the name of a figure must end in %s", path, suffixes);
    return NULL;
}
