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
                       "%s: the output needs a file name with a suffix that names its format: %s",
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

/* The notes of `kiln help outputs`, which stand below its table of formats. */
static const char notes[] =
    "\n"
    "The names of images are numbered: frame_####.png and frame_%04d.png both give "
    "frame_0000.png.\n"
    "Where a name of several frames has no number, _0000 is added before the suffix. A "
    "percent\n"
    "sign or hash of the name itself is written as %% or %#. Missing folders are made. A file\n"
    "appears under its name only when it is whole.\n"
    "\n"
    "A clip is one file of consecutive frames that starts at time 0. It holds neither date "
    "nor\n"
    "machine, and the same frames give the same bytes with any --threads. The clips of\n"
    "--frames 0-74 and 75-149 cannot be put together to the bytes of the whole clip. To split\n"
    "work, use --shard and 'kiln join', or render images and encode them.\n"
    "\n"
    "MP4, MOV and APNG hold exact frame rates. APNG has fractions up to 65535; another rate\n"
    "becomes the nearest fraction, with a warning. GIF counts times in 1/100 s. A GIF of up "
    "to\n"
    "50 frames a second holds all frames; some last 1/100 s longer than others, so that the\n"
    "clip keeps its length. A GIF of a higher rate holds only every second, third or later\n"
    "frame, and a warning says which. One palette serves the whole GIF. Until it is known, "
    "the\n"
    "frames wait in a file beside the GIF, of 3 bytes a pixel.\n"
    "\n"
    "An alpha channel comes from backdrop.transparent. MP4, GIF and JPEG have no alpha, and\n"
    "writing one is an error. Alpha is straight: colours are not multiplied by it. Colours "
    "are\n"
    "sRGB. Videos are BT.709 with sRGB's transfer function, and are tagged so.\n"
    "\n"
    "--flipbook 8x8 writes 64 frames as cells of one PNG for game engines, in rows from the\n"
    "top. Cell k of n shows the frame at k/n of --frames. --size is the size of a cell;\n"
    "padding is added inside the cell. FILE.json beside FILE.png has the grid, the frames, "
    "the\n"
    "cells a second and the kind of alpha. With straight alpha, pixels of alpha 0 have the\n"
    "colours of their neighbours. With premultiplied alpha, colours are those over black, for\n"
    "additive or premultiplied blending. A cell with alpha fades out towards its border\n"
    "(--flipbook-fade), where it is transparent, so a billboard shows no square where a glow\n"
    "or smoke leaves the frame.\n"
    "\n"
    "--flipbook-motion adds FILE_motion.png, which is linear, not sRGB. Red and green say how\n"
    "far right and up a pixel moves until the next cell: (channel - 128) / 127 * scale cells,\n"
    "with scale from the JSON. Houdini, Unity and look.motion of a scene have green up, too;\n"
    "--flipbook-green down is for engines whose v points downwards, such as Unreal. The JSON\n"
    "says which it is. At t between cells a and b, an engine mixes a at uv - t * motion and b\n"
    "at uv + (1 - t) * motion. The motion of the last cell is 0. One command must draw all\n"
    "cells; chunks of frames make no flipbook. The files appear together, the .json last.\n"
    "Where the .json is, all of them are whole.\n"
    "\n"
    "A scene plays such a flipbook by look.atlas and look.motion. It takes scale and green\n"
    "from the JSON if FILE.json is beside FILE_motion.png.\n"
    "\n"
    "-o - writes frames to standard output, in rows from the top, without a header. The\n"
    "default is Y4M (4:2:0, BT.709 in limited range, as in an MP4). --pipe rgb24 and rgba\n"
    "write bytes in sRGB, with straight alpha; rgbaf32 writes floats (little-endian, linear,\n"
    "premultiplied).\n";

bool kiln_write_outputs(FILE *out)
{
    fprintf(out, "Output formats, by the suffix of the output:\n\n");
    for (size_t i = 0; i < FORMAT_COUNT; i++) {
        struct kiln_error reason = {0};
        fprintf(out, "  %-6s %s: %s\n", formats[i]->suffix, formats[i]->name, formats[i]->help);
        if (formats[i]->video && !kiln_video_find(formats[i]->video, &reason))
            fprintf(out, "         not here: %s\n", reason.message);
    }
    fputs(notes, out);
    return !ferror(out);
}
