/* This file rasterises triangles into the rows of a strip, a vector of pixels at a time, within the
 * bounds of each triangle and in all layers. */
#include "base/lane_math.h"
#include "draw/vector/mesh_rows.h"

struct plane_row {
    float u, rest; /* factor of u; value at u = 0 */
};

static inline struct plane_row cut(const float plane[3], float v)
{
    return (struct plane_row){plane[0], plane[1] * v + plane[2]};
}

static inline void draw_row(const struct kiln_mesh_strip *s,
                            const struct kiln_projected_triangle *t, int32_t number, uint32_t row,
                            uint32_t layer)
{
    const float y = (float)(s->y + row) + s->offsets[layer][1];
    if (y < t->top || y > t->bottom)
        return;
    float v = s->v + y * s->v_step;
    struct plane_row edges[3], nearness = cut(t->nearness, v);
    for (int i = 0; i < 3; i++)
        edges[i] = cut(t->edges[i], v);
    size_t at = (row * s->layers + layer) * s->pitch;
    float *near = s->nearness + at;
    for (int32_t x = t->x.from; x < t->x.to; x += LANES) {
        const vf column = vf_count() + ((float)x + s->offsets[layer][0]);
        vf u = s->u + column * s->u_step;
        vi inside = (column < (float)t->x.to) & (edges[0].u * u + edges[0].rest >= 0.0f) &
                    (edges[1].u * u + edges[1].rest >= 0.0f) &
                    (edges[2].u * u + edges[2].rest >= 0.0f);
        vf here = nearness.u * u + nearness.rest, before = vf_load(near + x);
        inside &= (here > before) & (here <= s->nearness_max);
        if (!any(inside))
            continue;
        vf_store(near + x, vf_select(inside, here, before));
        if (s->triangles) {
            float *numbers = (float *)(void *)(s->triangles + at + x);
            vf seen = vf_load(numbers);
            vf_store(numbers, (vf)vi_select(inside, vi_all(number), (vi)seen));
        }
    }
}

static void draw_triangles(const struct kiln_mesh_strip *strip,
                           const struct kiln_projected_triangle *triangles, const uint32_t *list,
                           size_t count)
{
    const int32_t top = (int32_t)strip->y, bottom = top + (int32_t)strip->rows;
    for (size_t i = 0; i < count; i++) {
        const struct kiln_projected_triangle *t = &triangles[list[i]];
        const struct kiln_row_range rows = kiln_rows_of_triangle(t, (float)bottom);
        for (int32_t y = rows.from > top ? rows.from : top; y < rows.to; y++) {
            for (uint32_t layer = 0; layer < strip->layers; layer++)
                draw_row(strip, t, (int32_t)list[i] + 1, (uint32_t)(y - top), layer);
        }
    }
}

const struct kiln_mesh_rows KILN_SIMD_NAME(kiln_mesh_rows) = {.draw = draw_triangles};
