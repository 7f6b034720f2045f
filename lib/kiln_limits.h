/* Declares limits of what a job may take, for scenes from untrusted sources. This header is part of
 * kiln.h, which includes it. */
#ifndef KILN_LIMITS_H
#define KILN_LIMITS_H

#include "kiln.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The limits of a job: the name, the unit (a count, bytes, milliseconds), and the words that follow
 * an amount in messages. */
#define KILN_LIMITS(X)                                                                             \
    X(pixels, COUNT, "pixels of a frame")                                                          \
    X(frames, COUNT, "frames of the clip")                                                         \
    X(steps, COUNT, "steps of the clip")                                                           \
    X(particles, COUNT, "particles at once")                                                       \
    X(memory, BYTES, "of memory")                                                                  \
    X(time, TIME, "since it began")                                                                \
    X(cpu, TIME, "of processor time")                                                              \
    X(asset_pixels, COUNT, "decoded pixels of pictures")                                           \
    X(asset_bytes, BYTES, "of files that the scene names")                                         \
    X(triangles, COUNT, "triangles of meshes")                                                     \
    X(output, BYTES, "of output")                                                                  \
    X(gas_cells, COUNT, "cells of gas")                                                            \
    X(gas_steps, COUNT, "cells of gas in all steps")

enum kiln_limit {
#define KILN_LIMIT_ID(name, unit, noun) KILN_LIMIT_##name,
    KILN_LIMITS(KILN_LIMIT_ID)
#undef KILN_LIMIT_ID
        KILN_LIMIT_COUNT
};

struct kiln_limits {
    size_t size;
    uint64_t most[KILN_LIMIT_COUNT]; /* the largest amounts that are allowed; 0: no limit */
};
KILN_EMPTY(kiln_limits, kiln_limits_empty)

/* Reads limits from a text such as "frames=1000,memory=4 GiB,time=1 h", "service" (a preset), or
 * both with a comma between. Limits that the text does not name stay as they are; the value "none"
 * lifts a limit. Returns false with KILN_USAGE for a wrong text. */
KILN_API bool kiln_limits_parse(struct kiln_limits *limits, const char *text,
                                struct kiln_error *error);

/* The amounts that a job has taken of its limits. Any threads may use it at the same time. */
struct kiln_budget;

/* Returns a budget, which the caller destroys, or NULL when memory is short. Time counts from this
 * call on, so make it before the scene is loaded. `limits` NULL: no limits. */
KILN_API struct kiln_budget *kiln_budget_create(const struct kiln_limits *limits);
KILN_API void kiln_budget_destroy(struct kiln_budget **budget);

/* Returns whether time, processor time and memory of this process are within the limits; otherwise
 * fills the error with KILN_OVER_LIMIT. Jobs call it between passes; another thread may call it, to
 * end a process whose job is in a long call. A NULL budget has no limits. */
KILN_API bool kiln_budget_is_kept(struct kiln_budget *budget, struct kiln_error *error);

#ifdef __cplusplus
}
#endif

#endif
