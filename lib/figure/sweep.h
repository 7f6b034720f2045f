/* Finds which panels a figure of scenes has. They are the product of its axes. */
#ifndef KILN_FIGURE_SWEEP_H
#define KILN_FIGURE_SWEEP_H

#include "base/arena.h"
#include "kiln_program.h"

enum { KILN_MAX_PANELS = 1024, KILN_MAX_AXES = 8 };

enum kiln_sweep_moment { KILN_MOMENT_NONE, KILN_MOMENT_FRAME, KILN_MOMENT_TIME };

/* The scene, the overrides and the moment that one panel shows. */
struct kiln_choice {
    size_t scene;           /* index into the inputs */
    const char **overrides; /* "key=value" */
    size_t override_count;
    enum kiln_sweep_moment moment; /* NONE: the middle frame of the scene */
    double when;                   /* a frame's number, or seconds */
    const char *label;             /* "" without one */
};

struct kiln_choices {
    struct kiln_choice *items; /* the last axis runs fastest */
    size_t count;
    size_t axis_count;
    size_t last_axis; /* the number of values of the last axis that has more than one */
};

/* Expands the inputs, sweeps and frames of the parameters into choices, which lie in the arena.
 * KILN_USAGE names what is wrong with a sweep. */
bool kiln_choices_make(struct kiln_arena *arena, const struct kiln_figure_params *params,
                       struct kiln_choices *choices, struct kiln_error *error);

#endif
