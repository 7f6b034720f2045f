/* This header chooses the cells of flipbooks that sprites show (Heinz 2019, 3.2.4), for
 * sprite_simd.c. */
#ifndef KILN_DRAW_SPRITES_SPRITE_CELLS_H
#define KILN_DRAW_SPRITES_SPRITE_CELLS_H

#include "draw/sprites/sprite_lanes.h"

/* Holds the cells of a vector of billboards, as members of struct kiln_cell_name. */
struct chosen_cells {
    vi layer, next_layer, phase, level;
    vf motion;
};

/* Chooses at random which of their system's textures the particles have. */
SIMD struct columns choose_textures(const struct sprite_lanes *p)
{
    const uint32_t count = p->look->flags.w;
    const uint4 *textures = p->look->textures;
    vi chosen = vi_all(0);
    if (count > 1) {
        chosen = vi_of(vu_unit(p->stream, RANDOM_TEXTURE) * (float)count);
        vi last = vi_all((int32_t)count - 1);
        chosen = vi_select(chosen < last, chosen, last) * 4;
    }
    const struct lane_offsets places = lane_offsets_of(chosen);
    return columns_load((const float *)(const void *)textures, &places);
}

/* Returns the level with one to two texels a pixel: 7 less the exponent of the least power of two
 * that is not below the width in pixels; or that of the strip. */
SIMD vi level_of(vf width_px, vf length_px)
{
    vi bits = (vi)vf_clamp(vf_min(width_px, length_px), 1.0f, (float)KILN_ATLAS_CELL);
    vi level = KILN_ATLAS_LEVELS - 1 - (((bits - 1) >> 23) - 126);
    return vi_select(billboard_shows_strip(width_px, length_px), vi_all(KILN_STRIP_LEVEL), level);
}

/* Returns the edge of the cells of a level (kiln_cell_edge). */
SIMD vf edge_of(vi level)
{
    vf edge = (vf)((127 + KILN_ATLAS_LEVELS - 1 - level) << 23);
    return vf_select(level == KILN_STRIP_LEVEL, vf_all(KILN_ATLAS_STRIP), edge);
}

SIMD vi cell_number(vi layer, vi phase, vi level)
{
    return (layer * KILN_CELL_PHASES + phase) * KILN_CELL_LEVELS + level;
}

/* Calls kiln_cells_request for the cell of each visible lane. It first checks whether all of them
 * were requested before, as is usual. */
SIMD void request_cells(const struct sprite_lanes *p, const struct chosen_cells *chosen, vi number,
                        vi lanes)
{
    const atomic_bool *requested = p->pass->content.requested;
    const struct lane_offsets numbers = lane_offsets_of(number), visible = lane_offsets_of(lanes);
    int32_t missing = 0;
    for (int i = 0; i < LANES; i++)
        missing |=
            visible.at[i] & !atomic_load_explicit(&requested[numbers.at[i]], memory_order_relaxed);
    for (int i = 0; missing && i < LANES; i++) {
        const struct kiln_cell_name name = {
            (uint32_t)chosen->layer[i], (uint32_t)chosen->next_layer[i], (uint32_t)chosen->phase[i],
            (uint32_t)chosen->level[i], chosen->motion[i]};
        if (visible.at[i])
            (void)kiln_cells_request(p->pass->cells, &name);
    }
}

/* Reads the hulls of the cells; lanes with an empty hull become invisible. */
SIMD void read_hulls(struct sprite_lanes *p, vi layer)
{
    enum { FLOATS = sizeof(struct kiln_cell_hull) / sizeof(float) };
    const struct lane_offsets at = lane_offsets_of((layer * KILN_CELL_LEVELS + p->level) * FLOATS);
    const float *hulls = (const float *)(const void *)p->pass->content.hulls;
    p->hull_from = columns_load(hulls, &at);
    p->hull_to = columns_load(hulls + 4, &at);
    p->visible &= p->hull_from.c[0] < p->hull_to.c[0];
}

/* Returns how far apart the phases are that mixed cells have. count: cells of the flipbook. */
SIMD vi step_of(vi level, vi count)
{
    vi step = vi_select(level > KILN_CELL_MIXED_LEVEL, vi_all(1), vi_all(KILN_CELL_LARGE_STEP));
    return vi_select(count >= KILN_CELL_MANY, step * KILN_CELL_MANY_STEP, step);
}

/* Chooses the two adjacent cells and the part of the way between them by the progress through life
 * (equation 3.2). */
static void choose_cells(struct sprite_lanes *p)
{
    vi first = (vi)p->texture.c[0], count = (vi)p->texture.c[1];
    vf counted = vf_of(count), position = p->progress * p->cool.c[3] * (counted - 1.0f);
    if ((p->look->flags.y & LOOK_RANDOM_START) != 0)
        position += vu_unit(p->stream, RANDOM_CELL) * counted;
    position = vf_clamp(position, 0.0f, 1e6f);
    vf edge = edge_of(p->level);
    vf motion = p->texture.c[3] * edge;
    vi alone = (count == 1) & (motion == 0.0f); /* the next cell is the cell itself */
    position = vf_where(~alone, position);
    vi mixed = ((p->level >= KILN_CELL_MIXED_LEVEL) & p->mixes_cells) | alone;
    vi step = step_of(p->level, count);
    vi phase = step * vi_of(position * ((float)KILN_CELL_PHASES / vf_of(step)) + 0.5f);
    vi number = vi_select(mixed, (vi)((vu)phase / KILN_CELL_PHASES), vi_of(position));
    /* number is below 2^20, so the rounded quotient never reaches the next integer. */
    vi cell = number - vi_of(vf_of(number) / counted) * count;
    vi after = cell + 1;
    after &= after < count;
    struct chosen_cells chosen = {first + cell, first + after,
                                  (phase & (KILN_CELL_PHASES - 1)) & mixed, p->level,
                                  p->texture.c[3]};
    vi cells = cell_number(chosen.layer, chosen.phase, p->level);
    request_cells(p, &chosen, cells, p->visible);
    p->words[WORD_OF(cell)] = (vf)cells;
    p->words[WORD_OF(edge_u)] = p->words[WORD_OF(edge_v)] = edge;
    p->flags |= mixed & KILN_SPRITE_MIXED;
    if (billboard_is_flat(p->look->form.y))
        p->flags |= p->samples_floats & (motion == 0.0f) & (p->level >= KILN_CELL_FINE_LEVEL) &
                    KILN_SPRITE_FINE;
    read_hulls(p, chosen.layer);
    vi large = p->visible & ~mixed;
    if (!any(large))
        return;
    chosen.layer = chosen.next_layer;
    vi next = cell_number(chosen.layer, chosen.phase, p->level);
    request_cells(p, &chosen, next, large);
    p->words[WORD_OF(part)] = vf_where(large, position - vf_of(number));
    p->words[WORD_OF(motion)] = vf_where(large, motion);
    p->words[WORD_OF(next_cell)] = (vf)(next & large);
}

#endif
