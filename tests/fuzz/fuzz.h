/* One fuzz target a file; libFuzzer or replay.c calls it. */
#ifndef KILN_TESTS_FUZZ_H
#define KILN_TESTS_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* Returns 0; a finding is a crash. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Whether the last input was what the target reads. Each target sets it: of a corpus's folder
 * "good" all files are to be taken, lest the target reads nothing but the first line of what has
 * become of another version. One variable, whether or not replay.c is linked. */
__attribute__((weak)) bool fuzz_taken;

/* What must hold whatever the input is. */
static inline void require(bool condition, const char *what)
{
    if (!condition) {
        fprintf(stderr, "fuzz: %s\n", what);
        abort();
    }
}

#endif
