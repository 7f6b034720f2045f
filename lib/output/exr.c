/* Writes frames as OpenEXR files by OpenEXR's C core. A file has one part with the layers as
 * channels: R, G, B, A for the beauty, "fire.R" and so on for the others, Z for the depth, and
 * "gas.density.Y", a grey picture. Pixels are linear, premultiplied and ZIP-compressed in blocks of
 * 16 lines. Alpha, colour and grey are half or float as asked; depths are always float. */
#include <openexr.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "output/exr_rows.h"
#include "output/formats.h"
#include "output/zip.h"

enum {
    MAX_CHANNELS = KILN_MAX_LAYERS * 4,
    CHANNEL_NAME_SIZE = 32,
};

struct exr_encoder {
    const struct kiln_output_params *params;
    struct kiln_temporary *file;
    exr_context_t context;
    const struct kiln_exr_loops *loops;
    kiln_zip_run *zip;
    struct kiln_zip_scratch *scratch;
    struct kiln_zip_layout layout; /* of all chunks */
    /* A line's low bytes, then its high bytes; a chunk's bytes, as they are compressed; the chunk
     * as it is written. */
    uint8_t *line, *differences, *compressed;
};

/* A channel of the file, and the samples that it comes from. */
struct channel {
    char name[CHANNEL_NAME_SIZE];
    const struct kiln_layer *layer;
    exr_pixel_type_t type;
    size_t row; /* its first row of a line (struct kiln_zip_layout) */
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
    return true;
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
        return kiln_error_no_memory(error, "the EXR encoder of %s", target);
    return kiln_error_set(error, KILN_IO, "%s: OpenEXR failed: %s", target,
                          exr_get_default_error_message(code));
}

static void close_encoder(void *opaque)
{
    struct exr_encoder *encoder = opaque;
    if (encoder->context)
        exr_finish(&encoder->context);
    free(encoder->line);
    free(encoder->differences);
    free(encoder->compressed);
    free(encoder->scratch);
    free(encoder);
}

static void *open_encoder(const struct kiln_output_params *params, struct kiln_temporary *file,
                          struct kiln_error *error)
{
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error))
        return NULL;
    struct exr_encoder *encoder = calloc(1, sizeof *encoder);
    if (!encoder) {
        kiln_error_no_memory(error, "the EXR encoder of %s", file->target);
        return NULL;
    }
    encoder->params = params;
    encoder->file = file;
    encoder->loops = KILN_SIMD_PICK(kiln_exr_loops, simd);
    encoder->zip = KILN_SIMD_PICK(kiln_zip, simd);
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
        bool grey = layer->channels == 1 && strcmp(layer->name, KILN_LAYER_GAS_DENSITY) == 0;
        bool depth = layer->channels == 1 && !grey;
        bool bare = strcmp(layer->name, depth ? "depth" : "beauty") == 0;
        for (uint32_t c = 0; c < layer->channels && c < 4; c++) {
            struct channel *channel = &channels[count++];
            channel->layer = layer;
            channel->type =
                depth || encoder->params->exr_bits == 32 ? EXR_PIXEL_FLOAT : EXR_PIXEL_HALF;
            snprintf(channel->name, sizeof channel->name, "%.29s%s%c", bare ? "" : layer->name,
                     bare ? "" : ".",
                     depth  ? 'Z'
                     : grey ? 'Y'
                            : "RGBA"[c]);
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

static struct channel *find_channel(struct channel *channels, uint32_t count, const char *name)
{
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(channels[i].name, name) == 0)
            return &channels[i];
    }
    return NULL;
}

/* Gives the channels their rows, in the order of the file. */
static exr_result_t place_channels(struct exr_encoder *encoder, const struct kiln_picture *picture,
                                   struct channel *channels, uint32_t channel_count)
{
    struct kiln_zip_layout *layout = &encoder->layout;
    const exr_attr_chlist_t *list = NULL;
    const exr_result_t code = exr_get_channels(encoder->context, 0, &list);
    if (code != EXR_ERR_SUCCESS)
        return code;
    *layout = (struct kiln_zip_layout){.row_bytes = picture->width};
    for (int i = 0; i < list->num_channels; i++) {
        struct channel *channel = find_channel(channels, channel_count, list->entries[i].name.str);
        if (!channel)
            return EXR_ERR_INVALID_ARGUMENT;
        const size_t rows = channel->type == EXR_PIXEL_HALF ? 1 : 2;
        channel->row = layout->rows;
        layout->rows += rows;
        for (size_t row = channel->row; row < layout->rows && channel->type == EXR_PIXEL_FLOAT;
             row++)
            layout->float_rows |= UINT64_C(1) << row;
    }
    return layout->rows > 0 && layout->row_bytes > 0 ? EXR_ERR_SUCCESS : EXR_ERR_INVALID_ARGUMENT;
}

/* Makes room for chunks of so many lines. */
static exr_result_t make_buffers(struct exr_encoder *encoder, size_t lines)
{
    const size_t line = 2 * encoder->layout.rows * encoder->layout.row_bytes;
    encoder->line = malloc(line);
    encoder->differences = malloc(lines * line);
    encoder->compressed = malloc(kiln_zip_room(lines * line));
    encoder->scratch = malloc(sizeof *encoder->scratch);
    const bool ok =
        encoder->line && encoder->differences && encoder->compressed && encoder->scratch;
    return ok ? EXR_ERR_SUCCESS : EXR_ERR_OUT_OF_MEMORY;
}

static void pack_line(const struct exr_encoder *encoder, const struct kiln_picture *picture,
                      const struct channel *channels, uint32_t channel_count, size_t y)
{
    const size_t width = picture->width;
    uint8_t *high = encoder->line + encoder->layout.rows * width;
    for (uint32_t i = 0; i < channel_count;) {
        const struct kiln_layer *layer = channels[i].layer;
        const bool half = channels[i].type == EXR_PIXEL_HALF;
        struct kiln_exr_row rows[4];
        for (uint32_t c = 0; c < layer->channels; c++, i++) {
            const size_t at = channels[i].row * width;
            rows[c] = (struct kiln_exr_row){encoder->line + at, high + at};
        }
        encoder->loops->pack(layer->pixels + y * width * layer->channels, layer->channels, width,
                             half, rows);
    }
}

/* Writes a chunk's bytes as OpenEXR's ZIP compresses them: those at even places, then those at odd
 * ones, each but the first as its difference to the one before. Returns their number. */
static size_t make_differences(const struct exr_encoder *encoder,
                               const struct kiln_picture *picture, const struct channel *channels,
                               uint32_t channel_count, uint32_t y, uint32_t lines)
{
    const size_t line = encoder->layout.rows * picture->width, plane = lines * line;
    const uint8_t *low = encoder->line, *high = encoder->line + line;
    uint8_t *differences = encoder->differences, before[2] = {128, 0};
    for (uint32_t i = 0; i < lines; i++) {
        pack_line(encoder, picture, channels, channel_count, y + i);
        encoder->loops->subtract(low, before[0], line, differences + i * line);
        encoder->loops->subtract(high, before[1], line, differences + plane + i * line);
        before[0] = low[line - 1];
        before[1] = high[line - 1];
    }
    differences[plane] = (uint8_t)(differences[plane] - before[0]);
    return 2 * plane;
}

/* Writes a chunk's bytes as they are without compression. */
static void undo_differences(const uint8_t *differences, size_t size, uint8_t *out)
{
    uint8_t byte = 128;
    for (size_t i = 0; i < size; i++) {
        byte = (uint8_t)(byte + differences[i] - 128);
        out[i < size / 2 ? 2 * i : 2 * (i - size / 2) + 1] = byte;
    }
}

/* A chunk that gets no smaller is stored as it is. OpenEXR's C core would pack the pixels in more
 * passes, and compress them by zlib, which takes several times as long. */
static exr_result_t write_chunk(struct exr_encoder *encoder, const struct kiln_picture *picture,
                                const struct channel *channels, uint32_t channel_count, uint32_t y,
                                uint32_t lines)
{
    const size_t size = make_differences(encoder, picture, channels, channel_count, y, lines);
    size_t written = encoder->zip(encoder->differences, size, &encoder->layout, encoder->compressed,
                                  encoder->scratch);
    if (written >= size) {
        undo_differences(encoder->differences, size, encoder->compressed);
        written = size;
    }
    return exr_write_scanline_chunk(encoder->context, 0, (int)y, encoder->compressed, written);
}

static bool encode(void *opaque, const struct kiln_picture *picture, struct kiln_error *error)
{
    struct exr_encoder *encoder = opaque;
    struct channel channels[MAX_CHANNELS];
    uint32_t channel_count = list_channels(encoder, picture, channels);
    if (channel_count == 0)
        return fail(encoder, EXR_ERR_INVALID_ARGUMENT, error);
    exr_result_t code = write_header(encoder, picture, channels, channel_count);
    int32_t most = 1;
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_scanlines_per_chunk(encoder->context, 0, &most);
    if (code == EXR_ERR_SUCCESS)
        code = place_channels(encoder, picture, channels, channel_count);
    if (code == EXR_ERR_SUCCESS)
        code = make_buffers(encoder, (size_t)most);
    for (uint32_t y = 0; y < picture->height && code == EXR_ERR_SUCCESS; y += (uint32_t)most) {
        const uint32_t left = picture->height - y;
        const uint32_t lines = left < (uint32_t)most ? left : (uint32_t)most;
        code = write_chunk(encoder, picture, channels, channel_count, y, lines);
    }
    return code == EXR_ERR_SUCCESS || fail(encoder, code, error);
}

/* Ends the file; OpenEXR writes the table of chunks last. */
static bool finish(void *opaque, const struct kiln_caller *caller, struct kiln_error *error)
{
    (void)caller;
    struct exr_encoder *encoder = opaque;
    exr_result_t code = exr_finish(&encoder->context);
    encoder->context = NULL;
    return (code == EXR_ERR_SUCCESS && !encoder->file->failure) || fail(encoder, code, error);
}

const struct kiln_format kiln_format_exr = {
    .suffix = ".exr",
    .name = "OpenEXR images",
    .help = "half or float, linear, premultiplied; layers of depth, fire, smoke, bloom and gas",
    .uses = KILN_USES_EXR_BITS,
    .needs = needs,
    .check = check,
    .open = open_encoder,
    .encode = encode,
    .finish = finish,
    .close = close_encoder,
};
