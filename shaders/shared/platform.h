/* Defines the subset of C and GLSL in which shaders/shared is written. Its files compile as both,
 * so that each rule of the simulation is written once and gives the same bits on a CPU and on a
 * GPU. A kernel is a program in GLSL that a GPU runs once for each particle or pixel. The subset
 * has structs by value, scalar arithmetic and functions on vectors; no swizzles, no operators on
 * vectors, no built-in mathematics (drivers disagree in the last bits). Words of its own:
 *   FN         stands before every function: `static inline` in C, nothing in GLSL
 *   FN_APART   stands before a function that few calls of its callers need: C compiles it apart
 *              from them, so that they stay short
 *   FN_WITHIN  stands before a small function of the innermost loops, which C always inlines
 *   EXACT      stands before every local that holds floats: GLSL's `precise`, which keeps compilers
 *              from fusing or reordering operations. GLSL does not allow it for parameters and
 *              return types: so pass, return and compare names of such locals, never expressions
 *   S(name)    the type of a struct: `struct name` in C, `name` in GLSL
 *   UINT(x)    a conversion; the value must be in range
 *   1.0f       every literal carries its f: in C, 1.0 would compute in double
 *
 * An operation thus always ends in an EXACT local. */
#ifndef KILN_SHARED_PLATFORM_H
#define KILN_SHARED_PLATFORM_H

#ifdef GL_core_profile /* GLSL */

#define FN
#define FN_APART
#define FN_WITHIN
#define EXACT    precise
#define S(name)  name
#define UINT(x)  uint(x)
#define INT(x)   int(x)
#define FLOAT(x) float(x)
#define FLOOR(x) floor(x)
#define SQRT(x)  sqrt(x) /* of light; the simulation has exact_sqrt */

#define float3             vec3
#define float4             vec4
#define uint4              uvec4
#define FLOAT3(x, y, z)    vec3(x, y, z)
#define FLOAT4(x, y, z, w) vec4(x, y, z, w)
#define UINT4(x, y, z, w)  uvec4(x, y, z, w)
#define FLOAT_BITS(x)      floatBitsToUint(x)
#define BITS_FLOAT(x)      uintBitsToFloat(x)

#else /* C; compile with -ffp-contract=off */

#include <math.h>
#include <stdalign.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define FN        static inline
#define FN_APART  static __attribute__((noinline, unused))
#define FN_WITHIN static inline __attribute__((always_inline))
#define EXACT
#define S(name)            struct name
#define UINT(x)            ((uint)(x))
#define INT(x)             ((int)(x))
#define FLOAT(x)           ((float)(x))
#define FLOOR(x)           floorf(x)
#define SQRT(x)            sqrtf(x)

typedef unsigned int uint;
typedef struct float3 {
    float x, y, z;
} float3;
typedef struct float4 {
    alignas(16) float x;
    float y, z, w;
} float4;
typedef struct uint4 {
    alignas(16) uint x;
    uint y, z, w;
} uint4;
#define FLOAT3(x, y, z)    ((float3){x, y, z})
#define FLOAT4(x, y, z, w) ((float4){x, y, z, w})
#define UINT4(x, y, z, w)  ((uint4){x, y, z, w})

static inline uint FLOAT_BITS(float x)
{
    uint bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline float BITS_FLOAT(uint bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

#endif
#endif
