/* Forces: a row in kiln_force_kinds and a table of members for each kind. */
#include "scene/option_rows.h"

#define AT(field) offsetof(struct kiln_force, field)

static const struct kiln_option gravity[] = {
    VECTOR("acceleration", vector, KILN_ACCELERATION, -10000, 10000, BOTH, "[0, -9.81, 0]",
           "Acceleration; upwards for what is lighter than air."),
    END,
};

static const struct kiln_option drag[] = {
    VALUE("strength", strength, KILN_PER_SECOND, 0, 1000, BOTH, "0.5",
          "Part of the velocity that is lost a second, for small values."),
    END,
};

static const struct kiln_option wind[] = {
    VECTOR("velocity", vector, KILN_SPEED, -10000, 10000, BOTH, "[1, 0, 0]",
           "Velocity of the air."),
    VALUE("pull", strength, KILN_PER_SECOND, 0, 1000, BOTH, "1",
          "How fast particles take up the velocity of the air."),
    END,
};

static const struct kiln_option curl[] = {
    VALUE("strength", strength, KILN_SPEED, 0, 10000, BOTH, "1 m/s",
          "Typical velocity of the air in the eddies."),
    VALUE("scale", scale, KILN_METRES, 0.001, FAR, TIME, "1 m", "Size of the largest eddies."),
    VECTOR("drift", drift, KILN_SPEED, -10000, 10000, TIME, "[0, 0, 0]",
           "Velocity of the eddies as a whole."),
    VALUE("pull", pull, KILN_PER_SECOND, 0, 1000, BOTH, "1",
          "How fast particles take up the velocity of the air."),
    INTEGER("octaves", octaves, 1, 4, "1", "Layers of ever smaller eddies."),
    END,
};

static const struct kiln_option field[] = {
    {ROW("file", grid, AT(file), NULL,
         "Velocities of the air at points of a lattice; between them it moves as they say, beyond "
         "them as at the edge.")},
    VALUE("strength", strength, KILN_PLAIN, -1000, 1000, BOTH, "1", "Factor on the velocities."),
    VALUE("pull", pull, KILN_PER_SECOND, 0, 1000, BOTH, "1",
          "How fast particles take up the velocity of the air."),
    END,
};

static const struct kiln_option limit[] = {
    VALUE("speed", strength, KILN_SPEED, 0, 10000, BOTH, "10 m/s",
          "What is above it is taken off the speed, in every step."),
    END,
};

const struct kiln_option_kind kiln_force_kinds[] = {
    {.name = "gravity",
     .value = KILN_FORCE_GRAVITY,
     .members = gravity,
     .shortcut = "acceleration",
     .help = "The same acceleration everywhere."},
    {.name = "drag",
     .value = KILN_FORCE_DRAG,
     .members = drag,
     .shortcut = "strength",
     .help = "Slows particles down."},
    {.name = "curl",
     .value = KILN_FORCE_CURL,
     .members = curl,
     .shortcut = "strength",
     .help = "Turbulent air: noise without sources, in which smoke swirls."},
    {.name = "limit",
     .value = KILN_FORCE_LIMIT,
     .members = limit,
     .shortcut = "speed",
     .help = "No faster than this; of several, the lowest counts."},
    {.name = "wind",
     .variant = "uniform",
     .value = KILN_FORCE_WIND,
     .members = wind,
     .shortcut = "velocity",
     .help = "Air that moves alike everywhere."},
    {.name = "wind",
     .variant = "curl",
     .value = KILN_FORCE_CURL,
     .members = curl,
     .help = "Another way to write the force curl."},
    {.name = "wind",
     .variant = "grid",
     .value = KILN_FORCE_FIELD,
     .members = field,
     .help = "Air that moves as a file says (UberFlow 2004, 4.2)."},
    {.name = NULL},
};
