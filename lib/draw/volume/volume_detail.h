/* This header draws gas finer than it is simulated, by noise that moves with the gas. The noise
 * changes the amount of gas, which gives wide veils structure. It also tears edges: the solver
 * spreads those of smoke and flames over some cells; they are drawn steeper, where the gas has
 * become as thick as some cells (VOLUME_SMOKE_THICKNESS), sooner or later by the noise. Thickness
 * is the amount of gas by its slope, so thin smoke has such edges as dense smoke has. */
#ifndef KILN_DRAW_VOLUME_VOLUME_DETAIL_H
#define KILN_DRAW_VOLUME_VOLUME_DETAIL_H

#include "draw/volume/volume_noise.h"
#include "draw/volume/volume_sample.h"
#include "shared/gas_detail.h"

/* Holds what the gas of a step is drawn finer by, of each ray. */
struct finer {
    struct eight ways[VOLUME_CELL], edges[VOLUME_FOUR];
};

/* Returns noise at the places where the gas of lanes came from, by the ways of a group. */
SIMD vf noise_of_group(const struct kiln_volume_march *m, const struct places *at,
                       const struct finer *finer, int lanes, uint32_t group)
{
    const struct kiln_gas *gas = m->field->gas;
    const float corner[3] = {(float)gas->at.x, (float)gas->at.y, (float)gas->at.z};
    struct vf3 place;
    vf *const axes[3] = {&place.x, &place.y, &place.z};
    for (uint32_t i = 0; i < 3; i++) {
        const vf way = finer->ways[4 * group + i].part[lanes] * (1.0f / gas->shape.cell);
        *axes[i] = (at->at[i].part[lanes] + corner[i] + way) * (1.0f / GAS_NOISE_CELL) +
                   (group == 0 ? 0.0f : GAS_NOISE_APART);
    }
    float size = 1.0f;
    vf sum = vf_all(0.0f);
    for (uint32_t octave = 0; octave < m->octaves; octave++) {
        sum += size * noise_at(place);
        size *= GAS_OCTAVE;
        place = vf3_scale(place, vf_all(2.0f));
    }
    return sum;
}

/* Returns the part of gas of a thickness that is drawn. edge: the thickness of which half is. */
SIMD vf part_at_edge(vf thickness, float edge)
{
    const vf way = (thickness - edge) * (1.0f / GAS_EDGE_WIDTH) + 0.5f;
    const vf t = vf_clamp(way, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/* Holds noise, and its mean square. */
struct noise {
    vf value, variance;
};

/* Returns the noise of gas by both groups of ways. Where one of them is sheared, so that its noise
 * would be hair, the other one takes its part as far as it can. */
SIMD struct noise noise_of(const struct kiln_volume_march *m, const struct places *at,
                           const struct finer *finer, int lanes)
{
    const vf one = vf_all(1.0f), zero = vf_all(0.0f);
    const vf first = m->weights[0] * finer->edges[VOLUME_CALM].part[lanes];
    const vf second = m->weights[1] * finer->edges[VOLUME_CALM + 1].part[lanes];
    const vf squares = first * first + second * second;
    const vf scale = one / vf_sqrt(vf_max(squares, vf_all(0.25f)));
    struct noise noise = {zero,
                          squares * scale * scale * (m->octaves > 1 ? GAS_TWO_OCTAVES : 1.0f)};
    if (any(first > 0.0f))
        noise.value += first * scale * noise_of_group(m, at, finer, lanes, 0);
    if (any(second > 0.0f))
        noise.value += second * scale * noise_of_group(m, at, finer, lanes, 1);
    return noise;
}

/* Finds the factors on the smoke and the flames of a step. Those by which noise changes the amount
 * of gas are the exponential of noise of a known variance, so that the mean amount stays. */
SIMD_ONCE void find_detail(const struct kiln_volume_march *m, const struct places *at,
                           struct eight *smoke, struct eight *flame)
{
    struct finer finer;
    sample_floats(m->field->ways, at, finer.ways);
    sample_fours(m->field->edges, at, VOLUME_FOUR, finer.edges);
    EIGHT_EACH(k)
    {
        const struct noise noise = noise_of(m, at, &finer, (int)k);
        const vf value = GAS_DETAIL * noise.value,
                 variance = GAS_DETAIL * GAS_DETAIL * noise.variance;
        const vf thick_smoke =
            finer.edges[VOLUME_SMOKE_THICKNESS].part[k] + GAS_SMOKE_TORN * noise.value;
        const vf thick_flame =
            finer.edges[VOLUME_FLAME_THICKNESS].part[k] + GAS_FLAME_TORN * noise.value;
        smoke->part[k] =
            vf_exp(value - 0.5f * variance) * part_at_edge(thick_smoke, GAS_SMOKE_EDGE);
        flame->part[k] =
            vf_exp(0.5f * value - 0.125f * variance) * part_at_edge(thick_flame, GAS_FLAME_EDGE);
    }
}

/* Finds the rays that a step changes enough for its noise to be seen. Returns whether there is one.
 */
SIMD bool find_seen(const struct kiln_volume_march *m, const struct packet *p,
                    const struct places *at, const struct eight values[VOLUME_CELL],
                    vi seen[EIGHT_PARTS])
{
    vi some = vi_all(0);
    EIGHT_EACH(k)
    {
        const vf gas = values[VOLUME_SMOKE].part[k] * m->extinction +
                       values[VOLUME_FLAME].part[k] * (m->absorption + m->intensity);
        seen[k] = p->clear.part[k] * at->length.part[k] * m->cell_m * gas > GAS_DETAIL_SEEN;
        some |= seen[k];
    }
    return any(some);
}

/* Changes sampled gas by noise, and makes its edges steeper. tints: NULL without colours. */
SIMD void add_detail(const struct kiln_volume_march *m, const struct packet *p,
                     const struct places *at, struct eight values[VOLUME_CELL], struct eight *tints)
{
    struct eight smoke, flame;
    vi seen[EIGHT_PARTS];
    if (!find_seen(m, p, at, values, seen))
        return;
    find_detail(m, at, &smoke, &flame);
    EIGHT_EACH(k)
    {
        const vf part = vf_select(seen[k], smoke.part[k], vf_all(1.0f));
        values[VOLUME_SMOKE].part[k] *= part;
        values[VOLUME_FLAME].part[k] *= vf_select(seen[k], flame.part[k], vf_all(1.0f));
        for (int i = 0; i < 3 && tints; i++)
            tints[i].part[k] *= part;
    }
}

#endif
