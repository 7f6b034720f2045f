/* This file decodes PNG pictures by libpng, row by row into the picture. Chunks that do not change
 * a pixel are skipped: compressed texts and profiles can unpack to a thousand times their size. */
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
    bool lacks_memory;
    char complaint[128];
};

static void on_failure(png_structp png, png_const_charp message)
{
    struct reading *reading = png_get_error_ptr(png);
    snprintf(reading->complaint, sizeof reading->complaint, "%s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
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
    if (size > reading->picture->size - reading->at)
        png_error(png, "the file ends too early");
    memcpy(out, reading->picture->bytes + reading->at, size);
    reading->at += size;
}

static bool open_file(struct reading *reading)
{
    reading->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, reading, on_failure, on_warning,
                                            reading, allocate, release);
    reading->info = reading->png ? png_create_info_struct(reading->png) : NULL;
    return reading->info != NULL;
}

static void choose_chunks(struct reading *reading)
{
    /* All chunks that libpng knows and that do not change a pixel. */
    static const png_byte ignored[] = "iCCP\0iTXt\0tEXt\0zTXt\0sPLT\0hIST\0eXIf\0pCAL\0sCAL\0oFFs\0"
                                      "pHYs\0tIME\0bKGD\0sBIT\0cHRM";
    enum { IGNORED = sizeof ignored / 5 };
    png_set_keep_unknown_chunks(reading->png, PNG_HANDLE_CHUNK_NEVER, ignored, IGNORED);
    png_set_keep_unknown_chunks(reading->png, PNG_HANDLE_CHUNK_NEVER, NULL, 0);
    png_set_crc_action(reading->png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
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
    png_read_end(reading->png, NULL);
}

/* Sets the channels of a picture with a palette. Only the pixels tell whether a palette has alpha.
 */
static void look_for_alpha(const struct reading *reading)
{
    struct kiln_asset_image *image = reading->image;
    const uint8_t *pixel = image->pixels;
    const size_t pixels = (size_t)image->width * image->height;
    image->channels = 3;
    for (size_t i = 0; i < pixels && image->channels == 3; i++)
        image->channels = pixel[4 * i + 3] != 255 ? 4 : 3;
}

/* Reads the picture. All of libpng's errors longjmp to this function, so its locals must not change
 * after setjmp. */
static bool read_file(struct reading *reading)
{
    if (setjmp(png_jmpbuf(reading->png))) {
        return reading->lacks_memory ? decode_out_of_memory(reading->picture->error)
                                     : kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                                                      "the PNG image is broken or cut short (%s)",
                                                      reading->complaint);
    }
    choose_chunks(reading);
    png_read_info(reading->png, reading->info);
    if (!make_image(reading))
        return false;
    const bool palette = png_get_color_type(reading->png, reading->info) == PNG_COLOR_TYPE_PALETTE;
    set_transforms(reading);
    read_rows(reading);
    if (palette)
        look_for_alpha(reading);
    return true;
}

struct kiln_asset_image *decode_png(struct decode_picture *picture)
{
    struct reading reading = {.picture = picture};
    bool ok = open_file(&reading);
    ok = ok ? read_file(&reading) : decode_out_of_memory(picture->error);
    png_destroy_read_struct(&reading.png, &reading.info, NULL);
    if (!ok)
        kiln_asset_image_destroy(&reading.image);
    return reading.image;
}
