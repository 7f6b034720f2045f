/* This file makes packets of fragments. The glow of a fragment is its colour times the bloom
 * weights of its sprite, but where there is gas, which glows before it: then a packet has the glow
 * itself. It sorts and blends all packets of a vector of pixels together, so that no step depends
 * on a comparison that the processor cannot predict. A pixel has a key for each sheet of each
 * packet. The key of a fragment that the pixel lacks comes last and names the empty packet, whose
 * fragments change no colour. */
#include "base/lane_math.h"
#include "base/transpose.h"
#include "draw/sprites/packet_sort.h"
#include "draw/sprites/packets.h"
#include "draw/sprites/ribbon_pixels.h"
#include "shared/fragment_layout.h"

/* The upper word of the key of depth 0, and that of a fragment that does not exist. */
enum { NEAREST = 0x7fdfffff, ABSENT = 0x7fefffff };

struct packet {
    _Alignas(4 * LANES) float colors[LANES][4]; /* premultiplied, with alpha; of each sheet */
    vi depths[2]; /* upper words of keys: of the only or far sheet, and of the near sheet */
    float bloom[4];
    uint32_t order;    /* number of the sprite in the list of sprites */
    bool glows, thick; /* its bloom is not 0; some pixels have two sheets */
};

/* A packet that has the glow of each pixel of a sheet. */
struct glowing_packet {
    struct packet packet;
    _Alignas(4 * LANES) float glow[LANES][4];
};

SIMD struct packet *packet_of(const struct kiln_packets *packets, size_t number)
{
    return (struct packet *)(void *)((char *)packets->packets + number * packets->stride);
}

/* ---- making ---------------------------------------------------------------------------------- */

/* Returns exact_sqrt(x) for x up to 2^100. */
SIMD vf square_root(vf x)
{
    return vf_where(x >= 0x1p-100f, x * vf_rsqrt(x));
}

/* Returns half the thickness of a sprite in the pixels at u, v, m. */
SIMD vf find_half_depth(const struct kiln_sprite *s, vf u, vf v)
{
    vf across = u * (2.0f / s->edge_u) - 1.0f, along = v * (2.0f / s->edge_v) - 1.0f;
    vf inside = vf_max(1.0f - (across * across + along * along), vf_all(0.0f));
    vf half = 0.5f * s->bulge * square_root(inside);
    return vf_where(half > 0.0f, half);
}

SIMD vi depth_word(vf depth, vi drawn)
{
    return vi_select(drawn, NEAREST - (vi)vf_max(depth, vf_all(0.0f)), vi_all(ABSENT));
}

/* Sets the depths of the pixels from x, y, px, on. Returns which of them have two sheets. */
SIMD vi put_depths(struct packet *packet, const struct kiln_sprite *s,
                   const struct kiln_sprite_extra *extra, float x, float y, vi drawn)
{
    if (s->shade >= KILN_SHADES) {
        const struct ribbon_strip strip = ribbon_strip_of(s, &extra->ribbon);
        const struct ribbon_pixels ribbon = ribbon_at(&strip, vf_count() + x, vf_all(y));
        packet->depths[0] = depth_word(ribbon.depth, drawn);
        packet->depths[1] = depth_word(ribbon.depth, vi_all(0));
        packet->thick = false;
        return vi_all(0);
    }
    const vf dx = vf_count() + x - s->x;
    const float dy = y - s->y;
    vf u = s->u + s->u_x * dx + s->u_y * dy, v = s->v + s->v_x * dx + s->v_y * dy;
    vf depth = vf_all(s->depth), half = vf_all(0.0f);
    if (s->flags & KILN_SPRITE_DEEP) {
        depth = 1.0f / (extra->q + extra->q_x * dx + extra->q_y * dy);
        u *= depth;
        v *= depth;
    }
    if (s->bulge > 0.0f)
        half = find_half_depth(s, u, v);
    const vi thick = drawn & (half > 0.0f);
    packet->depths[0] = depth_word(depth + half, drawn);
    packet->depths[1] = depth_word(depth - half, thick);
    packet->thick = any(thick);
    return thick;
}

/* Stores four numbers of each lane. */
SIMD void put_fours(float to[LANES][4], vf a, vf b, vf c, vf d)
{
    const struct columns fours = columns_transpose(a, b, c, d);
    for (int k = 0; k < 4; k++) {
        for (size_t part = 0; part < LANES / 4; part++)
            memcpy(to[4 * part + (size_t)k], (const char *)&fours.c[k] + 16 * part, 16);
    }
}

/* Sets the colours, and unless it is NULL the glow: rgb. thick: pixels with two sheets, which share
 * them. */
SIMD void put_colors(struct packet *packet, const vf planes[4], const vf *glow, vi thick)
{
    vf rgb[3] = {planes[0], planes[1], planes[2]}, alpha = planes[3], part = vf_all(1.0f);
    if (packet->thick) {
        const vf left = vf_max(1.0f - alpha, vf_all(0.0f));
        alpha = vf_select(thick, 1.0f - square_root(left), alpha);
        part = vf_select(thick, 1.0f / (2.0f - alpha), part);
        for (int c = 0; c < 3; c++)
            rgb[c] = vf_select(thick, rgb[c] * part, rgb[c]);
    }
    put_fours(packet->colors, rgb[0], rgb[1], rgb[2], alpha);
    if (glow)
        put_fours(((struct glowing_packet *)(void *)packet)->glow, glow[0] * part, glow[1] * part,
                  glow[2] * part, vf_all(0.0f));
}

/* Takes the colours of the pixels from x on out of the scratch tile. end: the end of the sprite's
 * box; pixels beyond it count as empty. Returns the pixels that have a colour. */
SIMD vi take_pixels(float (*from)[KILN_TILE_PITCH], int x, int end, vf planes[4])
{
    const vi inside = vi_count() < end - x;
    vi bits = {0};
    for (int c = 0; c < 4; c++) {
        planes[c] = vf_where(inside, vf_load(&from[KILN_TILE_RED + c][x]));
        bits |= (vi)planes[c];
        vf_store(&from[KILN_TILE_RED + c][x], vf_all(0.0f));
    }
    return (bits & 0x7fffffff) != 0;
}

/* Takes the glow of pixels out of the scratch tile, as take_pixels takes their colours. */
SIMD void take_glow(float (*from)[KILN_TILE_PITCH], int x, int end, vf glow[3])
{
    const vi inside = vi_count() < end - x;
    for (int c = 0; c < 3; c++) {
        glow[c] = vf_where(inside, vf_load(&from[KILN_TILE_GLOW_RED + c][x]));
        vf_store(&from[KILN_TILE_GLOW_RED + c][x], vf_all(0.0f));
    }
}

/* Returns which sheets' keys are gathered now. */
SIMD vi gathered(const struct kiln_packets *packets, const struct packet *packet, int sheet)
{
    const vi word = packet->depths[sheet];
    const int32_t first = (int32_t)(packets->first_key >> 32);
    const int32_t end = (int32_t)(packets->end_key >> 32);
    const vi equals_first = vi_all(packet->order >= (uint32_t)packets->first_key ? -1 : 0);
    const vi equals_end = vi_all(packet->order < (uint32_t)packets->end_key ? -1 : 0);
    return ((word > first) | ((word == first) & equals_first)) &
           ((word < end) | ((word == end) & equals_end));
}

static bool gathers_all(const struct kiln_packets *packets)
{
    return packets->first_key == 0 && packets->end_key == KILN_PACKET_KEYS_END;
}

static void add(struct kiln_packets *packets, struct kiln_tile *scratch,
                const struct kiln_packet_box *box, const struct kiln_sprite *s,
                const struct kiln_sprite_extra *extra, uint32_t order)
{
    struct packet *to = packet_of(packets, packets->count);
    const bool all = gathers_all(packets);
    const bool glows = s->bloom[0] != 0.0f || s->bloom[1] != 0.0f || s->bloom[2] != 0.0f;
    const int drawn_to = box->x_to + UNIT - 1; /* the last unit of a row may reach beyond the box */
    const int end = drawn_to < KILN_TILE_WIDTH ? drawn_to : KILN_TILE_WIDTH;
    for (int y = box->y_from; y < box->y_to; y++) {
        for (int x = box->x_from / LANES * LANES; x < end; x += LANES) {
            vf planes[4], glow[3];
            const vi drawn = take_pixels(scratch->pixels[y], x, box->x_to, planes);
            if (packets->glow)
                take_glow(scratch->pixels[y], x, box->x_to, glow);
            if (!any(drawn))
                continue;
            const vi thick = put_depths(to, s, extra, (float)(scratch->x + x) + 0.5f,
                                        (float)(scratch->y + y) + 0.5f, drawn);
            to->order = order;
            if (!all && !any(gathered(packets, to, 0) | gathered(packets, to, 1)))
                continue;
            put_colors(to, planes, packets->glow ? glow : NULL, thick);
            memcpy(to->bloom, s->bloom, sizeof s->bloom);
            to->bloom[3] = 0.0f;
            to->glows = glows;
            packets->places[packets->count++] = (uint16_t)((y * KILN_TILE_WIDTH + x) / LANES);
            to = packet_of(packets, packets->count);
        }
    }
}

static uint64_t least_key(const struct kiln_packets *packets, size_t number)
{
    const struct packet *packet = packet_of(packets, number);
    uint64_t least = KILN_PACKET_KEYS_END;
    for (int i = 0; i < 2 * LANES; i++) {
        const uint64_t key =
            (uint64_t)(uint32_t)packet->depths[i / LANES][i % LANES] << 32 | packet->order;
        if (key >= packets->first_key && key < least)
            least = key;
    }
    return least;
}

/* ---- blending -------------------------------------------------------------------------------- */

/* Holds the keys of a vector of pixels, those of half of the pixels in each matrix. A key's lower
 * word is the offset of its packet, in floats. */
struct key_rows {
    keys *half[2];
    size_t count;
};

SIMD void put_row(struct key_rows *rows, vi words, vi offsets)
{
    const vf low = (vf)offsets, high = (vf)words;
    rows->half[0][rows->count] = (keys)VF_PICK(low, high, 0, 4, 1, 5);
    rows->half[1][rows->count++] = (keys)VF_PICK(low, high, 2, 6, 3, 7);
}

/* Lists and sorts the keys of some packets. Returns the greatest number of fragments of a pixel. */
SIMD size_t sort_keys(struct key_rows *rows, const struct kiln_packets *packets,
                      const uint32_t *list, size_t count)
{
    const bool all = gathers_all(packets);
    const int32_t floats = (int32_t)(packets->stride / sizeof(float));
    const size_t room =
        (2 * count + KILN_PACKET_SORT_BLOCK - 1) / KILN_PACKET_SORT_BLOCK * KILN_PACKET_SORT_BLOCK;
    *rows = (struct key_rows){.half = {(keys *)packets->keys, (keys *)packets->keys + room}};
    vi counts = {0};
    for (size_t i = 0; i < count; i++) {
        const struct packet *packet = packet_of(packets, list[i]);
        for (int sheet = 0; sheet < 1 + packet->thick; sheet++) {
            vi words = packet->depths[sheet], present = words < ABSENT;
            if (!all) {
                present &= gathered(packets, packet, sheet);
                words = vi_select(present, words, vi_all(ABSENT));
            }
            put_row(rows, words, present & ((int32_t)list[i] * floats));
            counts -= present;
        }
    }
    while (rows->count % KILN_PACKET_SORT_BLOCK != 0)
        put_row(rows, vi_all(ABSENT), vi_all(0));
    for (int half = 0; half < 2; half++)
        sort_rows(rows->half[half], rows->count);
    size_t most = 0;
    for (int i = 0; i < LANES; i++)
        most = (size_t)counts[i] > most ? (size_t)counts[i] : most;
    return most;
}

typedef int32_t offset_in_key __attribute__((may_alias));

/* Loads four floats for each of the lanes k, 4 + k, 8 + k...: those at `from` plus the offset in
 * the lane's key. `from` moves on by `step` floats from one of these lanes to the next. at: the
 * lower word of the key of lane k. */
SIMD vf load_fours(const float *from, const offset_in_key *at, size_t step)
{
#if LANES == 16
    __m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(from + at[0])),
                                      _mm_loadu_ps(from + at[4] + step), 1);
    __m256 high =
        _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(from + at[8] + 2 * step)),
                             _mm_loadu_ps(from + at[12] + 3 * step), 1);
    return (vf)_mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
#elif LANES == 8
    return (vf)_mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(from + at[0])),
                                    _mm_loadu_ps(from + at[4] + step), 1);
#else
    (void)step;
    return vf_load(from + at[0]);
#endif
}

/* Says what of the glow of fragments is blended. */
enum glow_of { GLOW_NONE, GLOW_WEIGHTS, GLOW_PIXELS };

/* Blends sorted fragments over colours and, if there are any, their glow over the glow. The lanes
 * are those of columns_transpose. */
SIMD void blend_rows(const struct key_rows *rows, size_t count, const float *packets,
                     struct columns *color, struct columns *glow, enum glow_of glow_of)
{
    const size_t bloom = offsetof(struct packet, bloom) / sizeof(float);
    const size_t pixels = offsetof(struct glowing_packet, glow) / sizeof(float);
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < 4; k++) {
            const offset_in_key *at = (const offset_in_key *)&rows->half[k / 2][i] + 2 * (k % 2);
            const vf drawn = load_fours(packets + 4 * k, at, 16);
            const vf passed = 1.0f - VF_PICK(drawn, drawn, 3, 3, 3, 3);
            color->c[k] = drawn + color->c[k] * passed;
            if (glow_of == GLOW_WEIGHTS)
                glow->c[k] = drawn * load_fours(packets + bloom, at, 0) + glow->c[k] * passed;
            if (glow_of == GLOW_PIXELS)
                glow->c[k] = load_fours(packets + pixels + 4 * k, at, 16) + glow->c[k] * passed;
        }
    }
}

SIMD struct columns load_planes(float (*planes)[KILN_TILE_PITCH], int first, int count, int x)
{
    return columns_transpose(vf_load(&planes[first][x]), vf_load(&planes[first + 1][x]),
                             vf_load(&planes[first + 2][x]),
                             count > 3 ? vf_load(&planes[first + 3][x]) : vf_all(0.0f));
}

SIMD void store_planes(float (*planes)[KILN_TILE_PITCH], int first, int count, int x,
                       const struct columns *pixels)
{
    const struct columns c =
        columns_transpose(pixels->c[0], pixels->c[1], pixels->c[2], pixels->c[3]);
    for (int k = 0; k < count; k++)
        vf_store(&planes[first + k][x], c.c[k]);
}

static void blend(const struct kiln_packets *packets, const uint32_t *list, size_t count,
                  float (*planes)[KILN_TILE_PITCH], int x)
{
    struct key_rows rows;
    const size_t most = sort_keys(&rows, packets, list, count);
    struct columns color = load_planes(planes, KILN_TILE_RED, 4, x);
    struct columns glow = load_planes(planes, KILN_TILE_GLOW_RED, 3, x);
    bool glows = packets->glow || any((glow.c[0] != 0.0f) | (glow.c[1] != 0.0f) |
                                      (glow.c[2] != 0.0f) | (glow.c[3] != 0.0f));
    for (size_t i = 0; i < count && !glows; i++)
        glows = packet_of(packets, list[i])->glows;
    if (packets->glow)
        blend_rows(&rows, most, packets->packets, &color, &glow, GLOW_PIXELS);
    else if (glows)
        blend_rows(&rows, most, packets->packets, &color, &glow, GLOW_WEIGHTS);
    else
        blend_rows(&rows, most, packets->packets, &color, &glow, GLOW_NONE);
    if (glows)
        store_planes(planes, KILN_TILE_GLOW_RED, 3, x, &glow);
    store_planes(planes, KILN_TILE_RED, 4, x, &color);
}

const struct kiln_packet_code KILN_SIMD_NAME(kiln_packet_code) = {
    .lanes = LANES,
    .size = sizeof(struct packet),
    .glow_size = sizeof(struct glowing_packet),
    .add = add,
    .least_key = least_key,
    .blend = blend,
};
