/* Writes PNG. libpng writes the file, its chunks and their checksums; png_data.c compresses the
 * pixels. Files are many and short-lived, so speed comes before size: zlib would take seven times
 * as long with its fastest settings. */
#include <png.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "output/formats.h"
#include "output/libdeflate.h"
#include "output/png_data.h"

struct png_encoder {
    png_structp png;
    png_infop info;
    struct kiln_png_data *data; /* of the picture that is being encoded */
    uint32_t threads;           /* that compress a picture */
    const struct kiln_output_params *params;
    struct kiln_temporary *file;
    const struct kiln_caller *caller; /* NULL: nobody is asked */
    char failure[128];                /* libpng's message */
};

static struct kiln_output_needs needs(const struct kiln_output_params *params)
{
    return (struct kiln_output_needs){.bits = params->png_bits};
}

static bool check(const struct kiln_output_params *params, struct kiln_error *error)
{
    if (params->png_bits != 8 && params->png_bits != 16)
        return kiln_error_set(error, KILN_USAGE,
                              "found %u bits a channel for a PNG; allowed are 8 or 16",
                              params->png_bits);
    return params->png_effort != KILN_PNG_SMALL || kiln_libdeflate_open(error);
}

/* Keeps libpng's message and jumps back to the setjmp in encode, since libpng must not return from
 * here. */
static void on_failure(png_structp png, png_const_charp message)
{
    struct png_encoder *encoder = png_get_error_ptr(png);
    snprintf(encoder->failure, sizeof encoder->failure, "%s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void on_write(png_structp png, png_bytep bytes, size_t size)
{
    struct png_encoder *encoder = png_get_io_ptr(png);
    if (!kiln_temporary_write(encoder->file, bytes, size))
        png_error(png, "write failed");
}

static void on_flush(png_structp png)
{
    (void)png;
}

static void close_encoder(void *opaque)
{
    struct png_encoder *encoder = opaque;
    png_destroy_write_struct(&encoder->png, &encoder->info);
    kiln_png_data_destroy(&encoder->data);
    free(encoder);
}

/* Returns whether no other picture is encoded at the same time. Of several pictures, each encoder
 * thread compresses one by itself, which takes all of the processor without threads of its own. */
static bool is_one_picture(const struct kiln_output_params *params)
{
    return params->range_count == 1 && params->ranges[0].first == params->ranges[0].last;
}

static void *open_encoder(const struct kiln_output_params *params, struct kiln_temporary *file,
                          struct kiln_error *error)
{
    struct png_encoder *encoder = calloc(1, sizeof *encoder);
    if (encoder) {
        encoder->params = params;
        encoder->threads = is_one_picture(params) ? params->threads : 1;
        encoder->file = file;
        encoder->png =
            png_create_write_struct(PNG_LIBPNG_VER_STRING, encoder, on_failure, on_warning);
    }
    if (encoder && encoder->png)
        encoder->info = png_create_info_struct(encoder->png);
    if (encoder && encoder->info) {
        png_set_write_fn(encoder->png, encoder, on_write, on_flush);
        return encoder;
    }
    kiln_error_no_memory(error, "the PNG encoder of %s", file->target);
    if (encoder)
        close_encoder(encoder);
    return NULL;
}

static void add_text(struct png_encoder *encoder, const char *key, const char *value)
{
    char key_copy[32], value_copy[80]; /* libpng takes pointers to char that is not const */
    snprintf(key_copy, sizeof key_copy, "%s", key);
    snprintf(value_copy, sizeof value_copy, "%s", value);
    png_text text = {.compression = PNG_TEXT_COMPRESSION_NONE, .key = key_copy, .text = value_copy};
    png_set_text(encoder->png, encoder->info, &text, 1);
}

static void write_header(struct png_encoder *encoder, const struct kiln_picture *picture)
{
    png_structp png = encoder->png;
    png_set_IHDR(png, encoder->info, picture->width, picture->height, (int)picture->bits,
                 picture->has_alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!picture->is_data)
        png_set_sRGB_gAMA_and_cHRM(png, encoder->info, PNG_sRGB_INTENT_PERCEPTUAL);

    char number[16], rate[32];
    add_text(encoder, "Software", "kiln " KILN_VERSION);
    add_text(encoder, "kiln:version", KILN_VERSION);
    if (encoder->params->scene_hash) {
        add_text(encoder, "kiln:scene", encoder->params->scene_hash);
        snprintf(number, sizeof number, "%u", encoder->params->seed);
        add_text(encoder, "kiln:seed", number);
        snprintf(number, sizeof number, "%u", picture->frame);
        snprintf(rate, sizeof rate, encoder->params->fps_den == 1 ? "%u" : "%u/%u",
                 encoder->params->fps_num, encoder->params->fps_den);
        if (encoder->params->flipbook.columns == 0) {
            add_text(encoder, "kiln:frame", number);
            add_text(encoder, "kiln:fps", rate);
        }
    }
    png_write_info(png, encoder->info);
}

static bool write_pixels(struct png_encoder *encoder, struct kiln_error *error)
{
    const uint8_t *bytes;
    size_t size;
    do {
        if (!kiln_png_data_next(encoder->data, encoder->caller, &bytes, &size, error))
            return false;
        if (size > 0)
            png_write_chunk(encoder->png, (png_const_bytep) "IDAT", bytes, size);
    } while (size > 0);
    /* png_write_end would miss the IDAT chunks, which libpng did not make */
    png_write_chunk(encoder->png, (png_const_bytep) "IEND", NULL, 0);
    return true;
}

/* No variable that changes after setjmp is read after the jump. */
static bool encode(void *opaque, const struct kiln_picture *picture, struct kiln_error *error)
{
    struct png_encoder *encoder = opaque;
    encoder->data =
        kiln_png_data_create(picture, encoder->params->png_effort, encoder->threads, error);
    if (!encoder->data)
        return false;
    if (setjmp(png_jmpbuf(encoder->png))) {
        if (encoder->file->failure)
            return kiln_temporary_fail(encoder->file, error);
        return kiln_error_set(error, KILN_IO, "%s: libpng failed: %s", encoder->file->target,
                              encoder->failure);
    }
    write_header(encoder, picture);
    return write_pixels(encoder, error);
}

bool kiln_png_write(const struct kiln_output_params *params, const struct kiln_picture *picture,
                    struct kiln_temporary *file, const struct kiln_caller *caller,
                    struct kiln_error *error)
{
    struct png_encoder *encoder = open_encoder(params, file, error);
    if (!encoder)
        return false;
    encoder->caller = caller;
    encoder->threads = params->threads;
    bool good = encode(encoder, picture, error);
    close_encoder(encoder);
    return good;
}

const struct kiln_format kiln_format_png = {
    .suffix = ".png",
    .name = "PNG images",
    .help = "8 or 16 bits, sRGB; alpha with a transparent backdrop",
    .uses = KILN_USES_PNG_BITS | KILN_USES_PNG_EFFORT,
    .needs = needs,
    .check = check,
    .open = open_encoder,
    .encode = encode,
    .close = close_encoder,
};
