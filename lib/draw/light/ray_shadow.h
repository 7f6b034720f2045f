/* This header reads shadow maps of meshes for vectors of points: of the sun (mesh_shadow.h), and of
 * lamps (lamp_map.h). */
#ifndef KILN_DRAW_LIGHT_RAY_SHADOW_H
#define KILN_DRAW_LIGHT_RAY_SHADOW_H

#include "base/real.h"
#include "base/transpose.h"
#include "draw/light/shadow_levels.h"

/* Describes maps of one size, one after another. */
struct shadow_map {
    const uint32_t *entries; /* as shadow_levels.h lays them out */
    int32_t edge;            /* of the finest level, texels */
    int32_t levels;
    int32_t words; /* of a texel: 1, or 2 as in lamp_solids.h */
};

/* Holds the part of a place in a shadow map that is covered, and that part times means of what
 * covers it. */
struct shadow_sample {
    vf cover, distance;
    vf square, narrow; /* as in lamp_solids.h; 0 where texels have one word */
};

/* Describes a level of maps in each lane: its edge, texels, and where its first entry is. */
struct shadow_level {
    vf edge;
    vi start;
};

/* Describes how maps are read in each lane: between two levels. */
struct shadow_filter {
    struct shadow_level fine, coarse;
    vf part; /* of the way from the fine level to the coarse one */
};

/* first: where the map starts, in entries. */
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

/* Adds a texel to a sum. second: NULL unless texels have two words. */
SIMD void add_texel(struct shadow_sample *sum, vf weight, vf first, const vf *second)
{
    const vi word = (vi)first;
    sum->cover += weight * vf_of(word & 0xffff);
    sum->distance += weight * vf_of(word >> 16 & 0xffff);
    if (!second)
        return;
    const vi other = (vi)*second;
    sum->square += weight * vf_of(other & 0xffff);
    sum->narrow += weight * vf_of(other >> 16 & 0xffff);
}

/* Interpolates linearly between four texels of a level; texels beside the map are empty. Numbers
 * are in units of 1 / KILN_SHADOW_ONE. */
SIMD struct shadow_sample read_shadow_level(const struct shadow_map *map,
                                            const struct shadow_level *level, vf u, vf v)
{
    const vf x = vf_min(vf_max(u * level->edge - 0.5f, vf_all(-1.0f)), level->edge);
    const vf y = vf_min(vf_max(v * level->edge - 0.5f, vf_all(-1.0f)), level->edge);
    const vf left = vf_floor(x), top = vf_floor(y), right = x - left, down = y - top;
    const int32_t pitch = KILN_SHADOW_PITCH(map->edge), entry = KILN_SHADOW_PAIR * map->words;
    const vi at = (level->start + vi_of(top) * pitch + vi_of(left)) * entry;
    const struct lane_offsets offsets = lane_offsets_of(at);
    const float *words = (const float *)(const void *)map->entries;
    const vf above[2] = {(1.0f - right) * (1.0f - down), right * (1.0f - down)};
    const vf below[2] = {(1.0f - right) * down, right * down};
    struct shadow_sample sum = {{0}, {0}, {0}, {0}};
    const struct columns first = columns_load(words, &offsets);
    if (map->words == 1) { /* two entries: left above, left below, right above, right below */
        add_texel(&sum, above[0], first.c[0], NULL);
        add_texel(&sum, above[1], first.c[2], NULL);
        add_texel(&sum, below[0], first.c[1], NULL);
        add_texel(&sum, below[1], first.c[3], NULL);
        return sum;
    }
    const struct columns next = columns_load(words + entry, &offsets);
    add_texel(&sum, above[0], first.c[0], &first.c[1]);
    add_texel(&sum, above[1], next.c[0], &next.c[1]);
    add_texel(&sum, below[0], first.c[2], &first.c[3]);
    add_texel(&sum, below[1], next.c[2], &next.c[3]);
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
