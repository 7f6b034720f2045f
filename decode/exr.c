/* This file decodes one layer of an OpenEXR file by OpenEXR's C core. decode/main.c calls
 * decode_exr once a request of kind KILN_DECODE_EXR, in the process kiln-decode, which has confined
 * itself. choose_kind in lib/asset/image/image.c decides which files come here: FFmpeg decodes the
 * layer "beauty" of tiled files instead (picture.c).
 *
 * A confined process can open no file, so OpenEXR reads the file from memory, through on_read. Each
 * chunk of scan lines is decoded straight into the picture, as four floats a pixel.
 *
 * The file may be malicious, so the picture's size is checked before memory is taken for the
 * pixels. Only parts in scan lines are read, and only channels of full resolution: read_pixels can
 * read no others. */
#include <openexr.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "decode.h"

struct reading {
    struct decode_picture *picture;
    exr_context_t file;
    int part;
    const char *channels[4]; /* names in the file for R, G, B and A; NULL: the layer lacks it */
    int32_t left, top;       /* first pixel of the data window, which need not be at 0 */
    struct kiln_asset_image *image;
};

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
    const struct reading *reading = opaque;
    if (offset > reading->picture->size)
        return -1;
    size_t left = reading->picture->size - (size_t)offset;
    size_t taken = count < left ? (size_t)count : left;
    memcpy(buffer, reading->picture->bytes + offset, taken);
    return (int64_t)taken;
}

static int64_t on_size(exr_const_context_t context, void *opaque)
{
    (void)context;
    return (int64_t)((const struct reading *)opaque)->picture->size;
}

static exr_result_t open_file(struct reading *reading)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    initializer.user_data = reading;
    initializer.error_handler_fn = on_failure;
    initializer.read_fn = on_read;
    initializer.size_fn = on_size;
    initializer.max_image_width = KILN_MAX_IMAGE_EDGE;
    initializer.max_image_height = KILN_MAX_IMAGE_EDGE;
    return exr_start_read(&reading->file, "an EXR image", &initializer);
}

static bool fail(const struct reading *reading, exr_result_t code)
{
    if (code == EXR_ERR_OUT_OF_MEMORY)
        return decode_out_of_memory(reading->picture->error);
    return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                          "the EXR image is broken or cut short (%s)",
                          exr_get_default_error_message(code));
}

/* ---- The layer ---------------------------------------------------------------------------- */

/* Returns which component of the layer a channel holds: 0 to 3 for R, G, B and A, or -1 if it is
 * not of the layer. Y, luminance, and Z, depth, are the one component of a grey layer: 0. */
static int component_of(const char *channel, const char *layer)
{
    static const char names[] = "RGBAYZ";
    bool beauty = strcmp(layer, "beauty") == 0, depth = strcmp(layer, "depth") == 0;
    const char *last = channel;
    if (!beauty && !(depth && strcmp(channel, "Z") == 0)) {
        size_t length = strlen(layer);
        if (strncmp(channel, layer, length) != 0 || channel[length] != '.')
            return -1;
        last = channel + length + 1;
    }
    const char *found = strlen(last) == 1 ? strchr(names, *last) : NULL;
    if (!found || (beauty && *last == 'Z'))
        return -1;
    return *last == 'Y' || *last == 'Z' ? 0 : (int)(found - names);
}

/* Finds the layer's channels in a part. Returns whether it has them: one, or all three colours.
 * Alpha may be missing. */
static bool find_channels(struct reading *reading, const exr_attr_chlist_t *list)
{
    memset(reading->channels, 0, sizeof reading->channels);
    for (int i = 0; i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[i];
        int component = component_of(entry->name.str, reading->picture->layer);
        if (component >= 0 && entry->x_sampling == 1 && entry->y_sampling == 1)
            reading->channels[component] = entry->name.str;
    }
    bool colour = reading->channels[1] && reading->channels[2];
    bool any = reading->channels[1] || reading->channels[2];
    return reading->channels[0] && colour == any;
}

/* Lists the channels of the file for an error: "R, G, B, fire.R, ..." */
static void list_channels(const struct reading *reading, int parts, char *text, size_t size)
{
    size_t length = 0;
    for (int part = 0; part < parts; part++) {
        const exr_attr_chlist_t *list = NULL;
        if (exr_get_channels(reading->file, part, &list) != EXR_ERR_SUCCESS)
            continue;
        for (int i = 0; i < list->num_channels && length + 1 < size; i++) {
            int written = snprintf(text + length, size - length, "%s%s", length ? ", " : "",
                                   list->entries[i].name.str);
            length += written > 0 ? (size_t)written : 0;
        }
    }
}

static bool find_part(struct reading *reading)
{
    int parts = 0;
    exr_result_t code = exr_get_count(reading->file, &parts);
    for (int part = 0; code == EXR_ERR_SUCCESS && part < parts; part++) {
        const exr_attr_chlist_t *list = NULL;
        exr_storage_t storage;
        code = exr_get_storage(reading->file, part, &storage);
        if (code == EXR_ERR_SUCCESS)
            code = exr_get_channels(reading->file, part, &list);
        if (code != EXR_ERR_SUCCESS || storage != EXR_STORAGE_SCANLINE)
            continue;
        reading->part = part;
        if (find_channels(reading, list))
            return true;
    }
    if (code != EXR_ERR_SUCCESS)
        return fail(reading, code);
    char found[256] = "none";
    list_channels(reading, parts, found, sizeof found);
    return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                          "no layer '%s' whose lines have full size; the file has the channels %s",
                          reading->picture->layer, found);
}

static bool make_image(struct reading *reading)
{
    exr_attr_box2i_t window;
    exr_result_t code = exr_get_data_window(reading->file, reading->part, &window);
    if (code != EXR_ERR_SUCCESS)
        return fail(reading, code);
    int64_t width = (int64_t)window.max.x - window.min.x + 1;
    int64_t height = (int64_t)window.max.y - window.min.y + 1;
    if (!decode_allows_size(reading->picture, "EXR", width, height))
        return false;
    struct kiln_asset_image *image = calloc(1, sizeof *image);
    float *pixels = image ? malloc((size_t)(width * height) * 4 * sizeof *pixels) : NULL;
    reading->image = image;
    if (!pixels)
        return fail(reading, EXR_ERR_OUT_OF_MEMORY);
    *image = (struct kiln_asset_image){.width = (uint32_t)width,
                                       .height = (uint32_t)height,
                                       .channels = reading->channels[1] ? 3 : 1,
                                       .type = KILN_IMAGE_F32,
                                       .premultiplied = true,
                                       .pixels = pixels};
    image->channels += reading->channels[3] != NULL;
    reading->left = window.min.x;
    reading->top = window.min.y;
    return true;
}

/* ---- The pixels --------------------------------------------------------------------------- */

static void set_targets(const struct reading *reading, exr_decode_pipeline_t *pipeline, uint32_t y)
{
    const struct kiln_asset_image *image = reading->image;
    float *row = (float *)image->pixels + (size_t)y * image->width * 4;
    for (int i = 0; i < pipeline->channel_count; i++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[i];
        channel->decode_to_ptr = NULL;
        for (int c = 0; c < 4; c++) {
            if (!reading->channels[c] || strcmp(channel->channel_name, reading->channels[c]) != 0)
                continue;
            channel->decode_to_ptr = (uint8_t *)(row + c);
            channel->user_data_type = EXR_PIXEL_FLOAT;
            channel->user_bytes_per_element = sizeof(float);
            channel->user_pixel_stride = 4 * sizeof(float);
            channel->user_line_stride = (int32_t)(image->width * sizeof(float[4]));
        }
    }
}

static exr_result_t read_chunk(const struct reading *reading, uint32_t y,
                               exr_decode_pipeline_t *pipeline, bool first)
{
    exr_chunk_info_t chunk;
    exr_result_t code = exr_read_scanline_chunk_info(reading->file, reading->part,
                                                     reading->top + (int32_t)y, &chunk);
    if (code == EXR_ERR_SUCCESS)
        code = first ? exr_decoding_initialize(reading->file, reading->part, &chunk, pipeline)
                     : exr_decoding_update(reading->file, reading->part, &chunk, pipeline);
    if (code != EXR_ERR_SUCCESS)
        return code;
    set_targets(reading, pipeline, y);
    if (first)
        code = exr_decoding_choose_default_routines(reading->file, reading->part, pipeline);
    return code == EXR_ERR_SUCCESS ? exr_decoding_run(reading->file, reading->part, pipeline)
                                   : code;
}

/* Fills the missing components: grey is copied to all colours, and missing alpha is opaque. */
static void fill_components(const struct reading *reading)
{
    float *pixel = reading->image->pixels;
    size_t pixels = (size_t)reading->image->width * reading->image->height;
    for (size_t i = 0; i < pixels; i++, pixel += 4) {
        if (!reading->channels[1])
            pixel[1] = pixel[2] = pixel[0];
        if (!reading->channels[3])
            pixel[3] = 1.0f;
    }
}

static bool read_pixels(const struct reading *reading)
{
    int32_t lines = 0;
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t code = exr_get_scanlines_per_chunk(reading->file, reading->part, &lines);
    for (uint32_t y = 0; code == EXR_ERR_SUCCESS && lines > 0 && y < reading->image->height;
         y += (uint32_t)lines)
        code = read_chunk(reading, y, &pipeline, y == 0);
    exr_decoding_destroy(reading->file, &pipeline);
    if (code != EXR_ERR_SUCCESS || lines < 1)
        return fail(reading, code);
    fill_components(reading);
    return true;
}

struct kiln_asset_image *decode_exr(struct decode_picture *picture)
{
    struct reading reading = {.picture = picture};
    exr_result_t code = open_file(&reading);
    bool ok = code == EXR_ERR_SUCCESS
                  ? find_part(&reading) && make_image(&reading) && read_pixels(&reading)
                  : fail(&reading, code);
    if (reading.file)
        exr_finish(&reading.file);
    if (!ok)
        kiln_asset_image_destroy(&reading.image);
    return reading.image;
}
