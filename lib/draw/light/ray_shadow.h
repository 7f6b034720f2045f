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

/* Describes a level of maps in each lane: its edge, texels, and where its first texel is. */
struct shadow_level {
    vf edge;
    vi start;
};

/* Describes how maps are read in each lane: between two levels. */
struct shadow_filter {
    struct shadow_level fine, coarse;
    vf part; /* of the way from the fine level to the coarse one */
};

/* first: where the map starts, in texels. */
SIMD struct shadow_level shadow_level_at(const struct shadow_map *map, vi first, vf level)
{
    const vi number = vi_of(level), edge = vi_all(map->edge) >> number, finest = number <= 0;
    const vi row = vi_select(finest, vi_all(1), KILN_SHADOW_COARSE_ROW(map->edge, number, edge));
    const vi column = vi_select(finest, vi_all(1), vi_all(KILN_SHADOW_COARSE_COLUMN(map->edge)));
    return (struct shadow_level){vf_of(edge), first + row * KILN_SHADOW_PITCH(map->edge) + column};
}

/* Returns the filter for a level, which need not be whole. */
SIMD struct shadow_filter shadow_filter_of(const struct shadow_map *map, vi first, vf level)
{
    const float last = (float)(map->levels - 1);
    level = vf_clamp(level, 0.0f, last);
    const vf fine = vf_floor(level), coarse = vf_min(fine + 1.0f, vf_all(last));
    return (struct shadow_filter){shadow_level_at(map, first, fine),
                                  shadow_level_at(map, first, coarse), level - fine};
}

SIMD void add_texel(struct shadow_sample *sum, vf weight, vi texel)
{
    sum->cover += weight * vf_of(texel & 0xffff);
    sum->distance += weight * vf_of(texel >> 16 & 0xffff);
}

SIMD void add_second_word(struct shadow_sample *sum, vf weight, vi word)
{
    sum->square += weight * vf_of(word & 0xffff);
    sum->narrow += weight * vf_of(word >> 16 & 0xffff);
}

/* Interpolates linearly between four texels of a level; texels beside the map are empty. Numbers
 * are in units of 1 / KILN_SHADOW_ONE. */
SIMD struct shadow_sample read_shadow_level(const struct shadow_map *map,
                                            const struct shadow_level *level, vf u, vf v)
{
    const vf x = vf_min(vf_max(u * level->edge - 0.5f, vf_all(-1.0f)), level->edge);
    const vf y = vf_min(vf_max(v * level->edge - 0.5f, vf_all(-1.0f)), level->edge);
    const vf left = vf_floor(x), top = vf_floor(y), right = x - left, down = y - top;
    const int32_t pitch = KILN_SHADOW_PITCH(map->edge);
    const vi at = (level->start + vi_of(top) * pitch + vi_of(left)) * map->words;
    const size_t texel = (size_t)map->words, below = (size_t)pitch * texel;
    struct shadow_sample sum = {{0}, {0}, {0}, {0}};
    for (int i = 0; i < 2; i++) {
        const int32_t *row = (const int32_t *)map->texels + (i ? below : 0);
        const vf height = i ? down : 1.0f - down, weights[2] = {1.0f - right, right};
        if (map->words == 1) {
            const struct vi_pair texels = vi_gather_pair(row, at);
            add_texel(&sum, weights[0] * height, texels.first);
            add_texel(&sum, weights[1] * height, texels.second);
            continue;
        }
        for (int k = 0; k < 2; k++) {
            const struct vi_pair words = vi_gather_pair(row + (k ? texel : 0), at);
            add_texel(&sum, weights[k] * height, words.first);
            add_second_word(&sum, weights[k] * height, words.second);
        }
    }
    return sum;
}

/* Reads a shadow map at a place. */
SIMD struct shadow_sample read_shadow(const struct shadow_map *map,
                                      const struct shadow_filter *filter, vf u, vf v)
{
    struct shadow_sample shadow = read_shadow_level(map, &filter->fine, u, v);
    if (any(filter->part > 0.0f)) {
        const struct shadow_sample coarse = read_shadow_level(map, &filter->coarse, u, v);
        shadow.cover += (coarse.cover - shadow.cover) * filter->part;
        shadow.distance += (coarse.distance - shadow.distance) * filter->part;
        if (map->words > 1) {
            shadow.square += (coarse.square - shadow.square) * filter->part;
            shadow.narrow += (coarse.narrow - shadow.narrow) * filter->part;
        }
    }
    const float unit = 1.0f / (float)KILN_SHADOW_ONE;
    return (struct shadow_sample){shadow.cover * unit, shadow.distance * unit, shadow.square * unit,
                                  shadow.narrow * unit};
}

#endif
