/* Reads what a PNG, JPEG or EXR file says of its own scene, frame and settings, so that kiln's
 * images are recognised without a journal. */
#include "output/carried.h"

#include <openexr.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "base/error.h"
#include "base/file_in.h"
#include "base/text.h"
#include "output/formats.h"

enum { MAX_PICTURE = INT32_MAX };

/* ---- PNG ------------------------------------------------------------------------------------- */

static uint32_t get_big_endian(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* Takes the value of a tEXt chunk: a key, a zero byte, a text. */
static void take_text(const uint8_t *data, size_t size, const char *key, char *value, size_t room)
{
    const size_t length = strlen(key) + 1;
    if (size <= length || size - length >= room || memcmp(data, key, length) != 0)
        return;
    memcpy(value, data + length, size - length);
    value[size - length] = '\0';
}

/* Looks at every chunk: each has a checksum, and the last one is the end. */
static bool look_at_png(const uint8_t *bytes, size_t size, struct kiln_carried *carried)
{
    static const uint8_t signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    enum { AROUND = 12 }; /* length, type, checksum */
    if (size < sizeof signature || memcmp(bytes, signature, sizeof signature) != 0)
        return false;
    for (size_t at = sizeof signature; size - at >= AROUND;) {
        const size_t length = get_big_endian(bytes + at);
        const uint8_t *type = bytes + at + 4, *data = type + 4;
        if (length > size - at - AROUND ||
            crc32_z(0, type, length + 4) != get_big_endian(data + length))
            return false;
        if (memcmp(type, "IHDR", 4) == 0 && length == 13)
            carried->bits = data[8];
        if (memcmp(type, "tEXt", 4) == 0) {
            take_text(data, length, "kiln:version", carried->version, sizeof carried->version);
            take_text(data, length, "kiln:scene", carried->scene, sizeof carried->scene);
            take_text(data, length, "kiln:seed", carried->seed, sizeof carried->seed);
            take_text(data, length, "kiln:frame", carried->frame, sizeof carried->frame);
            take_text(data, length, "kiln:fps", carried->fps, sizeof carried->fps);
        }
        at += length + AROUND;
        if (memcmp(type, "IEND", 4) == 0)
            return at == size;
    }
    return false;
}

static bool look_into_png(const char *path, struct kiln_carried *carried, struct kiln_error *reason)
{
    size_t size;
    uint8_t *bytes = kiln_file_read(path, "picture", "PNG", MAX_PICTURE, &size, reason);
    const bool ok = bytes && look_at_png(bytes, size, carried);
    free(bytes);
    return ok;
}

/* ---- JPEG ------------------------------------------------------------------------------------ */

/* Takes the value behind "KEY=" out of words between blanks. */
static void take_word(const uint8_t *data, size_t size, const char *key, char *value, size_t room)
{
    const size_t length = strlen(key);
    for (size_t at = 0; at < size;) {
        const uint8_t *blank = memchr(data + at, ' ', size - at);
        const size_t end = blank ? (size_t)(blank - data) : size;
        if (end - at > length && end - at - length < room && memcmp(data + at, key, length) == 0) {
            memcpy(value, data + at + length, end - at - length);
            value[end - at - length] = '\0';
        }
        at = end + 1;
    }
}

/* Reads a comment that kiln wrote. */
static void take_comment(const uint8_t *data, size_t size, struct kiln_carried *carried)
{
    take_word(data, size, "kiln:version=", carried->version, sizeof carried->version);
    take_word(data, size, "kiln:scene=", carried->scene, sizeof carried->scene);
    take_word(data, size, "kiln:seed=", carried->seed, sizeof carried->seed);
    take_word(data, size, "kiln:frame=", carried->frame, sizeof carried->frame);
    take_word(data, size, "kiln:fps=", carried->fps, sizeof carried->fps);
    take_word(data, size, "kiln:quality=", carried->quality, sizeof carried->quality);
}

/* Looks at every segment up to the pixels, which end with the file: in them, 0xff is followed by 0
 * or a mark to restart at. */
static bool look_at_jpeg(const uint8_t *bytes, size_t size, struct kiln_carried *carried)
{
    enum { START = 0xd8, END = 0xd9, COMMENT = 0xfe, SCAN = 0xda, BASELINE = 0xc0 };
    size_t at = 2;
    uint8_t marker = 0;
    if (size < 4 || bytes[0] != 0xff || bytes[1] != START)
        return false;
    while (marker != SCAN) {
        if (size - at < 4 || bytes[at] != 0xff)
            return false;
        marker = bytes[at + 1];
        const size_t length = (size_t)bytes[at + 2] << 8 | bytes[at + 3];
        if (length < 2 || length > size - at - 2)
            return false;
        if (marker == BASELINE && length > 2)
            carried->bits = bytes[at + 4];
        if (marker == COMMENT)
            take_comment(bytes + at + 4, length - 2, carried);
        at += 2 + length;
    }
    for (; size - at >= 2; at++) {
        const uint8_t next = bytes[at + 1];
        if (bytes[at] == 0xff && next != 0 && (next < 0xd0 || next > 0xd7))
            return next == END && at + 2 == size;
    }
    return false;
}

static bool look_into_jpeg(const char *path, struct kiln_carried *carried,
                           struct kiln_error *reason)
{
    size_t size;
    uint8_t *bytes = kiln_file_read(path, "picture", "JPEG", MAX_PICTURE, &size, reason);
    const bool ok = bytes && look_at_jpeg(bytes, size, carried);
    free(bytes);
    return ok;
}

/* ---- EXR ------------------------------------------------------------------------------------- */

static void be_silent(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

static void take_attribute(exr_const_context_t context, const char *key, char *value, size_t room)
{
    int32_t length = 0;
    const char *text = NULL;
    if (exr_attr_get_string(context, 0, key, &length, &text) == EXR_ERR_SUCCESS && text &&
        (size_t)length < room)
        snprintf(value, room, "%.*s", (int)length, text);
}

static void take_rate(exr_const_context_t context, char *value, size_t room)
{
    exr_attr_rational_t rate;
    if (exr_attr_get_rational(context, 0, "framesPerSecond", &rate) == EXR_ERR_SUCCESS &&
        rate.num > 0 && rate.denom > 0)
        snprintf(value, room, "%d/%u", rate.num, rate.denom);
}

/* Reads every chunk of scan lines. */
static bool has_all_chunks(exr_const_context_t context, const char *path, struct kiln_error *reason)
{
    int32_t count = 0, lines = 0;
    exr_attr_box2i_t window;
    bool ok = exr_get_chunk_count(context, 0, &count) == EXR_ERR_SUCCESS &&
              exr_get_scanlines_per_chunk(context, 0, &lines) == EXR_ERR_SUCCESS &&
              exr_get_data_window(context, 0, &window) == EXR_ERR_SUCCESS;
    for (int32_t i = 0; ok && i < count; i++) {
        exr_chunk_info_t chunk;
        ok = exr_read_scanline_chunk_info(context, 0, window.min.y + i * lines, &chunk) ==
             EXR_ERR_SUCCESS;
        void *packed = ok ? malloc(chunk.packed_size + 1) : NULL;
        if (ok && !packed)
            kiln_error_no_memory(reason, "%s", path);
        ok = packed && exr_read_chunk(context, 0, &chunk, packed) == EXR_ERR_SUCCESS;
        free(packed);
    }
    return ok && count > 0;
}

static bool look_into_exr(const char *path, struct kiln_carried *carried, struct kiln_error *reason)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t context = NULL;
    initializer.error_handler_fn = be_silent;
    const exr_result_t started = exr_start_read(&context, path, &initializer);
    if (started == EXR_ERR_OUT_OF_MEMORY)
        return kiln_error_no_memory(reason, "%s", path);
    if (started != EXR_ERR_SUCCESS)
        return false;
    const exr_attr_chlist_t *channels = NULL;
    if (exr_get_channels(context, 0, &channels) == EXR_ERR_SUCCESS && channels)
        carried->bits = 32;
    for (int i = 0; channels && i < channels->num_channels; i++) {
        if (channels->entries[i].pixel_type == EXR_PIXEL_HALF) /* depth is a float in any case */
            carried->bits = 16;
    }
    take_attribute(context, "kiln:version", carried->version, sizeof carried->version);
    take_attribute(context, "kiln:scene", carried->scene, sizeof carried->scene);
    take_attribute(context, "kiln:seed", carried->seed, sizeof carried->seed);
    take_attribute(context, "kiln:frame", carried->frame, sizeof carried->frame);
    take_attribute(context, "kiln:alpha", carried->alpha, sizeof carried->alpha);
    take_rate(context, carried->fps, sizeof carried->fps);
    const bool ok = has_all_chunks(context, path, reason);
    exr_finish(&context);
    return ok;
}

bool kiln_carried_read(const char *path, struct kiln_carried *carried, struct kiln_error *reason)
{
    *carried = (struct kiln_carried){.bits = 0};
    return look_into_png(path, carried, reason) || look_into_jpeg(path, carried, reason) ||
           look_into_exr(path, carried, reason);
}

/* Returns whether the file has the depth, or for JPEG the quality, that the parameters ask for. */
static bool is_as_good(const struct kiln_output_params *params, const struct kiln_carried *carried)
{
    uint64_t quality;
    if (params->format == &kiln_format_png)
        return carried->bits == params->png_bits;
    if (params->format == &kiln_format_exr)
        return carried->bits == params->exr_bits;
    return kiln_text_to_uint64(carried->quality, &quality) && quality == params->quality;
}

bool kiln_output_carries(const struct kiln_output_params *params, const char *path, uint32_t frame,
                         struct kiln_error *reason)
{
    static const struct {
        const struct kiln_format *format;
        bool (*look)(const char *path, struct kiln_carried *carried, struct kiln_error *reason);
    } readers[] = {{&kiln_format_png, look_into_png},
                   {&kiln_format_jpeg, look_into_jpeg},
                   {&kiln_format_exr, look_into_exr}};
    struct kiln_carried carried = {.bits = 0};
    char number[16];
    snprintf(number, sizeof number, "%u", frame);
    bool whole = false;
    for (size_t i = 0; i < sizeof readers / sizeof *readers; i++)
        whole = whole ||
                (params->format == readers[i].format && readers[i].look(path, &carried, reason));
    return whole && is_as_good(params, &carried) && strcmp(carried.version, KILN_VERSION) == 0 &&
           strcmp(carried.scene, params->scene_hash) == 0 && strcmp(carried.frame, number) == 0;
}
