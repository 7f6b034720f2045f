/* Lists the output formats in a table, and finds one by the suffix of a path. */
#include "output/formats.h"

#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "base/text.h"
#include "output/video.h"

static const struct kiln_format *const formats[] = {
    &kiln_format_png, &kiln_format_jpeg, &kiln_format_exr, &kiln_format_mp4,  &kiln_format_webm,
    &kiln_format_mkv, &kiln_format_mov,  &kiln_format_gif, &kiln_format_apng, &kiln_format_webp,
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
        if (strcasecmp(suffix, suffixes[i]) == 0 ||
            (formats[i]->also && strcasecmp(suffix, formats[i]->also) == 0))
            return formats[i];
    }
    const char *nearest = kiln_text_nearest(suffix, suffixes, FORMAT_COUNT);
    kiln_error_set(error, KILN_USAGE, "%s: unknown output format '%s'%s%s%s; allowed are %s", path,
                   suffix, nearest ? " (did you mean '" : "", nearest ? nearest : "",
                   nearest ? "'?)" : "", list);
    return NULL;
}

bool kiln_format_beside(const char *path, const char *ending, char beside[KILN_PATH_SIZE])
{
    const char *slash = strrchr(path, '/');
    const char *suffix = strrchr(slash ? slash : path, '.');
    int stem = suffix ? (int)(suffix - path) : (int)strlen(path);
    int length = snprintf(beside, KILN_PATH_SIZE, "%.*s%s", stem, path, ending);
    return length >= 0 && length < KILN_PATH_SIZE;
}

bool kiln_output_has_quality(const char *path)
{
    struct kiln_error ignored = {0};
    const struct kiln_format *format = kiln_format_find(path, &ignored);
    return !format || format->uses & KILN_USES_QUALITY;
}

bool kiln_output_is_images(const char *path)
{
    struct kiln_error ignored = {0};
    const struct kiln_format *format = kiln_format_find(path, &ignored);
    return format && !format->one_file;
}

bool kiln_write_outputs(FILE *out)
{
    fprintf(out, "Output formats, by the suffix of the output:\n\n");
    for (size_t i = 0; i < FORMAT_COUNT; i++) {
        struct kiln_error reason = {0};
        fprintf(out, "  %-6s %s: %s\n", formats[i]->suffix, formats[i]->name, formats[i]->help);
        if (formats[i]->video && !kiln_video_find(formats[i]->video, &reason))
            fprintf(out, "         not here: %s\n", reason.message);
    }
    static const char notes[] =
        "\nImages are numbered: frame_####.png and frame_%04d.png both give frame_0000.png;\n"
        "without a number in the name of several frames, _0000 is added before the suffix.\n"
        "A percent sign or hash of the name itself is written as %% or %#.\n"
        "Missing folders are made. A file appears under its name only when it is whole.\n"
        "\nA clip is one file of neighbouring frames that starts at time 0; nothing in it tells\n"
        "date or machine, and the same frames give the same bytes with any --threads. The\n"
        "clips of --frames 0-74 and 75-149 are no halves of the whole one's bytes: to split\n"
        "work, render images and encode those. Rates are exact in MP4, MOV and APNG (up to 65535\n"
        "in its fraction, else the nearest, with a warning). GIF counts 1/100 s: of up to 50 "
        "frames\n"
        "a second it holds all, some 1/100 s longer than others, so that time is kept; of more,\n"
        "each second, third... one. A warning says which. While frames are drawn, a GIF takes 3\n"
        "bytes a pixel and frame beside the file, since one palette is made for all.\n"
        "\nAlpha comes from backdrop.transparent; MP4, GIF and JPEG have none and refuse. It is\n"
        "straight, not multiplied into colours. Colours are sRGB; of videos BT.709 with sRGB's\n"
        "transfer function, tagged so.\n"
        "\n--flipbook 8x8 writes 64 frames as cells of one PNG, rows from the top, for game\n"
        "engines. Cell k of n shows frame k/n of --frames, and --size is a cell's; padding\n"
        "comes on top, inside the cell. Beside FILE.png stands FILE.json: the grid, which frames,\n"
        "cells a second, alpha. Straight alpha has the neighbours' colours where it is zero;\n"
        "premultiplied is what shows over black, for additive or premultiplied blending.\n"
        "--flipbook-motion adds FILE_motion.png, to be read as linear, not sRGB: red and green\n"
        "say how far right and down a pixel is in the next cell, (value * 2 - 1) * scale cells,\n"
        "with scale from the JSON (engines with v upwards: negate green). An engine at t between\n"
        "cells a and b mixes a at uv - t * motion and b at uv + (1 - t) * motion. Of the last\n"
        "cell it is 0. All cells must be drawn by one command: chunks of frames make no "
        "flipbook.\n"
        "Its files appear together, the .json last: where that is, they are whole.\n"
        "\n-o - writes frames to standard output: Y4M (4:2:0, BT.709 in limited range, as an "
        "MP4's),\n"
        "or by --pipe bytes in sRGB (rgb24, rgba: straight alpha) or floats (rgbaf32: "
        "little-endian,\n"
        "linear, premultiplied), rows from the top, without any header.\n";
    fputs(notes, out);
    return !ferror(out);
}
