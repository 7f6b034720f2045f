/* Declares the interface of the fuzz targets: programs that give arbitrary bytes to one of kiln's
 * readers. Each target is one file and defines LLVMFuzzerTestOneInput, which libFuzzer or replay.c
 * calls. */
#ifndef KILN_TESTS_FUZZ_H
#define KILN_TESTS_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* Runs the target on one input of `size` bytes, and returns 0. A target reports a fault by a crash,
 * as libFuzzer expects. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* True if the reader accepted the last input as a valid file; each target sets it. replay.c checks
 * that every file in the folder "good" of a corpus is accepted. Without this check, the tests would
 * pass after a change of a format's version although each target read only the first line of its
 * corpus. The symbol is weak, so that a target links with replay.c and with libFuzzer alike. */
__attribute__((weak)) bool fuzz_taken;

/* Prints a message and aborts the process unless the condition is true. Targets check by it what
 * must hold for every input. */
static inline void require(bool condition, const char *what)
{
    if (!condition) {
        fprintf(stderr, "fuzz: %s\n", what);
        abort();
    }
}

#endif
