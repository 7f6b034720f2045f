/* The operations of lib/draw/vector and lib/draw/sprites/texels.h on arrays, in a file compiled for
 * each level of vectors. */
#ifndef KILN_TESTS_VECTOR_SIMD_H
#define KILN_TESTS_VECTOR_SIMD_H

#include <stdint.h>

#include "base/simd.h"

enum {
    VECTOR_COUNT = 1024, /* numbers; a multiple of all widths */
    VECTOR_EDGE = 64,    /* texels of the cells, with a margin */
    VECTOR_QUAD = 8,     /* bytes of a texel with four channels */
    VECTOR_PAIR = 4,     /* with two */
    VECTOR_ALPHA = 2,    /* with alpha alone */
};

struct vector_operands {
    float a[VECTOR_COUNT], b[VECTOR_COUNT];
    uint32_t masks[VECTOR_COUNT]; /* all bits or none */
    float u[VECTOR_COUNT], v[VECTOR_COUNT];
    uint32_t places[VECTOR_COUNT]; /* any */
    uint32_t ways[VECTOR_COUNT];   /* any */
    uint32_t inside[VECTOR_COUNT]; /* places within the cells */
    int32_t move, least, most;     /* of places */
    int32_t part;
    uint8_t quads[VECTOR_EDGE * VECTOR_EDGE * VECTOR_QUAD];
    uint8_t pairs[VECTOR_EDGE * VECTOR_EDGE * VECTOR_PAIR];
    uint8_t alphas[VECTOR_EDGE * VECTOR_EDGE * VECTOR_ALPHA];
};

struct vector_results {
    float min[VECTOR_COUNT], max[VECTOR_COUNT], root[VECTOR_COUNT], floor[VECTOR_COUNT];
    float gathered[VECTOR_COUNT];         /* a, by the last bits of places */
    uint32_t neighbours[2][VECTOR_COUNT]; /* two of ways, by fewer of these bits */
    int32_t integer[VECTOR_COUNT];
    uint8_t bit[VECTOR_COUNT], any[VECTOR_COUNT]; /* of a mask; of all masks of the vector */
    uint32_t placed[VECTOR_COUNT], clamped[VECTOR_COUNT], between[VECTOR_COUNT];
    uint32_t moved[VECTOR_COUNT];
    int32_t offsets[VECTOR_COUNT]; /* of `inside`, among the quads */
    float four[4][VECTOR_COUNT], two[2][VECTOR_COUNT];
    int32_t alpha[VECTOR_COUNT];
    uint32_t sampled_ways[VECTOR_COUNT]; /* of the pairs, for part 1 */
};

struct vector_level {
    uint32_t lanes;
    void (*compute)(const struct vector_operands *operands, struct vector_results *results);
};

KILN_SIMD_DECLARE(const struct vector_level, vector_level);

#endif
