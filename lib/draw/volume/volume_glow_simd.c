/* This file relaxes planes of cells for volume_glow.c. Rows are followed by zeros, where the
 * inverse of the diagonal is zero, too, so whole vectors leave them zero. */
#include "base/lane_math.h"
#include "draw/volume/volume_glow.h"

/* How far an iterate goes: the value that damps short waves best in three dimensions. */
#define DAMPING (6.0f / 7.0f)

/* Returns the sum of the light of the six neighbours, and of what is emitted. */
SIMD vf arriving(const struct kiln_glow_level *l, ptrdiff_t at)
{
    const float *light = l->light + at;
    const vf along = vf_load(light - 1) + vf_load(light + 1);
    const vf across = vf_load(light - l->row) + vf_load(light + l->row);
    const vf beyond = vf_load(light - l->plane) + vf_load(light + l->plane);
    return along + across + (beyond + vf_load(l->source + at));
}

static void relax(const struct kiln_glow_level *l, int32_t begin, int32_t end)
{
    for (int32_t z = begin; z < end; z++)
        for (int32_t y = 0; y < l->cells.y; y++)
            for (int32_t x = 0; x < l->cells.x; x += LANES) {
                const ptrdiff_t at = z * l->plane + y * l->row + x;
                const vf solved = arriving(l, at) * vf_load(l->inverse + at);
                const vf light = vf_load(l->light + at);
                vf_store(l->next + at, light + DAMPING * (solved - light));
            }
}

static void find_residual(const struct kiln_glow_level *l, int32_t begin, int32_t end)
{
    for (int32_t z = begin; z < end; z++)
        for (int32_t y = 0; y < l->cells.y; y++)
            for (int32_t x = 0; x < l->cells.x; x += LANES) {
                const ptrdiff_t at = z * l->plane + y * l->row + x;
                const vf kept = vf_load(l->diagonal + at) * vf_load(l->light + at);
                const vi inside = vf_load(l->inverse + at) > 0.0f;
                vf_store(l->next + at, vf_where(inside, arriving(l, at) - kept));
            }
}

const struct kiln_volume_glow_rows KILN_SIMD_NAME(kiln_volume_glow_rows) = {
    .relax = relax, .find_residual = find_residual};
