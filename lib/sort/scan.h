/* A kiln_scan computes prefix sums on the device by reducing blocks and then scanning them. */
#ifndef KILN_SORT_SCAN_H
#define KILN_SORT_SCAN_H

#include "gpu/buffer.h"

struct kiln_scan {
    struct kiln_device *device;
    GLuint sum_program, top_program, block_program;
    struct kiln_buffer sums;  /* the sum of each block of words */
    struct kiln_buffer total; /* the sum of all words: one word */
};

/* kiln_scan_finish frees all resources, also after a failure. */
bool kiln_scan_init(struct kiln_scan *scan, struct kiln_device *device, struct kiln_error *error);
void kiln_scan_finish(struct kiln_scan *scan);

/* Replaces each of the first `count` words of a GL buffer by the sum, modulo 2^32, of the words
 * before it. The caller sets a barrier between writing the words and this call; the function sets
 * one after the result. */
bool kiln_scan_run(struct kiln_scan *scan, GLuint words, uint32_t count, struct kiln_error *error);

/* Reads back the sum of all words that the last scan had as its input. */
bool kiln_scan_total(struct kiln_scan *scan, uint32_t *total, struct kiln_error *error);

#endif
