/* This file sums up the gravity between particles in vectors.
 * Each lane adds up all sources in their order, so the width of a vector changes no bit. Two
 * vectors at a time share the loads of a source. */
#include "sim/crowd/gravity.h"

#if defined KILN_LEVEL_AVX512
enum { LANES = 16 };
#elif defined KILN_LEVEL_AVX2
enum { LANES = 8 };
#else
enum { LANES = 4 };
#endif

typedef float floats __attribute__((vector_size(4 * LANES)));
typedef uint32_t words __attribute__((vector_size(4 * LANES)));

struct targets {
    floats x, y, z;
    floats sum_x, sum_y, sum_z;
};

static inline struct targets targets_at(const float4 *places)
{
    struct targets t = {.sum_x = {0}};
    for (int i = 0; i < LANES; i++) {
        t.x[i] = places[i].x;
        t.y[i] = places[i].y;
        t.z[i] = places[i].z;
    }
    return t;
}

#define PULL            floats
#define PULL_FN         static inline
#define PULL_BITS(x)    ((words)(x))
#define PULL_OF_BITS(i) ((floats)(i))
#define PULL_RSQRT      rsqrt
#define PULL_A_METRE    pull_a_metre
#include "shared/gravity_pull.h"

static inline void add(struct targets *t, const float4 *source, float softening_square)
{
    floats x = source->x - t->x, y = source->y - t->y, z = source->z - t->z;
    floats pull = pull_a_metre(x, y, z, source->w, softening_square);
    t->sum_x += x * pull;
    t->sum_y += y * pull;
    t->sum_z += z * pull;
}

static inline void keep(const struct targets *t, float3 *accelerations)
{
    for (int i = 0; i < LANES; i++)
        accelerations[i] = (float3){t->sum_x[i], t->sum_y[i], t->sum_z[i]};
}

static void pull(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_gravity *g = context;
    for (size_t first = begin; first < end; first += (size_t)2 * LANES) {
        struct targets a = targets_at(g->places + first);
        struct targets b = targets_at(g->places + first + LANES);
        for (size_t i = 0; i < g->count; i++) {
            add(&a, &g->sources[i], g->softening_square);
            add(&b, &g->sources[i], g->softening_square);
        }
        keep(&a, g->accelerations + first);
        keep(&b, g->accelerations + first + LANES);
    }
}

const struct kiln_gravity_loops KILN_SIMD_NAME(kiln_gravity_loops) = {.pull = pull};
