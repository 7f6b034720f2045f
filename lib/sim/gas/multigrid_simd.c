/* Relaxes, restricts and prolongs levels of the pressure's multigrid, row by row. Rows beside
 * solids weigh the cells around by the open parts of faces. */
#include "sim/gas/gas_lanes.h"
#include "sim/gas/multigrid.h"

enum { MOST_HALF = 4096 + KILN_GAS_PAD };

static ptrdiff_t row_at(const struct gas_level *level, int32_t y, int32_t z)
{
    return z * level->plane + y * level->row;
}

/* Returns the place of a row's diagonals in their table. */
static ptrdiff_t kind_of(const struct gas_level *level, int32_t y, int32_t z)
{
    const int32_t a = y == 0 ? 0 : y == level->cells.y - 1 ? 2 : 1;
    const int32_t b = z == 0 ? 0 : z == level->cells.z - 1 ? 2 : 1;
    return (3 * b + a) * level->row;
}

/* Returns the sum of p around the cells of one half of a row. odd: 1 for the cells of odd x. */
SIMD vf around(const struct gas_level *level, const float *p, int odd, ptrdiff_t i)
{
    const float *own = p + odd * level->odd + i, *other = p + (1 - odd) * level->odd + i;
    const ptrdiff_t row = level->row, plane = level->plane;
    return gas_around(vf_load(other + odd - 1), vf_load(other + odd), vf_load(own - row),
                      vf_load(own + row), vf_load(own - plane), vf_load(own + plane));
}

static bool is_walled(const struct gas_level *level, int32_t y, int32_t z)
{
    return level->walled && level->walled[z * level->cells.y + y];
}

/* Holds what a cell beside solids has around it: the sum of p by the open parts of its faces, and
 * the sum of these parts. */
struct weighed {
    vf sum, open;
};

/* at: place of the row. Lanes from `count` on are beyond the row; nothing is open there. */
SIMD struct weighed weigh(const struct gas_level *level, ptrdiff_t at, int odd, int32_t i,
                          int32_t count)
{
    const ptrdiff_t row = level->row, plane = level->plane;
    const ptrdiff_t own = at + odd * level->odd + i, other = at + (1 - odd) * level->odd + i;
    const float *p = level->p;
    const vf within = (vf)(vf_count() + (float)i < (float)count);
    vf open[6] = {vf_load(level->open[0] + own), vf_load(level->open[0] + other + odd),
                  vf_load(level->open[1] + own), vf_load(level->open[1] + own + row),
                  vf_load(level->open[2] + own), vf_load(level->open[2] + own + plane)};
    for (int k = 0; k < 6; k++)
        open[k] = vf_where((vi)within, open[k]);
    return (struct weighed){
        gas_around(open[0] * vf_load(p + other + odd - 1), open[1] * vf_load(p + other + odd),
                   open[2] * vf_load(p + own - row), open[3] * vf_load(p + own + row),
                   open[4] * vf_load(p + own - plane), open[5] * vf_load(p + own + plane)),
        gas_around(open[0], open[1], open[2], open[3], open[4], open[5])};
}

/* Relaxes a row beside solids. fresh: p is zero everywhere, whatever it holds. */
static void relax_walled(const struct gas_level *level, ptrdiff_t at, int odd, int32_t count,
                         bool fresh)
{
    const ptrdiff_t own = at + odd * level->odd;
    for (int32_t i = 0; i < count; i += LANES) {
        const struct weighed around = weigh(level, at, odd, i, count);
        const vf sum = fresh ? vf_all(0.0f) : around.sum;
        const vf inverse = vf_rcp_within(vf_max(around.open, vf_all(1e-6f)));
        const vf p = (sum - vf_load(level->f + own + i)) * inverse;
        vf_store(level->p + own + i, vf_where(around.open > 0.0f, p));
    }
}

static void relax(const struct gas_level *level, int color, int32_t begin, int32_t end)
{
    const int32_t half = level->cells.x / 2;
    for (int32_t z = begin; z < end; z++)
        for (int32_t y = 0; y < level->cells.y; y++) {
            const int odd = (color + y + z) & 1;
            const ptrdiff_t at = row_at(level, y, z);
            const int32_t count = odd ? half : level->cells.x - half;
            const float *inverse = level->inverse + kind_of(level, y, z) + odd * level->odd;
            float *p = level->p + at, *own = p + odd * level->odd;
            const float *f = level->f + at + odd * level->odd;
            if (is_walled(level, y, z)) {
                relax_walled(level, at, odd, count, false);
                continue;
            }
            for (int32_t i = 0; i < count; i += LANES)
                vf_store(own + i,
                         (around(level, p, odd, i) - vf_load(f + i)) * vf_load(inverse + i));
        }
}

static void begin_zero(const struct gas_level *level, int32_t begin, int32_t end)
{
    const int32_t half = level->cells.x / 2;
    for (int32_t z = begin; z < end; z++)
        for (int32_t y = 0; y < level->cells.y; y++) {
            const int odd = (y + z) & 1;
            const ptrdiff_t at = row_at(level, y, z) + odd * level->odd;
            const int32_t count = odd ? half : level->cells.x - half;
            const float *inverse = level->inverse + kind_of(level, y, z) + odd * level->odd;
            if (is_walled(level, y, z)) {
                relax_walled(level, row_at(level, y, z), odd, count, true);
                continue;
            }
            for (int32_t i = 0; i < count; i += LANES)
                vf_store(level->p + at + i,
                         (0.0f - vf_load(level->f + at + i)) * vf_load(inverse + i));
        }
}

SIMD vf residual_of(const struct gas_level *level, int32_t y, int32_t z, int odd, int32_t i)
{
    const ptrdiff_t at = row_at(level, y, z), own = at + odd * level->odd + i;
    if (is_walled(level, y, z)) {
        const int32_t half = level->cells.x / 2;
        const struct weighed w = weigh(level, at, odd, i, odd ? half : level->cells.x - half);
        return vf_load(level->f + own) - (w.sum - w.open * vf_load(level->p + own));
    }
    const vf d = vf_load(level->diagonal + kind_of(level, y, z) + odd * level->odd + i);
    const vf sum = around(level, level->p + at, odd, i);
    return vf_load(level->f + own) - (sum - d * vf_load(level->p + own));
}

/* Stores numbers of neighbouring cells of a row, of which the first has an even x. */
SIMD void store_apart(float *even, float *odd, const float *row)
{
#if LANES == 8
    const __m256 a = _mm256_loadu_ps(row), b = _mm256_loadu_ps(row + 8);
    const __m256 e = _mm256_shuffle_ps(a, b, 0x88), o = _mm256_shuffle_ps(a, b, 0xdd);
    vf_store(even, (vf)_mm256_permute4x64_pd((__m256d)e, 0xd8));
    vf_store(odd, (vf)_mm256_permute4x64_pd((__m256d)o, 0xd8));
#else
    const vf a = vf_load(row), b = vf_load(row + 4);
    vf_store(even, __builtin_shufflevector(a, b, 0, 2, 4, 6));
    vf_store(odd, __builtin_shufflevector(a, b, 1, 3, 5, 7));
#endif
}

static void restrict_to(const struct gas_level *fine, const struct gas_level *coarse, int32_t begin,
                        int32_t end)
{
    const int32_t count = coarse->cells.x;
    float row[MOST_HALF];
    for (int32_t z = begin; z < end; z++)
        for (int32_t y = 0; y < coarse->cells.y; y++) {
            for (int32_t i = 0; i < count; i += LANES) {
                const vf sum = (residual_of(fine, 2 * y, 2 * z, 0, i) +
                                residual_of(fine, 2 * y + 1, 2 * z, 1, i)) +
                               (residual_of(fine, 2 * y, 2 * z + 1, 1, i) +
                                residual_of(fine, 2 * y + 1, 2 * z + 1, 0, i));
                vf_store(row + i, 0.5f * sum);
            }
            float *f = coarse->f + row_at(coarse, y, z);
            for (int32_t i = 0; i < count; i += 2 * LANES) {
                if (count - i < 2 * LANES) { /* what lies beyond the row stays zero */
                    for (int32_t k = i; k < count; k++)
                        f[(k & 1) * coarse->odd + k / 2] = row[k];
                    break;
                }
                store_apart(f + i / 2, f + coarse->odd + i / 2, row + i);
            }
        }
}

/* Puts the cells of a row of even and odd x in turn. */
SIMD void store_joined(float *row, vf even, vf odd)
{
#if LANES == 8
    const __m256 low = _mm256_unpacklo_ps((__m256)even, (__m256)odd);
    const __m256 high = _mm256_unpackhi_ps((__m256)even, (__m256)odd);
    _mm256_storeu_ps(row, _mm256_permute2f128_ps(low, high, 0x20));
    _mm256_storeu_ps(row + 8, _mm256_permute2f128_ps(low, high, 0x31));
#else
    vf_store(row, __builtin_shufflevector(even, odd, 0, 4, 1, 5));
    vf_store(row + 4, __builtin_shufflevector(even, odd, 2, 6, 3, 7));
#endif
}

/* Says which row of the coarser level is the second nearest to a row of the finer one, and the sign
 * of its p: beyond an open side p goes on with the opposite sign, beyond a closed one with the
 * same. */
struct second {
    ptrdiff_t to;
    float sign;
};

static struct second second_of(int32_t fine, int32_t count, ptrdiff_t stride, bool closed_below,
                               bool closed_above)
{
    const int32_t coarse = fine / 2;
    if (fine & 1)
        return coarse + 1 < count ? (struct second){stride, 1.0f}
                                  : (struct second){0, closed_above ? 1.0f : -1.0f};
    return coarse > 0 ? (struct second){-stride, 1.0f}
                      : (struct second){0, closed_below ? 1.0f : -1.0f};
}

static void prolong(const struct gas_level *coarse, const struct gas_level *fine, int color,
                    int32_t begin, int32_t end)
{
    const bool *closed = fine->closed;
    const int32_t count = coarse->cells.x;
    float joined[MOST_HALF + KILN_GAS_PAD], *row = joined + KILN_GAS_PAD;
    for (int32_t z = begin; z < end; z++)
        for (int32_t y = 0; y < fine->cells.y; y++) {
            const struct second sy =
                second_of(y, coarse->cells.y, coarse->row, closed[2], closed[3]);
            const struct second sz =
                second_of(z, coarse->cells.z, coarse->plane, closed[4], closed[5]);
            const float *p = coarse->p + row_at(coarse, y / 2, z / 2);
            const float by_y = 0.1875f * sy.sign, by_z = 0.1875f * sz.sign;
            const float by_both = 0.0625f * (sy.sign * sz.sign);
            for (ptrdiff_t i = 0; 2 * i < count; i += LANES) {
                vf half[2];
                for (int k = 0; k < 2; k++) {
                    const float *q = p + k * coarse->odd + i;
                    half[k] = (0.5625f * vf_load(q) +
                               (by_y * vf_load(q + sy.to) + by_z * vf_load(q + sz.to))) +
                              by_both * vf_load(q + sy.to + sz.to);
                }
                store_joined(row + 2 * i, half[0], half[1]);
            }
            row[-1] = closed[0] ? row[0] : -row[0];
            row[count] = closed[1] ? row[count - 1] : -row[count - 1];
            const int odd = (color + y + z) & 1;
            float *to = fine->p + row_at(fine, y, z) + odd * fine->odd;
            const float *side = row + (odd ? 1 : -1);
            int32_t i = 0;
            for (; i + LANES <= count; i += LANES)
                vf_store(to + i,
                         vf_load(to + i) + (0.75f * vf_load(row + i) + 0.25f * vf_load(side + i)));
            for (; i < count; i++)
                to[i] = to[i] + (0.75f * row[i] + 0.25f * side[i]);
        }
}

static double square(const struct gas_level *level, bool residual, int32_t plane)
{
    double sum = 0.0;
    for (int32_t y = 0; y < level->cells.y; y++)
        for (int odd = 0; odd < 2; odd++)
            for (int32_t i = 0; i < level->cells.x / 2; i += LANES) {
                const ptrdiff_t at = row_at(level, y, plane) + odd * level->odd + i;
                const vf x =
                    residual ? residual_of(level, y, plane, odd, i) : vf_load(level->f + at);
                for (int k = 0; k < LANES && i + k < level->cells.x / 2; k++)
                    sum += (double)x[k] * (double)x[k];
            }
    return sum;
}

const struct gas_multigrid KILN_SIMD_NAME(kiln_gas_multigrid) = {
    .relax = relax,
    .begin = begin_zero,
    .restrict_to = restrict_to,
    .prolong = prolong,
    .square = square,
};
