/* This file decodes JPEG pictures by libjpeg-turbo, whose slow and exact transform gives the same
 * numbers on every processor, and the numbers that browsers show. */
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* jpeglib.h takes names of stdio.h, and jerror.h those of jpeglib.h. */
/* clang-format off */
#include <jpeglib.h>
#include <jerror.h>
/* clang-format on */

#include "base/error.h"
#include "base/library.h"
#include "decode.h"

#define JPEG_FUNCTIONS(F)                                                                          \
    F(jpeg_std_error)                                                                              \
    F(jpeg_CreateDecompress)                                                                       \
    F(jpeg_destroy_decompress)                                                                     \
    F(jpeg_mem_src)                                                                                \
    F(jpeg_save_markers)                                                                           \
    F(jpeg_read_header)                                                                            \
    F(jpeg_read_icc_profile)                                                                       \
    F(jpeg_start_decompress)                                                                       \
    F(jpeg_read_scanlines)                                                                         \
    F(jpeg_finish_decompress)

static struct {
    JPEG_FUNCTIONS(KILN_LIBRARY_POINTER)
} jpeg;

bool decode_jpeg_begin(struct kiln_error *error)
{
#define FIND(function) {#function, &jpeg.function},
    static const struct kiln_library_function functions[] = {JPEG_FUNCTIONS(FIND)};
#undef FIND
    return kiln_library_open("libjpeg.so.62", "libjpeg62-turbo", functions,
                             sizeof functions / sizeof *functions, error);
}

struct reading {
    struct jpeg_decompress_struct file;
    struct jpeg_error_mgr errors;
    jmp_buf failed;
    struct decode_picture *picture;
    struct kiln_asset_image *image;
    JOCTET *profile; /* or NULL */
    unsigned profile_size;
    uint32_t orientation;
};

/* ---- faults ---------------------------------------------------------------------------------- */

static bool refuse(struct reading *reading, const char *what)
{
    return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT, "%s", what);
}

static void report(struct reading *reading)
{
    struct jpeg_error_mgr *errors = &reading->errors;
    char text[JMSG_LENGTH_MAX], what[JMSG_LENGTH_MAX + 64];
    if (errors->msg_code == JERR_OUT_OF_MEMORY) {
        decode_out_of_memory(reading->picture->error);
        return;
    }
    if (errors->msg_code == JERR_BAD_PRECISION) {
        snprintf(what, sizeof what,
                 "a JPEG image of %d bits a sample cannot be read; allowed are 8",
                 errors->msg_parm.i[0]);
    } else if (errors->msg_code == JERR_SOF_UNSUPPORTED) {
        snprintf(what, sizeof what,
                 "a lossless or hierarchical JPEG image cannot be read; allowed are baseline, "
                 "extended and progressive ones");
    } else {
        errors->format_message((j_common_ptr)&reading->file, text);
        snprintf(what, sizeof what, "the JPEG image is broken or cut short (%s)", text);
    }
    refuse(reading, what);
}

static void on_failure(j_common_ptr file)
{
    struct reading *reading = file->client_data;
    report(reading);
    longjmp(reading->failed, 1);
}

/* Is called for each message. level: -1 for a warning. The library fills pixels with what it
 * guesses where the data of the scan are broken; such a picture is refused. Other faults do not
 * change a pixel. */
static void on_message(j_common_ptr file, int level)
{
    static const int of_pixels[] = {JWRN_ARITH_BAD_CODE, JWRN_HIT_MARKER,       JWRN_HUFF_BAD_CODE,
                                    JWRN_JPEG_EOF,       JWRN_MUST_RESYNC,      JWRN_NOT_SEQUENTIAL,
                                    JWRN_TOO_MUCH_DATA,  JWRN_BOGUS_PROGRESSION};
    for (size_t i = 0; level < 0 && i < sizeof of_pixels / sizeof *of_pixels; i++) {
        if (file->err->msg_code == of_pixels[i])
            on_failure(file);
    }
}

/* ---- pixels ---------------------------------------------------------------------------------- */

static bool make_image(struct reading *reading)
{
    const struct jpeg_decompress_struct *file = &reading->file;
    if (!decode_allows_size(reading->picture, "JPEG", file->image_width, file->image_height))
        return false;
    struct kiln_asset_image *image = reading->image = calloc(1, sizeof *image);
    if (!image)
        return decode_out_of_memory(reading->picture->error);
    *image = (struct kiln_asset_image){.width = file->image_width,
                                       .height = file->image_height,
                                       .channels = file->num_components == 1 ? 1 : 3,
                                       .type = KILN_IMAGE_U8,
                                       .srgb = true};
    image->pixels = malloc(kiln_asset_image_bytes(image));
    return image->pixels || decode_out_of_memory(reading->picture->error);
}

/* Chooses what the library's pixels are. Files of four colours are ink, and by Adobe's custom they
 * hold how much ink is missing. */
static bool choose_colors(struct reading *reading)
{
    struct jpeg_decompress_struct *file = &reading->file;
    if (file->num_components == 1)
        file->out_color_space = JCS_GRAYSCALE;
    else if (file->num_components == 3)
        file->out_color_space = JCS_EXT_RGBX;
    else if (file->num_components == 4)
        file->out_color_space = JCS_CMYK;
    else
        return refuse(reading, "a JPEG image of 2 channels cannot be read; allowed are 1, 3 or 4");
    file->dct_method = JDCT_ISLOW;
    file->do_fancy_upsampling = TRUE;
    return true;
}

/* Spreads a row of grey over its pixels, from the last to the first. */
static void spread_grey(uint8_t *row, uint32_t width)
{
    for (size_t x = width; x-- > 0;) {
        const uint8_t grey = row[x];
        memset(row + 4 * x, grey, 3);
        row[4 * x + 3] = 255;
    }
}

static void read_rows(struct reading *reading)
{
    struct jpeg_decompress_struct *file = &reading->file;
    const struct kiln_asset_image *image = reading->image;
    while (file->output_scanline < file->output_height) {
        uint8_t *row = (uint8_t *)image->pixels + (size_t)file->output_scanline * image->width * 4;
        jpeg.jpeg_read_scanlines(file, &row, 1);
        if (file->num_components == 1)
            spread_grey(row, image->width);
        else if (file->num_components == 3)
            for (uint8_t *alpha = row + 3; alpha < row + 4 * (size_t)image->width; alpha += 4)
                *alpha = 255;
    }
}

/* Makes the picture that is meant of the pixels that are stored. */
static bool show(struct reading *reading)
{
    struct kiln_asset_image *image = reading->image;
    const struct decode_meaning meaning = {.profile = reading->profile,
                                           .profile_size = reading->profile_size,
                                           .ink = reading->file.num_components == 4,
                                           .orientation = reading->orientation};
    return decode_show(reading->picture, image, &meaning);
}

/* Finds how the picture is turned, in the first block of Exif data. */
static uint32_t find_orientation(const struct reading *reading)
{
    static const char name[6] = "Exif\0";
    for (const struct jpeg_marker_struct *marker = reading->file.marker_list; marker;
         marker = marker->next) {
        if (marker->marker == JPEG_APP0 + 1 && marker->data_length > sizeof name &&
            memcmp(marker->data, name, sizeof name) == 0)
            return decode_exif_orientation(reading->picture, marker->data + sizeof name,
                                           marker->data_length - sizeof name);
    }
    return 1;
}

/* Reads the picture. All of the library's errors longjmp to this function, so its locals must not
 * change after setjmp. */
static bool read_file(struct reading *reading)
{
    enum { WHOLE_MARKER = 0xffff };
    struct jpeg_decompress_struct *file = &reading->file;
    if (setjmp(reading->failed))
        return false;
    jpeg.jpeg_CreateDecompress(file, JPEG_LIB_VERSION, sizeof *file);
    jpeg.jpeg_mem_src(file, reading->picture->bytes, reading->picture->size);
    jpeg.jpeg_save_markers(file, JPEG_APP0 + 1, WHOLE_MARKER);
    jpeg.jpeg_save_markers(file, JPEG_APP0 + 2, WHOLE_MARKER);
    jpeg.jpeg_read_header(file, TRUE);
    if (!choose_colors(reading) || !make_image(reading))
        return false;
    if (!jpeg.jpeg_read_icc_profile(file, &reading->profile, &reading->profile_size))
        reading->profile = NULL;
    reading->orientation = find_orientation(reading); /* the end of decoding frees the markers */
    jpeg.jpeg_start_decompress(file);
    read_rows(reading);
    jpeg.jpeg_finish_decompress(file);
    return show(reading);
}

struct kiln_asset_image *decode_jpeg(struct decode_picture *picture)
{
    struct reading reading = {.picture = picture};
    reading.file.err = jpeg.jpeg_std_error(&reading.errors);
    reading.file.client_data = &reading;
    reading.errors.error_exit = on_failure;
    reading.errors.emit_message = on_message;
    const bool ok = read_file(&reading);
    jpeg.jpeg_destroy_decompress(&reading.file);
    free(reading.profile);
    if (!ok)
        kiln_asset_image_destroy(&reading.image);
    return reading.image;
}
