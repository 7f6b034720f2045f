/* This file gets the bytes of a glTF document's buffers: the binary chunk of a GLB, a data URI, or
 * another file, which kiln opens. It also finds the parts of buffers that views are, which meshopt
 * may have compressed. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gltf.h"
#include "meshopt.h"

/* ---- URIs ------------------------------------------------------------------------------------ */

static int hex_of(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

size_t gltf_decode_percents(char *text, size_t length)
{
    size_t to = 0;
    for (size_t from = 0; from < length; from++) {
        const int high = text[from] == '%' && length - from > 2 ? hex_of(text[from + 1]) : -1;
        const int low = high >= 0 ? hex_of(text[from + 2]) : -1;
        text[to++] = (char)(unsigned char)(low >= 0 ? high * 16 + low : text[from]);
        from += low >= 0 ? 2 : 0;
    }
    return to;
}

static int base64_of(unsigned char c)
{
    return c >= 'A' && c <= 'Z'   ? c - 'A'
           : c >= 'a' && c <= 'z' ? c - 'a' + 26
           : c >= '0' && c <= '9' ? c - '0' + 52
           : c == '+' || c == '-' ? 62
           : c == '/' || c == '_' ? 63
                                  : -1;
}

/* Decodes base64 in place; false: there is another character. */
static bool decode_base64(char *text, size_t *length)
{
    uint32_t bits = 0;
    unsigned count = 0;
    size_t to = 0, end = *length;
    while (end > 0 && text[end - 1] == '=')
        end--;
    for (size_t i = 0; i < end; i++) {
        const int digit = base64_of((unsigned char)text[i]);
        if (text[i] == ' ' || text[i] == '\n' || text[i] == '\r' || text[i] == '\t')
            continue;
        if (digit < 0)
            return false;
        bits = bits << 6 | (uint32_t)digit;
        count += 6;
        if (count >= 8) {
            count -= 8;
            text[to++] = (char)(bits >> count & 255);
        }
    }
    *length = to;
    return true;
}

bool gltf_decode_data(struct gltf *g, char *uri, size_t length, struct gltf_bytes *out)
{
    static const char base64[] = ";base64";
    const size_t mark = sizeof base64 - 1;
    char *comma = memchr(uri, ',', length);
    if (!comma)
        return GLTF_SET(g, "a buffer's data URI has no data");
    const bool encoded = (size_t)(comma - uri) >= mark && memcmp(comma - mark, base64, mark) == 0;
    size_t size = length - (size_t)(comma + 1 - uri);
    memmove(uri, comma + 1, size);
    size = gltf_decode_percents(uri, size);
    if (encoded && !decode_base64(uri, &size))
        return GLTF_SET(g, "a buffer's data URI is not base64");
    out->bytes = (const unsigned char *)uri;
    out->size = size;
    return true;
}

/* Gets the file of a relative URI from kiln. */
static bool open_file(struct gltf *g, char *uri, size_t length, struct gltf_bytes *out)
{
    length = gltf_decode_percents(uri, length);
    uri[length] = '\0';
    if (strlen(uri) != length || length >= KILN_MESSAGE_SIZE)
        return GLTF_SET(g, "the name of a buffer's file has a zero, or is longer than %d bytes",
                        KILN_MESSAGE_SIZE - 1);
    size_t size = 0;
    unsigned char *bytes = g->wanted->open
                               ? g->wanted->open(g->wanted->user, KILN_COMPANION_BUFFER, uri, &size)
                               : NULL;
    if (!bytes)
        return GLTF_SET(g, "the mesh file names the file '%.200s', which cannot be read", uri);
    free(out->owned);
    *out = (struct gltf_bytes){bytes, size, bytes};
    return true;
}

/* ---- buffers --------------------------------------------------------------------------------- */

char *gltf_copy_uri(struct gltf *g, const json_t *value, size_t *length)
{
    char none[1];
    *length = gltf_text(value, none, sizeof none);
    char *uri = malloc(*length + 1);
    if (uri)
        gltf_text(value, uri, *length + 1);
    else
        decode_out_of_memory(g->error);
    return uri;
}

static bool open_uri(struct gltf *g, const json_t *value, struct gltf_bytes *out)
{
    size_t length = 0;
    char *uri = gltf_copy_uri(g, value, &length);
    if (!uri)
        return false;
    *out = (struct gltf_bytes){.owned = (unsigned char *)uri};
    return length >= 5 && strncasecmp(uri, "data:", 5) == 0 ? gltf_decode_data(g, uri, length, out)
                                                            : open_file(g, uri, length, out);
}

static bool open_buffer(struct gltf *g, uint32_t number)
{
    struct gltf_bytes *buffer = &g->buffers[number];
    const json_t *json = gltf_element(g, GLTF_BUFFERS, number);
    const json_t *uri = gltf_member(json, "uri");
    const json_t *said = gltf_member(json, "byteLength");
    uint32_t length = 0;
    if (said && !gltf_index(said, &length))
        return GLTF_SET(g, "the byteLength of buffer %u is no length", number);
    if (uri && !open_uri(g, uri, buffer))
        return false;
    if (uri == NULL && number == 0)
        *buffer = g->chunk;
    /* A buffer without bytes is one that only meshopt's views refer to, or that nothing does. */
    if (!buffer->bytes)
        return true;
    if (length > buffer->size)
        return GLTF_SET(g, "buffer %u is cut short: it has %zu bytes of %u", number, buffer->size,
                        length);
    if (said)
        buffer->size = length;
    return true;
}

bool gltf_open_buffers(struct gltf *g)
{
    const uint32_t count = g->lists[GLTF_BUFFERS].count;
    g->buffers = calloc((size_t)count + 1, sizeof *g->buffers);
    g->views = calloc((size_t)g->lists[GLTF_VIEWS].count + 1, sizeof *g->views);
    if (!g->buffers || !g->views)
        return decode_out_of_memory(g->error);
    for (uint32_t i = 0; i < count; i++) {
        if (!open_buffer(g, i))
            return false;
    }
    return true;
}

/* ---- views ----------------------------------------------------------------------------------- */

/* Gets a member that is a size; `otherwise` if there is none. */
static bool get_size(struct gltf *g, const json_t *object, const char *key, uint32_t otherwise,
                     uint32_t *size)
{
    const json_t *value = gltf_member(object, key);
    *size = otherwise;
    return !value || gltf_index(value, size) ||
           GLTF_SET(g, "a member '%s' is no whole number from 0 to %u", key, UINT32_MAX - 1);
}

/* Finds the part of a buffer that a view, or its meshopt extension, names. */
static bool find_part(struct gltf *g, uint32_t view, const json_t *json, struct gltf_view *out)
{
    uint32_t buffer = 0, offset = 0, length = 0, stride = 0;
    if (!gltf_reference(g, json, "buffer", GLTF_BUFFERS, &buffer) ||
        !get_size(g, json, "byteOffset", 0, &offset) ||
        !get_size(g, json, "byteLength", 0, &length) ||
        !get_size(g, json, "byteStride", 0, &stride))
        return false;
    if (buffer == GLTF_NONE || !g->buffers[buffer].bytes)
        return GLTF_SET(g, "buffer view %u is in a buffer without data", view);
    const struct gltf_bytes *from = &g->buffers[buffer];
    if (offset > from->size || length > from->size - offset)
        return GLTF_SET(g, "buffer view %u ends at byte %llu of a buffer of %zu", view,
                        (unsigned long long)offset + length, from->size);
    *out = (struct gltf_view){from->bytes + offset, length, stride};
    return true;
}

const json_t *gltf_meshopt_of(const struct gltf *g, uint32_t view)
{
    const json_t *json = gltf_element(g, GLTF_VIEWS, view);
    const json_t *found = gltf_extension(json, "KHR_meshopt_compression");
    if (!found)
        found = gltf_extension(json, "EXT_meshopt_compression");
    if (!found || g->needs_meshopt)
        return found;
    /* The view's own buffer may have the data if the file does not require the extension. */
    uint32_t buffer = 0;
    const bool has = gltf_index(gltf_member(json, "buffer"), &buffer) &&
                     buffer < g->lists[GLTF_BUFFERS].count && g->buffers[buffer].bytes;
    return has ? NULL : found;
}

static bool get_meshopt(struct gltf *g, const json_t *json, struct meshopt_stream *stream)
{
    static const char *const modes[] = {[MESHOPT_ATTRIBUTES] = "ATTRIBUTES",
                                        [MESHOPT_TRIANGLES] = "TRIANGLES",
                                        [MESHOPT_INDICES] = "INDICES"};
    static const char *const filters[] = {[MESHOPT_NONE] = "NONE",
                                          [MESHOPT_OCTAHEDRAL] = "OCTAHEDRAL",
                                          [MESHOPT_QUATERNION] = "QUATERNION",
                                          [MESHOPT_EXPONENTIAL] = "EXPONENTIAL",
                                          [MESHOPT_COLOR] = "COLOR"};
    const json_t *mode = gltf_member(json, "mode");
    const json_t *filter = gltf_member(json, "filter");
    uint32_t stride = 0, count = 0, m = 0, f = 0;
    if (!get_size(g, json, "byteStride", 0, &stride) || !get_size(g, json, "count", 0, &count))
        return false;
    while (m < 3 && !gltf_is(mode, modes[m]))
        m++;
    while (filter && f < 5 && !gltf_is(filter, filters[f]))
        f++;
    stream->mode = (enum meshopt_mode)m;
    stream->filter = (enum meshopt_filter)f;
    stream->stride = stride;
    stream->count = count;
    return (m < 3 && f < 5) || GLTF_SET(g, "a buffer view has a mode or a filter of meshopt that "
                                           "kiln does not know");
}

/* Decompresses a view, once. */
static bool decompress(struct gltf *g, uint32_t number, const json_t *json, struct gltf_view *view)
{
    struct gltf_bytes *kept = &g->views[number];
    struct meshopt_stream stream;
    struct gltf_view packed = {.size = 0};
    if (!get_meshopt(g, json, &stream))
        return false;
    if (!kept->bytes) {
        if (!find_part(g, number, json, &packed))
            return false;
        stream.bytes = packed.bytes;
        stream.size = packed.size;
        kept->owned = meshopt_decode(&stream, g->error);
        if (!kept->owned)
            return false;
        kept->bytes = kept->owned;
        kept->size = (size_t)stream.count * stream.stride;
    }
    *view = (struct gltf_view){kept->bytes, kept->size, stream.stride};
    return true;
}

bool gltf_find_view(struct gltf *g, uint32_t number, struct gltf_view *view)
{
    const json_t *json = gltf_element(g, GLTF_VIEWS, number);
    const json_t *meshopt = gltf_meshopt_of(g, number);
    if (meshopt)
        return decompress(g, number, meshopt, view);
    return find_part(g, number, json, view);
}
