/* Chooses code for wide vectors by the machine that the process runs on.
 *
 * A file in a folder of lib/ whose name ends in _simd.c is compiled once for each level that the
 * build has (cmake/simd.cmake), with the level's name as KILN_SIMD_LEVEL and, for #ifdef, with a
 * macro such as KILN_LEVEL_AVX2. It exports one table of functions, or one function, named by
 * KILN_SIMD_NAME; other such files call its functions of the same level by that name. For example,
 * with made-up names:
 *
 *     rows.h:       struct rows { void (*blur)(...); void (*shrink)(...); };
 *                   KILN_SIMD_DECLARE(const struct rows, kiln_rows);
 *     rows_simd.c:  const struct rows KILN_SIMD_NAME(kiln_rows) = {.blur = blur, ...};
 *     stage.c:      enum kiln_simd simd;
 *                   if (!kiln_simd_choose(&simd, error))
 *                       return NULL;
 *                   stage->rows = KILN_SIMD_PICK(kiln_rows, simd);
 *
 * Which levels a build has is known to one generated file for each export, which has the export's
 * addresses by level. So a build gets another level without compiling anything else again.
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
    KILN_SIMD_PLAIN, /* any machine: SSE2 on x86-64, elsewhere what the compiler makes of vectors */
    KILN_SIMD_AVX2,  /* AVX2, BMI and BMI2 */
    KILN_SIMD_AVX512, /* AVX-512 F, BW, DQ and VL, BMI and BMI2 */
    KILN_SIMD_NEON,   /* Advanced SIMD, which every arm64 has */
    KILN_SIMD_COUNT
};

/* The level that the present file is compiled for. */
#ifndef KILN_SIMD_LEVEL
#define KILN_SIMD_LEVEL plain
#endif
#define KILN_SIMD_JOIN(name, level)    name##_##level
#define KILN_SIMD_NAME_OF(name, level) KILN_SIMD_JOIN(name, level)
#define KILN_SIMD_NAME(name)           KILN_SIMD_NAME_OF(name, KILN_SIMD_LEVEL)

/* The first macro declares an export of all levels; the second takes the address of one level's,
 * NULL where the build lacks the level. */
#define KILN_SIMD_DECLARE(type, name)                                                              \
    extern type name##_plain, name##_avx2, name##_avx512, name##_neon;                             \
    extern __typeof__(&name##_plain) const name##_levels[KILN_SIMD_COUNT]
#define KILN_SIMD_PICK(name, simd) (name##_levels[simd])

/* Whether the build has a level, by level. */
extern const bool kiln_simd_built_levels[KILN_SIMD_COUNT];

/* Returns a level's name: "plain", "avx2", "avx512", "neon". */
const char *kiln_simd_name(enum kiln_simd simd);

/* Returns whether this machine and this build have a level. */
bool kiln_simd_has(enum kiln_simd simd);

/* Returns the narrowest level that this build has. */
enum kiln_simd kiln_simd_narrowest(void);

/* Chooses the widest level that there is, or the one that the environment variable KILN_SIMD names:
 * for tests, and for measuring the speed of a lesser machine. KILN_USAGE for another name. */
bool kiln_simd_choose(enum kiln_simd *simd, struct kiln_error *error);

#endif
