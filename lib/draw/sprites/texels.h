/* This header samples texels of cells with the vectors of base/lanes.h, for tile_draw.h.
 *
 * A texel of 8 bytes holds red, green, blue and alpha of two rows: red, red of the row below, green
 * and so on, each less 128. A bilinear sample reads the 16 bytes of two adjacent texels and weights
 * them by integers: first down by two bytes, then across by two words; each two weights have the
 * sum 255. A texel of 4 bytes has only two channels, and takes half the work; a texel of 2 bytes
 * has only alpha.
 *
 * A place in a cell is two unsigned words, u and v. The high byte of a word is the texel. The low
 * byte is the place between that texel and the next one, in 255ths; it is the weight of the next
 * one. */
#ifndef KILN_DRAW_SPRITES_TEXELS_H
#define KILN_DRAW_SPRITES_TEXELS_H

#include "base/lanes.h"

enum { PLACE_BITS = 8, PLACE_ONE = 1 << PLACE_BITS, PLACE_STEPS = 255 };

/* The steps that are added to a coordinate: half a texel, since the outer texels are repeated
 * around a cell, and half a step for rounding. */
#define PLACE_MIDDLE (0.5f * (PLACE_STEPS + 1))

/* Holds weighted sums of texels of four channels (quads) or two channels (pairs), pixel after
 * pixel. */
struct quads {
    vi k[4];
};

struct pairs {
    vi k[2];
};

/* Holds four channels of a vector of pixels. */
struct vf4 {
    vf c[4];
};

/* A channel of a single sample, with part 1, is sum * SAMPLED_UNIT + SAMPLED_ZERO. For a sum of
 * several samples, the parts add up to PART_ONE, and the unit is SAMPLED_UNIT / PART_ONE. */
enum { PART_ONE = 128 };
#define SAMPLED_UNIT (1.0f / (255.0f * 255.0f * 255.0f))
#define SAMPLED_ZERO (128.0f / 255.0f)

/* The value of a word of ways_of() that stands for a full move. */
#define WAY_ONE (255.0f * 255.0f * 127.0f / 256.0f)

#ifdef KILN_LEVEL_NEON
#include "draw/sprites/texels_neon.h"
#elif defined KILN_LEVEL_AVX2 || defined KILN_LEVEL_AVX512

/* Loads the 4 bytes at each of four offsets. */
SIMD __m128i four_texels(const uint8_t *texels, const int32_t *at)
{
    int32_t loaded[4];
    for (int i = 0; i < 4; i++)
        memcpy(&loaded[i], texels + at[i], sizeof loaded[i]);
    __m128i two = _mm_insert_epi32(_mm_cvtsi32_si128(loaded[0]), loaded[1], 1);
    return _mm_insert_epi32(_mm_insert_epi32(two, loaded[2], 2), loaded[3], 3);
}

/* Loads the 8 bytes at each of two offsets. */
SIMD __m128i two_texels(const uint8_t *texels, const int32_t *at)
{
    return (__m128i)_mm_loadh_pi((__m128)_mm_loadl_epi64((const __m128i_u *)(texels + at[0])),
                                 (const __m64 *)(texels + at[1]));
}

#ifdef KILN_LEVEL_AVX512
typedef __m512i words;
#define WORDS(op)            _mm512_##op
#define SHUFFLE(a, b, lanes) _mm512_shuffle_ps((__m512)(a), (__m512)(b), lanes)
SIMD words fetch_texels(const uint8_t *texels, const int32_t *at)
{
    __m256i low = _mm256_inserti128_si256(
        _mm256_castsi128_si256(_mm_loadu_si128((const __m128i_u *)(texels + at[0]))),
        _mm_loadu_si128((const __m128i_u *)(texels + at[4])), 1);
    __m256i high = _mm256_inserti128_si256(
        _mm256_castsi128_si256(_mm_loadu_si128((const __m128i_u *)(texels + at[8]))),
        _mm_loadu_si128((const __m128i_u *)(texels + at[12])), 1);
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}
SIMD words fetch_pairs(const uint8_t *texels, const int32_t *at)
{
    __m256i low = _mm256_inserti128_si256(_mm256_castsi128_si256(two_texels(texels, at)),
                                          two_texels(texels, at + 4), 1);
    __m256i high = _mm256_inserti128_si256(_mm256_castsi128_si256(two_texels(texels, at + 8)),
                                           two_texels(texels, at + 12), 1);
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}
SIMD words fetch_alphas(const uint8_t *texels, const int32_t *at)
{
    __m256i low = _mm256_inserti128_si256(_mm256_castsi128_si256(four_texels(texels, at)),
                                          four_texels(texels, at + 4), 1);
    __m256i high = _mm256_inserti128_si256(_mm256_castsi128_si256(four_texels(texels, at + 8)),
                                           four_texels(texels, at + 12), 1);
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}
/* Returns the four integers in each 128 bits. */
SIMD words pattern(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return _mm512_broadcast_i32x4(_mm_setr_epi32(a, b, c, d));
}
#else
typedef __m256i words;
#define WORDS(op)            _mm256_##op
#define SHUFFLE(a, b, lanes) _mm256_shuffle_ps((__m256)(a), (__m256)(b), lanes)
SIMD words fetch_texels(const uint8_t *texels, const int32_t *at)
{
    return _mm256_inserti128_si256(
        _mm256_castsi128_si256(_mm_loadu_si128((const __m128i_u *)(texels + at[0]))),
        _mm_loadu_si128((const __m128i_u *)(texels + at[4])), 1);
}
SIMD words fetch_pairs(const uint8_t *texels, const int32_t *at)
{
    return _mm256_inserti128_si256(_mm256_castsi128_si256(two_texels(texels, at)),
                                   two_texels(texels, at + 4), 1);
}
SIMD words fetch_alphas(const uint8_t *texels, const int32_t *at)
{
    return _mm256_inserti128_si256(_mm256_castsi128_si256(four_texels(texels, at)),
                                   four_texels(texels, at + 4), 1);
}
SIMD words pattern(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return _mm256_broadcastsi128_si256(_mm_setr_epi32(a, b, c, d));
}
#endif

/* Converts coordinates in 255ths of a texel to places, rounding down and clamping to 16 bits. */
SIMD vi places_of(vf u, vf v)
{
    words both = WORDS(packus_epi32)((words)vi_of(u), (words)vi_of(v));
    /* A texel is 256 in a place and 255 steps, so 1 is added for each texel. For every word x,
     * x * 0x8081 >> 23 is x / 255. */
    words texels = WORDS(srli_epi16)(WORDS(mulhi_epu16)(both, WORDS(set1_epi16)((short)0x8081)), 7);
    both = WORDS(adds_epu16)(both, texels);
    return (vi)WORDS(shuffle_epi8)(both, pattern(0x09080100, 0x0b0a0302, 0x0d0c0504, 0x0f0e0706));
}

SIMD vi places_clamped(vi places, int32_t least, int32_t most)
{
    words low = WORDS(set1_epi16)((short)least), high = WORDS(set1_epi16)((short)most);
    return (vi)WORDS(min_epu16)(WORDS(max_epu16)((words)places, low), high);
}

/* Returns a mask of the pixels with least <= u <= most and least <= v <= most. */
SIMD vi places_between(vi places, int32_t least, int32_t most)
{
    words from_least = WORDS(sub_epi16)((words)places, WORDS(set1_epi16)((short)least));
    words beyond = WORDS(subs_epu16)(from_least, WORDS(set1_epi16)((short)(most - least)));
    return (vi)beyond == 0;
}

/* Moves places by way * part / 2^15 and clamps them to least..most. part: at most 32767. */
SIMD vi places_moved(vi places, vi way, int32_t part, int32_t least, int32_t most)
{
    const int32_t sign = (int32_t)0x80008000; /* signed words saturate at both ends */
    words low = WORDS(set1_epi16)((short)(least - 32768));
    words high = WORDS(set1_epi16)((short)(most - 32768));
    words moved = WORDS(mulhrs_epi16)((words)way, WORDS(set1_epi16)((short)part));
    moved = WORDS(adds_epi16)((words)(places ^ sign), moved);
    return (vi)WORDS(min_epi16)(WORDS(max_epi16)(moved, low), high) ^ sign;
}

/* Returns the byte offsets of the texels of places. pitch, texel: bytes of a row and of a texel. */
SIMD vi texel_offsets(vi places, int32_t pitch, int32_t texel)
{
    return (vi)WORDS(madd_epi16)(WORDS(srli_epi16)((words)places, PLACE_BITS),
                                 WORDS(set1_epi32)(pitch << 16 | texel));
}

/* Holds the weights of the texels around places. */
struct weights {
    words rows, columns; /* for each pixel: a pair of bytes, twice; a pair of words */
};

SIMD struct weights weigh(vi places, int32_t part)
{
    words rows =
        WORDS(shuffle_epi8)((words)places, pattern(0x02020202, 0x06060606, 0x0a0a0a0a, 0x0e0e0e0e));
    words columns =
        WORDS(shuffle_epi8)((words)places, pattern((int32_t)0x80008000, (int32_t)0x80048004,
                                                   (int32_t)0x80088008, (int32_t)0x800c800c));
    columns = (words)((vi)columns ^ 0x000000ff);
    if (part != 1)
        columns = WORDS(mullo_epi16)(columns, WORDS(set1_epi16)((short)part));
    return (struct weights){(words)((vi)rows ^ 0x00ff00ff), columns};
}

/* Samples four channels, times part. part: the sample's part of PART_ONE; 1 for a single sample. */
SIMD struct quads sample_quads(const uint8_t *texels, const int32_t *offsets, vi places,
                               int32_t part)
{
    const words twins = pattern(0x09080100, 0x0b0a0302, 0x0d0c0504, 0x0f0e0706);
    const struct weights w = weigh(places, part);
    struct quads quads;
#define QUAD(n)                                                                                    \
    do {                                                                                           \
        words weights = WORDS(shuffle_epi32)(w.rows, (n)*0x55);                                    \
        words texel = WORDS(maddubs_epi16)(weights, fetch_texels(texels, offsets + (n)));          \
        quads.k[n] = (vi)WORDS(madd_epi16)(WORDS(shuffle_epi8)(texel, twins),                      \
                                           WORDS(shuffle_epi32)(w.columns, (n)*0x55));             \
    } while (0)
    QUAD(0);
    QUAD(1);
    QUAD(2);
    QUAD(3);
#undef QUAD
    return quads;
}

SIMD struct pairs sample_pairs(const uint8_t *texels, const int32_t *offsets, vi places,
                               int32_t part)
{
    const words twins = pattern(0x05040100, 0x07060302, 0x0d0c0908, 0x0f0e0b0a);
    const struct weights w = weigh(places, part);
    struct pairs pairs;
#define PAIR(n, from, twice)                                                                       \
    do {                                                                                           \
        words weights = WORDS(shuffle_epi32)(w.rows, twice);                                       \
        words texel = WORDS(maddubs_epi16)(weights, fetch_pairs(texels, offsets + (from)));        \
        pairs.k[n] = (vi)WORDS(madd_epi16)(WORDS(shuffle_epi8)(texel, twins),                      \
                                           WORDS(shuffle_epi32)(w.columns, twice));                \
    } while (0)
    PAIR(0, 0, 0x50);
    PAIR(1, 2, 0xfa);
#undef PAIR
    return pairs;
}

/* Samples texels that have only alpha; returns the sums of the pixels. */
SIMD vi sample_alphas(const uint8_t *texels, const int32_t *offsets, vi places, int32_t part)
{
    const struct weights w = weigh(places, part);
    words across = WORDS(maddubs_epi16)(w.rows, fetch_alphas(texels, offsets));
    return (vi)WORDS(madd_epi16)(across, w.columns);
}

SIMD struct vf4 channels_of(struct quads q)
{
    words rg01 = WORDS(unpacklo_epi32)((words)q.k[0], (words)q.k[1]);
    words rg23 = WORDS(unpacklo_epi32)((words)q.k[2], (words)q.k[3]);
    words ba01 = WORDS(unpackhi_epi32)((words)q.k[0], (words)q.k[1]);
    words ba23 = WORDS(unpackhi_epi32)((words)q.k[2], (words)q.k[3]);
    const vi c[4] = {(vi)WORDS(unpacklo_epi64)(rg01, rg23), (vi)WORDS(unpackhi_epi64)(rg01, rg23),
                     (vi)WORDS(unpacklo_epi64)(ba01, ba23), (vi)WORDS(unpackhi_epi64)(ba01, ba23)};
    struct vf4 result;
    for (int i = 0; i < 4; i++)
        result.c[i] = __builtin_convertvector(c[i], vf);
    return result;
}

/* Returns the two channels as the third and the fourth of four. */
SIMD struct vf4 channels_of_pairs(struct pairs p)
{
    vf a = (vf)p.k[0], b = (vf)p.k[1];
    struct vf4 result = {{{0}}};
    result.c[2] = __builtin_convertvector((vi)SHUFFLE(a, b, 0x88), vf);
    result.c[3] = __builtin_convertvector((vi)SHUFFLE(a, b, 0xdd), vf);
    return result;
}

/* Returns samples of motion as two signed words, right and down; WAY_ONE is a full move. */
SIMD vi ways_of(struct pairs p)
{
    return (vi)WORDS(packs_epi32)((words)(p.k[0] >> 8), (words)(p.k[1] >> 8));
}

#undef WORDS
#undef SHUFFLE
#else

SIMD int32_t limited(int32_t x, int32_t least, int32_t most)
{
    return x < least ? least : x > most ? most : x;
}

SIMD int32_t place(int32_t u, int32_t v)
{
    return (int32_t)((uint32_t)v << 16 | ((uint32_t)u & 0xffff));
}

SIMD int32_t u_of(int32_t place)
{
    return place & 0xffff;
}

SIMD int32_t v_of(int32_t place)
{
    return (int32_t)((uint32_t)place >> 16);
}

SIMD vi places_of(vf u, vf v)
{
    vi x = vi_of(u), y = vi_of(v);
    for (int i = 0; i < LANES; i++) {
        int32_t right = limited(x[i], 0, 65535), down = limited(y[i], 0, 65535);
        x[i] = place(limited(right + right / PLACE_STEPS, 0, 65535),
                     limited(down + down / PLACE_STEPS, 0, 65535));
    }
    return x;
}

SIMD vi places_clamped(vi places, int32_t least, int32_t most)
{
    for (int i = 0; i < LANES; i++)
        places[i] =
            place(limited(u_of(places[i]), least, most), limited(v_of(places[i]), least, most));
    return places;
}

SIMD vi places_between(vi places, int32_t least, int32_t most)
{
    return places_clamped(places, least, most) == places;
}

SIMD vi places_moved(vi places, vi way, int32_t part, int32_t least, int32_t most)
{
    for (int i = 0; i < LANES; i++) {
        int32_t u = u_of(places[i]) + (((int16_t)u_of(way[i]) * part + 0x4000) >> 15);
        int32_t v = v_of(places[i]) + (((int16_t)v_of(way[i]) * part + 0x4000) >> 15);
        places[i] = place(limited(u, least, most), limited(v, least, most));
    }
    return places;
}

SIMD vi texel_offsets(vi places, int32_t pitch, int32_t texel)
{
    for (int i = 0; i < LANES; i++)
        places[i] =
            (v_of(places[i]) >> PLACE_BITS) * pitch + (u_of(places[i]) >> PLACE_BITS) * texel;
    return places;
}

/* Samples channel c of texels that have `channels` channels of two bytes each. */
SIMD vi sample_channel(const uint8_t *texels, const int32_t *offsets, vi places, int32_t part,
                       size_t channels, size_t c)
{
    vi sampled = places;
    for (int i = 0; i < LANES; i++) {
        int32_t u = u_of(places[i]), v = v_of(places[i]);
        const int8_t *t = (const int8_t *)texels + offsets[i] + 2 * c;
        const int8_t *next = t + 2 * channels;
        int32_t bottom = v & 255, top = 255 - bottom;
        int32_t right = (u & 255) * part, left = 255 * part - right;
        sampled[i] =
            (t[0] * top + t[1] * bottom) * left + (next[0] * top + next[1] * bottom) * right;
    }
    return sampled;
}

SIMD struct quads sample_quads(const uint8_t *texels, const int32_t *offsets, vi places,
                               int32_t part)
{
    return (struct quads){{sample_channel(texels, offsets, places, part, 4, 0),
                           sample_channel(texels, offsets, places, part, 4, 1),
                           sample_channel(texels, offsets, places, part, 4, 2),
                           sample_channel(texels, offsets, places, part, 4, 3)}};
}

SIMD struct pairs sample_pairs(const uint8_t *texels, const int32_t *offsets, vi places,
                               int32_t part)
{
    return (struct pairs){{sample_channel(texels, offsets, places, part, 2, 0),
                           sample_channel(texels, offsets, places, part, 2, 1)}};
}

SIMD vi sample_alphas(const uint8_t *texels, const int32_t *offsets, vi places, int32_t part)
{
    return sample_channel(texels, offsets, places, part, 1, 0);
}

SIMD struct vf4 channels_of(struct quads q)
{
    struct vf4 result;
    for (int i = 0; i < 4; i++)
        result.c[i] = __builtin_convertvector(q.k[i], vf);
    return result;
}

SIMD struct vf4 channels_of_pairs(struct pairs p)
{
    struct vf4 result = {{{0}}};
    for (int i = 0; i < 2; i++)
        result.c[2 + i] = __builtin_convertvector(p.k[i], vf);
    return result;
}

SIMD vi ways_of(struct pairs p)
{
    vi ways;
    for (int i = 0; i < LANES; i++)
        ways[i] = place(p.k[0][i] >> 8, p.k[1][i] >> 8);
    return ways;
}

#endif

SIMD struct quads quads_sum(struct quads a, struct quads b)
{
    for (int i = 0; i < 4; i++)
        a.k[i] += b.k[i];
    return a;
}

SIMD struct pairs pairs_sum(struct pairs a, struct pairs b)
{
    for (int i = 0; i < 2; i++)
        a.k[i] += b.k[i];
    return a;
}
#endif
