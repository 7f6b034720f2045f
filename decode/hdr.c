/* This file reads pictures of Radiance (RGBE and XYZE), whose pixels share an exponent. The format
 * is that of "The RADIANCE Picture File Format" (filefmts.pdf of Radiance). A number of a pixel is
 * mantissa / 256 * 2^(exponent - 128), as OpenImageIO, ImageMagick, pfstools and OpenCV show it.
 * Radiance itself adds half a step to the mantissa, and so does libvips; what kiln shows is
 * therefore up to half a step of a mantissa, 0.4 % of the brightest colour, darker than there. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "decode.h"
#include "kiln_program.h"

enum {
    COMPONENTS = 4,      /* three mantissas and the exponent */
    LEAST_PACKED = 8,    /* pixels of a line whose components may be packed one by one */
    MOST_PACKED = 32767, /* pixels of a line, as above */
    LONGEST_RUN = 127,   /* values of one byte of a packed line */
    WORDS = 512,         /* characters of a line of the header that kiln understands */
};

struct reading {
    struct decode_picture *picture;
    size_t at;           /* of the next byte */
    bool is_cut;         /* the line of the header was too long */
    double exposures[3]; /* what the numbers of each colour were multiplied by */
    bool has_format, is_xyz, has_primaries;
    struct kiln_primaries primaries;
    uint32_t orientation;   /* as in Exif */
    uint32_t columns, rows; /* as they are stored */
};

static bool refuse(const struct reading *reading)
{
    return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                          "the HDR image is broken or cut short");
}

/* ---- header ---------------------------------------------------------------------------------- */

/* Takes a line without its end. A line that is too long for kiln to understand is cut. False: the
 * file has no further line. */
static bool take_line(struct reading *reading, char line[WORDS])
{
    const uint8_t *begin = reading->picture->bytes + reading->at;
    const uint8_t *end = memchr(begin, '\n', reading->picture->size - reading->at);
    if (!end)
        return refuse(reading);
    size_t length = (size_t)(end - begin);
    reading->at += length + 1;
    if (length > 0 && begin[length - 1] == '\r')
        length--;
    reading->is_cut = length >= WORDS;
    length = reading->is_cut ? WORDS - 1 : length;
    memcpy(line, begin, length);
    line[length] = '\0';
    return true;
}

/* Reads numbers that are parted by blanks. False: there are more, fewer, or others. */
static bool take_numbers(const char *text, double *numbers, size_t count)
{
    static const char blanks[] = " \t";
    char word[WORDS];
    for (size_t i = 0; i < count; i++) {
        text += strspn(text, blanks);
        const size_t length = strcspn(text, blanks);
        memcpy(word, text, length);
        word[length] = '\0';
        if (!kiln_text_to_double(word, &numbers[i]))
            return false;
        text += length;
    }
    return text[strspn(text, blanks)] == '\0';
}

/* Takes what all numbers of the file were multiplied by. Each further variable of the kind
 * multiplies those before it. */
static bool multiply(struct reading *reading, const char *name, const double factors[3])
{
    static const double least = 1e-30, most = 1e30;
    bool ok = factors != NULL;
    for (size_t c = 0; ok && c < 3; c++) {
        reading->exposures[c] *= factors[c];
        ok = reading->exposures[c] >= least && reading->exposures[c] <= most;
    }
    return ok || kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                                "the HDR image has an invalid %s; allowed are products of 1e-30 to "
                                "1e30",
                                name);
}

static bool take_exposure(struct reading *reading, const char *text)
{
    double found;
    const bool ok = take_numbers(text, &found, 1);
    return multiply(reading, "EXPOSURE", ok ? (const double[3]){found, found, found} : NULL);
}

static bool take_color_correction(struct reading *reading, const char *text)
{
    double found[3];
    const bool ok = take_numbers(text, found, 3);
    return multiply(reading, "COLORCORR", ok ? found : NULL);
}

static bool take_format(struct reading *reading, const char *text)
{
    text += strspn(text, " \t");
    reading->has_format = true;
    reading->is_xyz = strcmp(text, "32-bit_rle_xyze") == 0;
    return reading->is_xyz || strcmp(text, "32-bit_rle_rgbe") == 0 ||
           kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                          "the HDR image has another FORMAT than 32-bit_rle_rgbe and "
                          "32-bit_rle_xyze");
}

static bool take_primaries(struct reading *reading, const char *text)
{
    double n[8];
    if (!take_numbers(text, n, 8))
        return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                              "the HDR image has PRIMARIES that are not eight numbers");
    reading->has_primaries = true;
    reading->primaries =
        (struct kiln_primaries){{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}, {n[6], n[7]}};
    return true;
}

/* Takes a variable if it changes a pixel. Pixels that are not square (PIXASPECT) are shown as
 * squares, as those of all other formats. */
static bool take_variable(struct reading *reading, const char *line)
{
    static const struct {
        const char *name;
        bool (*take)(struct reading *reading, const char *text);
    } known[] = {{"FORMAT=", take_format},
                 {"EXPOSURE=", take_exposure},
                 {"COLORCORR=", take_color_correction},
                 {"PRIMARIES=", take_primaries}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const size_t length = strlen(known[i].name);
        if (strncmp(line, known[i].name, length) == 0)
            return reading->is_cut ? refuse(reading) : known[i].take(reading, line + length);
    }
    return true;
}

/* Takes the signature and the variables, up to the empty line. */
static bool take_variables(struct reading *reading)
{
    char line[WORDS] = "";
    bool ok = take_line(reading, line);
    while (ok && *line) {
        ok = take_line(reading, line);
        ok = ok && take_variable(reading, line);
    }
    return ok && (reading->has_format || kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                                                        "the HDR image does not say its FORMAT"));
}

/* The struct is one half of the line of sizes, such as "-Y 480". */
struct axis {
    bool is_x, grows;
    int64_t pixels;
};

static bool take_axis(const char **text, struct axis *axis)
{
    const char *at = *text + strspn(*text, " ");
    if ((at[0] != '+' && at[0] != '-') || (at[1] != 'X' && at[1] != 'Y') || at[2] != ' ')
        return false;
    axis->grows = at[0] == '+';
    axis->is_x = at[1] == 'X';
    at += 2;
    at += strspn(at, " ");
    const size_t digits = strspn(at, "0123456789");
    axis->pixels = 0;
    for (size_t i = 0; i < digits && axis->pixels < INT32_MAX; i++)
        axis->pixels = 10 * axis->pixels + (at[i] - '0');
    *text = at + digits;
    return digits > 0;
}

/* Takes the line of sizes. Its first axis leads from line to line of the file, its second along a
 * line; X grows to the right, and Y up. */
static bool take_sizes(struct reading *reading)
{
    static const uint32_t orientations[2][2][2] = {/* [X is first][X grows][Y grows] */
                                                   {{2, 3}, {1, 4}},
                                                   {{6, 7}, {5, 8}}};
    char line[WORDS] = "";
    struct axis first, second;
    const char *text = line;
    if (!take_line(reading, line))
        return false;
    if (reading->is_cut || !take_axis(&text, &first) || !take_axis(&text, &second) ||
        first.is_x == second.is_x || text[strspn(text, " ")] != '\0')
        return refuse(reading);
    const struct axis *x = first.is_x ? &first : &second, *y = first.is_x ? &second : &first;
    reading->orientation = orientations[first.is_x][x->grows][y->grows];
    if (!decode_allows_size(reading->picture, "HDR", x->pixels, y->pixels))
        return false;
    reading->rows = (uint32_t)first.pixels;
    reading->columns = (uint32_t)second.pixels;
    return true;
}

/* ---- lines ----------------------------------------------------------------------------------- */

/* Reads pixels one by one. Mantissas of 1 with a number in the place of the exponent repeat the
 * pixel before that many times; what follows such a number is 256 times as many. */
static bool take_plain(struct reading *reading, uint8_t *line)
{
    const uint8_t *bytes = reading->picture->bytes;
    uint32_t shift = 0;
    for (size_t x = 0; x < reading->columns;) {
        if (reading->picture->size - reading->at < COMPONENTS)
            return refuse(reading);
        const uint8_t *pixel = bytes + reading->at;
        reading->at += COMPONENTS;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            memcpy(line + COMPONENTS * x++, pixel, COMPONENTS);
            shift = 0;
            continue;
        }
        const size_t run = shift < 24 ? (size_t)pixel[3] << shift : SIZE_MAX;
        if (x == 0 || run > reading->columns - x)
            return refuse(reading);
        for (const size_t end = x + run; x < end; x++)
            memcpy(line + COMPONENTS * x, line + COMPONENTS * (x - 1), COMPONENTS);
        shift += 8;
    }
    return true;
}

/* Reads one component of all pixels of a line, in runs. */
static bool take_component(struct reading *reading, uint8_t *line, size_t component)
{
    const uint8_t *bytes = reading->picture->bytes;
    for (size_t x = 0; x < reading->columns;) {
        const size_t left = reading->picture->size - reading->at;
        const uint8_t code = left > 1 ? bytes[reading->at] : 0;
        const bool repeats = code > LONGEST_RUN + 1;
        const size_t run = repeats ? code - (LONGEST_RUN + 1u) : code;
        if (run == 0 || run > reading->columns - x || (!repeats && run > left - 1))
            return refuse(reading);
        reading->at++;
        for (size_t i = 0; i < run; i++)
            line[COMPONENTS * x++ + component] = bytes[reading->at + (repeats ? 0 : i)];
        reading->at += repeats ? 1 : run;
    }
    return true;
}

/* Returns whether the components of the next line are packed one by one, which four bytes that are
 * no pixel announce. */
static bool is_packed(const struct reading *reading)
{
    const uint8_t *at = reading->picture->bytes + reading->at;
    return reading->columns >= LEAST_PACKED && reading->columns <= MOST_PACKED &&
           reading->picture->size - reading->at >= COMPONENTS && at[0] == 2 && at[1] == 2 &&
           at[2] < 128;
}

static bool take_pixels(struct reading *reading, uint8_t *line)
{
    if (!is_packed(reading))
        return take_plain(reading, line);
    const uint8_t *at = reading->picture->bytes + reading->at;
    if ((uint32_t)(at[2] << 8 | at[3]) != reading->columns)
        return refuse(reading);
    reading->at += COMPONENTS;
    bool ok = true;
    for (size_t component = 0; ok && component < COMPONENTS; component++)
        ok = take_component(reading, line, component);
    return ok;
}

/* ---- light ----------------------------------------------------------------------------------- */

static struct kiln_asset_image *make_image(const struct reading *reading)
{
    struct kiln_asset_image *image = calloc(1, sizeof *image);
    if (image) {
        *image = (struct kiln_asset_image){.width = reading->columns,
                                           .height = reading->rows,
                                           .channels = 3,
                                           .type = KILN_IMAGE_F32};
        image->pixels = malloc(kiln_asset_image_bytes(image));
    }
    if (!image || !image->pixels) {
        kiln_asset_image_destroy(&image);
        decode_out_of_memory(reading->picture->error);
    }
    return image;
}

/* Reads all lines. The quotient is computed in double and rounded once. */
static bool read_lines(struct reading *reading, struct kiln_asset_image *image)
{
    double scales[256] = {0.0}; /* for each exponent; 0 means a black pixel */
    for (int exponent = 1; exponent < 256; exponent++)
        scales[exponent] = ldexp(1.0, exponent - 128 - 8);
    uint8_t *line = malloc((size_t)COMPONENTS * reading->columns);
    float *out = image->pixels;
    bool ok = line || decode_out_of_memory(reading->picture->error);
    for (uint32_t y = 0; ok && y < reading->rows; y++) {
        ok = take_pixels(reading, line);
        for (size_t x = 0; ok && x < reading->columns; x++, out += 4) {
            const uint8_t *pixel = line + COMPONENTS * x;
            for (int c = 0; c < 3; c++)
                out[c] = (float)(pixel[c] * scales[pixel[3]] / reading->exposures[c]);
            out[3] = 1.0f;
        }
    }
    free(line);
    return ok;
}

/* Returns whether primaries are those that Radiance means where a file names none. */
static bool are_radiance(const struct kiln_primaries *primaries)
{
    static const struct kiln_primaries own = {
        {0.64, 0.33}, {0.29, 0.60}, {0.15, 0.06}, {1.0 / 3.0, 1.0 / 3.0}};
    static const double most = 1e-3;
    bool near = true;
    for (int i = 0; i < 2; i++)
        near = near && fabs(primaries->red[i] - own.red[i]) < most &&
               fabs(primaries->green[i] - own.green[i]) < most &&
               fabs(primaries->blue[i] - own.blue[i]) < most &&
               fabs(primaries->white[i] - own.white[i]) < most;
    return near;
}

/* Turns numbers into light of sRGB's primaries. Numbers of a file that names no primaries, or
 * Radiance's own, are taken for such light, as all other readers take them; libvips names them in
 * all its files, whose numbers are of sRGB's primaries. Of XYZ, white is that of sRGB, with Y 1, as
 * in ImageMagick. */
static bool show_colors(const struct reading *reading, struct kiln_asset_image *image)
{
    double to_srgb[3][3];
    bool ok = true;
    if (reading->is_xyz)
        ok = kiln_xyz_to_srgb(to_srgb);
    else if (reading->has_primaries && !are_radiance(&reading->primaries) &&
             !kiln_primaries_are_rec709(&reading->primaries))
        ok = kiln_primaries_to_srgb(&reading->primaries, to_srgb);
    else
        return true;
    if (!ok)
        return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                              "the PRIMARIES of the HDR image are no triangle around white");
    kiln_light_convert(to_srgb, image->pixels, (size_t)image->width * image->height);
    return true;
}

struct kiln_asset_image *decode_hdr(struct decode_picture *picture)
{
    struct reading reading = {.picture = picture, .exposures = {1.0, 1.0, 1.0}};
    if (!take_variables(&reading) || !take_sizes(&reading))
        return NULL;
    if (picture->raw)
        reading.exposures[0] = reading.exposures[1] = reading.exposures[2] = 1.0;
    struct kiln_asset_image *image = make_image(&reading);
    bool ok = image && read_lines(&reading, image);
    if (ok && !picture->raw)
        ok = show_colors(&reading, image) &&
             (decode_turn(image, reading.orientation) || decode_out_of_memory(picture->error));
    if (!ok)
        kiln_asset_image_destroy(&image);
    return image;
}
