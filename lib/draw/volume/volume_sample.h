/* This header samples the blocks of a field at the steps of eight rays. */
#ifndef KILN_DRAW_VOLUME_VOLUME_SAMPLE_H
#define KILN_DRAW_VOLUME_VOLUME_SAMPLE_H

#include "draw/volume/volume_packet.h"

_Static_assert(VOLUME_CUBE == 4, "find_places shifts cells by 2");

/* Holds the places of a step's samples, of each ray. */
struct places {
    _Alignas(32) float part[3][8]; /* of the way to the next cell */
    _Alignas(32) int32_t block[8]; /* -1: nothing is seen */
    _Alignas(32) int32_t cell[8];  /* floats from the block's first cell */
    struct eight at[3];            /* in the window, cells, from the middle of its first cell */
    struct eight middle;           /* of the segments: from the eye, cells */
    struct eight length;           /* of the segments, cells; 0: none */
    bool some;                     /* a ray has a block */
    float skip;                    /* where else the next ray meets another cube */
};

/* Finds the samples of step number `step`. */
SIMD void find_places(const struct kiln_volume_march *m, const struct packet *p, float step,
                      struct places *at)
{
    const struct kiln_volume_field *field = m->field;
    const int32_t count[3] = {field->cells.x, field->cells.y, field->cells.z};
    const int32_t stride[3] = {1, 2 * field->bricks.x, 4 * field->bricks.x * field->bricks.y};
    const int32_t floats[3] = {VOLUME_CELL, VOLUME_ROW, VOLUME_PLANE};
    struct eight skip;
    at->some = false;
    EIGHT_EACH(k)
    {
        const vf begin = vf_max(vf_all(step * m->step), p->from.part[k]);
        const vf end = vf_min(vf_all((step + 1.0f) * m->step), p->to.part[k]);
        const vi meets = begin < end;
        const vf middle = 0.5f * (begin + end);
        at->middle.part[k] = middle;
        vi number = vi_all(0), in = vi_all(0);
        vf leaves = vf_all(1e9f);
        for (int i = 0; i < 3; i++) {
            vf place = m->eye[i] + p->way[i].part[k] * middle - 0.5f;
            place = vf_clamp(place, 0.0f, (float)(count[i] - 1));
            const vi cell = vi_of(place), cube = cell >> 2;
            at->at[i].part[k] = place;
            vf_store(at->part[i] + (ptrdiff_t)k * LANES, place - vf_of(cell));
            number += cube * stride[i];
            in += (cell & (GAS_BRICK - 1)) * floats[i];
            const vf side = vf_of((cube - (p->way[i].part[k] > 0.0f)) * VOLUME_CUBE) + 0.5f;
            leaves = vf_min(leaves, (side - m->eye[i]) * p->inverse[i].part[k]);
        }
        const vi block = vi_gather(field->cube_of, number & meets) | ~meets;
        const vi begun = p->from.part[k] < (step + 1.0f) * m->step;
        const vi over = p->to.part[k] <= (step + 1.0f) * m->step;
        vf next = vf_select(begun, leaves, p->from.part[k]);
        next = vf_select(over, vf_all(1e9f), next);
        skip.part[k] = next;
        vf_store((float *)(void *)(at->block + (ptrdiff_t)k * LANES), (vf)block);
        vf_store((float *)(void *)(at->cell + (ptrdiff_t)k * LANES), (vf)in);
        at->length.part[k] = vf_where(block >= 0, end - begin);
        at->some |= any(block >= 0);
    }
    at->skip = least_of(skip);
}

SIMD struct eight eight_between(struct eight a, struct eight b, float part)
{
    EIGHT_EACH(k)
    a.part[k] += (b.part[k] - a.part[k]) * part;
    return a;
}

/* Interpolates the floats of a cell between eight cells. */
SIMD struct eight sample_block(const float *at, float x, float y, float z)
{
    const float *above = at + VOLUME_PLANE;
#define ALONG(p) eight_between(eight_load(p), eight_load((p) + VOLUME_CELL), x)
    const struct eight low = eight_between(ALONG(at), ALONG(at + VOLUME_ROW), y);
    const struct eight high = eight_between(ALONG(above), ALONG(above + VOLUME_ROW), y);
#undef ALONG
    return eight_between(low, high, z);
}

/* Samples the floats of cells for each ray; zeros where a ray has no block. blocks: of the field.
 * Returns the number of rays that have one. */
SIMD uint32_t sample_floats(const float *blocks, const struct places *at,
                            struct eight values[VOLUME_CELL])
{
    _Alignas(32) float cells[8 * VOLUME_CELL];
    uint32_t count = 0;
    for (ptrdiff_t i = 0; i < 8; i++) {
        struct eight cell = {{{0}}};
        if (at->block[i] >= 0) {
            cell = sample_block(blocks + (size_t)at->block[i] * VOLUME_BLOCK + at->cell[i],
                                at->part[0][i], at->part[1][i], at->part[2][i]);
            count++;
        }
        eight_store(cells + i * VOLUME_CELL, cell);
    }
    eight_columns(cells, values);
    return count;
}

/* Returns whether sampled cells have neither smoke nor flames, so that they change no ray. */
SIMD bool is_clear(const struct eight values[VOLUME_CELL])
{
    vi some = vi_all(0);
    EIGHT_EACH(k)
    some |= (values[VOLUME_SMOKE].part[k] > 0.0f) | (values[VOLUME_FLAME].part[k] > 0.0f);
    return !any(some);
}

/* Holds the floats of a cell that has VOLUME_FOUR of them. */
typedef float four __attribute__((vector_size(4 * VOLUME_FOUR)));

/* Interpolates between the floats of two cells. */
SIMD four four_between(const float *a, const float *b, float part)
{
    four from, to;
    memcpy(&from, a, sizeof from);
    memcpy(&to, b, sizeof to);
    return from + (to - from) * part;
}

/* Samples numbers of cells that have VOLUME_FOUR floats, the first `count` of them; zeros where a
 * ray has no block. fours: of the field. */
SIMD_ONCE void sample_fours(const float *fours, const struct places *at, int count,
                            struct eight *values)
{
    enum { ROW = VOLUME_ROW / VOLUME_CELL * VOLUME_FOUR };
    enum { PLANE = VOLUME_PLANE / VOLUME_CELL * VOLUME_FOUR };
    _Alignas(32) float sampled[VOLUME_FOUR][8];
    for (int i = 0; i < 8; i++) {
        const float x = at->part[0][i], y = at->part[1][i], z = at->part[2][i];
        four value = {0.0f, 0.0f, 0.0f, 0.0f};
        if (at->block[i] >= 0) {
            const ptrdiff_t number = at->cell[i] / VOLUME_CELL;
            const float *cell = fours + (size_t)at->block[i] * VOLUME_FOURS + number * VOLUME_FOUR;
#define ALONG(p) four_between(p, (p) + VOLUME_FOUR, x)
            const four a = ALONG(cell), b = ALONG(cell + ROW);
            const four d = ALONG(cell + PLANE), e = ALONG(cell + PLANE + ROW);
#undef ALONG
            const four low = a + (b - a) * y, high = d + (e - d) * y;
            value = low + (high - low) * z;
        }
        for (int c = 0; c < VOLUME_FOUR; c++)
            sampled[c][i] = value[c];
    }
    for (int c = 0; c < count; c++)
        values[c] = eight_load(sampled[c]);
}

#endif
