/* This file composes rows of the picture on the host, as shaders/post/composite.frag does in GL. It
 * works on blocks of a row: it composes them pixel by pixel, then encodes them channel by channel,
 * in loops that compilers vectorise. */
#include "post/composite_rows.h"
#include "shared/tonemap.h"

enum { BLOCK = 128 };

static const float HALF_MAX = 65504.0f;

struct block {
    float red[BLOCK], green[BLOCK], blue[BLOCK], alpha[BLOCK];
    float noise[3][BLOCK]; /* of the dither, in levels */
    int32_t words[4][BLOCK];
};

static inline uint32_t hash(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

/* Makes triangular noise with a mean of 0 from -0.5 to 0.5 levels. It differs by pixel, channel and
 * frame, and is the same in each run. */
static inline void make_noise(struct block *block, uint32_t first, uint32_t row_hash)
{
    for (uint32_t i = 0; i < BLOCK; i++) {
        uint32_t h = hash(first + i + row_hash);
        for (uint32_t c = 0; c < 3; c++) {
            h = hash(h + c);
            float sum = (float)(int32_t)(h & 0xffffu) + (float)(int32_t)(h >> 16);
            block->noise[c][i] = sum * (0.5f / 65535.0f) - 0.5f;
        }
    }
}

/* Returns exposed light, limited to the range of 16-bit floats; a NaN becomes black. */
static inline float exposed(float light, float exposure)
{
    return exact_min(exact_max(light * exposure, 0.0f), HALF_MAX);
}

static inline void expose(struct block *block, float exposure)
{
    for (int i = 0; i < BLOCK; i++) {
        block->red[i] = exposed(block->red[i], exposure);
        block->green[i] = exposed(block->green[i], exposure);
        block->blue[i] = exposed(block->blue[i], exposure);
    }
}

static inline void map_agx(struct block *block)
{
    for (int i = 0; i < BLOCK; i++) {
        float3 color = tonemap_agx_root(FLOAT3(block->red[i], block->green[i], block->blue[i]));
        block->red[i] = color.x;
        block->green[i] = color.y;
        block->blue[i] = color.z;
    }
}

static inline void map_aces(struct block *block)
{
    for (int i = 0; i < BLOCK; i++) {
        float3 color = tonemap_aces(FLOAT3(block->red[i], block->green[i], block->blue[i]));
        block->red[i] = color.x;
        block->green[i] = color.y;
        block->blue[i] = color.z;
    }
}

static inline void encode_channel(float *channel, bool is_root)
{
    if (is_root) {
        for (int i = 0; i < BLOCK; i++)
            channel[i] = tonemap_encode_root(exact_min(channel[i], 1.0f));
        return;
    }
    for (int i = 0; i < BLOCK; i++)
        channel[i] = tonemap_encode(exact_min(channel[i], 1.0f));
}

/* Divides colour by alpha, since files hold straight alpha. Light brighter than its alpha, such as
 * fire over a transparent background, would exceed 1. Its brightness becomes its alpha instead, so
 * that it still shows over black. */
static inline void unpremultiply(struct block *block)
{
    for (int i = 0; i < BLOCK; i++) {
        float r = block->red[i], g = block->green[i], b = block->blue[i], a = block->alpha[i];
        bool opaque = !(a < 1.0f);
        float alpha = exact_clamp(exact_max(a, exact_max(exact_max(r, g), b)), 0.0f, 1.0f);
        float divisor = alpha > 0.0f ? alpha : 1.0f; /* a transparent black pixel stays black */
        divisor = opaque ? 1.0f : divisor;
        block->red[i] = exact_min(r / divisor, 1.0f);
        block->green[i] = exact_min(g / divisor, 1.0f);
        block->blue[i] = exact_min(b / divisor, 1.0f);
        block->alpha[i] = opaque ? 1.0f : alpha;
    }
}

static inline void round_channel(const float *channel, const float *noise, float levels,
                                 int32_t *words)
{
    for (int i = 0; i < BLOCK; i++) {
        float steps = channel[i] * levels + 0.5f + noise[i];
        words[i] = (int32_t)exact_clamp(steps, 0.0f, levels);
    }
}

static inline void encode_block(const struct kiln_composite_rows *p, struct block *block,
                                uint32_t first, uint32_t row_hash)
{
    static const float no_noise[BLOCK];
    const float levels = p->bits == 16 ? 65535.0f : 255.0f;
    expose(block, p->exposure);
    if (p->tonemap == KILN_TONEMAP_AGX)
        map_agx(block);
    else if (p->tonemap == KILN_TONEMAP_ACES)
        map_aces(block);
    const bool is_root = p->tonemap == KILN_TONEMAP_AGX;
    encode_channel(block->red, is_root);
    encode_channel(block->green, is_root);
    encode_channel(block->blue, is_root);
    unpremultiply(block);
    if (p->dither)
        make_noise(block, first, row_hash);
    round_channel(block->red, p->dither ? block->noise[0] : no_noise, levels, block->words[0]);
    round_channel(block->green, p->dither ? block->noise[1] : no_noise, levels, block->words[1]);
    round_channel(block->blue, p->dither ? block->noise[2] : no_noise, levels, block->words[2]);
    round_channel(block->alpha, no_noise, levels, block->words[3]);
}

static inline void store_bytes(const struct block *block, uint32_t count, uint8_t *out)
{
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 4; c++)
            out[4 * i + (uint32_t)c] = (uint8_t)block->words[c][i];
    }
}

static inline void store_shorts(const struct block *block, uint32_t count, uint16_t *out)
{
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 4; c++)
            out[4 * i + (uint32_t)c] = (uint16_t)block->words[c][i];
    }
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* Composes a block of pixels. at: index of its first pixel in the picture; x: column of that
 * pixel. */
static inline void compose_block(const struct kiln_composite_rows *p, struct block *block,
                                 size_t at, uint32_t x, uint32_t count, const kiln_quad *glow)
{
    float *beauty = p->beauty;
    for (uint32_t i = 0; i < count; i++) {
        kiln_quad color = kiln_compose(&p->light, 4 * (at + i));
        if (glow)
            color += kiln_magnified(p->magnifier, glow, x + i);
        if (beauty)
            kiln_quad_store(beauty + 4 * (at + i), color);
        block->red[i] = color[0];
        block->green[i] = color[1];
        block->blue[i] = color[2];
        block->alpha[i] = color[3];
    }
}

static inline void compose_row(const struct kiln_composite_rows *p, uint32_t y, uint32_t worker)
{
    const uint32_t width = p->width;
    const uint32_t row_hash = hash(y + hash(p->frame));
    const kiln_quad *glow = NULL;
    if (p->glow)
        glow = kiln_magnifier_row(p->magnifier, p->glow, y, p->strength, worker);
    struct block block = {0};
    for (uint32_t x = 0; x < width; x += BLOCK) {
        uint32_t count = width - x < BLOCK ? width - x : BLOCK;
        size_t at = (size_t)y * width + x;
        compose_block(p, &block, at, x, count, glow);
        encode_block(p, &block, x, row_hash);
        if (p->bits == 16)
            store_shorts(&block, count, (uint16_t *)p->display + 4 * at);
        else
            store_bytes(&block, count, (uint8_t *)p->display + 4 * at);
    }
}

void KILN_SIMD_NAME(kiln_composite_rows_run)(void *context, size_t begin, size_t end,
                                             uint32_t worker)
{
    for (size_t y = begin; y < end; y++)
        compose_row(context, (uint32_t)y, worker);
}
