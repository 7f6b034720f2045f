/* This header reads shadow maps of meshes for vectors of points: of the sun (mesh_shadow.h), and of
 * lamps (lamp_map.h). */
#ifndef KILN_DRAW_LIGHT_RAY_SHADOW_H
#define KILN_DRAW_LIGHT_RAY_SHADOW_H

#include "base/real.h"
#include "draw/light/shadow_levels.h"

/* Describes maps of one size, one after another. */
struct shadow_map {
    const uint32_t *texels;
    int32_t edge; /* of the finest level, texels */
    int32_t levels;
    int32_t words; /* of a texel: 1, or 2 as in lamp_solids.h */
};

/* Holds the part of a place in a shadow map that is covered, and that part times means of what
 * covers it. */
struct shadow_sample {
    vf cover, distance;
    vf square, narrow; /* as in lamp_solids.h; 0 where texels have one word */
};

/* Interpolates linearly between four texels of a level; texels beside the map are empty. first:
 * where the map starts, in texels. */
SIMD struct shadow_sample read_shadow_level(const struct shadow_map *map, vi first, vf u, vf v,
                                            vi level)
{
    vi edge = vi_all(map->edge) >> level;
    vf size = vf_of(edge);
    vf x = vf_min(vf_max(u * size - 0.5f, vf_all(-2.0f)), size + 1.0f);
    vf y = vf_min(vf_max(v * size - 0.5f, vf_all(-2.0f)), size + 1.0f);
    vf left = vf_floor(x), top = vf_floor(y), right = x - left, down = y - top;
    /* Finer levels have edge^2 + edge^2 / 4 + ... texels. */
    vi start = first + (4 * map->edge * map->edge - 4 * edge * edge) / 3;
    struct shadow_sample sum = {{0}, {0}, {0}, {0}};
    for (int i = 0; i < 4; i++) {
        vi column = vi_of(left) + (i & 1), row = vi_of(top) + (i >> 1);
        vi inside = (column >= 0) & (row >= 0) & (column < edge) & (row < edge);
        vf weight = (i & 1 ? right : 1.0f - right) * (i >> 1 ? down : 1.0f - down);
        weight = vf_where(inside, weight);
        vi at = vi_select(inside, start + row * edge + column, vi_all(0));
        vi texel = vi_gather((const int32_t *)map->texels, at * map->words);
        weight *= 1.0f / (float)KILN_SHADOW_ONE;
        if (map->words > 1) {
            vi more = vi_gather((const int32_t *)map->texels + 1, at * map->words);
            sum.square += weight * vf_of(more & 0xffff);
            sum.narrow += weight * vf_of(more >> 16 & 0xffff);
        }
        sum.cover += weight * vf_of(texel & 0xffff);
        sum.distance += weight * vf_of(texel >> 16 & 0xffff);
    }
    return sum;
}

/* Reads a shadow map, interpolated between two levels. */
SIMD struct shadow_sample read_shadow(const struct shadow_map *map, vi first, vf u, vf v, vf level)
{
    const float last = (float)(map->levels - 1);
    level = vf_clamp(level, 0.0f, last);
    vf fine = vf_floor(level), part = level - fine;
    struct shadow_sample shadow = read_shadow_level(map, first, u, v, vi_of(fine));
    if (any(part > 0.0f)) {
        vf coarse = vf_min(fine + 1.0f, vf_all(last));
        struct shadow_sample coarser = read_shadow_level(map, first, u, v, vi_of(coarse));
        shadow.cover += (coarser.cover - shadow.cover) * part;
        shadow.distance += (coarser.distance - shadow.distance) * part;
        if (map->words > 1) {
            shadow.square += (coarser.square - shadow.square) * part;
            shadow.narrow += (coarser.narrow - shadow.narrow) * part;
        }
    }
    return shadow;
}

#endif
