/* Packs lines of pixels for EXR files, a vector of pixels at a time: it transposes their channels,
 * rounds to halves, and takes bytes apart in registers. OpenEXR's C core would read and write each
 * of them four times. */
#include "base/transpose.h"
#include "output/exr_rows.h"

typedef uint8_t bytes_of_lanes __attribute__((vector_size(LANES)));
typedef uint16_t shorts_of_lanes __attribute__((vector_size(2 * LANES)));

/* Bits of floats. */
enum {
    FLOAT_INFINITY = 0x7f800000,
    UNDEFINED = 0x7fc00000,
    HALF_MOST = 0x477fe000,   /* 65504, the largest half: a larger one would read as infinity */
    HALF_NORMAL = 0x38800000, /* 2^-14, the least half of full precision */
    HALF_STEP = 0x3f000000,   /* 1/2, whose last bit is worth 2^-24, the least half */
    REBIASED = (int32_t)((uint32_t)(15 - 127) << 23)
};

SIMD void store_shorts(uint8_t *to, vi x)
{
    const shorts_of_lanes shorts = __builtin_convertvector(x, shorts_of_lanes);
    memcpy(to, &shorts, sizeof shorts);
}

/* store_halves stores the bytes of the nearest halves; of two, that with an even last bit. What is
 * too large becomes the largest half. */

#ifdef KILN_LEVEL_AVX512

SIMD void store_halves(const struct kiln_exr_row *row, size_t x, vf samples)
{
    const vi sign = (vi)samples & INT32_MIN, undefined = ((vi)samples & INT32_MAX) > FLOAT_INFINITY;
    const vf size = vf_min(vf_abs(samples), (vf)vi_all(HALF_MOST));
    const vi kept = vi_select(undefined, vi_all(UNDEFINED), (vi)size) | sign;
    const __m256i halves = _mm512_cvtps_ph((__m512)kept, _MM_FROUND_TO_NEAREST_INT);
    const __m128i low = _mm256_cvtepi16_epi8(halves);
    const __m128i high = _mm256_cvtepi16_epi8(_mm256_srli_epi16(halves, 8));
    memcpy(row->low + x, &low, sizeof low);
    memcpy(row->high + x, &high, sizeof high);
}

#else

SIMD void store_bytes(uint8_t *to, vi x)
{
    const bytes_of_lanes bytes = __builtin_convertvector(x, bytes_of_lanes);
    memcpy(to, &bytes, sizeof bytes);
}

SIMD vi half_bits(vf x)
{
    const vi sign = (vi)x & INT32_MIN;
    vi size = (vi)x & INT32_MAX;
    const vi undefined = size > FLOAT_INFINITY;
    const vi large = (size > HALF_MOST) & ~undefined;
    size = (size & ~large) | (large & HALF_MOST);
    const vi normal = (size + (REBIASED + 0xfff) + ((size >> 13) & 1)) >> 13;
    const vi small = (vi)((vf)size + 0.5f) - HALF_STEP;
    const vi is_small = size < HALF_NORMAL;
    vi half = (normal & ~is_small) | (small & is_small);
    half = (half & ~undefined) | (undefined & 0x7e00);
    return half | (vi)((vu)sign >> 16);
}

SIMD void store_halves(const struct kiln_exr_row *row, size_t x, vf samples)
{
    const vi bits = half_bits(samples);
    store_bytes(row->low + x, bits & 0xff);
    store_bytes(row->high + x, bits >> 8);
}

#endif

/* Stores a vector of samples, the pixels from x on. */
SIMD void store_samples(const struct kiln_exr_row *row, size_t x, vf samples, bool half)
{
    if (half) {
        store_halves(row, x, samples);
    } else {
        const vi bits = (vi)samples;
        store_shorts(row->low + 2 * x, (bits & 0xff) | ((bits >> 8) & 0xff00));
        store_shorts(row->high + 2 * x, ((bits >> 8) & 0xff) | ((bits >> 16) & 0xff00));
    }
}

SIMD void pack_fours(const float *pixels, size_t x, bool half, const struct kiln_exr_row *rows)
{
    vf lying[4];
    for (size_t i = 0; i < 4; i++)
        lying[i] = vf_load(pixels + 4 * x + i * LANES);
    const struct columns colors = columns_transpose(lying[0], lying[1], lying[2], lying[3]);
    for (int c = 0; c < 4; c++)
        store_samples(&rows[c], x, row_order(colors.c[c]), half);
}

/* Packs a vector of pixels with any number of channels. */
SIMD void pack_some(const float *pixels, uint32_t channels, size_t x, bool half,
                    const struct kiln_exr_row *rows)
{
    for (uint32_t c = 0; c < channels; c++) {
        vf samples;
        for (size_t i = 0; i < LANES; i++)
            samples[i] = pixels[(x + i) * channels + c];
        store_samples(&rows[c], x, samples, half);
    }
}

/* Packs the last pixels of a line, fewer than a vector has. */
static void pack_rest(const float *pixels, uint32_t channels, size_t x, size_t count, bool half,
                      const struct kiln_exr_row *rows)
{
    float rest[4 * LANES] = {0};
    uint8_t low[4][2 * LANES], high[4][2 * LANES];
    struct kiln_exr_row rest_rows[4];
    for (int c = 0; c < 4; c++)
        rest_rows[c] = (struct kiln_exr_row){low[c], high[c]};
    memcpy(rest, pixels + x * channels, count * channels * sizeof *rest);
    pack_some(rest, channels, 0, half, rest_rows);
    const size_t size = half ? 1 : 2;
    for (uint32_t c = 0; c < channels; c++) {
        memcpy(rows[c].low + x * size, low[c], count * size);
        memcpy(rows[c].high + x * size, high[c], count * size);
    }
}

SIMD void pack_line(const float *pixels, uint32_t channels, size_t width, bool half,
                    const struct kiln_exr_row *rows)
{
    size_t x = 0;
    for (; x + LANES <= width; x += LANES) {
        if (channels == 4)
            pack_fours(pixels, x, half, rows);
        else
            pack_some(pixels, channels, x, half, rows);
    }
    if (x < width)
        pack_rest(pixels, channels, x, width - x, half, rows);
}

static void pack(const float *pixels, uint32_t channels, size_t width, bool half,
                 const struct kiln_exr_row *rows)
{
    if (half && channels == 4)
        pack_line(pixels, 4, width, true, rows);
    else if (channels == 4)
        pack_line(pixels, 4, width, false, rows);
    else if (channels == 1)
        pack_line(pixels, 1, width, half, rows);
    else
        pack_line(pixels, channels, width, half, rows);
}

static void subtract(const uint8_t *bytes, uint8_t before, size_t count, uint8_t *restrict out)
{
    if (count > 0)
        out[0] = (uint8_t)(bytes[0] - before + 128);
    for (size_t i = 1; i < count; i++)
        out[i] = (uint8_t)(bytes[i] - bytes[i - 1] + 128);
}

const struct kiln_exr_loops KILN_SIMD_NAME(kiln_exr_loops) = {.pack = pack, .subtract = subtract};
