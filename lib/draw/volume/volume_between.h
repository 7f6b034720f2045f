/* This header finds what pixels between rays see, when every second pixel has a ray. It is the
 * cubic through four rays in a row. Where the cubic is far from the straight line between the
 * middle two, the gas changes within few pixels, as at the border of a flame; where the scene is
 * not as deep at the pixel as at its neighbours, it may be before other gas. There the pixel needs
 * a ray of its own. */
#ifndef KILN_DRAW_VOLUME_VOLUME_BETWEEN_H
#define KILN_DRAW_VOLUME_VOLUME_BETWEEN_H

#include "draw/volume/volume_packet.h"

/* How far the light of a pixel may be off: a part of it, and light or opacity. */
#define BETWEEN_LIGHT (1.0f / 64.0f)
#define BETWEEN_LEAST (1.0f / 512.0f)

/* How much more a slope may change from ray to ray. Where it changes by 1 at one place between two
 * rays, the pixel there is off by 1/4. */
#define BETWEEN_BENDS 4.0f

/* How far the scene may be from where it is by its neighbours, cells. */
#define BETWEEN_CELLS 0.1f

/* Cells that are narrower have smaller details than rays of every second pixel meet, px. */
#define BETWEEN_WIDTH 2.5f

/* Returns whether cells at a depth are wide enough in the picture. */
SIMD bool cells_are_wide(const struct kiln_volume_march *m, float depth_m)
{
    const float pixel = m->pixel_x > m->pixel_y ? m->pixel_x : m->pixel_y; /* m, a metre away */
    return m->cell_m >= BETWEEN_WIDTH * pixel * depth_m;
}

/* Holds what rays on both sides of a pixel say of it: the cubic through them, and the greater of
 * the changes of the slope at the two nearest rays. */
struct between {
    struct eight cubic, bend;
};

/* Returns the rays between the middle two of four in a row. Columns and rows are those of the grid;
 * the picture's border repeats. */
SIMD struct between between_rays(const struct kiln_volume_march *m, int32_t x, int32_t y,
                                 int32_t across, int32_t down)
{
    const int32_t right = (int32_t)m->grid_across - 1, bottom = (int32_t)m->grid_down - 1;
    struct eight ray[4];
    struct between b;
    for (int32_t i = 0; i < 4; i++) {
        int32_t column = x + (i - 1) * across, row = y + (i - 1) * down;
        column = column < 0 ? 0 : column > right ? right : column;
        row = row < 0 ? 0 : row > bottom ? bottom : row;
        ray[i] = eight_load(kiln_volume_grid_ray(m, (uint32_t)column, (uint32_t)row));
    }
    EIGHT_EACH(k)
    {
        const vf a = ray[0].part[k], p = ray[1].part[k], q = ray[2].part[k], z = ray[3].part[k];
        b.cubic.part[k] = 0.5625f * (p + q) - 0.0625f * (a + z);
        b.bend.part[k] = vf_max(vf_abs(a - 2.0f * p + q), vf_abs(p - 2.0f * q + z));
    }
    return b;
}

/* Returns whether the light of a pixel bends little enough. */
SIMD bool is_even(const struct between *b)
{
    vi uneven = vi_all(0);
    EIGHT_EACH(k)
    uneven |= b->bend.part[k] >
              BETWEEN_BENDS * (BETWEEN_LIGHT * vf_abs(b->cubic.part[k]) + BETWEEN_LEAST);
    return !any(uneven);
}

/* Finds what a pixel sees that is not on the grid. Returns false if it needs a ray of its own. */
SIMD_ONCE bool find_between(const struct kiln_volume_march *m, uint32_t x, uint32_t y,
                            float ray[VOLUME_RAY])
{
    const int32_t column = (int32_t)(x / 2), row = (int32_t)(y / 2);
    const int32_t odd_x = (int32_t)(x % 2), odd_y = (int32_t)(y % 2);
    if ((odd_x && x + 1 >= m->width) || (odd_y && y + 1 >= m->height))
        return false;
    struct between b = between_rays(m, column, row, odd_x, odd_y);
    bool even = is_even(&b);
    if (odd_x && odd_y) { /* in the middle of four rays: both diagonals */
        const struct between other = between_rays(m, column, row + 1, 1, -1);
        even = even && is_even(&other);
        EIGHT_EACH(k)
        {
            b.cubic.part[k] = 0.5f * (b.cubic.part[k] + other.cubic.part[k]);
            b.bend.part[k] = vf_max(b.bend.part[k], other.bend.part[k]);
        }
    }
    float bend[VOLUME_RAY];
    eight_store(ray, b.cubic);
    eight_store(bend, b.bend);
    const float end = kiln_volume_ray_end(m, (size_t)y * m->width + x);
    const float most = BETWEEN_CELLS * m->cell_m * end * end;
    even = even && bend[VOLUME_RAY_END] <= BETWEEN_BENDS * most &&
           fabsf(ray[VOLUME_RAY_END] - end) <= most;
    ray[VOLUME_RAY_END] = 0.0f;
    for (int i = 0; i < VOLUME_RAY_END; i++)
        ray[i] = ray[i] < 0.0f ? 0.0f : ray[i];
    ray[VOLUME_RAY_ALPHA] = ray[VOLUME_RAY_ALPHA] > 1.0f ? 1.0f : ray[VOLUME_RAY_ALPHA];
    return even;
}

#endif
