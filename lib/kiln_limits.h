/* Declares limits of what a job may take, for scenes from untrusted sources. This header is part of
 * kiln.h, which includes it. */
#ifndef KILN_LIMITS_H
#define KILN_LIMITS_H

#include "kiln.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What can be limited, in what (a count, bytes, milliseconds), and what is said of an amount. */
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
    X(output, BYTES, "of output")

enum kiln_limit {
#define KILN_LIMIT_ID(name, unit, noun) KILN_LIMIT_##name,
    KILN_LIMITS(KILN_LIMIT_ID)
#undef KILN_LIMIT_ID
        KILN_LIMIT_COUNT
};

struct kiln_limits {
    size_t size;
    uint64_t most[KILN_LIMIT_COUNT]; /* 0: no limit */
};
KILN_EMPTY(kiln_limits, kiln_limits_empty)

/* Reads "frames=1000,memory=4 GiB,time=1 h" or "service", or both with commas between, into limits
 * that stay what they are where the text says nothing; "none" lifts one. KILN_USAGE with what was
 * found and what is allowed. */
KILN_API bool kiln_limits_parse(struct kiln_limits *limits, const char *text,
                                struct kiln_error *error);

/* What a job has taken of its limits. It counts from here on, so make it before the scene is
 * loaded; who uses it may be on any threads. NULL: no limits. Returns NULL when memory is short. */
struct kiln_budget;
KILN_API struct kiln_budget *kiln_budget_create(const struct kiln_limits *limits);
KILN_API void kiln_budget_destroy(struct kiln_budget **budget);

/* Whether time, processor time and memory of this process are within the limits: else false with
 * KILN_OVER_LIMIT. Jobs ask it themselves between passes; another thread may, for what cannot be
 * left. A NULL budget has no limits. */
KILN_API bool kiln_budget_is_kept(struct kiln_budget *budget, struct kiln_error *error);

#ifdef __cplusplus
}
#endif

#endif
