/* Encodes the pixels of a figure as PNG in memory. Unlike frames, figures are made once and read
 * often, so the encoder spends time on a small file. */
#include <png.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "figure/drawing.h"

/* Leaves libpng after a failure. libpng does not allow this function to return, so it jumps to the
 * setjmp in encode. */
static void on_failure(png_structp png, png_const_charp message)
{
    (void)message; /* the only failure is lack of memory, to which the message adds nothing */
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void on_write(png_structp png, png_bytep bytes, size_t size)
{
    if (fwrite(bytes, 1, size, png_get_io_ptr(png)) != size)
        png_error(png, "write failed");
}

static void on_flush(png_structp png)
{
    (void)png;
}

/* Adds the resolution in pixels per metre, and the text for screen readers under "Description", a
 * keyword of the PNG standard. */
static void add_imprint(png_structp png, png_infop info, uint32_t dpi, char *alt)
{
    if (dpi > 0) {
        uint32_t per_metre = (uint32_t)(dpi / 0.0254 + 0.5);
        png_set_pHYs(png, info, per_metre, per_metre, PNG_RESOLUTION_METER);
    }
    if (alt) {
        char key[] = "Description", none[] = ""; /* libpng takes pointers to non-const */
        png_text text = {.compression = PNG_ITXT_COMPRESSION_NONE,
                         .key = key,
                         .text = alt,
                         .itxt_length = strlen(alt),
                         .lang = none,
                         .lang_key = none};
        png_set_text(png, info, &text, 1);
    }
}

static bool encode(png_structp png, png_infop info, const struct kiln_pixels *pixels, uint32_t dpi,
                   char *alt, FILE *out)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_set_write_fn(png, out, on_write, on_flush);
    png_set_IHDR(png, info, pixels->width, pixels->height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    add_imprint(png, info, dpi, alt);
    png_write_info(png, info);
    png_set_filler(png, 0, PNG_FILLER_AFTER); /* drops the alpha */
    for (uint32_t y = 0; y < pixels->height; y++)
        png_write_row(png, pixels->rgba + (size_t)4 * y * pixels->width);
    png_write_end(png, NULL);
    return true;
}

bool kiln_pixels_png(const struct kiln_pixels *pixels, const struct kiln_imprint *imprint,
                     uint8_t **bytes, size_t *size, struct kiln_error *error)
{
    char *text = NULL;
    FILE *out = open_memstream(&text, size);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, on_failure, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    char *alt = imprint && imprint->alt ? strdup(imprint->alt) : NULL;
    bool ok = out && info && (alt || !imprint || !imprint->alt) &&
              encode(png, info, pixels, imprint ? imprint->dpi : 0, alt, out);
    free(alt);
    png_destroy_write_struct(&png, &info);
    ok = out && fclose(out) == 0 && ok;
    *bytes = ok ? (uint8_t *)text : NULL;
    if (ok)
        return true;
    free(text);
    return kiln_error_no_memory(error, "a PNG of %u x %u pixels", pixels->width, pixels->height);
}
