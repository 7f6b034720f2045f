/* This file composes rows of the picture on the host, as shaders/post/composite.frag does in GL.
 * Images hold RGBA, pixel by pixel: vectors of them are blended as they lie, then transposed to one
 * vector for each channel, in which the pixels have another order (transpose.h).
 *
 * A block of vectors takes one short loop after another: a processor works on several turns of a
 * short loop at a time, but on hardly more than one turn of a loop that does all. */
#include "base/real.h"
#include "base/transpose.h"
#include "post/composite_rows.h"
#include "post/magnify_row.h"
#include "shared/exact.h"
#include "shared/tonemap.h"

enum {
    FLOATS = 4 * LANES, /* of a vector of pixels */
    BLOCK = 8,          /* vectors of a block, at most */
};

/* Holds channels of pixels, each vector in the order of columns; and the noise of the dither. */
struct block {
    vf channel[4][BLOCK];
    vi noise[BLOCK];
};

/* Describes a block's pixels: the column of the first, its index in the pictures, and how many
 * vectors they are. */
struct place {
    uint32_t x;
    size_t at;
    int count;
};

static const float HALF_MAX = 65504.0f;

/* ---- dither ---------------------------------------------------------------------------------- */

SIMD vu hash(vu x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

static inline uint32_t hash_of(uint32_t x)
{
    return hash(x - (vu){0})[0];
}

/* Makes the noise of the dither (shared/tonemap.h). It differs by pixel, channel and frame, and is
 * the same in each run. */
SIMD void make_noise(struct block *block, const struct place *place, uint32_t row_hash)
{
    const vu columns = (vu)vi_of(lane_order(vf_count())) + place->x + row_hash;
    for (int i = 0; i < place->count; i++) {
        const vu h = hash(columns + (uint32_t)(i * LANES));
        block->noise[i] = (vi)((h & TONEMAP_NOISE_FIELDS) + (h >> 5 & TONEMAP_NOISE_FIELDS));
    }
}

/* ---- display --------------------------------------------------------------------------------- */

/* Returns exposed light; a NaN becomes black. */
SIMD vf exposed(vf light, float exposure)
{
    return vf_max(light * exposure, vf_all(0.0f));
}

SIMD void store_color(struct block *block, int i, struct vf3 color)
{
    block->channel[0][i] = color.x;
    block->channel[1][i] = color.y;
    block->channel[2][i] = color.z;
}

SIMD struct vf3 color_of(const struct block *block, int i)
{
    return (struct vf3){block->channel[0][i], block->channel[1][i], block->channel[2][i]};
}

/* Exposes, tone-maps and encodes light; of textures, divides it by alpha before it is encoded.
 * For ACES, light is limited to the range of 16-bit floats, since its squares overflow beyond it.
 */
SIMD void encode(const struct kiln_composite_rows *p, struct block *block, int count)
{
    const enum kiln_tonemap tonemap = p->tonemap;
    const float exposure = p->exposure, root = tonemap == KILN_TONEMAP_AGX ? 2.2f : 1.0f;
    for (int i = 0; i < count; i++) {
        struct vf3 light = color_of(block, i);
        light.x = exposed(light.x, exposure);
        light.y = exposed(light.y, exposure);
        light.z = exposed(light.z, exposure);
        if (tonemap == KILN_TONEMAP_AGX)
            light = tonemap_agx_root(light);
        else if (tonemap == KILN_TONEMAP_ACES)
            light = tonemap_aces((struct vf3){vf_min(light.x, vf_all(HALF_MAX)),
                                              vf_min(light.y, vf_all(HALF_MAX)),
                                              vf_min(light.z, vf_all(HALF_MAX))});
        if (p->texture) {
            const struct tonemap_straight straight =
                tonemap_straight_of(light, block->channel[3][i], root);
            light = straight.color;
            block->channel[3][i] = straight.alpha;
        }
        store_color(block, i, light);
    }
    for (int c = 0; c < 3; c++) {
        vf *x = block->channel[c];
        for (int i = 0; i < count && tonemap == KILN_TONEMAP_AGX; i++)
            x[i] = tonemap_encode_root(vf_min(x[i], vf_all(1.0f)));
        for (int i = 0; i < count && tonemap != KILN_TONEMAP_AGX; i++)
            x[i] = tonemap_encode(vf_min(x[i], vf_all(1.0f)));
    }
}

/* Divides colour by alpha, since files hold straight alpha. Light brighter than its alpha, such as
 * fire over a transparent background, would exceed 1. Its brightness becomes its alpha instead, so
 * that it still shows over black. Returns whether all pixels are opaque. */
SIMD bool unpremultiply(struct block *block, int i)
{
    const vf a = block->channel[3][i], one = vf_all(1.0f);
    const vi opaque = ~(a < 1.0f);
    if (!any(~opaque))
        return true;
    const struct vf3 color = color_of(block, i);
    const vf brightest = vf_max(vf_max(color.x, color.y), color.z);
    const vf alpha = vf_clamp01(vf_max(a, brightest));
    vf divisor = vf_select(alpha > 0.0f, alpha, one); /* a transparent black pixel stays black */
    divisor = vf_select(opaque, one, divisor);
    for (int c = 0; c < 3; c++)
        block->channel[c][i] = vf_min(block->channel[c][i] / divisor, one);
    block->channel[3][i] = vf_select(opaque, one, alpha);
    return false;
}

/* Stores pixels of 8 or 16 bits a channel, in the order of columns. steps: of the colours; alpha:
 * levels. */
SIMD void store_display(const struct kiln_composite_rows *p, const vi steps[3], vi alpha, size_t at)
{
    if (p->bits == 8) {
        const vi pixels =
            steps[0] >> 6 | (steps[1] << 2 & 0xff00) | (steps[2] << 10 & 0xff0000) | alpha << 24;
        vf_store((float *)(void *)((uint8_t *)p->display + 4 * at), row_order((vf)pixels));
        return;
    }
    _Alignas(64) uint32_t halves[2][LANES];
    const vi red_green = steps[0] >> 6 | (steps[1] >> 6) << 16;
    const vi blue_alpha = steps[2] >> 6 | alpha << 16;
    vf_store((float *)(void *)halves[0], row_order((vf)red_green));
    vf_store((float *)(void *)halves[1], row_order((vf)blue_alpha));
    uint16_t *const to = (uint16_t *)p->display + 4 * at;
    for (size_t i = 0; i < LANES; i++) {
        memcpy(to + 4 * i, &halves[0][i], sizeof **halves);
        memcpy(to + 4 * i + 2, &halves[1][i], sizeof **halves);
    }
}

/* Shows a block's pixels: exposes, tone-maps, encodes and dithers them. */
SIMD void show(const struct kiln_composite_rows *p, struct block *block, const struct place *place,
               uint32_t row_hash)
{
    const float levels = p->bits == 16 ? 65535.0f : 255.0f, scale = levels * TONEMAP_STEPS;
    encode(p, block, place->count);
    if (p->dither)
        make_noise(block, place, row_hash);
    for (int i = 0; i < place->count; i++) {
        const bool opaque = !p->texture && unpremultiply(block, i);
        const vi noise = p->dither ? block->noise[i] : vi_all(TONEMAP_NOISE_NONE);
        vi steps[3] = {noise & 0x3ff, noise >> 10 & 0x3ff, noise >> 20}, alpha;
        for (int c = 0; c < 3; c++)
            steps[c] += vi_of(block->channel[c][i] * scale + TONEMAP_NOISE_BIAS);
        alpha = opaque ? vi_all(exact_int(levels)) : vi_of(block->channel[3][i] * levels + 0.5f);
        store_display(p, steps, alpha, place->at + (size_t)(i * LANES));
    }
}

/* ---- light ----------------------------------------------------------------------------------- */

/* Blends pixels of a vector, which lie RGBA after RGBA, over others. */
SIMD vf blend(vf above, vf alpha, vf below)
{
    return above + below * (1.0f - alpha);
}

/* Composes as kiln_compose does. at: index of the first pixel. */
SIMD void compose(const struct kiln_compose_light *light, size_t at, vf color[4])
{
    const vi is_alpha = (vi_count() & 3) == 3;
    for (size_t k = 0; k < 4; k++) {
        const size_t first = 4 * at + k * LANES;
        color[k] = vf_load(light->scene + first);
        if (light->particles) {
            const vf above = vf_load(light->particles + first);
            color[k] = blend(above, VF_PICK(above, above, 3, 3, 3, 3), color[k]);
        }
        if (light->fire) {
            vf fire = vf_load(light->fire + first);
            fire = vf_select(is_alpha, vf_min(fire, vf_all(1.0f)), fire);
            color[k] = blend(fire, VF_PICK(fire, fire, 3, 3, 3, 3), color[k]);
        }
    }
}

/* Composes and shows a block of pixels. glow: the row of the glow, or NULL. */
static void draw_block(const struct kiln_composite_rows *p, const struct place *place,
                       uint32_t row_hash, const float *glow)
{
    struct block block;
    for (int i = 0; i < place->count; i++) {
        const size_t at = place->at + (size_t)(i * LANES);
        vf lying[4];
        compose(&p->light, at, lying);
        struct columns color = columns_transpose(lying[0], lying[1], lying[2], lying[3]);
        if (glow) {
            const struct vf3 more = magnified(p->magnifier, glow, place->x + (uint32_t)(i * LANES));
            color.c[0] += lane_order(more.x);
            color.c[1] += lane_order(more.y);
            color.c[2] += lane_order(more.z);
        }
        for (int c = 0; c < 4; c++)
            block.channel[c][i] = color.c[c];
        if (!p->beauty)
            continue;
        color = columns_transpose(color.c[0], color.c[1], color.c[2], color.c[3]);
        for (size_t k = 0; k < 4; k++)
            vf_store(p->beauty + 4 * at + k * LANES, color.c[k]);
    }
    show(p, &block, place, row_hash);
}

/* Draws the last pixels of a row, fewer than a vector, by way of a copy. */
static void draw_rest(const struct kiln_composite_rows *p, uint32_t x, size_t at, uint32_t count,
                      uint32_t row_hash, const float *glow)
{
    float images[3][FLOATS] = {{0}}, beauty[FLOATS];
    uint16_t display[FLOATS];
    const float *const from[3] = {p->light.scene, p->light.particles, p->light.fire};
    for (int i = 0; i < 3; i++) {
        if (from[i])
            memcpy(images[i], from[i] + 4 * at, count * (4 * sizeof **images));
    }
    struct kiln_composite_rows copy = *p;
    copy.light = (struct kiln_compose_light){images[0], from[1] ? images[1] : NULL,
                                             from[2] ? images[2] : NULL};
    copy.beauty = p->beauty ? beauty : NULL;
    copy.display = display;
    draw_block(&copy, &(struct place){x, 0, 1}, row_hash, glow);
    const size_t pixel = (size_t)4 * (p->bits / 8);
    memcpy((char *)p->display + pixel * at, display, pixel * count);
    if (p->beauty)
        memcpy(p->beauty + 4 * at, beauty, count * (4 * sizeof *beauty));
}

void KILN_SIMD_NAME(kiln_composite_rows_run)(void *context, size_t begin, size_t end,
                                             uint32_t worker)
{
    const struct kiln_composite_rows *p = context;
    const uint32_t width = p->width, whole = width - width % LANES;
    for (size_t y = begin; y < end; y++) {
        const uint32_t row_hash = hash_of((uint32_t)y + hash_of(p->frame));
        const float *glow = NULL;
        if (p->glow)
            glow = magnify_row(p->magnifier, p->glow, (uint32_t)y, p->strength, worker);
        for (uint32_t x = 0; x < whole; x += BLOCK * LANES) {
            const uint32_t left = (whole - x) / LANES;
            const struct place place = {x, y * width + x, left < BLOCK ? (int)left : BLOCK};
            draw_block(p, &place, row_hash, glow);
        }
        if (whole < width)
            draw_rest(p, whole, y * width + whole, width - whole, row_hash, glow);
    }
}
