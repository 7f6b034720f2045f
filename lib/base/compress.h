/* This header moves the lanes of a vector that a mask selects together. AVX-512 has an instruction
 * for it; AVX2 and NEON permute lanes by a table. */
#ifndef KILN_BASE_COMPRESS_H
#define KILN_BASE_COMPRESS_H

#include "base/lanes.h"

/* Says which lanes are selected; count: their number. */
#if defined KILN_LEVEL_AVX512
struct selection {
    __mmask16 lanes;
    int count;
};

SIMD struct selection selection_of(vi mask)
{
    const __mmask16 lanes = _mm512_movepi32_mask((__m512i)mask);
    return (struct selection){lanes, __builtin_popcount(lanes)};
}

/* Writes the selected lanes to `to`, in order. The places after them, up to LANES in all, get any
 * values. */
SIMD void vf_compress(float *to, struct selection selection, vf x)
{
    vf_store(to, (vf)_mm512_maskz_compress_ps(selection.lanes, (__m512)x));
}
#elif defined KILN_LEVEL_AVX2
struct selection {
    __m256i order;
    int count;
};

SIMD struct selection selection_of(vi mask)
{
    /* Three bits of each selected lane's number, moved together: pext takes them from 0 to 7. */
    const uint32_t bits = vi_bits(mask);
    const uint64_t bytes = _pdep_u64(bits, 0x0101010101010101) * 0xff;
    const uint64_t numbers = _pext_u64(0x0706050403020100, bytes);
    return (struct selection){_mm256_cvtepu8_epi32(_mm_cvtsi64_si128((int64_t)numbers)),
                              __builtin_popcount(bits)};
}

SIMD void vf_compress(float *to, struct selection selection, vf x)
{
    vf_store(to, (vf)_mm256_permutevar8x32_ps((__m256)x, selection.order));
}
#elif defined KILN_LEVEL_NEON
struct selection {
    const uint8_t *order; /* of the 16 bytes of a vector */
    int count;
};

SIMD struct selection selection_of(vi mask)
{
#define LANE(n) 4 * (n), 4 * (n) + 1, 4 * (n) + 2, 4 * (n) + 3
#define FOUR(a, b, c, d)                                                                           \
    {                                                                                              \
        LANE(a), LANE(b), LANE(c), LANE(d)                                                         \
    }
    /* By the bits of the mask; lanes after the selected ones are any. */
    static const uint8_t orders[16][16] = {
        FOUR(0, 0, 0, 0), FOUR(0, 0, 0, 0), FOUR(1, 0, 0, 0), FOUR(0, 1, 0, 0),
        FOUR(2, 0, 0, 0), FOUR(0, 2, 0, 0), FOUR(1, 2, 0, 0), FOUR(0, 1, 2, 0),
        FOUR(3, 0, 0, 0), FOUR(0, 3, 0, 0), FOUR(1, 3, 0, 0), FOUR(0, 1, 3, 0),
        FOUR(2, 3, 0, 0), FOUR(0, 2, 3, 0), FOUR(1, 2, 3, 0), FOUR(0, 1, 2, 3),
    };
#undef FOUR
#undef LANE
    static const uint8_t counts[16] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};
    const uint32_t bits = vi_bits(mask);
    return (struct selection){orders[bits], counts[bits]};
}

SIMD void vf_compress(float *to, struct selection selection, vf x)
{
    vf_store(to, (vf)vqtbl1q_u8((uint8x16_t)x, vld1q_u8(selection.order)));
}
#else
struct selection {
    vi mask;
    int count;
};

SIMD struct selection selection_of(vi mask)
{
    return (struct selection){mask, -(mask[0] + mask[1] + mask[2] + mask[3])};
}

SIMD void vf_compress(float *to, struct selection selection, vf x)
{
    for (int i = 0; i < LANES; i++) {
        const float lane = x[i];
        memcpy(to, &lane, sizeof lane); /* `to` may point to integers (vi_compress) */
        to -= selection.mask[i];
    }
}
#endif

SIMD void vi_compress(int32_t *to, struct selection selection, vi x)
{
    vf_compress((float *)(void *)to, selection, (vf)x);
}

#endif
