/* This header draws small sprites of systems with few slots, whose cells are sampled in floats
 * (KILN_CELL_FINE_MOST). */
#ifndef KILN_DRAW_SPRITES_TILE_FLOATS_H
#define KILN_DRAW_SPRITES_TILE_FLOATS_H

#include "draw/sprites/tile_begin.h"

/* Interpolates down between two rows. Each lane's word has a channel of a row in the signed byte at
 * bit `from`, and that of the row below in the next byte. */
SIMD vf between_rows(vi word, int from, vf down)
{
    const vi above = word << (24 - from) >> 24, below = word << (16 - from) >> 24;
    return vf_of(above) + vf_of(below - above) * down;
}

/* Samples a cell in floats at u, v, texels, for the channels from `first` to 3. A word of 4 bytes
 * has two channels. In a cell of alpha alone it has two columns, and begins at any second byte. */
SIMD struct vf4 sample_floats(const struct brush *b, const uint8_t *cell, size_t first, vf u, vf v)
{
    const vi column = vi_of(u), row = vi_of(v);
    const vf right = u - vf_of(column), down = v - vf_of(row);
    const vi at = row * b->pitch + column * b->texel;
    struct vf4 sampled = {{{0}}};
    if (first == 3) {
        vi word;
        for (int i = 0; i < LANES; i++) {
            int32_t texels;
            memcpy(&texels, cell + at[i], sizeof texels);
            word[i] = texels;
        }
        const vf left_side = between_rows(word, 0, down), right_side = between_rows(word, 16, down);
        sampled.c[3] = left_side + (right_side - left_side) * right;
        return sampled;
    }
    const int32_t *texels = (const int32_t *)(const void *)cell;
    for (size_t c = first; c < 4; c += 2) {
        const vi word = (at >> 2) + (int32_t)((c - first) / 2);
        const vi left = vi_gather(texels, word), next = vi_gather(texels, word + b->texel / 4);
        for (int k = 0; k < 2; k++) {
            const vf left_side = between_rows(left, 16 * k, down);
            const vf right_side = between_rows(next, 16 * k, down);
            sampled.c[c + (size_t)k] = left_side + (right_side - left_side) * right;
        }
    }
    return sampled;
}

/* Draws a unit in each of UNITS rows, or a part of one unit. u, v: texels. */
SIMD void draw_floats(const struct target *d, struct batch *batch, vf u, vf v)
{
    const struct kiln_sprite *s = d->s;
    const struct brush *b = &d->brush;
    const size_t first = first_channel((enum kiln_sprite_shade)s->shade);
    const vf zero = vf_all(0.0f), edge = vf_all(s->edge_u);
    if (b->rim) {
        batch->rim[0] = rim_cover(s, u, v);
        batch->inside[0] &= batch->rim[0] > 0.0f;
    } else {
        batch->rim[0] = vf_all(1.0f);
        batch->inside[0] &= (u >= 0.0f) & (u < edge) & (v >= 0.0f) & (v < edge);
    }
    u = vf_min(vf_max(u, zero), edge) + 0.5f;
    v = vf_min(vf_max(v, zero), edge) + 0.5f;
    struct vf4 cell = sample_floats(b, b->cell, first, u, v);
    if (b->next) {
        const struct vf4 next = sample_floats(b, b->next, first, u, v);
        for (size_t c = first; c < 4; c++)
            cell.c[c] += (next.c[c] - cell.c[c]) * s->part;
    }
    struct shaded c = shade_cell(s, d->extra, b, (enum kiln_sprite_shade)s->shade, cell);
    draw_vector(batch, 0, d, c, s->shade == KILN_SHADE_COLOR, false,
                (s->flags & KILN_SPRITE_COVERS) != 0);
}

static void draw_in_floats(struct kiln_tile *tile, const struct kiln_cells_content *cells,
                           const struct kiln_sprite *s, const struct kiln_sprite_extra *extra)
{
    const struct box box = box_in(tile, s);
    struct target d;
    if (!begin_target(tile, s, extra, &box, (s->flags & KILN_SPRITE_COVERS) != 0, &d))
        return;
    make_brush(tile, cells, s, (enum kiln_sprite_shade)s->shade, false,
               (s->flags & KILN_SPRITE_MIXED) != 0, &d.brush);
    d.brush.sampled = 1.0f / 255.0f;
    struct batch batch;
    for (int y = box.y_from; y < box.y_to; y += UNITS) {
        vf row = vf_units_number() + ((float)(tile->y + y) + 0.5f), below = row - s->y;
        for (int x = box.x_from; x < box.x_to; x += LANES / UNITS) {
            vf right = vf_units_count(0) + ((float)(tile->x + x) + 0.5f) - s->x;
            batch.inside[0] = row < (float)(tile->y + box.y_to);
            for (int k = 0; k < UNITS; k++)
                batch.at[0][k] = (y + k) * KILN_TILE_PLANES * KILN_TILE_PITCH + x;
            draw_floats(&d, &batch, (s->u + s->u_x * right) + s->u_y * below,
                        (s->v + s->v_x * right) + s->v_y * below);
        }
    }
}

#endif
