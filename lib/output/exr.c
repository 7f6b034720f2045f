/* Writes frames as OpenEXR files by OpenEXR's C core. A file has one part with the layers as
 * channels: R, G, B, A for the beauty, "fire.R" and so on for the others, Z for the depth. Pixels
 * are linear, premultiplied and ZIP-compressed in blocks of 16 lines. Alpha and colour are half or
 * float as asked; depth is always float. */
#include <math.h>
#include <openexr.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "output/formats.h"
#include "output/libdeflate.h"

enum {
    MAX_CHANNELS = KILN_MAX_LAYERS * 4,
    CHANNEL_NAME_SIZE = 32,
    ZIP_LEVEL = 1, /* of libdeflate */
};

/* The largest half: a larger value would read back as infinity. */
static const float half_max = 65504.0f;

struct exr_encoder {
    const struct kiln_output_params *params;
    struct kiln_temporary *file;
    exr_context_t context;
    exr_encode_pipeline_t pipeline;
    bool pipeline_used;
    float *block; /* the lines of one chunk, channel after channel */
    struct kiln_compressor *compressor;
    /* A chunk's bytes, sorted; their differences; the chunk as it is written. */
    uint8_t *sorted, *differences, *compressed;
    size_t chunk_room; /* bytes of each of them */
};

/* A channel of the file, and the samples that it comes from. */
struct channel {
    char name[CHANNEL_NAME_SIZE];
    const struct kiln_layer *layer;
    uint32_t component;
    exr_pixel_type_t type;
};

static struct kiln_output_needs needs(const struct kiln_output_params *params)
{
    (void)params;
    return (struct kiln_output_needs){.layers = KILN_LAYERS_ALL};
}

static bool check(const struct kiln_output_params *params, struct kiln_error *error)
{
    if (params->exr_bits != 16 && params->exr_bits != 32)
        return kiln_error_set(
            error, KILN_USAGE,
            "found %u bits a channel for an EXR; allowed are 16 (half) or 32 (float)",
            params->exr_bits);
    return kiln_libdeflate_open(error);
}

/* Ignores OpenEXR's message; without a handler, OpenEXR would print it. The returned code is
 * enough. The handler cannot ask the context for its user data, since the context holds its
 * lock. */
static void on_failure(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

static int64_t on_write(exr_const_context_t context, void *opaque, const void *bytes, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t report)
{
    (void)context;
    (void)report;
    struct exr_encoder *encoder = opaque;
    bool good = kiln_temporary_seek(encoder->file, (int64_t)offset) &&
                kiln_temporary_write(encoder->file, bytes, size);
    return good ? (int64_t)size : -1;
}

static bool fail(const struct exr_encoder *encoder, exr_result_t code, struct kiln_error *error)
{
    const char *target = encoder->file->target;
    if (encoder->file->failure)
        return kiln_temporary_fail(encoder->file, error);
    if (code == EXR_ERR_OUT_OF_MEMORY)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: no memory for the EXR encoder",
                              target);
    return kiln_error_set(error, KILN_IO, "%s: OpenEXR failed: %s", target,
                          exr_get_default_error_message(code));
}

static void close_encoder(void *opaque)
{
    struct exr_encoder *encoder = opaque;
    if (encoder->pipeline_used)
        exr_encoding_destroy(encoder->context, &encoder->pipeline);
    if (encoder->context)
        exr_finish(&encoder->context);
    kiln_compressor_destroy(&encoder->compressor);
    free(encoder->sorted);
    free(encoder->differences);
    free(encoder->compressed);
    free(encoder->block);
    free(encoder);
}

static void *open_encoder(const struct kiln_output_params *params, struct kiln_temporary *file,
                          struct kiln_error *error)
{
    struct exr_encoder *encoder = calloc(1, sizeof *encoder);
    if (!encoder) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: no memory for the EXR encoder",
                       file->target);
        return NULL;
    }
    encoder->params = params;
    encoder->file = file;
    encoder->compressor = kiln_compressor_create(ZIP_LEVEL);
    if (!encoder->compressor) {
        fail(encoder, EXR_ERR_OUT_OF_MEMORY, error);
        close_encoder(encoder);
        return NULL;
    }
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    initializer.user_data = encoder;
    initializer.error_handler_fn = on_failure;
    initializer.write_fn = on_write;
    exr_result_t code =
        exr_start_write(&encoder->context, file->target, EXR_WRITE_FILE_DIRECTLY, &initializer);
    if (code == EXR_ERR_SUCCESS)
        return encoder;
    fail(encoder, code, error);
    close_encoder(encoder);
    return NULL;
}

/* ---- The header --------------------------------------------------------------------------- */

static uint32_t list_channels(const struct exr_encoder *encoder, const struct kiln_picture *picture,
                              struct channel channels[MAX_CHANNELS])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < picture->layer_count; i++) {
        const struct kiln_layer *layer = &picture->layers[i];
        bool depth = layer->channels == 1;
        bool bare = strcmp(layer->name, depth ? "depth" : "beauty") == 0;
        for (uint32_t c = 0; c < layer->channels && c < 4; c++) {
            struct channel *channel = &channels[count++];
            channel->layer = layer;
            channel->component = c;
            channel->type =
                depth || encoder->params->exr_bits == 32 ? EXR_PIXEL_FLOAT : EXR_PIXEL_HALF;
            snprintf(channel->name, sizeof channel->name, "%.29s%s%c", bare ? "" : layer->name,
                     bare ? "" : ".", depth ? 'Z' : "RGBA"[c]);
        }
    }
    return count;
}

static exr_result_t write_metadata(const struct exr_encoder *encoder, uint32_t frame)
{
    const struct kiln_output_params *params = encoder->params;
    char seed[16], number[16];
    snprintf(seed, sizeof seed, "%u", params->seed);
    snprintf(number, sizeof number, "%u", frame);
    const char *const texts[][2] = {
        {"software", "kiln " KILN_VERSION},
        {"kiln:version", KILN_VERSION},
        {"kiln:alpha", params->alpha ? "1" : "0"},
        /* this key and all after it are written only where there is a scene */
        {"kiln:scene", params->scene_hash},
        {"kiln:seed", seed},
        {"kiln:frame", number},
    };
    const size_t count = params->scene_hash ? sizeof texts / sizeof *texts : 3;
    exr_result_t code = EXR_ERR_SUCCESS;
    for (size_t i = 0; i < count && code == EXR_ERR_SUCCESS; i++)
        code = exr_attr_set_string(encoder->context, 0, texts[i][0], texts[i][1]);
    const exr_attr_chromaticities_t rec709 = {0.64f, 0.33f, 0.30f,   0.60f,
                                              0.15f, 0.06f, 0.3127f, 0.3290f};
    if (code == EXR_ERR_SUCCESS)
        code = exr_attr_set_chromaticities(encoder->context, 0, "chromaticities", &rec709);
    const exr_attr_rational_t rate = {(int32_t)params->fps_num, params->fps_den};
    if (code == EXR_ERR_SUCCESS && params->scene_hash)
        code = exr_attr_set_rational(encoder->context, 0, "framesPerSecond", &rate);
    return code;
}

static exr_result_t write_header(const struct exr_encoder *encoder,
                                 const struct kiln_picture *picture, const struct channel *channels,
                                 uint32_t channel_count)
{
    int part = 0;
    exr_context_t context = encoder->context;
    exr_result_t code = exr_add_part(context, "kiln", EXR_STORAGE_SCANLINE, &part);
    if (code == EXR_ERR_SUCCESS)
        code = exr_initialize_required_attr_simple(context, part, (int32_t)picture->width,
                                                   (int32_t)picture->height, EXR_COMPRESSION_ZIP);
    for (uint32_t i = 0; i < channel_count && code == EXR_ERR_SUCCESS; i++)
        code = exr_add_channel(context, part, channels[i].name, channels[i].type,
                               EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    if (code == EXR_ERR_SUCCESS)
        code = write_metadata(encoder, picture->frame);
    if (code == EXR_ERR_SUCCESS)
        code = exr_write_header(context);
    return code;
}

/* ---- The pixels --------------------------------------------------------------------------- */

static const struct channel *find_channel(const struct channel *channels, uint32_t count,
                                          const char *name)
{
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(channels[i].name, name) == 0)
            return &channels[i];
    }
    return NULL;
}

/* Gathers the lines from y on of one channel, in order; halves are kept finite. */
static void gather(const struct channel *channel, const struct kiln_picture *picture, uint32_t y,
                   uint32_t lines, float *out)
{
    uint32_t step = channel->layer->channels;
    const float *in =
        channel->layer->pixels + (size_t)y * picture->width * step + channel->component;
    size_t count = (size_t)lines * picture->width;
    bool half = channel->type == EXR_PIXEL_HALF;
    for (size_t i = 0; i < count; i++, in += step)
        out[i] = half && fabsf(*in) > half_max ? copysignf(half_max, *in) : *in;
}

static bool reserve_chunk(struct exr_encoder *encoder, size_t size)
{
    if (size <= encoder->chunk_room)
        return true;
    free(encoder->sorted);
    free(encoder->differences);
    free(encoder->compressed);
    encoder->sorted = malloc(size);
    encoder->differences = malloc(size);
    encoder->compressed = malloc(size);
    const bool ok = encoder->sorted && encoder->differences && encoder->compressed;
    encoder->chunk_room = ok ? size : 0;
    return ok;
}

/* Compresses a chunk as OpenEXR's ZIP does (ImfZip.cpp): bytes at even places come first, then
 * those at odd ones; then each byte but the first becomes its difference to the one before, plus
 * 128. A chunk that gets no smaller is stored as it is. OpenEXR 3.1 would call zlib, which takes
 * three times as long. */
static exr_result_t compress_chunk(exr_encode_pipeline_t *pipeline)
{
    struct exr_encoder *encoder = pipeline->encoding_user_data;
    const size_t size = pipeline->packed_bytes, half = (size + 1) / 2;
    const uint8_t *packed = pipeline->packed_buffer;
    if (!reserve_chunk(encoder, size))
        return EXR_ERR_OUT_OF_MEMORY;
    uint8_t *sorted = encoder->sorted, *differences = encoder->differences;
    for (size_t i = 0; i < size / 2; i++) {
        sorted[i] = packed[2 * i];
        sorted[half + i] = packed[2 * i + 1];
    }
    if (size % 2)
        sorted[half - 1] = packed[size - 1];
    differences[0] = sorted[0];
    for (size_t i = 1; i < size; i++)
        differences[i] = (uint8_t)(sorted[i] - sorted[i - 1] + 128);
    size_t written =
        kiln_compressor_run(encoder->compressor, differences, size, encoder->compressed, size);
    if (written == 0 || written >= size) {
        memcpy(encoder->compressed, packed, size);
        written = size;
    }
    pipeline->compressed_buffer = encoder->compressed;
    pipeline->compressed_bytes = written;
    pipeline->compressed_alloc_size = 0;
    return EXR_ERR_SUCCESS;
}

/* Runs the pipeline, to which the compressed bytes are lent. */
static exr_result_t run_pipeline(struct exr_encoder *encoder)
{
    exr_encode_pipeline_t *pipeline = &encoder->pipeline;
    pipeline->encoding_user_data = encoder;
    pipeline->compress_fn = compress_chunk;
    const exr_result_t code = exr_encoding_run(encoder->context, 0, pipeline);
    pipeline->compressed_buffer = NULL;
    return code;
}

static exr_result_t write_chunk(struct exr_encoder *encoder, const struct kiln_picture *picture,
                                const struct channel *channels, uint32_t channel_count, uint32_t y)
{
    exr_chunk_info_t chunk;
    exr_encode_pipeline_t *pipeline = &encoder->pipeline;
    exr_result_t code = exr_write_scanline_chunk_info(encoder->context, 0, (int)y, &chunk);
    if (code == EXR_ERR_SUCCESS)
        code = encoder->pipeline_used
                   ? exr_encoding_update(encoder->context, 0, &chunk, pipeline)
                   : exr_encoding_initialize(encoder->context, 0, &chunk, pipeline);
    if (code != EXR_ERR_SUCCESS)
        return code;
    size_t plane = (size_t)picture->width * (size_t)chunk.height;
    for (int i = 0; i < pipeline->channel_count; i++) {
        exr_coding_channel_info_t *target = &pipeline->channels[i];
        const struct channel *source = find_channel(channels, channel_count, target->channel_name);
        if (!source)
            return EXR_ERR_INVALID_ARGUMENT;
        float *out = encoder->block + plane * (size_t)i;
        gather(source, picture, y, (uint32_t)chunk.height, out);
        target->user_data_type = EXR_PIXEL_FLOAT;
        target->user_bytes_per_element = sizeof(float);
        target->user_pixel_stride = sizeof(float);
        target->user_line_stride = (int32_t)(picture->width * sizeof(float));
        target->encode_from_ptr = (const uint8_t *)out;
    }
    if (!encoder->pipeline_used)
        code = exr_encoding_choose_default_routines(encoder->context, 0, pipeline);
    encoder->pipeline_used = true;
    return code == EXR_ERR_SUCCESS ? run_pipeline(encoder) : code;
}

static bool encode(void *opaque, const struct kiln_picture *picture, struct kiln_error *error)
{
    struct exr_encoder *encoder = opaque;
    struct channel channels[MAX_CHANNELS];
    uint32_t channel_count = list_channels(encoder, picture, channels);
    if (channel_count == 0)
        return fail(encoder, EXR_ERR_INVALID_ARGUMENT, error);
    exr_result_t code = write_header(encoder, picture, channels, channel_count);
    int32_t lines = 1;
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_scanlines_per_chunk(encoder->context, 0, &lines);
    if (code == EXR_ERR_SUCCESS) {
        encoder->block =
            malloc((size_t)lines * picture->width * channel_count * sizeof *encoder->block);
        code = encoder->block ? EXR_ERR_SUCCESS : EXR_ERR_OUT_OF_MEMORY;
    }
    for (uint32_t y = 0; y < picture->height && code == EXR_ERR_SUCCESS; y += (uint32_t)lines)
        code = write_chunk(encoder, picture, channels, channel_count, y);
    return code == EXR_ERR_SUCCESS || fail(encoder, code, error);
}

/* Ends the file; OpenEXR writes the table of chunks last. */
static bool finish(void *opaque, const struct kiln_caller *caller, struct kiln_error *error)
{
    (void)caller;
    struct exr_encoder *encoder = opaque;
    if (encoder->pipeline_used)
        exr_encoding_destroy(encoder->context, &encoder->pipeline);
    encoder->pipeline_used = false;
    exr_result_t code = exr_finish(&encoder->context);
    encoder->context = NULL;
    return (code == EXR_ERR_SUCCESS && !encoder->file->failure) || fail(encoder, code, error);
}

const struct kiln_format kiln_format_exr = {
    .suffix = ".exr",
    .name = "OpenEXR images",
    .help = "half or float, linear, premultiplied; named layers",
    .uses = KILN_USES_EXR_BITS,
    .needs = needs,
    .check = check,
    .open = open_encoder,
    .encode = encode,
    .finish = finish,
    .close = close_encoder,
};
