/* This file decodes PNG pictures by libpng, row by row into the picture. Chunks that do not change
 * a pixel are skipped: compressed texts can unpack to a thousand times their size. */
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "decode.h"

struct reading {
    struct decode_picture *picture;
    size_t at; /* position in the file's bytes */
    png_structp png;
    png_infop info;
    struct kiln_asset_image *image;
    png_infop end; /* of the chunks behind the pixels */
    bool lacks_memory;
    bool is_whole;  /* all rows are read */
    bool has_ended; /* more bytes were wanted than there are */
    bool has_bad_checksum;
    char complaint[128];
};

static void on_failure(png_structp png, png_const_charp message)
{
    struct reading *reading = png_get_error_ptr(png);
    snprintf(reading->complaint, sizeof reading->complaint, "%s", message);
    png_longjmp(png, 1);
}

/* Notes the first chunk with a wrong checksum, and Exif data that libpng refuses; it leaves out
 * both. Its other warnings are about what changes no pixel. */
static void on_warning(png_structp png, png_const_charp message)
{
    struct reading *reading = png_get_error_ptr(png);
    const int length = (int)strcspn(message, ":");
    const bool checksum = strcmp(message + length, ": CRC error") == 0;
    if (checksum && !reading->has_bad_checksum)
        decode_warn(reading->picture, "its chunk %.*s has a wrong checksum and is ignored", length,
                    message);
    else if (strcmp(message, "eXIf: incorrect byte-order specifier") == 0 ||
             strcmp(message, "eXIf: too short") == 0)
        decode_warn(reading->picture, DECODE_BROKEN_EXIF);
    reading->has_bad_checksum = reading->has_bad_checksum || checksum;
}

static png_voidp allocate(png_structp png, png_alloc_size_t size)
{
    struct reading *reading = png_get_mem_ptr(png);
    void *memory = malloc(size);
    reading->lacks_memory = reading->lacks_memory || !memory;
    return memory;
}

static void release(png_structp png, png_voidp memory)
{
    (void)png;
    free(memory);
}

static void on_read(png_structp png, png_bytep out, size_t size)
{
    struct reading *reading = png_get_io_ptr(png);
    reading->has_ended = size > reading->picture->size - reading->at;
    if (reading->has_ended)
        png_error(png, "the file ends too early");
    memcpy(out, reading->picture->bytes + reading->at, size);
    reading->at += size;
}

static bool open_file(struct reading *reading)
{
    reading->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, reading, on_failure, on_warning,
                                            reading, allocate, release);
    reading->info = reading->png ? png_create_info_struct(reading->png) : NULL;
    reading->end = reading->png ? png_create_info_struct(reading->png) : NULL;
    return reading->info && reading->end;
}

static void choose_chunks(struct reading *reading)
{
    /* All chunks that libpng knows and that do not change a pixel. */
    static const png_byte ignored[] = "iTXt\0tEXt\0zTXt\0sPLT\0hIST\0pCAL\0sCAL\0oFFs\0"
                                      "pHYs\0tIME\0bKGD\0sBIT";
    enum { IGNORED = sizeof ignored / 5, MOST_CHUNK_BYTES = 16 << 20 };
    png_set_keep_unknown_chunks(reading->png, PNG_HANDLE_CHUNK_NEVER, ignored, IGNORED);
    png_set_keep_unknown_chunks(reading->png, PNG_HANDLE_CHUNK_NEVER, NULL, 0);
    png_set_keep_unknown_chunks(reading->png, PNG_HANDLE_CHUNK_ALWAYS, (png_const_bytep) "cICP", 1);
    png_set_chunk_malloc_max(reading->png, MOST_CHUNK_BYTES);
    png_set_crc_action(reading->png, PNG_CRC_ERROR_QUIT, PNG_CRC_WARN_DISCARD);
    png_set_user_limits(reading->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX); /* make_image checks it */
    png_set_read_fn(reading->png, reading, on_read);
}

/* Counts the channels of the file, before libpng expands a palette or a transparent colour. */
static uint32_t count_channels(const struct reading *reading)
{
    const int type = png_get_color_type(reading->png, reading->info);
    const uint32_t colours = type & PNG_COLOR_MASK_COLOR ? 3 : 1;
    const bool alpha =
        (type & PNG_COLOR_MASK_ALPHA) || png_get_valid(reading->png, reading->info, PNG_INFO_tRNS);
    return colours + alpha;
}

static bool make_image(struct reading *reading)
{
    png_structp png = reading->png;
    const bool deep = png_get_bit_depth(png, reading->info) == 16;
    const uint32_t width = png_get_image_width(png, reading->info);
    const uint32_t height = png_get_image_height(png, reading->info);
    if (!decode_allows_size(reading->picture, "PNG", width, height))
        return false;
    struct kiln_asset_image *image = reading->image = calloc(1, sizeof *image);
    if (!image)
        return decode_out_of_memory(reading->picture->error);
    *image = (struct kiln_asset_image){.width = width,
                                       .height = height,
                                       .channels = count_channels(reading),
                                       .type = deep ? KILN_IMAGE_U16 : KILN_IMAGE_U8,
                                       .srgb = true};
    image->pixels = malloc(kiln_asset_image_bytes(image));
    return image->pixels || decode_out_of_memory(reading->picture->error);
}

/* Makes libpng convert all formats to red, green, blue and alpha of 8 or 16 bits. */
static void set_transforms(struct reading *reading)
{
    png_structp png = reading->png;
    png_set_expand(png);
    png_set_gray_to_rgb(png);
    png_set_filler(png, 0xffff, PNG_FILLER_AFTER);
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    png_set_swap(png);
#endif
}

static void read_rows(struct reading *reading)
{
    struct kiln_asset_image *image = reading->image;
    const size_t stride = kiln_asset_image_bytes(image) / image->height;
    const int passes = png_set_interlace_handling(reading->png);
    png_read_update_info(reading->png, reading->info);
    if (png_get_rowbytes(reading->png, reading->info) != stride)
        png_error(reading->png, "rows of an unknown size");
    for (int pass = 0; pass < passes; pass++) {
        for (uint32_t y = 0; y < image->height; y++)
            png_read_row(reading->png, (png_bytep)image->pixels + y * stride, NULL);
    }
    reading->is_whole = true;
    png_read_end(reading->png, reading->end);
}

/* Reads the picture. All of libpng's errors longjmp to this function, so its locals must not change
 * after setjmp. */
static bool read_file(struct reading *reading)
{
    if (setjmp(png_jmpbuf(reading->png))) {
        if (reading->is_whole && reading->has_ended) {
            decode_warn(reading->picture, "its end is missing (chunk IEND)");
            return true;
        }
        return reading->lacks_memory ? decode_out_of_memory(reading->picture->error)
                                     : kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                                                      "the PNG image is broken or cut short (%s)",
                                                      reading->complaint);
    }
    choose_chunks(reading);
    png_read_info(reading->png, reading->info);
    if (!make_image(reading))
        return false;
    set_transforms(reading);
    read_rows(reading);
    return true;
}

/* ---- what the numbers mean ------------------------------------------------------------------- */

/* The chunk cICP has numbers of ITU-T H.273 for primaries and transfer. */
static const struct {
    png_byte number;
    struct kiln_primaries primaries;
} known_primaries[] = {
    {1, {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}}},   /* Rec. 709 */
    {5, {{0.64, 0.33}, {0.29, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}}},   /* Rec. 601, 625 lines */
    {6, {{0.63, 0.34}, {0.31, 0.595}, {0.155, 0.07}, {0.3127, 0.3290}}}, /* Rec. 601, 525 lines */
    {9, {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}}}, /* Rec. 2020 */
    {12, {{0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, {0.3127, 0.3290}}},     /* Display P3 */
};

/* Finds the curve of a transfer characteristic. */
static bool find_curve(png_byte number, struct kiln_curve *curve)
{
    switch (number) {
    case 1: /* Rec. 709, 601 and 2020: what a display shows of them (ITU-R BT.1886) */
    case 6:
    case 14:
    case 15:
        *curve = kiln_power_curve(2.4f);
        return true;
    case 4:
        *curve = kiln_power_curve(2.2f);
        return true;
    case 5:
        *curve = kiln_power_curve(2.8f);
        return true;
    case 8:
        *curve = kiln_power_curve(1.0f);
        return true;
    case 13:
        *curve = kiln_srgb_curve();
        return true;
    default:
        return false;
    }
}

static bool set_curves(struct kiln_color *color, struct kiln_curve curve,
                       const struct kiln_primaries *primaries)
{
    for (int i = 0; i < 3; i++)
        color->curves[i] = curve;
    return kiln_primaries_to_srgb(primaries, color->to_srgb);
}

/* Looks for the chunk cICP, which comes before all others. *known: there is one. False: kiln
 * cannot show what it says. */
static bool find_cicp(const struct reading *reading, struct kiln_color *color, bool *known)
{
    png_unknown_chunkp chunks = NULL;
    const int count = png_get_unknown_chunks(reading->png, reading->info, &chunks);
    const png_byte *data = NULL;
    for (int i = 0; i < count && !data; i++) {
        if (memcmp(chunks[i].name, "cICP", 4) == 0 && chunks[i].size == 4)
            data = chunks[i].data;
    }
    *known = data != NULL;
    if (!data)
        return true;
    struct kiln_curve curve;
    for (size_t i = 0; i < sizeof known_primaries / sizeof *known_primaries; i++) {
        if (known_primaries[i].number == data[0] && data[2] == 0 && data[3] == 1 &&
            find_curve(data[1], &curve))
            return set_curves(color, curve, &known_primaries[i].primaries);
    }
    return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                          "the PNG image has the colours %u/%u/%u/%u (cICP) of ITU-T H.273, which "
                          "cannot be shown; allowed are RGB of full range with the primaries 1, 5, "
                          "6, 9 or 12 and the transfer 1, 4, 5, 6, 8, 13, 14 or 15",
                          data[0], data[1], data[2], data[3]);
}

/* Reads the chunks gAMA and cHRM. A power near 2.2 alone stands for sRGB, and primaries alone for
 * nothing, as in browsers. */
static bool find_gamma(const struct reading *reading, struct kiln_color *color)
{
    double gamma = 0.0;
    struct kiln_primaries p = kiln_rec709;
    if (png_get_gAMA(reading->png, reading->info, &gamma) == 0 || !(gamma > 0.0 && gamma < 100.0))
        return false;
    const bool has_primaries =
        png_get_cHRM(reading->png, reading->info, &p.white[0], &p.white[1], &p.red[0], &p.red[1],
                     &p.green[0], &p.green[1], &p.blue[0], &p.blue[1]) != 0;
    if (!has_primaries && 2.2 * gamma > 0.95 && 2.2 * gamma < 1.05)
        return false;
    return set_curves(color, kiln_power_curve((float)(1.0 / gamma)), &p);
}

/* Returns how the picture is turned. Exif data may come before the pixels or behind them. */
static uint32_t find_orientation(const struct reading *reading)
{
    const png_infop places[2] = {reading->info, reading->end};
    for (int i = 0; i < 2; i++) {
        png_bytep exif = NULL;
        png_uint_32 size = 0;
        if (png_get_eXIf_1(reading->png, places[i], &size, &exif) != 0 && exif)
            return decode_exif_orientation(reading->picture, exif, size);
    }
    return 1;
}

/* Makes the picture that is meant. The order of the chunks' precedence is that of PNG's
 * specification (third edition, 4.3). */
static bool show(struct reading *reading)
{
    struct kiln_color color;
    struct decode_meaning meaning = {.orientation = find_orientation(reading)};
    png_charp name;
    png_bytep profile = NULL;
    png_uint_32 profile_size = 0;
    int compression, intent;
    bool known = false;
    if (!reading->picture->raw && !find_cicp(reading, &color, &known))
        return false;
    if (known) {
        meaning.color = &color;
    } else if (png_get_iCCP(reading->png, reading->info, &name, &compression, &profile,
                            &profile_size) != 0) {
        meaning.profile = profile;
        meaning.profile_size = profile_size;
    } else if (png_get_sRGB(reading->png, reading->info, &intent) == 0 &&
               find_gamma(reading, &color)) {
        meaning.color = &color;
    }
    return decode_show(reading->picture, reading->image, &meaning);
}

struct kiln_asset_image *decode_png(struct decode_picture *picture)
{
    struct reading reading = {.picture = picture};
    bool ok = open_file(&reading);
    ok = ok ? read_file(&reading) : decode_out_of_memory(picture->error);
    if (ok && png_get_color_type(reading.png, reading.info) == PNG_COLOR_TYPE_PALETTE)
        decode_find_alpha(reading.image); /* only the pixels tell whether a palette has alpha */
    ok = ok && show(&reading);
    png_destroy_read_struct(&reading.png, &reading.info, &reading.end);
    if (!ok)
        kiln_asset_image_destroy(&reading.image);
    return reading.image;
}
