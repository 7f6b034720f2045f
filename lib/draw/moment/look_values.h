/* This header declares the values of looks that the table of looks cannot have by a particle's life
 * alone: those over another clock, such as random numbers or the speed. The table has 1 in their
 * places, and in those of values that are inherited from a parent. Each of them becomes a few rows
 * of samples over its own clock, which lie behind the rows of all systems, and a factor that is
 * made of these rows for each particle. */
#ifndef KILN_DRAW_MOMENT_LOOK_VALUES_H
#define KILN_DRAW_MOMENT_LOOK_VALUES_H

#include "scene/scene.h"
#include "scene/source.h"
#include "shared/look_layout.h"

/* The most values of a system, which is as many as there are in the table's rows. */
#define KILN_LOOK_VALUES 30

/* A part of a value: its own curve, what multiplies it, or what is added to it. */
struct kiln_look_part {
    uint32_t clock;    /* KILN_CLOCK_*; KILN_CLOCK_CONSTANT: the row is the same everywhere */
    uint32_t flags;    /* LOOK_PART_* */
    uint32_t draw;     /* what random_unit takes, or the seed of a noise */
    uint32_t row;      /* of the table, counted from its begin */
    uint32_t steps;    /* with LOOK_PART_STEPS: how many texels of the row there are */
    float from, per_x; /* x of the first sample; samples for each 1 of x */
    float span;        /* of a repetition */
    float period_s;    /* of a noise */
    uint32_t octaves;
    const struct kiln_source *source; /* with LOOK_CLOCK_SOURCE */
};

struct kiln_look_value {
    uint32_t target; /* the row of the look that the value multiplies, KILN_LOOK_* */
    uint32_t lanes;  /* bit mask of the row's components */
    uint32_t parts;  /* bit mask of the parts that the value has */
    struct kiln_look_part part[3];
    float low, high;    /* limits of the result */
    uint32_t light_row; /* a row of light over the result, which is a temperature; 0: none */
    float light_from, light_per_x;
};

/* The values of a system. */
struct kiln_look_program {
    uint32_t count;
    uint32_t row; /* the first of the rows in which shaders find it */
    struct kiln_look_value values[KILN_LOOK_VALUES];
};

/* Returns whether a value has a clock that the table does not have. */
bool kiln_look_value_is_own(const float4 *keys, const struct kiln_value *value);

/* Returns what a system inherits of its parent's look. */
struct kiln_inherited kiln_look_inherited(const struct kiln_scene *scene, uint32_t index);

/* Returns the look of a system, in which values are 1 that are inherited, or vary over other clocks
 * than the time and a particle's life. */
struct kiln_look kiln_look_over_life(const struct kiln_scene *scene, uint32_t index);

/* Returns how many rows the table of a scene has: those of all systems, and those of values. */
uint32_t kiln_look_rows(const struct kiln_scene *scene);

/* Finds the values of all systems. */
void kiln_look_programs_fill(const struct kiln_scene *scene,
                             struct kiln_look_program programs[KILN_MAX_SYSTEMS]);

/* Fills the rows of the values at a clip time. table: of kiln_look_rows rows. */
void kiln_look_programs_sample(const struct kiln_scene *scene,
                               const struct kiln_look_program programs[KILN_MAX_SYSTEMS],
                               float time_s, float4 *table);

/* Returns a part of a value, with its first component in the place of the fourth. */
float4 kiln_look_part_at(const float4 *table, const struct kiln_look_part *part,
                         const struct value_clocks *clocks);

/* Returns a row of a look after its values have multiplied it. row: the row over life. */
float4 kiln_look_multiply(const float4 *table, const struct kiln_look_program *program,
                          uint32_t target, const struct value_clocks *clocks, float4 row);

#endif
