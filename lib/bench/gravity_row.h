/* Declares a way to add up gravity that the suite `gravity` compares with the host's loops: a row
 * of the table in gravity.c. */
#ifndef KILN_BENCH_GRAVITY_ROW_H
#define KILN_BENCH_GRAVITY_ROW_H

#include "gpu/device.h"
#include "shared/platform.h"

struct kiln_gravity_row {
    const char *name;
    uint32_t most_in_software; /* with more bodies, a software device takes seconds a turn */
    /* Returns NULL with an error (KILN_DEVICE_FAILED). most: bodies, at least 1. */
    void *(*create)(struct kiln_device *device, uint32_t most, struct kiln_error *error);
    void (*destroy)(void *way);
    /* Adds up the accelerations of each body by all sources (gravity_source: m, m/s^2 at 1 m). *ms
     * is the time that this takes. */
    bool (*run)(void *way, const float4 *sources, uint32_t count, float softening_square,
                double *ms, struct kiln_error *error);
};

#endif
