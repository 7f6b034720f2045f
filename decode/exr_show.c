/* This file makes a picture of the numbers of a layer of an OpenEXR file: that of the display
 * window, in light of sRGB's primaries. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "exr.h"

/* ---- windows --------------------------------------------------------------------------------- */

static struct kiln_asset_image *make_image(const struct exr_reading *reading,
                                           const struct exr_box *box)
{
    const struct exr_layer *layer = &reading->layer;
    struct kiln_asset_image *image = calloc(1, sizeof *image);
    float *pixels = image ? calloc((size_t)box->width * box->height, sizeof(float[4])) : NULL;
    if (!pixels) {
        decode_out_of_memory(reading->picture->error);
        free(image);
        return NULL;
    }
    const bool alpha = layer->names[EXR_ALPHA] != NULL;
    *image = (struct kiln_asset_image){.width = box->width,
                                       .height = box->height,
                                       .channels = (layer->grey ? 1u : 3u) + alpha,
                                       .type = layer->is_whole ? KILN_IMAGE_U32 : KILN_IMAGE_F32,
                                       .premultiplied = alpha,
                                       .pixels = pixels};
    return image;
}

bool decode_exr_make_planes(struct exr_reading *reading)
{
    const uint32_t by = (uint32_t)reading->layer.sampling;
    reading->image = make_image(reading, &reading->data);
    if (!reading->image || !reading->layer.names[EXR_RY])
        return reading->image != NULL;
    reading->chroma_width = reading->data.width / by;
    reading->chroma_height = reading->data.height / by;
    for (int i = 0; i < 2; i++) {
        reading->chroma[i] =
            calloc((size_t)reading->chroma_width * reading->chroma_height, sizeof(float));
        if (!reading->chroma[i])
            return decode_out_of_memory(reading->picture->error);
    }
    return true;
}

static bool same_box(const struct exr_box *a, const struct exr_box *b)
{
    return a->left == b->left && a->top == b->top && a->width == b->width && a->height == b->height;
}

static void make_opaque(struct kiln_asset_image *image)
{
    const bool whole = image->type == KILN_IMAGE_U32;
    const size_t pixels = (size_t)image->width * image->height;
    for (size_t i = 0; i < pixels; i++) {
        if (whole)
            ((uint32_t *)image->pixels)[4 * i + 3] = 1;
        else
            ((float *)image->pixels)[4 * i + 3] = 1.0f;
    }
}

/* Copies what the display window shows of the data window, for which `whole` has room. */
static void copy_shown(const struct exr_reading *reading, struct kiln_asset_image *whole)
{
    const struct exr_box *data = &reading->data, *display = &reading->display;
    const int64_t x = (int64_t)data->left - display->left, y = (int64_t)data->top - display->top;
    const int64_t begin = x > 0 ? x : 0;
    const int64_t end = x + data->width < display->width ? x + data->width : display->width;
    const float *from = reading->image->pixels;
    float *to = whole->pixels;
    for (int64_t row = 0; row < data->height && begin < end; row++) {
        const int64_t line = y + row;
        if (line >= 0 && line < display->height)
            memcpy(to + (line * display->width + begin) * 4,
                   from + (row * data->width + begin - x) * 4,
                   (size_t)(end - begin) * sizeof(float[4]));
    }
}

/* Makes the picture of the display window. It is black, and transparent if the layer has alpha,
 * where the file has no data. */
static bool show_window(struct exr_reading *reading)
{
    if (same_box(&reading->data, &reading->display))
        return true;
    struct kiln_asset_image *whole = make_image(reading, &reading->display);
    if (!whole)
        return false;
    if (!reading->layer.names[EXR_ALPHA])
        make_opaque(whole);
    copy_shown(reading, whole);
    kiln_asset_image_destroy(&reading->image);
    reading->image = whole;
    return true;
}

/* ---- colours --------------------------------------------------------------------------------- */

/* Fills the missing components: grey is copied to all colours, and missing alpha is opaque. */
static void fill_components(const struct exr_reading *reading)
{
    float *pixel = reading->image->pixels;
    const size_t pixels = (size_t)reading->image->width * reading->image->height;
    for (size_t i = 0; reading->layer.grey && i < pixels; i++)
        pixel[4 * i + 1] = pixel[4 * i + 2] = pixel[4 * i];
    if (!reading->layer.names[EXR_ALPHA])
        make_opaque(reading->image);
}

/* Finds the primaries of the part. */
static bool find_primaries(const struct exr_reading *reading, struct kiln_primaries *primaries)
{
    exr_attr_chromaticities_t found;
    *primaries = kiln_rec709;
    const exr_result_t code =
        exr_attr_get_chromaticities(reading->file, reading->part, "chromaticities", &found);
    if (code == EXR_ERR_NO_ATTR_BY_NAME)
        return true;
    if (code != EXR_ERR_SUCCESS)
        return decode_exr_fail(reading, code);
    *primaries = (struct kiln_primaries){{(double)found.red_x, (double)found.red_y},
                                         {(double)found.green_x, (double)found.green_y},
                                         {(double)found.blue_x, (double)found.blue_y},
                                         {(double)found.white_x, (double)found.white_y}};
    return true;
}

/* Turns the numbers of a layer of colours into light of sRGB's primaries. */
static bool show_colors(struct exr_reading *reading)
{
    const size_t pixels = (size_t)reading->data.width * reading->data.height;
    const bool chroma = reading->layer.names[EXR_RY] != NULL;
    struct kiln_primaries primaries;
    double weights[3], to_srgb[3][3];
    if (!chroma && !reading->layer.is_color)
        return true;
    if (!find_primaries(reading, &primaries))
        return false;
    if (!kiln_primaries_luminance(&primaries, weights) ||
        !kiln_primaries_to_srgb(&primaries, to_srgb))
        return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                              "the chromaticities of the EXR image are no triangle around white");
    if (chroma && !decode_exr_chroma(reading, weights))
        return false;
    if (reading->layer.is_color && !reading->picture->raw && !kiln_primaries_are_rec709(&primaries))
        kiln_light_convert(to_srgb, reading->image->pixels, pixels);
    return true;
}

bool decode_exr_show(struct exr_reading *reading)
{
    if (!show_colors(reading))
        return false;
    fill_components(reading);
    return show_window(reading);
}
