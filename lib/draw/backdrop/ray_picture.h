/* This header reads the pictures of the floor and the sky for vectors of rays. Texels are fetched
 * one lane after another; a ray_texel is a vector of one texel's channels. */
#ifndef KILN_DRAW_BACKDROP_RAY_PICTURE_H
#define KILN_DRAW_BACKDROP_RAY_PICTURE_H

#include "base/real.h"
#include "draw/backdrop/ray.h"
#include "shared/picture_map.h"

typedef float ray_texel __attribute__((vector_size(16)));

/* Reads a colour of half floats. The bits of a half float, shifted by 13, are those of a float
 * 2^112 times too small. */
static inline ray_texel read_texel(const uint16_t half[4])
{
    typedef uint16_t halves __attribute__((vector_size(8)));
    typedef uint32_t widened __attribute__((vector_size(16)));
    halves bits;
    memcpy(&bits, half, sizeof bits);
    return (ray_texel)(__builtin_convertvector(bits, widened) << 13) * 0x1p112f;
}

static inline float fraction(float x)
{
    return x - floorf(x);
}

/* Interpolates linearly between four texels of a level. u, v: 0 to 1. The picture repeats beyond
 * its left and right edges; beyond the upper and lower ones it repeats too, or is clamped. */
static inline ray_texel read_level(const struct kiln_pyramid *p, uint32_t level, float u, float v,
                                   bool repeats_y)
{
    int32_t width = (int32_t)p->widths[level], height = (int32_t)p->heights[level];
    float x = u * (float)width - 0.5f, y = v * (float)height - 0.5f;
    float left = floorf(x), top = floorf(y), right = x - left, down = y - top;
    int32_t x0 = (int32_t)left, x1 = x0 + 1 < width ? x0 + 1 : 0;
    int32_t y0 = (int32_t)top, y1 = y0 + 1;
    x0 = x0 < 0 ? width - 1 : x0;
    if (y1 >= height)
        y1 = repeats_y ? 0 : height - 1;
    if (y0 < 0)
        y0 = repeats_y ? height - 1 : 0;
    const uint16_t(*upper)[4] = (const uint16_t(*)[4])p->texels + p->first[level];
    const uint16_t(*lower)[4] = upper + (size_t)y1 * (size_t)width;
    upper += (size_t)y0 * (size_t)width;
    ray_texel a = read_texel(upper[x0]), b = read_texel(upper[x1]);
    ray_texel c = read_texel(lower[x0]), d = read_texel(lower[x1]);
    a += (b - a) * right;
    c += (d - c) * right;
    return a + (c - a) * down;
}

/* Holds the two mip levels between which one lane interpolates. */
struct ray_levels {
    uint32_t fine, coarse;
    float part; /* weight of the coarse level */
};

static inline struct ray_levels choose_levels(const struct kiln_pyramid *p, float level)
{
    float most = (float)(p->levels - 1);
    level = level > 0.0f ? level : 0.0f;
    level = level < most ? level : most;
    uint32_t fine = (uint32_t)level;
    return (struct ray_levels){fine, fine + 1 < p->levels ? fine + 1 : fine, level - (float)fine};
}

static inline ray_texel read_picture(const struct kiln_pyramid *p, const struct ray_levels *levels,
                                     float u, float v, bool repeats_y)
{
    ray_texel fine = read_level(p, levels->fine, u, v, repeats_y);
    if (levels->part > 0.0f)
        fine += (read_level(p, levels->coarse, u, v, repeats_y) - fine) * levels->part;
    return fine;
}

SIMD void set_lane(struct vf3 *color, int lane, ray_texel texel)
{
    color->x[lane] = texel[0];
    color->y[lane] = texel[1];
    color->z[lane] = texel[2];
}

/* ---- the floor ------------------------------------------------------------------------------- */

/* Reads the floor's picture at (x, z) on the floor, m. */
SIMD struct vf3 floor_picture(const struct kiln_ray_frame *frame,
                              const struct floor_footprint *footprint, vf x, vf z, vi active)
{
    const struct kiln_pyramid *picture = frame->floor_image;
    const float4 map = frame->shapes->floor_map;
    struct vf3 color = {{0}, {0}, {0}};
    for (int lane = 0; lane < LANES; lane++) {
        if (!active[lane])
            continue;
        const struct ray_levels levels = choose_levels(picture, footprint->level[lane]);
        ray_texel sum = {0};
        for (int i = 0; i < FLOOR_TAPS; i++) {
            float way = floor_tap_of(i);
            float u = fraction((x[lane] + footprint->longer_x[lane] * way) * map.x);
            float v = fraction((z[lane] + footprint->longer_z[lane] * way) * map.y);
            sum += read_picture(picture, &levels, u, v, true);
        }
        set_lane(&color, lane, sum * (1.0f / (float)FLOOR_TAPS));
    }
    return color;
}

/* ---- the sky --------------------------------------------------------------------------------- */

/* Reads the sky's picture, averaged over at least `angle` radians. */
SIMD struct vf3 sky_picture(const struct kiln_ray_frame *frame, struct vf3 direction, float angle,
                            vi active)
{
    const struct kiln_pyramid *picture = frame->sky_image;
    const float4 map = frame->shapes->sky_map;
    const struct ray_levels levels =
        choose_levels(picture, exact_log2(exact_max(angle * map.z, 1e-6f)));
    const struct sky_place at = sky_place_of(direction, map.x);
    vf u = at.u - vf_floor(at.u);
    struct vf3 color = {{0}, {0}, {0}};
    for (int lane = 0; lane < LANES; lane++) {
        if (active[lane])
            set_lane(&color, lane,
                     read_picture(picture, &levels, u[lane], at.v[lane], false) * map.y);
    }
    return color;
}

#endif
