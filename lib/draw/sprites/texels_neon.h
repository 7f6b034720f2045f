/* This header defines the functions of texels.h for NEON. Only texels.h includes it, after
 * declaring the types. It computes in integers, whose products and sums are exact in any order. */
#ifndef KILN_DRAW_SPRITES_TEXELS_NEON_H
#define KILN_DRAW_SPRITES_TEXELS_NEON_H

/* Converts coordinates in 255ths of a texel to places, rounding down and clamping to 16 bits. */
SIMD vi places_of(vf u, vf v)
{
    uint16x4_t right = vqmovun_s32((int32x4_t)vi_of(u)), down = vqmovun_s32((int32x4_t)vi_of(v));
    /* A texel is 256 in a place and 255 steps, so 1 is added for each texel. For every word x,
     * x * 0x8081 >> 23 is x / 255. */
    uint16x4_t columns = vshr_n_u16(vshrn_n_u32(vmull_n_u16(right, 0x8081), 16), 7);
    uint16x4_t rows = vshr_n_u16(vshrn_n_u32(vmull_n_u16(down, 0x8081), 16), 7);
    uint16x4x2_t both = vzip_u16(vqadd_u16(right, columns), vqadd_u16(down, rows));
    return (vi)vcombine_u16(both.val[0], both.val[1]);
}

SIMD vi places_clamped(vi places, int32_t least, int32_t most)
{
    uint16x8_t low = vdupq_n_u16((uint16_t)least), high = vdupq_n_u16((uint16_t)most);
    return (vi)vminq_u16(vmaxq_u16((uint16x8_t)places, low), high);
}

/* Returns a mask of the pixels with least <= u <= most and least <= v <= most. */
SIMD vi places_between(vi places, int32_t least, int32_t most)
{
    return places_clamped(places, least, most) == places;
}

/* Moves places by way * part / 2^15 and clamps them to least..most. part: at most 32767. */
SIMD vi places_moved(vi places, vi way, int32_t part, int32_t least, int32_t most)
{
    const int32_t sign = (int32_t)0x80008000; /* signed words saturate at both ends */
    int16x8_t low = vdupq_n_s16((int16_t)(least - 32768));
    int16x8_t high = vdupq_n_s16((int16_t)(most - 32768));
    int16x8_t moved = vqrdmulhq_n_s16((int16x8_t)way, (int16_t)part);
    moved = vqaddq_s16((int16x8_t)(places ^ sign), moved);
    return (vi)vminq_s16(vmaxq_s16(moved, low), high) ^ sign;
}

/* Returns the byte offsets of the texels of places. pitch, texel: bytes of a row and of a texel. */
SIMD vi texel_offsets(vi places, int32_t pitch, int32_t texel)
{
    const int16x4_t units = {(int16_t)texel, (int16_t)pitch, (int16_t)texel, (int16_t)pitch};
    int16x8_t at = (int16x8_t)vshrq_n_u16((uint16x8_t)places, PLACE_BITS);
    return (vi)vpaddq_s32(vmull_s16(vget_low_s16(at), units), vmull_s16(vget_high_s16(at), units));
}

/* Holds the weights of the texels around places: two words a pixel, across and down. */
struct weights {
    int16x8_t near, far;           /* weights of 255 in all; down: this row, and the row below */
    int16x8_t near_part, far_part; /* the same times the part, for weighting across */
};

SIMD struct weights weigh(vi places, int32_t part)
{
    int16x8_t far = (int16x8_t)vandq_u16((uint16x8_t)places, vdupq_n_u16(255));
    int16x8_t near = vsubq_s16(vdupq_n_s16(255), far);
    return (struct weights){near, far, vmulq_n_s16(near, (int16_t)part),
                            vmulq_n_s16(far, (int16_t)part)};
}

/* Samples four channels, times part. part: the sample's part of PART_ONE; 1 for a single sample. */
SIMD struct quads sample_quads(const uint8_t *texels, const int32_t *offsets, vi places,
                               int32_t part)
{
    const struct weights w = weigh(places, part);
    struct quads quads;
#define QUAD(n)                                                                                    \
    do {                                                                                           \
        int8x8x2_t rows = vld2_s8((const int8_t *)texels + offsets[n]);                            \
        int16x8_t down = vmulq_laneq_s16(vmovl_s8(rows.val[0]), w.near, 2 * (n) + 1);              \
        down = vmlaq_laneq_s16(down, vmovl_s8(rows.val[1]), w.far, 2 * (n) + 1);                   \
        int32x4_t across = vmull_laneq_s16(vget_low_s16(down), w.near_part, 2 * (n));              \
        quads.k[n] = (vi)vmlal_laneq_s16(across, vget_high_s16(down), w.far_part, 2 * (n));        \
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
    const struct weights w = weigh(places, part);
    int32x2_t sampled[LANES];
    /* The 8 bytes are two channels of a texel and of the next one, each in two rows. */
#define PAIR(n)                                                                                    \
    do {                                                                                           \
        int8x8_t both = vld1_s8((const int8_t *)texels + offsets[n]);                              \
        int16x4_t row = vget_low_s16(vmovl_s8(vuzp1_s8(both, both)));                              \
        int16x4_t below = vget_low_s16(vmovl_s8(vuzp2_s8(both, both)));                            \
        int16x4_t down = vmul_laneq_s16(row, w.near, 2 * (n) + 1);                                 \
        down = vmla_laneq_s16(down, below, w.far, 2 * (n) + 1);                                    \
        int32x4_t left = vmull_laneq_s16(down, w.near_part, 2 * (n));                              \
        int32x4_t right = vmull_laneq_s16(down, w.far_part, 2 * (n));                              \
        sampled[n] = vadd_s32(vget_low_s32(left), vget_high_s32(right));                           \
    } while (0)
    PAIR(0);
    PAIR(1);
    PAIR(2);
    PAIR(3);
#undef PAIR
    return (struct pairs){
        {(vi)vcombine_s32(sampled[0], sampled[1]), (vi)vcombine_s32(sampled[2], sampled[3])}};
}

/* Samples texels that have only alpha; returns the sums of the pixels. */
SIMD vi sample_alphas(const uint8_t *texels, const int32_t *offsets, vi places, int32_t part)
{
    const struct weights w = weigh(places, part);
    int32_t loaded[LANES];
    for (int i = 0; i < LANES; i++)
        memcpy(&loaded[i], texels + offsets[i], sizeof loaded[i]);
    /* The 4 bytes of a pixel are a texel and the next one, each in two rows. */
    int8x16_t both = vreinterpretq_s8_s32(vld1q_s32(loaded));
    int16x8_t row = vmovl_s8(vget_low_s8(vuzp1q_s8(both, both)));
    int16x8_t below = vmovl_s8(vget_low_s8(vuzp2q_s8(both, both)));
    int16x8_t down = vmulq_s16(row, vtrn2q_s16(w.near, w.near));
    down = vmlaq_s16(down, below, vtrn2q_s16(w.far, w.far));
    int16x8_t across = vtrn1q_s16(w.near_part, w.far_part);
    return (vi)vpaddq_s32(vmull_s16(vget_low_s16(down), vget_low_s16(across)),
                          vmull_s16(vget_high_s16(down), vget_high_s16(across)));
}

SIMD struct vf4 channels_of(struct quads q)
{
    int32x4x2_t ab = vtrnq_s32((int32x4_t)q.k[0], (int32x4_t)q.k[1]);
    int32x4x2_t cd = vtrnq_s32((int32x4_t)q.k[2], (int32x4_t)q.k[3]);
    struct vf4 result;
    for (int i = 0; i < 2; i++) {
        int32x4_t low = vcombine_s32(vget_low_s32(ab.val[i]), vget_low_s32(cd.val[i]));
        int32x4_t high = vcombine_s32(vget_high_s32(ab.val[i]), vget_high_s32(cd.val[i]));
        result.c[i] = (vf)vcvtq_f32_s32(low);
        result.c[2 + i] = (vf)vcvtq_f32_s32(high);
    }
    return result;
}

/* Returns the two channels as the third and the fourth of four. */
SIMD struct vf4 channels_of_pairs(struct pairs p)
{
    int32x4x2_t channels = vuzpq_s32((int32x4_t)p.k[0], (int32x4_t)p.k[1]);
    struct vf4 result = {{{0}}};
    result.c[2] = (vf)vcvtq_f32_s32(channels.val[0]);
    result.c[3] = (vf)vcvtq_f32_s32(channels.val[1]);
    return result;
}

SIMD vi ways_of(struct pairs p)
{
    return (vi)vcombine_s16(vqmovn_s32((int32x4_t)p.k[0] >> 8), vqmovn_s32((int32x4_t)p.k[1] >> 8));
}

#endif
