/* This header defines the types and operations of shared/real.h as vectors, so that the formulas in
 * shaders/shared that are written in them compute a vector of points. A file includes it before any
 * header that includes shared/real.h, which would otherwise define them as single numbers. */
#ifndef KILN_BASE_REAL_H
#ifdef KILN_SHARED_REAL_H
#error "shared/real.h was included before base/real.h"
#endif
#define KILN_BASE_REAL_H

#include "base/lane_math.h"

#define REAL_FN                     SIMD
#define real                        vf
#define real3                       struct vf3
#define truth                       vi
#define truth_and(a, b)             ((a) & (b))
#define truth_or(a, b)              ((a) | (b))
#define truth_not(a)                (~(a))
#define real_all(x)                 vf_all(x)
#define real_abs(x)                 vf_abs(x)
#define real_min(a, b)              vf_min(a, b)
#define real_max(a, b)              vf_max(a, b)
#define real_clamp(x, low, high)    vf_clamp(x, low, high)
#define real_floor(x)               vf_floor(x)
#define real_sqrt(x)                vf_sqrt(x)
#define real_rsqrt(x)               vf_rsqrt(x)
#define real_exp(x)                 vf_exp(x)
#define real_log2(x)                vf_log2(x)
#define real_sin(x)                 vf_sincos(x).sine
#define real_cos(x)                 vf_sincos(x).cosine
#define real_atan2(y, x)            vf_atan2(y, x)
#define real_select(holds, yes, no) vf_select(holds, yes, no)
#define real_where(holds, x)        vf_where(holds, x)
#define real_some(holds)            any(holds)
#define real_sign_one(x)            vf_sign_one(x)
#define REAL_INT                    vi
#define real_bits(x)                ((vi)(x))
#define real_of_bits(x)             ((vf)(x))
#define real_of(x)                  vf_of(x)
#define real_int(x)                 vi_of(x)

#define REAL3(x, y, z)               ((struct vf3){x, y, z})
#define real3_all(v)                 ((struct vf3){vf_all((v).x), vf_all((v).y), vf_all((v).z)})
#define real3_add(a, b)              vf3_add(a, b)
#define real3_sub(a, b)              vf3_sub(a, b)
#define real3_scale(a, x)            vf3_scale(a, x)
#define real3_add_scaled(a, b, x)    vf3_add_scaled(a, b, x)
#define real3_dot(a, b)              vf3_dot(a, b)
#define real3_dot_all(a, b)          vf3_dot_all(a, b)
#define real3_towards(to, from)      vf3_towards(to, from)
#define real3_length(a)              vf3_length(a)
#define real3_normalize(a)           vf3_normalize(a)
#define real3_mix_all(a, b, x)       vf3_mix(a, b, x)
#define real3_select(holds, yes, no) vf3_select(holds, yes, no)

#include "shared/real.h"

#endif
