/* This file makes a picture of one layer of an OpenEXR file: that of the display window, in light
 * of sRGB's primaries. decode/main.c calls decode_exr once for a request, in the process
 * kiln-decode, which has confined itself. A confined process can open no file, so OpenEXR reads the
 * file from memory, through on_read.
 *
 * The file may be malicious, so the sizes of both windows are checked before memory is taken for
 * pixels. */
#include "exr.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"

/* Ignores OpenEXR's messages. The code that its functions return says enough, and without a handler
 * the library would print. */
static void on_failure(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

static int64_t on_read(exr_const_context_t context, void *opaque, void *buffer, uint64_t count,
                       uint64_t offset, exr_stream_error_func_ptr_t report)
{
    (void)context;
    (void)report;
    const struct exr_reading *reading = opaque;
    if (offset > reading->picture->size)
        return -1;
    const size_t left = reading->picture->size - (size_t)offset;
    const size_t taken = count < left ? (size_t)count : left;
    memcpy(buffer, reading->picture->bytes + offset, taken);
    return (int64_t)taken;
}

static int64_t on_size(exr_const_context_t context, void *opaque)
{
    (void)context;
    return (int64_t)((const struct exr_reading *)opaque)->picture->size;
}

static exr_result_t open_file(struct exr_reading *reading)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    initializer.user_data = reading;
    initializer.error_handler_fn = on_failure;
    initializer.read_fn = on_read;
    initializer.size_fn = on_size;
    return exr_start_read(&reading->file, "an EXR image", &initializer);
}

bool decode_exr_fail(const struct exr_reading *reading, exr_result_t code)
{
    if (code == EXR_ERR_OUT_OF_MEMORY)
        return decode_out_of_memory(reading->picture->error);
    return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                          "the EXR image is broken or cut short (%s)",
                          exr_get_default_error_message(code));
}

/* ---- windows --------------------------------------------------------------------------------- */

static bool take_window(struct exr_reading *reading, const exr_attr_box2i_t *window,
                        struct exr_box *box)
{
    const int64_t width = (int64_t)window->max.x - window->min.x + 1;
    const int64_t height = (int64_t)window->max.y - window->min.y + 1;
    if (!decode_allows_size(reading->picture, "EXR", width, height))
        return false;
    *box = (struct exr_box){window->min.x, window->min.y, (uint32_t)width, (uint32_t)height};
    return true;
}

/* Takes the sizes of both windows. The display window comes last, since its size is the picture's.
 */
static bool take_windows(struct exr_reading *reading)
{
    exr_attr_box2i_t data, display;
    exr_result_t code = exr_get_data_window(reading->file, reading->part, &data);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_display_window(reading->file, reading->part, &display);
    if (code != EXR_ERR_SUCCESS)
        return decode_exr_fail(reading, code);
    if (!take_window(reading, &data, &reading->data) ||
        !take_window(reading, &display, &reading->display))
        return false;
    /* OpenEXR allows no other windows for samples of two by two pixels. */
    const struct exr_box *box = &reading->data;
    const bool odd = ((uint32_t)box->left | (uint32_t)box->top | box->width | box->height) & 1u;
    return reading->layer.sampling == 1 || !odd || decode_exr_fail(reading, EXR_ERR_INVALID_ATTR);
}

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
                                       .type = KILN_IMAGE_F32,
                                       .premultiplied = alpha,
                                       .pixels = pixels};
    return image;
}

static bool make_planes(struct exr_reading *reading)
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
    float *pixel = image->pixels;
    const size_t pixels = (size_t)image->width * image->height;
    for (size_t i = 0; i < pixels; i++)
        pixel[4 * i + 3] = 1.0f;
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

/* Returns whether primaries are Rec. 709 up to the rounding of writers. */
static bool is_rec709(const struct kiln_primaries *primaries)
{
    static const double most = 1e-4;
    bool near = true;
    for (int i = 0; i < 2; i++)
        near = near && fabs(primaries->red[i] - kiln_rec709.red[i]) < most &&
               fabs(primaries->green[i] - kiln_rec709.green[i]) < most &&
               fabs(primaries->blue[i] - kiln_rec709.blue[i]) < most &&
               fabs(primaries->white[i] - kiln_rec709.white[i]) < most;
    return near;
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
    if (reading->layer.is_color && !reading->picture->raw && !is_rec709(&primaries))
        kiln_light_convert(to_srgb, reading->image->pixels, pixels);
    return true;
}

/* A cube map shows its six faces, one below the other. */
static bool check_sky(const struct exr_reading *reading)
{
    exr_envmap_t map;
    return !reading->picture->sky ||
           exr_attr_get_envmap(reading->file, reading->part, "envmap", &map) != EXR_ERR_SUCCESS ||
           map != EXR_ENVMAP_CUBE ||
           kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                          "the EXR image is a cube map; a sky is a picture by longitude and "
                          "latitude");
}

/* ---- the file -------------------------------------------------------------------------------- */

/* Returns whether all channels of the part are half floats. */
static bool are_halves(const struct exr_reading *reading)
{
    const exr_attr_chlist_t *list = NULL;
    bool all = exr_get_channels(reading->file, reading->part, &list) == EXR_ERR_SUCCESS;
    for (int i = 0; all && i < list->num_channels; i++)
        all = list->entries[i].pixel_type == EXR_PIXEL_HALF;
    return all;
}

/* Returns whether OpenEXR's C core cannot decode the part: it has no DWAA and no DWAB, and misreads
 * what follows a channel of B44 that is not of half floats. */
static bool needs_more(const struct exr_reading *reading, exr_compression_t compression)
{
    return compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB ||
           ((compression == EXR_COMPRESSION_B44 || compression == EXR_COMPRESSION_B44A) &&
            !are_halves(reading));
}

/* Only colours of deep scan lines can be flattened, which takes their alpha and depth. */
static bool check_deep(const struct exr_reading *reading, exr_storage_t storage)
{
    const struct exr_layer *layer = &reading->layer;
    const exr_attr_chlist_t *list = NULL;
    bool depth = false;
    if (exr_get_channels(reading->file, reading->part, &list) == EXR_ERR_SUCCESS) {
        for (int i = 0; i < list->num_channels; i++)
            depth = depth || strcmp(list->entries[i].name.str, "Z") == 0;
    }
    const bool flat = storage == EXR_STORAGE_DEEP_SCANLINE && depth && layer->is_color &&
                      layer->names[EXR_ALPHA] && strcmp(layer->names[EXR_ALPHA], "A") == 0;
    return flat || kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                                  "the layer '%s' of the EXR image is deep; kiln flattens only R, "
                                  "G, B and A with Z in scan lines",
                                  reading->picture->layer);
}

/* Decodes the channels, or asks for a process that has OpenEXR's C++. */
static bool read_pixels(struct exr_reading *reading)
{
    exr_storage_t storage;
    exr_compression_t compression;
    exr_result_t code = exr_get_storage(reading->file, reading->part, &storage);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_compression(reading->file, reading->part, &compression);
    if (code != EXR_ERR_SUCCESS)
        return decode_exr_fail(reading, code);
    const bool deep = storage == EXR_STORAGE_DEEP_SCANLINE || storage == EXR_STORAGE_DEEP_TILED;
    if (deep && !check_deep(reading, storage))
        return false;
    if (!deep && !needs_more(reading, compression))
        return make_planes(reading) && decode_exr_pixels(reading);
    reading->picture->needs_other = !decode_exr_more_is_ready();
    if (reading->picture->needs_other)
        return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                              "the EXR image needs OpenEXR's C++");
    return make_planes(reading) && decode_exr_more(reading, deep);
}

struct kiln_asset_image *decode_exr(struct decode_picture *picture)
{
    struct exr_reading reading = {.picture = picture};
    const exr_result_t code = open_file(&reading);
    bool ok = code == EXR_ERR_SUCCESS || decode_exr_fail(&reading, code);
    ok = ok && decode_exr_find_layer(&reading) && check_sky(&reading) && take_windows(&reading) &&
         read_pixels(&reading) && show_colors(&reading);
    if (ok) {
        fill_components(&reading);
        ok = show_window(&reading);
    }
    if (reading.file)
        exr_finish(&reading.file);
    for (int i = 0; i < 2; i++)
        free(reading.chroma[i]);
    if (!ok)
        kiln_asset_image_destroy(&reading.image);
    return reading.image;
}
