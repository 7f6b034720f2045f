/* Applies the vectors of lib/draw to arrays of operands, a vector after the other. */
#include "unit/vector_simd.h"

#include "base/lane_math.h"
#include "draw/sprites/texels.h"

static vi load(const void *from, int i)
{
    vi x;
    memcpy(&x, (const char *)from + 4 * (size_t)i, sizeof x);
    return x;
}

static void store(void *to, int i, vi x)
{
    memcpy((char *)to + 4 * (size_t)i, &x, sizeof x);
}

static void compute_numbers(const struct vector_operands *o, struct vector_results *r, int i)
{
    vf a = vf_load(o->a + i), b = vf_load(o->b + i);
    vi mask = load(o->masks, i);
    vf_store(r->min + i, vf_min(a, b));
    vf_store(r->max + i, vf_max(a, b));
    vf_store(r->root + i, vf_sqrt(a));
    vf_store(r->floor + i, round_down(a));
    const vi places = load(o->places, i) & (VECTOR_COUNT - 1);
    vf_store(r->gathered + i, vf_gather(o->a, places));
    const struct vi_pair pair =
        vi_gather_pair((const int32_t *)o->ways, places & (VECTOR_COUNT / 2 - 1));
    store(r->neighbours[0], i, pair.first);
    store(r->neighbours[1], i, pair.second);
    store(r->integer, i, vi_of(a));
    uint32_t bits = vi_bits(mask);
    for (int k = 0; k < LANES; k++) {
        r->bit[i + k] = bits >> k & 1;
        r->any[i + k] = any(mask);
    }
}

static void compute_texels(const struct vector_operands *o, struct vector_results *r, int i)
{
    vi places = load(o->places, i), inside = load(o->inside, i);
    store(r->placed, i, places_of(vf_load(o->u + i), vf_load(o->v + i)));
    store(r->clamped, i, places_clamped(places, o->least, o->most));
    store(r->between, i, places_between(places, o->least, o->most));
    store(r->moved, i, places_moved(places, load(o->ways, i), o->move, o->least, o->most));

    int32_t at[LANES];
    vi offsets = texel_offsets(inside, VECTOR_EDGE * VECTOR_QUAD, VECTOR_QUAD);
    store(r->offsets, i, offsets);
    memcpy(at, &offsets, sizeof at);
    struct vf4 four = channels_of(sample_quads(o->quads, at, inside, o->part));
    offsets = texel_offsets(inside, VECTOR_EDGE * VECTOR_PAIR, VECTOR_PAIR);
    memcpy(at, &offsets, sizeof at);
    struct vf4 two = channels_of_pairs(sample_pairs(o->pairs, at, inside, o->part));
    for (int c = 0; c < 4; c++)
        vf_store(r->four[c] + i, four.c[c]);
    for (int c = 0; c < 2; c++)
        vf_store(r->two[c] + i, two.c[2 + c]);
    store(r->sampled_ways, i, ways_of(sample_pairs(o->pairs, at, inside, 1)));
    offsets = texel_offsets(inside, VECTOR_EDGE * VECTOR_ALPHA, VECTOR_ALPHA);
    memcpy(at, &offsets, sizeof at);
    store(r->alpha, i, sample_alphas(o->alphas, at, inside, o->part));
}

static void compute(const struct vector_operands *operands, struct vector_results *results)
{
    for (int i = 0; i < VECTOR_COUNT; i += LANES) {
        compute_numbers(operands, results, i);
        compute_texels(operands, results, i);
    }
}

const struct vector_level KILN_SIMD_NAME(vector_level) = {.lanes = LANES, .compute = compute};
