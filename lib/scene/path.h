/* Declares paths: smooth curves through points in space, along which nodes move.
 *
 * A curve is a centripetal Catmull-Rom spline (Yuksel, Schaefer and Keyser 2011), which has neither
 * cusps nor loops between two of its points. It is run through by its length. All arithmetic is
 * that of IEEE doubles and square roots, so every machine computes the same bits. */
#ifndef KILN_SCENE_PATH_H
#define KILN_SCENE_PATH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "option/values.h"

enum { KILN_MAX_PATH_POINTS = 1024 };

struct kiln_path_points {
    const float (*at)[3]; /* m; owned by the scene's arena */
    uint32_t count;       /* 0: there is no path */
};

struct kiln_path_table; /* lengths and directions along a curve */

struct kiln_path {
    struct kiln_path_points points;
    struct kiln_range over; /* s: when the node leaves the first and reaches the last point */
    unsigned ease;          /* VALUE_LINEAR and so on: how it goes through the length */
    bool closed;            /* the curve ends at its first point */
    const struct kiln_path_table *table; /* follows; NULL: there is no path */
};

/* A place on a curve and how fast it changes. */
struct kiln_path_place {
    double at[3];       /* m */
    double velocity[3]; /* m/s */
    double ahead[3];    /* unit vector along the curve */
    double up[3];       /* unit vector across it, carried along from the first point without roll */
    double spin[3];     /* rad/s: how `ahead` and `up` turn, about an axis of the world */
};

/* Makes the table of a path, in the arena; NULL when memory is short. No two neighbours among the
 * points may be the same; there are two of them at least, and three if the path is closed. */
const struct kiln_path_table *kiln_path_table_create(struct kiln_arena *arena,
                                                     const struct kiln_path *path);

/* Returns the most memory that the table of a path takes. */
size_t kiln_path_bytes(const struct kiln_path *path);

/* Returns the length of the whole curve, m. */
double kiln_path_length(const struct kiln_path *path);

/* Returns where a path is at a clip time, and how fast it moves at another one: just before or at
 * the first. */
struct kiln_path_place kiln_path_at(const struct kiln_path *path, float time_s, float rate_s);

#endif
