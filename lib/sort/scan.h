/* A kiln_scan computes prefix sums on the device: it reduces, then scans. */
#ifndef KILN_SORT_SCAN_H
#define KILN_SORT_SCAN_H

#include "gpu/buffer.h"

struct kiln_scan {
    struct kiln_device *device;
    GLuint sum_program, top_program, block_program;
    struct kiln_buffer sums;  /* of blocks */
    struct kiln_buffer total; /* one word */
};

/* kiln_scan_finish frees what there is, also when this fails. */
bool kiln_scan_init(struct kiln_scan *scan, struct kiln_device *device, struct kiln_error *error);
void kiln_scan_finish(struct kiln_scan *scan);

/* Makes each of the first `count` words of a GL buffer the sum, modulo 2^32, of those before it.
 * They must have been written before a barrier; there is one behind the result. */
bool kiln_scan_run(struct kiln_scan *scan, GLuint words, uint32_t count, struct kiln_error *error);

/* Reads back the sum of all words of the last scan. */
bool kiln_scan_total(struct kiln_scan *scan, uint32_t *total, struct kiln_error *error);

#endif
