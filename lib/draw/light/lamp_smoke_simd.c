/* This file fills rows of the maps of smoke around lamps, a vector of directions at a time. It adds
 * up the extinction along each direction, from the lamp outwards. */
#include <assert.h>
#include <string.h>

#include "draw/light/lamp_smoke.h"
#include "draw/light/ray_smoke.h"
#include "shared/exact.h"

static_assert(KILN_LAMP_SMOKE_FACE % LANES == 0, "rows of a face are whole vectors");

/* Returns directions through texels of a face, 0 to 5. aside, above: tangents. */
static struct vf3 face_direction(uint32_t face, vf aside, vf above)
{
    const vf ahead = vf_all(face & 1 ? -1.0f : 1.0f);
    if (face < 2)
        return (struct vf3){ahead, above, aside};
    if (face < 4)
        return (struct vf3){aside, ahead, above};
    return (struct vf3){aside, above, ahead};
}

/* Returns the directions of texels of a row, of length 1, against lamp_smoke_place_of. */
static struct vf3 directions_of(const struct kiln_draw_light *lamp, uint32_t x, uint32_t y)
{
    const float4 ahead = lamp->smoke_ahead, right = lamp->smoke_right;
    if (ahead.w > 0.0f) {
        const float scale = 1.0f / (LAMP_SMOKE_PICTURE_HALF * ahead.w), wide = 1.0f / ahead.w;
        const vf aside = (vf_count() + (float)x) * scale - wide;
        const vf above = vf_all((float)y * scale - wide);
        const struct vf3 up = real3_cross(vf3_all(ahead), vf3_all(right));
        const struct vf3 level = vf3_add_scaled(vf3_all(ahead), vf3_all(right), aside);
        return vf3_normalize(vf3_add_scaled(level, up, above));
    }
    const uint32_t edge = KILN_LAMP_SMOKE_FACE, face = x / edge * 2 + y / edge;
    const float scale = 1.0f / LAMP_SMOKE_FACE_HALF;
    const vf aside = (vf_count() + (float)(x % edge)) * scale - 1.0f;
    const vf above = vf_all((float)(y % edge) * scale - 1.0f);
    return vf3_normalize(face_direction(face, aside, above));
}

/* Returns the extinction at a distance from the lamp, 1/m. */
static vf extinction_at(const struct kiln_lamp_smoke_job *job, struct vf3 direction, float distance)
{
    const float4 *row = job->grid->world_to_grid;
    const struct vf3 place =
        vf3_add_scaled(vf3_all(job->lamp.position_radius2), direction, vf_all(distance));
    const struct vf3 at = smoke_grid_place(row[0], row[1], row[2], place);
    const vi inside =
        (vf_min(vf_min(at.x, at.y), at.z) >= 0.0f) & (vf_max(vf_max(at.x, at.y), at.z) <= 1.0f);
    if (!any(inside))
        return vf_all(0.0f);
    const struct smoke_cells cells = {job->grid->extinction, KILN_SMOKE_COARSE};
    return vf_where(inside, read_grid(&cells, vf_where(inside, at.x), vf_where(inside, at.y),
                                      vf_where(inside, at.z)));
}

/* The ways through the grid take at most 37 steps, from corner to corner. A way of more than these
 * lies between a lamp and the grid, where there is no smoke. */
enum { MOST_STEPS = 256 };

/* Returns the optical depth between two distances from the lamp. */
static vf depth_between(const struct kiln_lamp_smoke_job *job, struct vf3 direction, float from,
                        float to)
{
    if (to - from > (float)MOST_STEPS * job->step)
        return vf_all(0.0f);
    const int steps = 1 + exact_int((to - from) / job->step);
    const float step = (to - from) / (float)steps;
    vf sum = vf_all(0.0f);
    for (int i = 0; i < steps; i++)
        sum += extinction_at(job, direction, from + ((float)i + 0.5f) * step);
    return sum * step;
}

/* Clears the texels beside a picture. The one next to it is read with weight 0, and must be a
 * number. */
static void clear_beside(float *line, uint32_t width)
{
    for (size_t layer = 0; layer < KILN_LAMP_SMOKE_LAYERS; layer++)
        memset(line + layer * KILN_LAMP_SMOKE_LAYER + width, 0,
               (KILN_LAMP_SMOKE_WIDTH - width) * sizeof *line);
}

static void fill(const struct kiln_lamp_smoke_job *job, uint32_t row)
{
    const bool far = job->lamp.smoke_ahead.w > 0.0f;
    const uint32_t width = far ? KILN_LAMP_SMOKE_HEIGHT : KILN_LAMP_SMOKE_WIDTH;
    float *line = job->map + row * (size_t)KILN_LAMP_SMOKE_WIDTH;
    for (uint32_t x = 0; x < width; x += LANES) {
        const struct vf3 direction = directions_of(&job->lamp, x, row);
        vf depth = vf_all(0.0f);
        float from = job->lamp.color.w, to = job->lamp.maps.y;
        for (size_t layer = 0; layer < KILN_LAMP_SMOKE_LAYERS; layer++) {
            memcpy(line + layer * KILN_LAMP_SMOKE_LAYER + x, &depth, sizeof depth);
            depth += depth_between(job, direction, from, to);
            from = to;
            to *= job->factor;
        }
    }
    clear_beside(line, width);
}

void KILN_SIMD_NAME(kiln_lamp_smoke_fill)(const struct kiln_lamp_smoke_job *job, uint32_t row)
{
    fill(job, row);
}
