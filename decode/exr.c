/* This file reads OpenEXR files. decode/main.c calls decode_exr or decode_exr_layers once for a
 * request, in the process kiln-decode, which has confined itself. A confined process can open no
 * file, so OpenEXR reads the file from memory, through on_read.
 *
 * The file may be malicious, so the sizes of both windows are checked before memory is taken for
 * pixels. */
#include "exr.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"

/* Bytes of the layers that are decoded at once, of the memory that this process may take. */
static const uint64_t MOST_AT_ONCE = (uint64_t)1 << 30;

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

/* ---- layers ---------------------------------------------------------------------------------- */

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

/* Chooses what becomes of the samples of a deep part: colours are flattened, which takes their
 * alpha, and of data the nearest sample is taken. Both take the depth. */
static bool choose_deep(struct exr_reading *reading, exr_storage_t storage)
{
    const struct exr_layer *layer = &reading->layer;
    const exr_attr_chlist_t *list = NULL;
    bool depth = false, alpha = false;
    if (exr_get_channels(reading->file, reading->part, &list) == EXR_ERR_SUCCESS) {
        for (int i = 0; i < list->num_channels; i++) {
            depth = depth || strcmp(list->entries[i].name.str, "Z") == 0;
            alpha = alpha || strcmp(list->entries[i].name.str, "A") == 0;
        }
    }
    reading->deep = layer->is_data ? KILN_OPENEXR_NEAREST : KILN_OPENEXR_FLATTEN;
    return (storage == EXR_STORAGE_DEEP_SCANLINE && depth && (layer->is_data || alpha)) ||
           kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                          "the layer '%s' of the EXR image is deep; kiln reads such layers only in "
                          "scan lines, with Z, and colours with A",
                          reading->name);
}

/* Finds out how the channels of a layer are decoded. */
static bool find_way(struct exr_reading *reading)
{
    exr_storage_t storage;
    exr_compression_t compression;
    exr_result_t code = exr_get_storage(reading->file, reading->part, &storage);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_compression(reading->file, reading->part, &compression);
    if (code != EXR_ERR_SUCCESS)
        return decode_exr_fail(reading, code);
    const bool deep = storage == EXR_STORAGE_DEEP_SCANLINE || storage == EXR_STORAGE_DEEP_TILED;
    reading->more = deep || needs_more(reading, compression);
    return !deep || choose_deep(reading, storage);
}

/* Finds the layers that are asked for. */
static bool find_layers(struct exr_reading *file, struct exr_reading **layers, size_t *count)
{
    if (file->picture->layers && !*file->picture->layer)
        return decode_exr_list(file, layers, count);
    *layers = malloc(sizeof **layers);
    *count = *layers ? 1 : 0;
    if (!*layers)
        return decode_out_of_memory(file->picture->error);
    **layers = *file;
    return decode_exr_find_layer(*layers);
}

/* Checks all layers before the first one is decoded. A process that has OpenEXR's C++ is asked for
 * if one of them needs it. */
static bool prepare_layers(struct exr_reading *layers, size_t count)
{
    bool more = false;
    for (size_t i = 0; i < count; i++) {
        if (!check_sky(&layers[i]) || !take_windows(&layers[i]) || !find_way(&layers[i]))
            return false;
        more = more || layers[i].more;
    }
    layers->picture->needs_other = more && !decode_exr_more_is_ready();
    return !layers->picture->needs_other ||
           kiln_error_set(layers->picture->error, KILN_INVALID_INPUT,
                          "the EXR image needs OpenEXR's C++");
}

/* Returns how many of the layers, at least one, are decoded at once: those of one part that have
 * room in memory. A part is decompressed once for all of them. */
static size_t count_at_once(const struct exr_reading *layers, size_t count)
{
    const uint64_t pixels = (uint64_t)layers->data.width * layers->data.height;
    const uint64_t room = MOST_AT_ONCE / (pixels * sizeof(float[4]));
    size_t some = 1;
    while (some < count && some < room && layers[some].part == layers->part &&
           layers[some].deep == layers->deep)
        some++;
    return some;
}

static bool decode_layers(struct exr_reading *layers, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!decode_exr_make_planes(&layers[i]))
            return false;
    }
    return layers->more ? decode_exr_more(layers, count) : decode_exr_pixels(layers, count);
}

static void free_planes(struct exr_reading *reading)
{
    for (int i = 0; i < 2; i++) {
        free(reading->chroma[i]);
        reading->chroma[i] = NULL;
    }
    kiln_asset_image_destroy(&reading->image);
}

bool decode_exr_layers(struct decode_picture *picture, decode_take_layer *take, void *user)
{
    struct exr_reading file = {.picture = picture}, *layers = NULL;
    size_t count = 0, some = 0;
    const exr_result_t code = open_file(&file);
    bool ok = code == EXR_ERR_SUCCESS || decode_exr_fail(&file, code);
    ok = ok && find_layers(&file, &layers, &count) && prepare_layers(layers, count);
    for (size_t begin = 0; ok && begin < count; begin += some) {
        some = count_at_once(layers + begin, count - begin);
        ok = decode_layers(layers + begin, some);
        for (size_t i = begin; i < begin + some; i++) {
            ok = ok && decode_exr_show(&layers[i]);
            if (ok) {
                take(user, layers[i].name, layers[i].layer.is_data, layers[i].image);
                layers[i].image = NULL;
            }
            free_planes(&layers[i]);
        }
    }
    free(layers);
    if (file.file)
        exr_finish(&file.file);
    return ok;
}

static void keep(void *user, const char *name, bool data, struct kiln_asset_image *image)
{
    (void)name;
    (void)data;
    *(struct kiln_asset_image **)user = image;
}

struct kiln_asset_image *decode_exr(struct decode_picture *picture)
{
    struct kiln_asset_image *image = NULL;
    return decode_exr_layers(picture, keep, &image) ? image : NULL;
}
