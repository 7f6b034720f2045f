/* Chooses code for wide vectors by the machine that the process runs on.
 *
 * A file in a folder of lib/ whose name ends in _simd.c is compiled once for each level that the
 * processor's kind may have (CMakeLists.txt), with KILN_SIMD_LEVEL as a number for the
 * preprocessor. It exports one table of functions, or one function, named by KILN_SIMD_NAME. For
 * example, with made-up names:
 *
 *     rows.h:       struct rows { void (*blur)(...); void (*shrink)(...); };
 *                   KILN_SIMD_DECLARE(const struct rows, kiln_rows);
 *     rows_simd.c:  const struct rows KILN_SIMD_NAME(kiln_rows) = {.blur = blur, ...};
 *     stage.c:      enum kiln_simd simd;
 *                   if (!kiln_simd_choose(&simd, error))
 *                       return NULL;
 *                   stage->rows = KILN_SIMD_PICK(kiln_rows, simd);
 *
 * All levels must give the same bits. The compiler neither contracts nor reorders operations, so a
 * plain loop rounds alike at every level. All other functions of such a file, and of headers that
 * it includes, are static: of two copies of an inline function the linker would keep either, and
 * that may have instructions which the machine lacks. */
#ifndef KILN_BASE_SIMD_H
#define KILN_BASE_SIMD_H

#include "kiln.h"

/* The levels, narrowest first. Each level of one kind of processor has the instructions of that
 * kind's narrower ones. */
enum kiln_simd {
    KILN_SIMD_PLAIN,  /* any machine: what the compiler makes of vectors; SSE2 on x86-64 */
    KILN_SIMD_SSE41,  /* SSE4.1 */
    KILN_SIMD_AVX2,   /* AVX2, BMI and BMI2 */
    KILN_SIMD_AVX512, /* AVX-512 F, BW, DQ and VL, BMI and BMI2 */
    KILN_SIMD_NEON,   /* Advanced SIMD, which every arm64 has */
    KILN_SIMD_COUNT
};

/* The level that the present file is compiled for. */
#ifndef KILN_SIMD_LEVEL
#define KILN_SIMD_LEVEL 0
#endif
#if KILN_SIMD_LEVEL == 0
#define KILN_SIMD_NAME(name) name##_plain
#elif KILN_SIMD_LEVEL == 1
#define KILN_SIMD_NAME(name) name##_sse41
#elif KILN_SIMD_LEVEL == 2
#define KILN_SIMD_NAME(name) name##_avx2
#elif KILN_SIMD_LEVEL == 3
#define KILN_SIMD_NAME(name) name##_avx512
#else
#define KILN_SIMD_NAME(name) name##_neon
#endif

/* The levels that this build has, a bit each (CMake's KILN_SIMD_LEVELS). */
#ifndef KILN_SIMD_LEVELS
#define KILN_SIMD_LEVELS 1
#endif

/* The narrowest level that this build has. */
#define KILN_SIMD_NARROWEST                                                                        \
    (KILN_SIMD_LEVELS & 1   ? KILN_SIMD_PLAIN                                                      \
     : KILN_SIMD_LEVELS & 2 ? KILN_SIMD_SSE41                                                      \
     : KILN_SIMD_LEVELS & 4 ? KILN_SIMD_AVX2                                                       \
     : KILN_SIMD_LEVELS & 8 ? KILN_SIMD_AVX512                                                     \
                            : KILN_SIMD_NEON)

/* Each of these names a level's export, or NULL where the build lacks the level. */
#if KILN_SIMD_LEVELS & 1
#define KILN_SIMD_OF_PLAIN(name) &name##_plain
#else
#define KILN_SIMD_OF_PLAIN(name) (__typeof__(&name##_plain))NULL
#endif
#if KILN_SIMD_LEVELS & 2
#define KILN_SIMD_OF_SSE41(name) &name##_sse41
#else
#define KILN_SIMD_OF_SSE41(name) (__typeof__(&name##_sse41))NULL
#endif
#if KILN_SIMD_LEVELS & 4
#define KILN_SIMD_OF_AVX2(name) &name##_avx2
#else
#define KILN_SIMD_OF_AVX2(name) (__typeof__(&name##_avx2))NULL
#endif
#if KILN_SIMD_LEVELS & 8
#define KILN_SIMD_OF_AVX512(name) &name##_avx512
#else
#define KILN_SIMD_OF_AVX512(name) (__typeof__(&name##_avx512))NULL
#endif
#if KILN_SIMD_LEVELS & 16
#define KILN_SIMD_OF_NEON(name) &name##_neon
#else
#define KILN_SIMD_OF_NEON(name) (__typeof__(&name##_neon))NULL
#endif

/* The first macro declares an export of all levels; the second takes the address of one level's. */
#define KILN_SIMD_DECLARE(type, name)                                                              \
    extern type name##_plain, name##_sse41, name##_avx2, name##_avx512, name##_neon
#define KILN_SIMD_PICK(name, simd)                                                                 \
    (((__typeof__(&name##_plain)[]){[KILN_SIMD_PLAIN] = KILN_SIMD_OF_PLAIN(name),                  \
                                    [KILN_SIMD_SSE41] = KILN_SIMD_OF_SSE41(name),                  \
                                    [KILN_SIMD_AVX2] = KILN_SIMD_OF_AVX2(name),                    \
                                    [KILN_SIMD_AVX512] = KILN_SIMD_OF_AVX512(name),                \
                                    [KILN_SIMD_NEON] = KILN_SIMD_OF_NEON(name)})[simd])

/* Returns a level's name: "plain", "sse4.1", "avx2", "avx512", "neon". */
const char *kiln_simd_name(enum kiln_simd simd);

/* Returns whether this machine and this build have a level. */
bool kiln_simd_has(enum kiln_simd simd);

/* Chooses the widest level that there is, or the one that the environment variable KILN_SIMD names:
 * for tests, and for measuring the speed of a lesser machine. KILN_USAGE for another name. */
bool kiln_simd_choose(enum kiln_simd *simd, struct kiln_error *error);

#endif
