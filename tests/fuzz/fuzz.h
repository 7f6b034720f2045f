/* Declares the interface of the fuzz targets, one target a file. libFuzzer or replay.c calls the
 * target. */
#ifndef KILN_TESTS_FUZZ_H
#define KILN_TESTS_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* Runs the target on one input. Returns 0. A target reports a fault by a crash, as libFuzzer
 * expects. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Whether the last input was accepted; each target sets it. replay.c checks that every file of a
 * corpus's folder "good" is accepted. Otherwise, after a change of the format's version, a target
 * would go on to read only the first line of its corpus and test nothing. The symbol is weak, so
 * that a target links with replay.c and with libFuzzer alike. */
__attribute__((weak)) bool fuzz_taken;

/* Crashes with a message unless the condition is true, which it must be whatever the input is. */
static inline void require(bool condition, const char *what)
{
    if (!condition) {
        fprintf(stderr, "fuzz: %s\n", what);
        abort();
    }
}

#endif
