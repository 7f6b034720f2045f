/* This file decodes the channels of layers of an OpenEXR file, in scan lines or tiles, by OpenEXR's
 * C core. The core decompresses a chunk to the samples as they lie in the file; this file
 * turns the samples into floats, since the core's own routines for that write to address 0 in some
 * files whose channels are not all asked for. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "exr.h"
#include "values.h"

/* The struct says where the samples of a channel go. */
struct target {
    struct exr_reading *reading; /* NULL: nowhere */
    enum exr_role role;
};

/* The decoding of one part. */
struct pass {
    const struct exr_reading *first; /* one of the layers, which all have this part's windows */
    struct target *targets;          /* of the channels, in the order of the file */
    int channels;
};

/* OpenEXR's core passes a chunk to `unpack`, which writes its samples into the pictures. */
struct chunk {
    const struct pass *pass;
    uint32_t x, y; /* place of its first pixel in the data window */
};

float *decode_exr_target(const struct exr_reading *reading, enum exr_role role, size_t *step,
                         size_t *stride)
{
    if (!reading->layer.names[role])
        return NULL;
    *step = role < EXR_RY ? 4 : 1;
    *stride = role < EXR_RY ? (size_t)reading->image->width * 4 : reading->chroma_width;
    return role < EXR_RY ? (float *)reading->image->pixels + role : reading->chroma[role - EXR_RY];
}

/* ---- samples --------------------------------------------------------------------------------- */

static uint32_t word_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

/* Converts a row of samples of one channel. */
static void convert_row(struct exr_reading *reading, uint16_t type, const uint8_t *bytes,
                        uint32_t count, float *target, size_t step)
{
    for (uint32_t i = 0; i < count; i++, target += step) {
        if (type == EXR_PIXEL_HALF) {
            *target = decode_half((uint32_t)bytes[2 * (size_t)i] |
                                  (uint32_t)bytes[2 * (size_t)i + 1] << 8);
        } else if (type == EXR_PIXEL_FLOAT) {
            *target = decode_float(word_at(bytes + (size_t)4 * i));
        } else {
            const uint32_t whole = word_at(bytes + (size_t)4 * i);
            if (reading->layer.is_whole) {
                memcpy(target, &whole, sizeof whole); /* the image is one of whole numbers */
                continue;
            }
            *target = (float)whole;
            if ((double)*target != (double)whole)
                reading->inexact = (double)whole;
        }
    }
}

static int role_of(const struct exr_layer *layer, const char *channel)
{
    for (int role = 0; role < EXR_ROLES; role++) {
        if (layer->names[role] && strcmp(layer->names[role], channel) == 0)
            return role;
    }
    return -1;
}

/* Converts line y of a channel in a chunk. False: it does not lie in the data window. */
static bool unpack_row(const struct chunk *chunk, int index,
                       const exr_coding_channel_info_t *channel, uint32_t y, const uint8_t *bytes)
{
    const struct pass *pass = chunk->pass;
    struct exr_reading *reading = index < pass->channels ? pass->targets[index].reading : NULL;
    size_t step = 0, stride = 0;
    if (!reading)
        return true;
    const enum exr_role role = pass->targets[index].role;
    float *target = decode_exr_target(reading, role, &step, &stride);
    const uint32_t by = role < EXR_RY ? 1 : (uint32_t)reading->layer.sampling;
    const uint32_t columns = role < EXR_RY ? reading->image->width : reading->chroma_width;
    const uint32_t rows = role < EXR_RY ? reading->image->height : reading->chroma_height;
    const uint32_t column = chunk->x / by, row = (chunk->y + y) / by;
    if (row >= rows || column > columns || (uint32_t)channel->width > columns - column)
        return false;
    convert_row(reading, channel->data_type, bytes, (uint32_t)channel->width,
                target + row * stride + column * step, step);
    return true;
}

/* Is called by the core with a decompressed chunk, whose lines have the samples of one channel
 * after those of another. */
static exr_result_t unpack(exr_decode_pipeline_t *pipeline)
{
    const struct chunk *chunk = pipeline->decoding_user_data;
    const uint8_t *bytes = pipeline->unpacked_buffer;
    uint64_t left = pipeline->chunk.unpacked_size;
    for (int32_t y = 0; y < pipeline->chunk.height; y++) {
        const int64_t line = (int64_t)chunk->pass->first->data.top + chunk->y + y;
        for (int i = 0; i < pipeline->channel_count; i++) {
            const exr_coding_channel_info_t *channel = &pipeline->channels[i];
            if (channel->width <= 0 || line % channel->y_samples != 0)
                continue;
            const uint64_t size =
                (uint64_t)channel->width * (channel->data_type == EXR_PIXEL_HALF ? 2 : 4);
            if (size > left || !bytes || !unpack_row(chunk, i, channel, (uint32_t)y, bytes))
                return EXR_ERR_CORRUPT_CHUNK;
            bytes += size;
            left -= size;
        }
    }
    return EXR_ERR_SUCCESS;
}

/* ---- chunks ---------------------------------------------------------------------------------- */

static exr_result_t read_chunk(const struct exr_reading *reading, const exr_chunk_info_t *info,
                               struct chunk *chunk, exr_decode_pipeline_t *pipeline)
{
    const bool first = !pipeline->channels;
    exr_result_t code = first
                            ? exr_decoding_initialize(reading->file, reading->part, info, pipeline)
                            : exr_decoding_update(reading->file, reading->part, info, pipeline);
    if (code == EXR_ERR_SUCCESS && first)
        code = exr_decoding_choose_default_routines(reading->file, reading->part, pipeline);
    if (code != EXR_ERR_SUCCESS)
        return code;
    pipeline->decoding_user_data = chunk;
    pipeline->unpack_and_convert_fn = unpack;
    /* The core takes a chunk without bytes for one that needs no decompression. */
    code = info->packed_size == 0 ? EXR_ERR_CORRUPT_CHUNK
                                  : exr_decoding_run(reading->file, reading->part, pipeline);
    pipeline->decoding_user_data = NULL; /* the pipeline lives longer than the chunk */
    return code;
}

static exr_result_t read_lines(const struct pass *pass, exr_decode_pipeline_t *pipeline)
{
    const struct exr_reading *reading = pass->first;
    int32_t lines = 0;
    exr_result_t code = exr_get_scanlines_per_chunk(reading->file, reading->part, &lines);
    if (code == EXR_ERR_SUCCESS && lines < 1)
        code = EXR_ERR_INVALID_ATTR;
    for (uint32_t y = 0; code == EXR_ERR_SUCCESS && y < reading->data.height;
         y += (uint32_t)lines) {
        struct chunk chunk = {.pass = pass, .y = y};
        exr_chunk_info_t info;
        code = exr_read_scanline_chunk_info(reading->file, reading->part,
                                            (int32_t)(reading->data.top + (int64_t)y), &info);
        if (code == EXR_ERR_SUCCESS)
            code = read_chunk(reading, &info, &chunk, pipeline);
    }
    return code;
}

/* Reads the tiles of the largest level. */
static exr_result_t read_tiles(const struct pass *pass, exr_decode_pipeline_t *pipeline)
{
    const struct exr_reading *reading = pass->first;
    uint32_t width = 0, height = 0;
    exr_tile_level_mode_t levels;
    exr_tile_round_mode_t rounding;
    exr_result_t code =
        exr_get_tile_descriptor(reading->file, reading->part, &width, &height, &levels, &rounding);
    if (code == EXR_ERR_SUCCESS && (width < 1 || height < 1))
        code = EXR_ERR_INVALID_ATTR;
    for (uint64_t y = 0; code == EXR_ERR_SUCCESS && y < reading->data.height; y += height) {
        for (uint64_t x = 0; code == EXR_ERR_SUCCESS && x < reading->data.width; x += width) {
            struct chunk chunk = {.pass = pass, .x = (uint32_t)x, .y = (uint32_t)y};
            exr_chunk_info_t info;
            code = exr_read_tile_chunk_info(reading->file, reading->part, (int)(x / width),
                                            (int)(y / height), 0, 0, &info);
            if (code == EXR_ERR_SUCCESS)
                code = read_chunk(reading, &info, &chunk, pipeline);
        }
    }
    return code;
}

/* Finds where the samples of each channel of the part go. */
static exr_result_t find_targets(struct pass *pass, struct exr_reading *readings, size_t count)
{
    const exr_attr_chlist_t *list = NULL;
    const exr_result_t code = exr_get_channels(readings->file, readings->part, &list);
    if (code != EXR_ERR_SUCCESS)
        return code;
    pass->channels = list->num_channels;
    pass->targets = calloc((size_t)pass->channels + 1, sizeof *pass->targets);
    for (int i = 0; pass->targets && i < pass->channels; i++) {
        for (size_t k = 0; k < count && !pass->targets[i].reading; k++) {
            const int role = role_of(&readings[k].layer, list->entries[i].name.str);
            if (role >= 0)
                pass->targets[i] = (struct target){&readings[k], (enum exr_role)role};
        }
    }
    return pass->targets ? EXR_ERR_SUCCESS : EXR_ERR_OUT_OF_MEMORY;
}

/* Whole numbers that no float equals cannot be shown. */
static bool check_exact(const struct exr_reading *reading)
{
    return reading->inexact == 0.0 ||
           kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                          "the layer '%s' has the whole number %.0f, which no float equals; kiln "
                          "reads whole numbers up to 16777216",
                          reading->name, reading->inexact);
}

bool decode_exr_pixels(struct exr_reading *readings, size_t count)
{
    struct pass pass = {.first = readings};
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    exr_result_t code = exr_get_storage(readings->file, readings->part, &storage);
    if (code == EXR_ERR_SUCCESS)
        code = find_targets(&pass, readings, count);
    if (code == EXR_ERR_SUCCESS)
        code = storage == EXR_STORAGE_TILED ? read_tiles(&pass, &pipeline)
                                            : read_lines(&pass, &pipeline);
    exr_decoding_destroy(readings->file, &pipeline);
    free(pass.targets);
    bool ok = code == EXR_ERR_SUCCESS || decode_exr_fail(readings, code);
    for (size_t i = 0; ok && i < count; i++)
        ok = check_exact(&readings[i]);
    return ok;
}
