/* lib/base/lanes.h, lane_math.h and lib/draw/sprites/texels.h: at every level of vectors each
 * operation has the bits that plain C has here, at the edges too: NaN, infinities, zeros with
 * signs, and floats that no integer holds. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shared/random.h"
#include "support/cmocka.h"
#include "unit/vector_simd.h"

static const float edges[] = {
    0.0f,          -0.0f,    1.0f,     -1.0f,           0.5f,        -0.5f,       254.99998f,
    255.0f,        65535.0f, 65536.0f, 8388607.5f,      -8388607.5f, 16711425.0f, 16711680.0f,
    2147483520.0f, 0x1p31f,  -0x1p31f, -0x1.000002p31f, 4e9f,        1e-45f,      -1e-45f,
    0x1p-126f,     3e38f,    -3e38f,   INFINITY,        -INFINITY,   NAN,         -NAN,
};
enum { EDGES = sizeof edges / sizeof *edges };

/* Every pair of edges, then random numbers of all sizes. */
static void fill(struct vector_operands *o)
{
    uint32_t stream = 1;
    for (int i = 0; i < VECTOR_COUNT; i++) {
        uint32_t bits[6];
        for (int k = 0; k < 6; k++)
            bits[k] = random_mix(stream++);
        memcpy(&o->a[i], &bits[0], sizeof(float));
        memcpy(&o->b[i], &bits[1], sizeof(float));
        if (i < EDGES * EDGES) {
            o->a[i] = edges[i / EDGES];
            o->b[i] = edges[i % EDGES];
        }
        o->masks[i] = i / 64 % 2 ? 0u - (bits[2] & 1) : 0u;
        o->u[i] = i % 4 == 0 ? o->a[i] : (float)(bits[2] >> 8);
        o->v[i] = i % 5 == 0 ? o->b[i] : (float)(bits[3] >> 14);
        o->places[i] = bits[4];
        o->ways[i] = bits[5];
        uint32_t u = bits[2] % ((VECTOR_EDGE - 1) * 256), v = bits[3] % ((VECTOR_EDGE - 1) * 256);
        o->inside[i] = v << 16 | u;
    }
    for (size_t i = 0; i < sizeof o->quads; i++)
        o->quads[i] = (uint8_t)random_mix(stream++);
    for (size_t i = 0; i < sizeof o->pairs; i++)
        o->pairs[i] = (uint8_t)random_mix(stream++);
    memset(o->quads, 0x80, sizeof o->quads / 4); /* the farthest from zero */
    memset(o->pairs, 0x80, sizeof o->pairs / 4);
    memcpy(o->alphas, o->pairs, sizeof o->alphas);
}

static uint32_t limited(double x, uint32_t least, uint32_t most)
{
    return x > most ? most : x >= least ? (uint32_t)x : least;
}

/* From 255ths of texels to 256ths; what no integer of 32 bits holds becomes 0. */
static uint32_t place_of(float x)
{
    uint32_t steps = fabsf(x) < 0x1p31f ? limited((double)x, 0, 65535) : 0;
    return limited(steps + steps / 255, 0, 65535);
}

static uint32_t moved(uint32_t place, uint32_t way, const struct vector_operands *o)
{
    double by = floor(((double)(int16_t)way * o->move + 16384.0) / 32768.0);
    return limited(place + by, (uint32_t)o->least, (uint32_t)o->most);
}

/* A channel of the four texels around a place, times 255 * 255 * part. */
static int64_t sample(const uint8_t *texels, int channels, int c, uint32_t place, int32_t part)
{
    int64_t u = place & 255, v = place >> 16 & 255, sum = 0;
    size_t column = place >> 8 & 255, row = place >> 24;
    for (int right = 0; right < 2; right++) {
        for (int below = 0; below < 2; below++) {
            size_t texel = row * VECTOR_EDGE + column + (size_t)right;
            int8_t value =
                (int8_t)texels[2 * (texel * (size_t)channels + (size_t)c) + (size_t)below];
            sum += value * (right ? u : 255 - u) * (below ? v : 255 - v) * part;
        }
    }
    return sum;
}

static void expect(const struct vector_operands *o, struct vector_results *r, uint32_t lanes)
{
    for (uint32_t i = 0; i < VECTOR_COUNT; i++) {
        r->min[i] = o->a[i] < o->b[i] ? o->a[i] : o->b[i];
        r->max[i] = o->a[i] > o->b[i] ? o->a[i] : o->b[i];
        r->root[i] = sqrtf(o->a[i]);
        r->floor[i] = floorf(o->a[i]);
        r->gathered[i] = o->a[o->places[i] % VECTOR_COUNT];
        for (uint32_t k = 0; k < 2; k++)
            r->neighbours[k][i] = o->ways[o->places[i] % (VECTOR_COUNT / 2) + k];
        r->integer[i] = fabsf(o->a[i]) < 0x1p31f ? (int32_t)o->a[i] : INT32_MIN;
        r->bit[i] = o->masks[i] != 0;
        for (uint32_t k = i / lanes * lanes; k < i / lanes * lanes + lanes; k++)
            r->any[i] |= o->masks[k] != 0;
        uint32_t least = (uint32_t)o->least, most = (uint32_t)o->most;
        uint32_t u = o->places[i] & 0xffff, v = o->places[i] >> 16;
        r->placed[i] = place_of(o->v[i]) << 16 | place_of(o->u[i]);
        r->clamped[i] = limited(v, least, most) << 16 | limited(u, least, most);
        r->between[i] = r->clamped[i] == o->places[i] ? UINT32_MAX : 0;
        r->moved[i] = moved(v, o->ways[i] >> 16, o) << 16 | moved(u, o->ways[i] & 0xffff, o);
        uint32_t texel = (o->inside[i] >> 24) * VECTOR_EDGE + (o->inside[i] >> 8 & 255);
        r->offsets[i] = (int32_t)(texel * VECTOR_QUAD);
        for (int c = 0; c < 4; c++)
            r->four[c][i] = (float)sample(o->quads, 4, c, o->inside[i], o->part);
        r->alpha[i] = (int32_t)sample(o->alphas, 1, 0, o->inside[i], o->part);
        for (int c = 0; c < 2; c++) {
            r->two[c][i] = (float)sample(o->pairs, 2, c, o->inside[i], o->part);
            int64_t way = sample(o->pairs, 2, c, o->inside[i], 1) >> 8;
            r->sampled_ways[i] |= ((uint32_t)way & 0xffff) << 16 * c;
        }
    }
}

/* NaN of an operation has a sign and a payload of the processor's. */
static void assert_floats(const char *what, const char *level, const float *found,
                          const float *expected)
{
    for (int i = 0; i < VECTOR_COUNT; i++) {
        if (memcmp(found + i, expected + i, sizeof *found) != 0 &&
            !(isnan(found[i]) && isnan(expected[i])))
            fail_msg("%s at %s, %d: %a, not %a", what, level, i, (double)found[i],
                     (double)expected[i]);
    }
}

static void assert_bytes(const char *what, const char *level, const void *found,
                         const void *expected, size_t size)
{
    const uint8_t *a = found, *b = expected;
    for (size_t i = 0; i < size; i++) {
        if (a[i] != b[i])
            fail_msg("%s at %s, byte %zu: %#x, not %#x", what, level, i, a[i], b[i]);
    }
}

static void check_level(enum kiln_simd simd, const struct vector_operands *o)
{
    const struct vector_level *level = KILN_SIMD_PICK(vector_level, simd);
    const char *name = kiln_simd_name(simd);
    struct vector_results *found = calloc(1, sizeof *found), *right = calloc(1, sizeof *right);
    assert_true(found && right);
    level->compute(o, found);
    expect(o, right, level->lanes);
#define FLOATS(member) assert_floats(#member, name, found->member, right->member)
#define BYTES(member)                                                                              \
    assert_bytes(#member, name, found->member, right->member, sizeof found->member)
    BYTES(min); /* NaN as well: it is an operand's */
    BYTES(max);
    FLOATS(root);
    FLOATS(floor);
    BYTES(gathered);
    BYTES(neighbours);
    BYTES(integer);
    BYTES(bit);
    BYTES(any);
    BYTES(placed);
    BYTES(clamped);
    BYTES(between);
    BYTES(moved);
    BYTES(offsets);
    for (int c = 0; c < 4; c++)
        FLOATS(four[c]);
    for (int c = 0; c < 2; c++)
        FLOATS(two[c]);
    BYTES(sampled_ways);
    BYTES(alpha);
#undef FLOATS
#undef BYTES
    free(found);
    free(right);
}

static void every_level_has_the_bits_of_plain_c(void **state)
{
    (void)state;
    static const struct {
        int32_t move, least, most, part;
    } rows[] = {
        {32767, 0, 65535, 1}, {-32767, 128, 32767, 128}, {257, 128, 16511, 77}, {-1, 1, 2, 0}};
    struct vector_operands *o = calloc(1, sizeof *o);
    assert_non_null(o);
    fill(o);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        o->move = rows[i].move;
        o->least = rows[i].least;
        o->most = rows[i].most;
        o->part = rows[i].part;
        for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
            if (kiln_simd_has(simd))
                check_level(simd, o);
            else if (i == 0)
                print_message("no %s here\n", kiln_simd_name(simd));
        }
    }
    free(o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_level_has_the_bits_of_plain_c),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
