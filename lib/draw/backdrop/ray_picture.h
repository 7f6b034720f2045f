/* This header reads pictures: those of the floor and the sky for vectors of rays, and the paint of
 * meshes for one ray after another, since each ray may meet another mesh. A ray_texel is a vector
 * of one texel's channels. */
#ifndef KILN_DRAW_BACKDROP_RAY_PICTURE_H
#define KILN_DRAW_BACKDROP_RAY_PICTURE_H

#include "base/real.h"
#include "draw/backdrop/ray.h"
#include "shared/exact.h"
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
 * its left and right edges; beyond the upper and lower ones it repeats too, or is clamped. A
 * coordinate that is NaN reads an edge, so that no place outside of the memory is read. */
static inline ray_texel read_level(const struct kiln_pyramid *p, uint32_t level, float u, float v,
                                   bool repeats_y)
{
    int32_t width = (int32_t)p->widths[level], height = (int32_t)p->heights[level];
    float x = exact_max(u * (float)width - 0.5f, -1.0f);
    float y = exact_max(v * (float)height - 0.5f, -1.0f);
    float left = floorf(x), top = floorf(y), right = x - left, down = y - top;
    int32_t x0 = exact_int(left), x1 = x0 + 1 < width ? x0 + 1 : 0;
    int32_t y0 = exact_int(top), y1 = y0 + 1;
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
    uint32_t fine = exact_uint(level);
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

/* ---- vectors --------------------------------------------------------------------------------- */

/* Holds a mip level of each lane: its size, and its first texel. */
struct ray_level {
    vi width, height, first;
};

SIMD struct ray_level level_of_lanes(const struct kiln_pyramid *p, vi level)
{
    return (struct ray_level){vi_gather((const int32_t *)p->widths, level),
                              vi_gather((const int32_t *)p->heights, level),
                              vi_gather((const int32_t *)p->first, level)};
}

/* Reads colours of half floats, as read_texel does. A texel is two words, each of two channels. */
SIMD struct vf3 gather_texels(const struct kiln_pyramid *p, vi at)
{
    const int32_t *words = (const int32_t *)(const void *)p->texels;
    const struct vi_pair two = vi_gather_pair(words, 2 * at);
    return (struct vf3){(vf)((two.first & 0xffff) << 13) * 0x1p112f,
                        (vf)((two.first >> 16 & 0xffff) << 13) * 0x1p112f,
                        (vf)((two.second & 0xffff) << 13) * 0x1p112f};
}

SIMD struct vf3 mix_colors(struct vf3 from, struct vf3 to, vf part)
{
    return (struct vf3){from.x + (to.x - from.x) * part, from.y + (to.y - from.y) * part,
                        from.z + (to.z - from.z) * part};
}

/* Interpolates as read_level does. */
SIMD struct vf3 gather_level(const struct kiln_pyramid *p, const struct ray_level *level, vf u,
                             vf v, bool repeats_y)
{
    const vi width = level->width, height = level->height, zero = vi_all(0);
    const vf x = vf_max(u * vf_of(width) - 0.5f, vf_all(-1.0f));
    const vf y = vf_max(v * vf_of(height) - 0.5f, vf_all(-1.0f));
    const vf left = vf_floor(x), top = vf_floor(y), right = x - left, down = y - top;
    vi x0 = vi_of(left), y0 = vi_of(top), x1 = x0 + 1, y1 = y0 + 1;
    x1 &= x1 < width;
    x0 = vi_select(x0 < 0, width - 1, x0);
    y1 = vi_select(y1 < height, y1, repeats_y ? zero : height - 1);
    y0 = vi_select(y0 < 0, repeats_y ? height - 1 : zero, y0);
    const vi upper = level->first + y0 * width, lower = level->first + y1 * width;
    const struct vf3 above =
        mix_colors(gather_texels(p, upper + x0), gather_texels(p, upper + x1), right);
    const struct vf3 below =
        mix_colors(gather_texels(p, lower + x0), gather_texels(p, lower + x1), right);
    return mix_colors(above, below, down);
}

/* Holds the two mip levels between which each lane interpolates. */
struct ray_level_pair {
    struct ray_level fine, coarse;
    vf part; /* weight of the coarse level */
    bool mixes;
};

/* Chooses levels as choose_levels does. */
SIMD struct ray_level_pair level_pair(const struct kiln_pyramid *p, vf level)
{
    const int32_t last = (int32_t)p->levels - 1;
    level = vf_clamp(level, 0.0f, (float)last);
    const vi fine = vi_of(level), next = fine + 1;
    const vf part = level - vf_of(fine);
    return (struct ray_level_pair){
        level_of_lanes(p, fine),
        level_of_lanes(p, vi_select(next <= last, next, fine)),
        part,
        any(part > 0.0f),
    };
}

SIMD struct vf3 gather_picture(const struct kiln_pyramid *p, const struct ray_level_pair *levels,
                               vf u, vf v, bool repeats_y)
{
    const struct vf3 fine = gather_level(p, &levels->fine, u, v, repeats_y);
    if (!levels->mixes)
        return fine;
    return mix_colors(fine, gather_level(p, &levels->coarse, u, v, repeats_y), levels->part);
}

/* ---- the floor ------------------------------------------------------------------------------- */

/* Returns the mean of fetches from a level along the footprint. taps: of each lane. */
SIMD struct vf3 floor_level(const struct kiln_ray_frame *frame,
                            const struct floor_footprint *footprint, const struct ray_level *level,
                            vf taps, vf x, vf z, vi active)
{
    const float4 map = frame->shapes->floor_map;
    const vf part = 1.0f / taps, needed = vf_where(active, taps);
    struct vf3 sum = {{0}, {0}, {0}};
    for (int i = 0; any(needed > (float)i); i++) {
        const vf way = floor_tap_of(part, i);
        const vf u = (x + footprint->longer_x * way) * map.x;
        const vf v = (z + footprint->longer_z * way) * map.y;
        const struct vf3 color =
            gather_level(frame->floor_image, level, vf_where(active, u - vf_floor(u)),
                         vf_where(active, v - vf_floor(v)), true);
        sum = vf3_add_scaled(sum, color, vf_where(needed > (float)i, part));
    }
    return sum;
}

/* Reads the floor's picture at (x, z) on the floor, m. */
SIMD struct vf3 floor_picture(const struct kiln_ray_frame *frame,
                              const struct floor_footprint *footprint, vf x, vf z, vi active)
{
    const struct ray_level_pair levels =
        level_pair(frame->floor_image, vf_where(active, footprint->level));
    const struct vf3 fine =
        floor_level(frame, footprint, &levels.fine, footprint->taps, x, z, active);
    if (!levels.mixes)
        return fine;
    const struct vf3 coarse = floor_level(frame, footprint, &levels.coarse,
                                          floor_coarse_taps(footprint->taps), x, z, active);
    return mix_colors(fine, coarse, levels.part);
}

/* ---- the sky --------------------------------------------------------------------------------- */

/* Reads the sky's picture, averaged over at least `angle` radians. */
SIMD struct vf3 sky_picture(const struct kiln_ray_frame *frame, struct vf3 direction, float angle,
                            vi active)
{
    const struct kiln_pyramid *picture = frame->sky_image;
    const float4 map = frame->shapes->sky_map;
    const struct ray_level_pair levels =
        level_pair(picture, vf_all(exact_log2(exact_max(angle * map.z, 1e-6f))));
    const struct sky_place at = sky_place_of(direction, map.x);
    const struct vf3 color = gather_picture(
        picture, &levels, vf_where(active, at.u - vf_floor(at.u)), vf_where(active, at.v), false);
    return vf3_scale(color, vf_all(map.y));
}

#endif
