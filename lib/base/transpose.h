/* This header transposes records in memory to vectors and back. The lanes of a vector are records,
 * and four consecutive floats of each record become four vectors. Before the transposition, vector
 * k of four holds the four floats of lane 4 p + k in its 128-bit part p. */
#ifndef KILN_BASE_TRANSPOSE_H
#define KILN_BASE_TRANSPOSE_H

#include "base/lane_math.h"

/* The indices of lanes a, b, c and d of the 128-bit part p, for a shuffle of two vectors; 4 to 7
 * are lanes of the second vector. */
#define LANE_OF(a, p)           (4 * (p) + ((a)&3) + ((a) >> 2) * LANES)
#define LANES_OF(a, b, c, d, p) LANE_OF(a, p), LANE_OF(b, p), LANE_OF(c, p), LANE_OF(d, p)

/* Picks the same four lanes of two vectors in each 128-bit part. */
#if LANES == 16
#define VF_PICK(x, y, a, b, c, d)                                                                  \
    __builtin_shufflevector(x, y, LANES_OF(a, b, c, d, 0), LANES_OF(a, b, c, d, 1),                \
                            LANES_OF(a, b, c, d, 2), LANES_OF(a, b, c, d, 3))
#elif LANES == 8
#define VF_PICK(x, y, a, b, c, d)                                                                  \
    __builtin_shufflevector(x, y, LANES_OF(a, b, c, d, 0), LANES_OF(a, b, c, d, 1))
#else
#define VF_PICK(x, y, a, b, c, d) __builtin_shufflevector(x, y, LANES_OF(a, b, c, d, 0))
#endif

/* Holds an offset for each lane. Offsets go through memory, since extracting lanes from a vector
 * costs twice as much. */
struct lane_offsets {
    _Alignas(64) int32_t at[LANES];
};

SIMD struct lane_offsets lane_offsets_of(vi x)
{
    struct lane_offsets places;
    memcpy(places.at, &x, sizeof places.at);
    __asm__("" : "+m"(places));
    return places;
}

/* Loads four floats for each of the lanes k, 4 + k, 8 + k...: those at `from` plus the lane's
 * offset. at: points to the offset of lane k, in floats. */
SIMD vf vf_load_fours(const float *from, const int32_t *at)
{
#if LANES == 16
    __m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(from + at[0])),
                                      _mm_loadu_ps(from + at[4]), 1);
    __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(from + at[8])),
                                       _mm_loadu_ps(from + at[12]), 1);
    return (vf)_mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
#elif LANES == 8
    return (vf)_mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(from + at[0])),
                                    _mm_loadu_ps(from + at[4]), 1);
#else
    return vf_load(from + at[0]);
#endif
}

/* Holds four floats of each lane's record, a vector for each float. */
struct columns {
    vf c[4];
};

/* Transposes four floats of each record to four vectors, or back. */
SIMD struct columns columns_transpose(vf a, vf b, vf c, vf d)
{
    vf ab = VF_PICK(a, b, 0, 4, 1, 5), cd = VF_PICK(c, d, 0, 4, 1, 5);
    vf ab_high = VF_PICK(a, b, 2, 6, 3, 7), cd_high = VF_PICK(c, d, 2, 6, 3, 7);
    return (struct columns){{VF_PICK(ab, cd, 0, 1, 4, 5), VF_PICK(ab, cd, 2, 3, 6, 7),
                             VF_PICK(ab_high, cd_high, 0, 1, 4, 5),
                             VF_PICK(ab_high, cd_high, 2, 3, 6, 7)}};
}

/* Columns of records that lay one after another have their lanes in another order than the records:
 * lane 4 p + k is record p of the k-th quarter of them. */
#if LANES == 16
#define LANE_ORDER 0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15
#define ROW_ORDER  LANE_ORDER
#elif LANES == 8
#define LANE_ORDER 0, 2, 4, 6, 1, 3, 5, 7
#define ROW_ORDER  0, 4, 1, 5, 2, 6, 3, 7
#else
#define LANE_ORDER 0, 1, 2, 3
#define ROW_ORDER  LANE_ORDER
#endif

/* Puts values of consecutive records into the order of columns' lanes. */
SIMD vf lane_order(vf x)
{
    return __builtin_shufflevector(x, x, LANE_ORDER);
}

/* Puts lanes of columns into the order of the records. */
SIMD vf row_order(vf x)
{
    return __builtin_shufflevector(x, x, ROW_ORDER);
}

/* Loads four floats of each lane's record. places: offsets of the records, in floats. */
SIMD struct columns columns_load(const float *from, const struct lane_offsets *places)
{
    const int32_t *at = places->at;
    return columns_transpose(vf_load_fours(from, at), vf_load_fours(from, at + 1),
                             vf_load_fours(from, at + 2), vf_load_fours(from, at + 3));
}

/* Interpolates between four floats of each lane's record and the four floats after them. part: the
 * weight of the latter four, as vf_spread_fours lays it out. */
SIMD struct columns columns_load_lerp(const float *from, const struct lane_offsets *places,
                                      const vf part[4])
{
    vf between[4];
    for (int k = 0; k < 4; k++) {
        vf a = vf_load_fours(from, places->at + k);
        vf b = vf_load_fours(from + 4, places->at + k);
        between[k] = a + (b - a) * part[k];
    }
    return columns_transpose(between[0], between[1], between[2], between[3]);
}

/* Repeats each lane's value for the four floats of its record, in the layout before the
 * transposition. */
SIMD void vf_spread_fours(vf x, vf spread[4])
{
    spread[0] = VF_PICK(x, x, 0, 0, 0, 0);
    spread[1] = VF_PICK(x, x, 1, 1, 1, 1);
    spread[2] = VF_PICK(x, x, 2, 2, 2, 2);
    spread[3] = VF_PICK(x, x, 3, 3, 3, 3);
}

enum { LINE_FLOATS = 16 };

/* Stores sixteen floats of each lane, a whole cache line, to the lane's record. lanes: the number
 * of each lane's record; size: of a record, in floats. */
SIMD void vf_store_lines(const vf x[LINE_FLOATS], float *records, size_t size,
                         const uint16_t lanes[LANES])
{
    struct columns fours[4];
    for (size_t i = 0; i < 4; i++)
        fours[i] = columns_transpose(x[4 * i], x[4 * i + 1], x[4 * i + 2], x[4 * i + 3]);
    for (int k = 0; k < 4; k++) {
#if LANES == 16
#define PARTS(a, b, parts) _mm512_shuffle_f32x4(a, b, parts)
#define STORE(lane, line)  _mm512_store_ps(records + size * lanes[lane], line)
        __m512 a = (__m512)fours[0].c[k], b = (__m512)fours[1].c[k];
        __m512 c = (__m512)fours[2].c[k], d = (__m512)fours[3].c[k];
        __m512 ab = PARTS(a, b, 0x44), cd = PARTS(c, d, 0x44);
        __m512 ab_high = PARTS(a, b, 0xee), cd_high = PARTS(c, d, 0xee);
        STORE(k, PARTS(ab, cd, 0x88));
        STORE(4 + k, PARTS(ab, cd, 0xdd));
        STORE(8 + k, PARTS(ab_high, cd_high, 0x88));
        STORE(12 + k, PARTS(ab_high, cd_high, 0xdd));
#undef STORE
#undef PARTS
#else
        for (size_t part = 0; part < LANES / 4; part++) {
            float *to = records + size * lanes[4 * part + (size_t)k];
            for (size_t i = 0; i < 4; i++)
                memcpy(to + 4 * i, (const char *)&fours[i].c[k] + 16 * part, 16);
        }
#endif
    }
}

#endif
