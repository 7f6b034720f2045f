/* This file reads pages of TIFF and BigTIFF files by libtiff, which undoes the compression. What
 * the samples mean, and which images of a file are pages, is decided by kiln (tiff_tags.c,
 * tiff_samples.c): libtiff's own conversion to RGBA guesses what it does not know. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "tiff_file.h"

static struct tiff_library library;
static bool is_open;

bool decode_tiff_begin(struct kiln_error *error)
{
#define FIND(function) {#function, &library.function},
    static const struct kiln_library_function functions[] = {TIFF_FUNCTIONS(FIND)};
#undef FIND
    if (!kiln_library_open("libtiff.so.6", "libtiff6", functions,
                           sizeof functions / sizeof *functions, error))
        return false;
    library.TIFFSetErrorHandler(NULL);
    library.TIFFSetWarningHandler(NULL);
    is_open = true;
    return true;
}

enum {
    MOST_BLOCK = 1 << 30,               /* bytes of a decoded strip or tile */
    MOST_IMAGES = KILN_MAX_IMAGE_PAGES, /* of a file, pages and others */
};

/* ---- faults ---------------------------------------------------------------------------------- */

bool decode_tiff_refuse(struct tiff_reading *reading, const char *what)
{
    return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                          "a TIFF image %s cannot be read", what);
}

bool decode_tiff_refuse_broken(struct tiff_reading *reading)
{
    const char *detail = reading->detail;
    return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                          "the TIFF image is broken or cut short%s%s%s", *detail ? " (" : "",
                          detail, *detail ? ")" : "");
}

static void keep_message(struct tiff_reading *reading, const char *format, va_list arguments)
{
    if (!reading->detail[0])
        vsnprintf(reading->detail, sizeof reading->detail, format, arguments);
}

static int on_error(TIFF *file, void *user, const char *module, const char *format, va_list values)
{
    struct tiff_reading *reading = user;
    (void)file;
    (void)module;
    keep_message(reading, format, values);
    reading->guessed = reading->guessed || reading->in_pixels;
    return 1; /* nothing else reports it */
}

/* The decoders of JPEG and of fax fill pixels with what they guess where data are broken, and only
 * warn. Other warnings change no pixel. */
static int on_warning(TIFF *file, void *user, const char *module, const char *format,
                      va_list values)
{
    struct tiff_reading *reading = user;
    (void)file;
    if (reading->in_pixels && module &&
        (strncmp(module, "JPEG", 4) == 0 || strncmp(module, "Fax", 3) == 0)) {
        keep_message(reading, format, values);
        reading->guessed = true;
    }
    return 1;
}

/* ---- the bytes of the file ------------------------------------------------------------------- */

static tmsize_t read_bytes(thandle_t user, void *to, tmsize_t size)
{
    struct tiff_reading *reading = user;
    const size_t whole = reading->picture->size;
    const size_t left = reading->place < whole ? whole - (size_t)reading->place : 0;
    const size_t count = size < 0 ? 0 : (size_t)size < left ? (size_t)size : left;
    if (count > 0)
        memcpy(to, reading->picture->bytes + reading->place, count);
    reading->place += count;
    return (tmsize_t)count;
}

static tmsize_t write_bytes(thandle_t user, void *from, tmsize_t size)
{
    (void)user;
    (void)from;
    (void)size;
    return -1;
}

static toff_t seek_byte(thandle_t user, toff_t offset, int from)
{
    struct tiff_reading *reading = user;
    if (from == SEEK_CUR)
        offset += reading->place;
    else if (from == SEEK_END)
        offset += reading->picture->size;
    reading->place = offset;
    return offset;
}

static int close_bytes(thandle_t user)
{
    (void)user;
    return 0;
}

static toff_t size_of_bytes(thandle_t user)
{
    const struct tiff_reading *reading = user;
    return reading->picture->size;
}

static bool open_file(struct tiff_reading *reading)
{
    TIFFOpenOptions *options = reading->tiff->TIFFOpenOptionsAlloc();
    if (!options)
        return decode_out_of_memory(reading->picture->error);
    reading->tiff->TIFFOpenOptionsSetMaxSingleMemAlloc(options, MOST_BLOCK);
    reading->tiff->TIFFOpenOptionsSetErrorHandlerExtR(options, on_error, reading);
    reading->tiff->TIFFOpenOptionsSetWarningHandlerExtR(options, on_warning, reading);
    /* m: libtiff reads by the functions here, and maps no memory */
    reading->file =
        reading->tiff->TIFFClientOpenExt("", "rm", reading, read_bytes, write_bytes, seek_byte,
                                         close_bytes, size_of_bytes, NULL, NULL, options);
    reading->tiff->TIFFOpenOptionsFree(options);
    return reading->file || decode_tiff_refuse_broken(reading);
}

/* ---- pages ----------------------------------------------------------------------------------- */

/* Returns whether the current image is a page, and no smaller version of one and no mask. */
static bool is_page(const struct tiff_reading *reading)
{
    uint32_t type = 0;
    reading->tiff->TIFFGetFieldDefaulted(reading->file, TIFFTAG_SUBFILETYPE, &type);
    return (type & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) == 0;
}

/* Counts the pages of the file, and goes to the one that is wanted. */
static bool find_page(struct tiff_reading *reading)
{
    uint32_t pages = 0, found = 0, number = 0;
    for (;; number++) {
        if (is_page(reading)) {
            if (pages == reading->picture->page)
                found = number;
            pages++;
        }
        if (reading->tiff->TIFFLastDirectory(reading->file))
            break;
        if (number == MOST_IMAGES)
            return decode_tiff_refuse(reading, "with more than 65536 images in its file");
        if (!reading->tiff->TIFFReadDirectory(reading->file))
            return decode_tiff_refuse_broken(reading);
    }
    reading->picture->pages = pages;
    if (pages == 0)
        return decode_tiff_refuse(reading, "that is a smaller version of another or a mask");
    if (reading->picture->page >= pages)
        return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                              "no page %u: the TIFF file has %u", reading->picture->page, pages);
    return found == number || reading->tiff->TIFFSetDirectory(reading->file, found) ||
           decode_tiff_refuse_broken(reading);
}

/* ---- pixels ---------------------------------------------------------------------------------- */

static bool make_image(struct tiff_reading *reading)
{
    const struct tiff_samples *samples = &reading->samples;
    const bool grey = samples->color == TIFF_GREY || samples->color == TIFF_GREY_OF_WHITE;
    struct kiln_asset_image *image = reading->image = calloc(1, sizeof *image);
    if (!image)
        return decode_out_of_memory(reading->picture->error);
    *image = (struct kiln_asset_image){.width = reading->width,
                                       .height = reading->height,
                                       .channels = (grey ? 1u : 3u) + (samples->alpha > 0),
                                       .type = decode_tiff_type(samples),
                                       .srgb = !samples->floats,
                                       .premultiplied = samples->associated};
    image->pixels = malloc(kiln_asset_image_bytes(image));
    const bool apart = samples->color == TIFF_INK && samples->alpha > 0;
    if (apart)
        reading->ink_alpha = malloc(kiln_asset_image_bytes(image) / 4);
    return (image->pixels && (!apart || reading->ink_alpha)) ||
           decode_out_of_memory(reading->picture->error);
}

/* The strips or tiles of an image. */
struct blocks {
    bool tiled;
    uint32_t width, height; /* of a block; the last strip may have fewer rows */
    uint32_t columns, rows; /* blocks */
    uint32_t stride;        /* samples from pixel to pixel */
};

/* Returns the bytes that a decoded block of some rows has by its description. */
static uint64_t block_bytes(const struct tiff_reading *reading, const struct blocks *blocks,
                            uint32_t rows)
{
    const struct tiff_samples *samples = &reading->samples;
    const uint64_t across = samples->chroma[0], down = samples->chroma[1];
    if (across > 1 || down > 1)
        return (blocks->width + across - 1) / across * ((rows + down - 1) / down) *
               (across * down + 2);
    return ((uint64_t)blocks->width * blocks->stride * samples->bits + 7) / 8 * rows;
}

static bool find_blocks(struct tiff_reading *reading, struct blocks *blocks)
{
    TIFF *file = reading->file;
    *blocks = (struct blocks){.tiled = reading->tiff->TIFFIsTiled(file),
                              .width = reading->width,
                              .height = reading->height,
                              .stride = reading->samples.planar ? 1 : reading->samples.samples};
    uint32_t rows = 0;
    if (blocks->tiled) {
        if (!reading->tiff->TIFFGetField(file, TIFFTAG_TILEWIDTH, &blocks->width) ||
            !reading->tiff->TIFFGetField(file, TIFFTAG_TILELENGTH, &blocks->height))
            return decode_tiff_refuse_broken(reading);
    } else if (reading->tiff->TIFFGetFieldDefaulted(file, TIFFTAG_ROWSPERSTRIP, &rows) &&
               rows < reading->height) {
        blocks->height = rows;
    }
    if (blocks->width < 1 || blocks->height < 1)
        return decode_tiff_refuse_broken(reading);
    /* With such edges, the bytes of a block do not exceed 64 bits. */
    const bool small = blocks->width <= 1 << 24 && blocks->height <= 1 << 24;
    if (!small || block_bytes(reading, blocks, blocks->height) > MOST_BLOCK)
        return decode_tiff_refuse(reading, "with strips or tiles of more than 1024 MiB");
    blocks->columns = (reading->width - 1) / blocks->width + 1;
    blocks->rows = (reading->height - 1) / blocks->height + 1;
    reading->buffer = malloc((size_t)block_bytes(reading, blocks, blocks->height));
    return reading->buffer || decode_out_of_memory(reading->picture->error);
}

/* Decodes a block. Its size by libtiff must be that by kiln. libtiff would read past the end of a
 * block that is not compressed, into other data. */
static bool read_block(struct tiff_reading *reading, const struct blocks *blocks, uint32_t number,
                       uint32_t rows)
{
    TIFF *file = reading->file;
    const uint64_t bytes = block_bytes(reading, blocks, rows);
    const uint64_t theirs = blocks->tiled ? reading->tiff->TIFFTileSize64(file)
                                          : reading->tiff->TIFFVStripSize64(file, rows);
    const bool cut = reading->compression == COMPRESSION_NONE &&
                     reading->tiff->TIFFGetStrileByteCount(file, number) < bytes;
    if (theirs != bytes || cut)
        return decode_tiff_refuse_broken(reading);
    memset(reading->buffer, 0, (size_t)bytes);
    reading->in_pixels = true;
    const tmsize_t size = (tmsize_t)bytes;
    const tmsize_t got =
        blocks->tiled ? reading->tiff->TIFFReadEncodedTile(file, number, reading->buffer, size)
                      : reading->tiff->TIFFReadEncodedStrip(file, number, reading->buffer, size);
    reading->in_pixels = false;
    return (got == size && !reading->guessed) || decode_tiff_refuse_broken(reading);
}

/* Stores a block of YCbCr whose pixels share Cb and Cr: groups of pixels, each with the Y of all,
 * then Cb and Cr. Each pixel of a group gets the same Cb and Cr, as in libtiff. */
static void store_shared(struct tiff_reading *reading, const struct blocks *blocks, uint32_t left,
                         uint32_t top, uint32_t width, uint32_t height)
{
    const size_t across = reading->samples.chroma[0], down = reading->samples.chroma[1];
    const size_t groups = (blocks->width + across - 1) / across, group = across * down + 2;
    for (size_t y = 0; y < height; y++) {
        uint8_t *out = (uint8_t *)reading->image->pixels + 4 * ((top + y) * reading->width + left);
        for (size_t x = 0; x < width; x++, out += 4) {
            const uint8_t *in = reading->buffer + (y / down * groups + x / across) * group;
            out[0] = in[y % down * across + x % across];
            out[1] = in[group - 2];
            out[2] = in[group - 1];
        }
    }
}

/* Stores a sample of each pixel of a block. sample: the place of it in a pixel of the block. */
static void store_sample(struct tiff_reading *reading, const struct blocks *blocks, uint32_t left,
                         uint32_t top, uint32_t width, uint32_t height, uint32_t sample,
                         uint32_t slot)
{
    const size_t row_bytes = (size_t)block_bytes(reading, blocks, 1);
    for (uint32_t y = 0; y < height; y++) {
        const struct tiff_run run = {.row = reading->buffer + y * row_bytes,
                                     .stride = blocks->stride,
                                     .first = sample,
                                     .count = width,
                                     .pixel = (size_t)(top + y) * reading->width + left,
                                     .slot = slot};
        decode_tiff_store(&reading->samples, &run, reading->image, reading->ink_alpha);
    }
}

/* Reads a block of a plane, and stores all of its samples that the picture needs. plane: its
 * sample, or 0 if all samples are in one plane. */
static bool take_block(struct tiff_reading *reading, const struct blocks *blocks, uint32_t plane,
                       uint32_t column, uint32_t row)
{
    const struct tiff_samples *samples = &reading->samples;
    const uint32_t number = (plane * blocks->rows + row) * blocks->columns + column;
    const uint32_t left = column * blocks->width, top = row * blocks->height;
    const uint32_t right = reading->width - left, below = reading->height - top;
    const uint32_t width = right < blocks->width ? right : blocks->width;
    const uint32_t height = below < blocks->height ? below : blocks->height;
    if (!read_block(reading, blocks, number, blocks->tiled ? blocks->height : height))
        return false;
    if (samples->chroma[0] > 1 || samples->chroma[1] > 1) {
        store_shared(reading, blocks, left, top, width, height);
        return true;
    }
    for (uint32_t i = 0; i < samples->colors + (samples->alpha > 0); i++) {
        const uint32_t sample = i < samples->colors ? i : samples->alpha;
        const uint32_t slot = i < samples->colors          ? i
                              : samples->color == TIFF_INK ? (uint32_t)TIFF_INK_ALPHA
                                                           : 3;
        if (!samples->planar)
            store_sample(reading, blocks, left, top, width, height, sample, slot);
        else if (sample == plane)
            store_sample(reading, blocks, left, top, width, height, 0, slot);
    }
    return true;
}

static bool read_pixels(struct tiff_reading *reading)
{
    const struct tiff_samples *samples = &reading->samples;
    struct blocks blocks;
    if (!find_blocks(reading, &blocks))
        return false;
    const uint32_t planes = samples->planar ? samples->samples : 1;
    for (uint32_t plane = 0; plane < planes; plane++) {
        if (plane >= samples->colors && plane != samples->alpha)
            continue;
        for (uint32_t row = 0; row < blocks.rows; row++) {
            for (uint32_t column = 0; column < blocks.columns; column++) {
                if (!take_block(reading, &blocks, plane, column, row))
                    return false;
            }
        }
    }
    free(reading->buffer); /* the picture may be turned, which takes memory, too */
    reading->buffer = NULL;
    return decode_tiff_finish(samples, reading->image) ||
           decode_tiff_refuse(reading, "whose white (tag 318) is none");
}

/* Makes the picture that is meant of the pixels that are stored. Floats are linear light. */
static bool show(struct tiff_reading *reading)
{
    const struct tiff_samples *samples = &reading->samples;
    const bool has_profile =
        !samples->floats && samples->color != TIFF_LAB && samples->color != TIFF_ICC_LAB;
    uint32_t size = 0;
    void *profile = NULL;
    if (has_profile &&
        !reading->tiff->TIFFGetField(reading->file, TIFFTAG_ICCPROFILE, &size, &profile))
        profile = NULL;
    const struct decode_meaning meaning = {.profile = profile,
                                           .profile_size = size,
                                           .ink = samples->color == TIFF_INK,
                                           .ink_alpha = reading->ink_alpha,
                                           .orientation =
                                               decode_tiff_number(reading, TIFFTAG_ORIENTATION, 1)};
    return decode_show(reading->picture, reading->image, &meaning);
}

struct kiln_asset_image *decode_tiff(struct decode_picture *picture)
{
    struct tiff_reading reading = {.tiff = &library, .picture = picture};
    if (!is_open) {
        kiln_error_set(picture->error, KILN_IO, "libtiff is not open");
        return NULL;
    }
    const bool ok = open_file(&reading) && find_page(&reading) && decode_tiff_describe(&reading) &&
                    make_image(&reading) && read_pixels(&reading) && show(&reading);
    if (reading.file)
        library.TIFFClose(reading.file);
    free(reading.buffer);
    free(reading.ink_alpha);
    if (!ok)
        kiln_asset_image_destroy(&reading.image);
    return reading.image;
}
