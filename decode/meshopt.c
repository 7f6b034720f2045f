/* This file decodes the streams of meshopt, as the glTF extension KHR_meshopt_compression describes
 * them: attributes, of which each byte is stored as differences from the element before, in groups
 * of 16; triangles, which refer to recent edges and vertices; and other indices. */
#include "meshopt.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "decode.h"

enum {
    MOST_ELEMENTS = 4 * KILN_MAX_MESH_VERTICES, /* of a view, of attributes or indices */
    MOST_STRIDE = 256,
    GROUP = 16, /* bytes that are stored in one way */
    MOST_BLOCK = 256,
    BLOCK_BYTES = 8192,
    KIND_MASK = 0xf0, /* of the first byte, whose rest is a version */
    ATTRIBUTES = 0xa0,
    TRIANGLES = 0xe0,
    INDICES = 0xd0,
    CODES_OF_VERTICES = 16, /* bytes at the end of a stream of triangles */
};

struct input {
    const unsigned char *at, *end;
    bool is_short; /* more was read than there is */
};

static unsigned next_byte(struct input *in)
{
    if (in->at < in->end)
        return *in->at++;
    in->is_short = true;
    return 0;
}

/* Undoes the mapping of signed numbers to unsigned ones by which small ones stay small. */
static uint32_t unzigzag(uint32_t v)
{
    return (v >> 1) ^ (0u - (v & 1));
}

/* ---- attributes ------------------------------------------------------------------------------ */

struct block {
    uint32_t count; /* of elements */
    /* byte by byte of an element, those of all elements of the block, padded to groups */
    unsigned char deltas[MOST_STRIDE][MOST_BLOCK];
};

/* Reads a group of 16 numbers of 1, 2 or 4 bits. The largest number stands for one that follows as
 * a byte. */
static void read_bits(struct input *in, unsigned bits, unsigned char out[GROUP])
{
    unsigned char packed[GROUP] = {0};
    const unsigned per_byte = 8 / bits, mask = (1u << bits) - 1;
    for (unsigned i = 0; i < GROUP / per_byte; i++)
        packed[i] = (unsigned char)next_byte(in);
    for (unsigned i = 0; i < GROUP; i++) {
        const unsigned place = i % per_byte;
        /* single bits begin with the lowest, others with the highest */
        const unsigned shift = bits == 1 ? place : (per_byte - 1 - place) * bits;
        const unsigned value = packed[i / per_byte] >> shift & mask;
        out[i] = (unsigned char)(value == mask ? next_byte(in) : value);
    }
}

static void read_raw(struct input *in, size_t count, unsigned char *out)
{
    for (size_t i = 0; i < count; i++)
        out[i] = (unsigned char)next_byte(in);
}

/* Reads the differences of one byte of all elements of a block, in groups each of which says by how
 * many bits it has them. */
static void read_groups(struct input *in, const unsigned widths[4], uint32_t count,
                        unsigned char *out)
{
    const uint32_t groups = (count + GROUP - 1) / GROUP;
    unsigned char header[MOST_BLOCK / GROUP / 4] = {0};
    read_raw(in, (groups + 3) / 4, header);
    for (uint32_t i = 0; i < groups; i++) {
        const unsigned bits = widths[header[i / 4] >> i % 4 * 2 & 3];
        unsigned char *group = out + (size_t)i * GROUP;
        if (bits == 0)
            memset(group, 0, GROUP);
        else if (bits == 8)
            read_raw(in, GROUP, group);
        else
            read_bits(in, bits, group);
    }
}

/* Reads a block. In the second version, two bits say of each byte of an element how its differences
 * are stored. */
static void read_block(struct input *in, unsigned version, uint32_t stride, struct block *block)
{
    static const unsigned first[4] = {0, 2, 4, 8}, low[4] = {0, 1, 2, 4}, high[4] = {1, 2, 4, 8};
    unsigned char control[MOST_STRIDE / 4] = {0};
    if (version > 0)
        read_raw(in, stride / 4, control);
    for (uint32_t byte = 0; byte < stride; byte++) {
        const unsigned how = control[byte / 4] >> byte % 4 * 2 & 3;
        unsigned char *out = block->deltas[byte];
        if (version == 0)
            read_groups(in, first, block->count, out);
        else if (how == 2)
            memset(out, 0, MOST_BLOCK);
        else if (how == 3)
            read_raw(in, block->count, out);
        else
            read_groups(in, how == 0 ? low : high, block->count, out);
    }
}

/* Adds the differences of four bytes of an element to those of the element before, `last`: as four
 * bytes, as two numbers of 16 bits, or by exclusive or with 32 bits that are rotated. */
static void add_bytes(const struct block *block, uint32_t element, uint32_t byte, unsigned channel,
                      unsigned char *last)
{
    uint32_t d[4];
    for (uint32_t i = 0; i < 4; i++)
        d[i] = block->deltas[byte + i][element];
    if ((channel & 3) == 0) {
        for (uint32_t i = 0; i < 4; i++)
            last[i] = (unsigned char)(last[i] + unzigzag(d[i]));
    } else if ((channel & 3) == 1) {
        for (uint32_t i = 0; i < 4; i += 2) {
            const uint32_t before = last[i] | (uint32_t)last[i + 1] << 8;
            const uint32_t now = before + unzigzag(d[i] | d[i + 1] << 8);
            last[i] = (unsigned char)now;
            last[i + 1] = (unsigned char)(now >> 8);
        }
    } else {
        const uint32_t delta = d[0] | d[1] << 8 | d[2] << 16 | d[3] << 24, turn = channel >> 4;
        const uint32_t turned = turn ? delta >> turn | delta << (32 - turn) : delta;
        for (uint32_t i = 0; i < 4; i++)
            last[i] = (unsigned char)(last[i] ^ turned >> 8 * i);
    }
}

static bool decode_attributes(const struct meshopt_stream *stream, unsigned char *out,
                              struct block *block)
{
    const uint32_t stride = stream->stride;
    const unsigned version = stream->bytes[0] & ~(unsigned)KIND_MASK;
    const size_t tail = stride + (version > 0 ? stride / 4 : 0);
    const size_t least = version > 0 ? 24 : 32, padded = tail > least ? tail : least;
    if (version > 1 || stride % 4 != 0 || stride > MOST_STRIDE || stream->size < 1 + padded)
        return false;
    const unsigned char *end = stream->bytes + stream->size, *channels = end - tail + stride;
    struct input in = {stream->bytes + 1, end - padded, false};
    unsigned char last[MOST_STRIDE];
    memcpy(last, end - tail, stride); /* what the first element's differences are from */
    uint32_t most = BLOCK_BYTES / stride / GROUP * GROUP;
    most = most < MOST_BLOCK ? most : MOST_BLOCK;
    for (uint32_t first = 0; first < stream->count && !in.is_short; first += most) {
        block->count = stream->count - first < most ? stream->count - first : most;
        read_block(&in, version, stride, block);
        for (uint32_t i = 0; i < block->count; i++) {
            for (uint32_t byte = 0; byte < stride; byte += 4)
                add_bytes(block, i, byte, version > 0 ? channels[byte / 4] : 0, last + byte);
            memcpy(out + ((size_t)first + i) * stride, last, stride);
        }
    }
    return !in.is_short && in.at == in.end;
}

/* ---- indices --------------------------------------------------------------------------------- */

/* Reads a number of 7 bits a byte, the lowest first. */
static uint32_t read_varying(struct input *in)
{
    uint32_t number = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
        const unsigned byte = next_byte(in);
        number |= (uint32_t)(byte & 127) << shift;
        if (byte < 128)
            break;
    }
    return number;
}

static void put_index(const struct meshopt_stream *stream, size_t i, uint32_t index,
                      unsigned char *out)
{
    for (uint32_t k = 0; k < stream->stride; k++)
        out[i * stream->stride + k] = (unsigned char)(index >> 8 * k);
}

static bool decode_indices(const struct meshopt_stream *stream, unsigned char *out)
{
    struct input in = {stream->bytes + 1, stream->bytes + stream->size, false};
    uint32_t last[2] = {0};
    for (uint32_t i = 0; i < stream->count && !in.is_short; i++) {
        const uint32_t code = read_varying(&in);
        last[code & 1] += unzigzag(code >> 1);
        put_index(stream, i, last[code & 1], out);
    }
    return !in.is_short;
}

struct triangles {
    struct input data;
    const unsigned char *codes; /* the pairs of codes that are frequent */
    uint32_t next, last;        /* the next new vertex; the last that was written as a difference */
    uint32_t edges[16][2], vertices[16];
    unsigned edge_at, vertex_at;
};

static void push_edge(struct triangles *t, uint32_t a, uint32_t b)
{
    t->edges[t->edge_at][0] = a;
    t->edges[t->edge_at][1] = b;
    t->edge_at = (t->edge_at + 1) % 16;
}

static void push_vertex(struct triangles *t, uint32_t v)
{
    t->vertices[t->vertex_at] = v;
    t->vertex_at = (t->vertex_at + 1) % 16;
}

/* Returns the vertex that was pushed `back` vertices before the last one. */
static uint32_t recent_vertex(const struct triangles *t, unsigned back)
{
    return t->vertices[(t->vertex_at - 1 - back) % 16];
}

static uint32_t read_vertex(struct triangles *t)
{
    t->last += unzigzag(read_varying(&t->data));
    return t->last;
}

/* Decodes a triangle beside a recent edge. */
static void beside_edge(struct triangles *t, unsigned edge, unsigned code, uint32_t out[3])
{
    const uint32_t *from = t->edges[(t->edge_at - 1 - edge) % 16];
    const uint32_t a = from[0], b = from[1];
    uint32_t c;
    if (code == 0)
        c = t->next++;
    else if (code < 13)
        c = recent_vertex(t, code);
    else if (code == 15)
        c = read_vertex(t);
    else
        c = t->last += code == 13 ? UINT32_MAX : 1;
    if (code == 0 || code >= 13)
        push_vertex(t, c);
    push_edge(t, c, b);
    push_edge(t, a, c);
    out[0] = a;
    out[1] = b;
    out[2] = c;
}

/* Decodes a vertex of a triangle by itself: a new one, a recent one, or, if `far`, one that is
 * written as a difference. */
static uint32_t free_vertex(struct triangles *t, unsigned code, bool far)
{
    return code == 0 ? t->next++ : far ? read_vertex(t) : recent_vertex(t, code - 1);
}

static void by_itself(struct triangles *t, unsigned code, uint32_t out[3])
{
    const bool is_rare = code >= 14;
    const unsigned pair = is_rare ? next_byte(&t->data) : t->codes[code];
    const unsigned b = pair >> 4, c = pair & 15;
    if (is_rare && pair == 0)
        t->next = 0;
    /* the codes refer to the vertices that were recent before this triangle */
    out[0] = code == 15 ? read_vertex(t) : t->next++;
    out[1] = free_vertex(t, b, is_rare && b == 15);
    out[2] = free_vertex(t, c, is_rare && c == 15);
    push_vertex(t, out[0]);
    if (b == 0 || (is_rare && b == 15))
        push_vertex(t, out[1]);
    if (c == 0 || (is_rare && c == 15))
        push_vertex(t, out[2]);
    push_edge(t, out[1], out[0]);
    push_edge(t, out[2], out[1]);
    push_edge(t, out[0], out[2]);
}

static bool decode_triangles(const struct meshopt_stream *stream, unsigned char *out)
{
    const uint32_t count = stream->count / 3;
    if (stream->count % 3 != 0 || stream->size < 1 + (size_t)count + CODES_OF_VERTICES)
        return false;
    const unsigned char *codes = stream->bytes + 1, *end = stream->bytes + stream->size;
    struct triangles t = {.data = {codes + count, end - CODES_OF_VERTICES, false},
                          .codes = end - CODES_OF_VERTICES};
    memset(t.edges, 0xff, sizeof t.edges);
    memset(t.vertices, 0xff, sizeof t.vertices);
    for (uint32_t i = 0; i < count && !t.data.is_short; i++) {
        uint32_t corners[3];
        if (codes[i] >> 4 < 15)
            beside_edge(&t, codes[i] >> 4, codes[i] & 15, corners);
        else
            by_itself(&t, codes[i] & 15, corners);
        for (size_t c = 0; c < 3; c++)
            put_index(stream, (size_t)i * 3 + c, corners[c], out);
    }
    return !t.data.is_short && t.data.at == t.data.end;
}

/* ---- all of it ------------------------------------------------------------------------------- */

static bool decode(const struct meshopt_stream *stream, unsigned char *out, struct block *block)
{
    const unsigned kind = stream->size > 0 ? stream->bytes[0] & KIND_MASK : 0;
    const unsigned version = stream->size > 0 ? stream->bytes[0] & ~(unsigned)KIND_MASK : 0;
    const bool is_index = stream->stride == 2 || stream->stride == 4;
    switch (stream->mode) {
    case MESHOPT_ATTRIBUTES:
        return kind == ATTRIBUTES && decode_attributes(stream, out, block) &&
               meshopt_unfilter(stream, out);
    case MESHOPT_TRIANGLES:
        return kind == TRIANGLES && version == 1 && is_index && decode_triangles(stream, out);
    case MESHOPT_INDICES:
        break;
    }
    return kind == INDICES && version == 1 && is_index && decode_indices(stream, out);
}

unsigned char *meshopt_decode(const struct meshopt_stream *stream, struct kiln_error *error)
{
    if (stream->count > MOST_ELEMENTS || stream->stride == 0 || stream->stride > MOST_STRIDE) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "a compressed buffer view has %u elements of %u bytes; allowed are %d of %d",
                       stream->count, stream->stride, MOST_ELEMENTS, MOST_STRIDE);
        return NULL;
    }
    const size_t size = (size_t)stream->count * stream->stride;
    unsigned char *out = malloc(size + 1);
    struct block *block = calloc(1, sizeof *block);
    if (!out || !block) {
        decode_out_of_memory(error);
        free(out);
        out = NULL;
    } else if (!decode(stream, out, block)) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "a buffer view that meshopt compresses is broken or cut short");
        free(out);
        out = NULL;
    }
    free(block);
    return out;
}
