/* Asks the processor which vector instructions it has, and chooses the level that kiln's vector
 * code uses. The environment variable KILN_SIMD overrides the choice. */
#include "base/simd.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/text.h"
#include "kiln_program.h"

const char *kiln_simd_name(enum kiln_simd simd)
{
    static const char *const names[KILN_SIMD_COUNT] = {[KILN_SIMD_PLAIN] = "plain",
                                                       [KILN_SIMD_AVX2] = "avx2",
                                                       [KILN_SIMD_AVX512] = "avx512",
                                                       [KILN_SIMD_NEON] = "neon"};
    return names[simd];
}

#ifdef __x86_64__
/* Returns whether there are BMI and BMI2, which came with AVX2. */
static bool has_bit_instructions(void)
{
    return __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
}
#endif

bool kiln_simd_has(enum kiln_simd simd)
{
    if (!kiln_simd_built_levels[simd])
        return false;
#ifdef __x86_64__
    switch (simd) {
    case KILN_SIMD_AVX2:
        return __builtin_cpu_supports("avx2") && has_bit_instructions();
    case KILN_SIMD_AVX512:
        return has_bit_instructions() && __builtin_cpu_supports("avx512f") &&
               __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl");
    default:
        return simd == KILN_SIMD_PLAIN;
    }
#elif defined __aarch64__
    return simd == KILN_SIMD_PLAIN || simd == KILN_SIMD_NEON;
#else
    return simd == KILN_SIMD_PLAIN;
#endif
}

enum kiln_simd kiln_simd_narrowest(void)
{
    enum kiln_simd simd = KILN_SIMD_PLAIN;
    while (!kiln_simd_built_levels[simd])
        simd++;
    return simd;
}

bool kiln_simd_choose(enum kiln_simd *simd, struct kiln_error *error)
{
    const char *wanted = kiln_environment("KILN_SIMD");
    struct kiln_text names = {0};
    bool found = false;
    for (int i = 0; i < KILN_SIMD_COUNT; i++) {
        const char *name = kiln_simd_name((enum kiln_simd)i);
        if (!kiln_simd_has((enum kiln_simd)i))
            continue;
        kiln_text_add(&names, "%s%s", names.length ? ", " : "", name);
        if (!wanted || strcmp(name, wanted) == 0) {
            *simd = (enum kiln_simd)i;
            found = true;
        }
    }
    if (!found)
        kiln_error_set(error, KILN_USAGE, "KILN_SIMD is '%s'; this machine has %s", wanted,
                       names.data ? names.data : "");
    kiln_text_free(&names);
    return found;
}

bool kiln_environment_check(struct kiln_error *error)
{
    enum kiln_simd simd;
    return kiln_simd_choose(&simd, error);
}
