/* This file rasterises triangles into the rows of a strip, a vector of pixels at a time, within the
 * bounds of each triangle and in all layers. */
#include "base/lane_math.h"
#include "draw/vector/mesh_rows.h"
#include "shared/exact.h"

/* Returns what a plane has in a row, without its part that changes with u. */
static inline float rest_of(const float plane[3], float v)
{
    return plane[1] * v + plane[2];
}

/* Holds what a triangle's planes have in a vector of columns in every row: factor of u times u. */
struct across {
    vf edges[3], nearness;
    vi within; /* mask: columns that the triangle may touch */
};

static inline struct across across_columns(const struct kiln_mesh_strip *s,
                                           const struct kiln_projected_triangle *t, int32_t x,
                                           uint32_t layer)
{
    const vf column = vf_count() + ((float)x + s->offsets[layer][0]);
    const vf u = s->u + column * s->u_step;
    return (struct across){
        .edges = {t->edges[0][0] * u, t->edges[1][0] * u, t->edges[2][0] * u},
        .nearness = t->nearness[0] * u,
        .within = column < (float)t->x.to,
    };
}

/* Draws a vector of pixels of a triangle. Half of the vectors have none of its pixels; storing them
 * all the same costs less than a branch that is often foreseen wrongly. at: the first pixel in the
 * strip's arrays; number: of the triangle, plus 1. */
static inline void draw_pixels(const struct kiln_mesh_strip *s,
                               const struct kiln_projected_triangle *t, const struct across *across,
                               float v, size_t at, int32_t number)
{
    float *near = s->nearness + at;
    vi inside = across->within;
    for (int i = 0; i < 3; i++)
        inside &= across->edges[i] + rest_of(t->edges[i], v) >= 0.0f;
    const vf here = across->nearness + rest_of(t->nearness, v), before = vf_load(near);
    inside &= (here > before) & (here <= s->nearness_max);
    vf_store(near, vf_select(inside, here, before));
    if (s->triangles) {
        float *numbers = (float *)(void *)(s->triangles + at);
        const vf seen = vf_load(numbers);
        vf_store(numbers, (vf)vi_select(inside, vi_all(number), (vi)seen));
    }
}

/* Draws a triangle in a layer, column by column of vectors, since most triangles are narrower than
 * a vector. */
static inline void draw_layer(const struct kiln_mesh_strip *s,
                              const struct kiln_projected_triangle *t, uint32_t layer,
                              int32_t number)
{
    /* from the first row whose samples are below the triangle's top to the last above its bottom */
    const float down = s->offsets[layer][1], end = (float)(s->y + s->rows);
    const int32_t from = exact_int(exact_clamp(t->top - down + 1.0f, (float)s->y, end));
    const int32_t to = exact_int(exact_clamp(t->bottom - down + 1.0f, (float)s->y, end));
    for (int32_t x = t->x.from; x < t->x.to; x += LANES) {
        const struct across across = across_columns(s, t, x, layer);
        for (int32_t y = from; y < to; y++) {
            const size_t line = ((size_t)y - s->y) * s->layers + layer;
            draw_pixels(s, t, &across, s->v + ((float)y + down) * s->v_step,
                        line * s->pitch + (size_t)x, number);
        }
    }
}

static void draw_triangles(const struct kiln_mesh_strip *strip,
                           const struct kiln_projected_triangle *triangles, const uint32_t *list,
                           size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint32_t number = list[i];
        for (uint32_t layer = 0; layer < strip->layers; layer++)
            draw_layer(strip, &triangles[number], layer, (int32_t)number + 1);
    }
}

const struct kiln_mesh_rows KILN_SIMD_NAME(kiln_mesh_rows) = {.draw = draw_triangles};
