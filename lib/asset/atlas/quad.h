/* Defines a vector of four floats: a texel, or the four fields that move at a sample of a fluid. */
#ifndef KILN_ASSET_ATLAS_QUAD_H
#define KILN_ASSET_ATLAS_QUAD_H

#include <stdint.h>

typedef float asset_quad __attribute__((vector_size(16)));
typedef float asset_quad_unaligned __attribute__((vector_size(16), aligned(4), may_alias));
typedef int32_t asset_quad_mask __attribute__((vector_size(16)));

static inline asset_quad asset_quad_load(const float *from)
{
    return *(const asset_quad_unaligned *)from;
}

static inline void asset_quad_store(float *to, asset_quad quad)
{
    *(asset_quad_unaligned *)to = quad;
}

static inline asset_quad asset_quad_select(asset_quad_mask mask, asset_quad a, asset_quad b)
{
    return (asset_quad)((mask & (asset_quad_mask)a) | (~mask & (asset_quad_mask)b));
}

/* Return the lesser and the greater, like exact_min and exact_max: b where there is no order. */
static inline asset_quad asset_quad_min(asset_quad a, asset_quad b)
{
    return asset_quad_select(a < b, a, b);
}

static inline asset_quad asset_quad_max(asset_quad a, asset_quad b)
{
    return asset_quad_select(a > b, a, b);
}

#endif
