/* This file has the option tables of forces. Each kind of force has a table of members, and one row
 * or two in kiln_force_kinds: `curl: {}` can also be written `wind: {field: curl}`.
 *
 * scene/rows.h defines MOTION, TIME, LIFE and FAR. */
#include "scene/rows.h"

#define FILLS struct kiln_force_region

TABLE(region_box) = {
    VECTOR(MOTION, "center", box_center, KILN_METRES, -FAR, FAR, TIME(94), "[0, 0, 0]",
           "Centre of the box."),
    VECTOR(MOTION, "size", box_size, KILN_METRES, 0, FAR, TIME(95), "[1, 1, 1]",
           "Lengths of the edges, which lie along the axes."),
    END,
};

TABLE(region_sphere) = {
    VECTOR(MOTION, "center", ball_center, KILN_METRES, -FAR, FAR, TIME(96), "[0, 0, 0]",
           "Centre of the sphere."),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0, FAR, TIME(97), "1 m", "Radius."),
    END,
};

TABLE(region_options) = {
    ATTACH(IF_REGION_IS_ATTACHED,
           "Node that the region lies in. Without one, it lies in the node of its force."),
    SWITCH(MOTION, "box", region_box, box, "none", "The region is a box."),
    SWITCH(MOTION, "sphere", region_sphere, sphere, "none", "The region is a sphere."),
    VALUE(MOTION, "falloff", falloff, KILN_METRES, 0, FAR, TIME(98), "0 m",
          "Over so many metres inside of the border the force fades, by 3 t^2 - 2 t^3."),
    END,
};

#undef FILLS
#define FILLS struct kiln_force

/* An option of all forces that are summed up. */
#define REGION                                                                                     \
    SWITCH_AT(IF_REGION, "region", region, region_options, region.enabled, "none",                 \
              "Where the force acts: in a `box` or a `sphere`. Outside of it the force does "      \
              "nothing.")

/* An option of these forces, too. */
#define ATTACHED                                                                                   \
    ATTACH(                                                                                        \
        IF_FORCE_IS_ATTACHED,                                                                      \
        "Node that the force lies in: its places, directions and sizes are in the frame of the "   \
        "node, and move, turn and scale with it. Speeds and accelerations are not scaled, and "    \
        "air does not take up the velocity of the node.")

TABLE(gravity) = {
    VECTOR(MOTION, "acceleration", acceleration, KILN_ACCELERATION, -10000, 10000, LIFE(46),
           "[0, -9.81, 0]",
           "Acceleration of the particles. It points upwards for gas that is lighter than air."),
    ATTACHED,
    REGION,
    END,
};

TABLE(drag) = {
    VALUE(MOTION, "strength", pull, KILN_PER_SECOND, 0, 1000, LIFE(47), "0.5",
          "Linear drag: the deceleration is `strength` times the speed."),
    VALUE(MOTION, "quadratic", quadratic, KILN_PER_METRE, 0, 1000, LIFE(48), "0",
          "Quadratic drag: the deceleration is `quadratic` times the square of the speed. Air "
          "slows all but the smallest and slowest particles this way."),
    ATTACHED,
    REGION,
    END,
};

static const char *const modes[] = {
    [KILN_WIND_PULL] = "pull",
    [KILN_WIND_ADD] = "add",
    NULL,
};

#define MODE                                                                                       \
    CHOICE(                                                                                        \
        MOTION, "mode", mode, modes, "pull",                                                       \
        "`pull` draws particles towards the velocity of the air. `add` adds the velocity of the "  \
        "air in each step, regardless of `pull` (UberFlow 2004, 4.2, equation 1), so that "        \
        "smaller steps accelerate particles more.")

TABLE(wind) = {
    VECTOR(MOTION, "velocity", air, KILN_SPEED, -10000, 10000, LIFE(49), "[1, 0, 0]",
           "Velocity of the air."),
    VALUE(MOTION, "pull", pull, KILN_PER_SECOND, 0, 1000, LIFE(50), "1",
          "How fast particles take up the velocity of the air: `pull` times the difference of "
          "the velocities is their acceleration."),
    MODE,
    ATTACHED,
    REGION,
    END,
};

TABLE(curl) = {
    VALUE(MOTION, "strength", strength, KILN_SPEED, 0, 10000, LIFE(51), "1 m/s",
          "Typical velocity of the air in the eddies."),
    VALUE(MOTION, "scale", scale, KILN_METRES, 0.001, FAR, BIRTH(52), "1 m",
          "Size of the largest eddies. At random, each particle has eddies of its own size."),
    VECTOR(MOTION, "drift", drift, KILN_SPEED, -10000, 10000, TIME(53), "[0, 0, 0]",
           "Velocity at which the whole pattern of eddies moves."),
    VALUE(MOTION, "pull", pull, KILN_PER_SECOND, 0, 1000, LIFE(54), "1",
          "How fast particles take up the velocity of the air: `pull` times the difference of "
          "the velocities is their acceleration."),
    INTEGER(MOTION, "octaves", octaves, 1, 4, "1", "Number of layers of ever smaller eddies."),
    MODE,
    ATTACHED,
    REGION,
    END,
};

TABLE(grid) = {
    {ROW(MOTION, "file", grid, file, NULL,
         "A grid of air velocities. They are interpolated between the points of the grid. Outside "
         "of the grid, the air moves as at the nearest edge.")},
    VALUE(MOTION, "strength", strength, KILN_PLAIN, -1000, 1000, LIFE(55), "1",
          "Factor on the velocities."),
    VALUE(MOTION, "pull", pull, KILN_PER_SECOND, 0, 1000, LIFE(56), "1",
          "How fast particles take up the velocity of the air: `pull` times the difference of "
          "the velocities is their acceleration."),
    MODE,
    ATTACHED,
    REGION,
    END,
};

static const char *const falloffs[] = {
    [KILN_FALLOFF_INVERSE_SQUARE] = "inverse_square",
    [KILN_FALLOFF_INVERSE] = "inverse",
    [KILN_FALLOFF_CONSTANT] = "constant",
    [KILN_FALLOFF_LINEAR] = "linear",
    NULL,
};

TABLE(attract) = {
    VECTOR(MOTION, "position", center, KILN_METRES, -FAR, FAR, TIME(57), "[0, 0, 0]",
           "Point that particles are drawn to."),
    VALUE(MOTION, "strength", strength, KILN_ACCELERATION, -100000, 100000, LIFE(58), "1 m/s^2",
          "Acceleration at a distance of 1 m, before the softening by `radius`. A negative value "
          "pushes particles away."),
    CHOICE(MOTION, "falloff", falloff, falloffs, "inverse_square",
           "How the acceleration falls off with the distance: inverse_square like gravity, "
           "inverse, constant, or linear like a spring."),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0.001, FAR, LIFE(59), "0.1 m",
          "Softening radius (Plummer): at the distance d, the acceleration is strength * d / (d^2 "
          "+ radius^2)^(n/2), with n of 3, 2, 1 or 0 by the falloff. The acceleration is 0 at the "
          "position itself. At a distance of three radii it is 15, 10 or 5 % less than without "
          "softening, for n of 3, 2 or 1."),
    ATTACHED,
    REGION,
    END,
};

static const char *const profiles[] = {
    [KILN_VORTEX_RANKINE] = "rankine",
    [KILN_VORTEX_LAMB_OSEEN] = "lamb_oseen",
    NULL,
};

TABLE(vortex) = {
    VECTOR(MOTION, "position", center, KILN_METRES, -FAR, FAR, TIME(60), "[0, 0, 0]",
           "A point of the axis."),
    VECTOR(MOTION, "axis", axis, KILN_PLAIN, -FAR, FAR, TIME(61), "[0, 1, 0]",
           "Direction of the axis, of any length. The air turns anticlockwise when the axis points "
           "at the viewer."),
    VALUE(MOTION, "speed", speed, KILN_SPEED, -10000, 10000, LIFE(62), "1 m/s",
          "Speed of the air around the axis at the edge of the core, where it is fastest."),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0.001, FAR, LIFE(63), "0.5 m",
          "Radius of the core. Over `height`, it widens or narrows along the axis of a whirlwind."),
    CHOICE(MOTION, "profile", profile, profiles, "rankine",
           "rankine: the core turns like a solid body, and the air outside of it is slower with "
           "the distance. lamb_oseen: the change from core to outside is smooth."),
    VALUE(MOTION, "inward", inward, KILN_SPEED, -10000, 10000, TIME(64), "0 m/s",
          "Speed of the air towards the axis at the edge of the core. It varies with the distance "
          "as `speed` does."),
    VALUE(MOTION, "lift", lift, KILN_SPEED, -10000, 10000, TIME(65), "0 m/s",
          "Speed of the air along the axis, measured on the axis. Half of it is left at the edge "
          "of the core."),
    VALUE(MOTION, "pull", pull, KILN_PER_SECOND, 0, 1000, LIFE(66), "1",
          "How fast particles take up the velocity of the air: `pull` times the difference of "
          "the velocities is their acceleration."),
    MODE,
    ATTACHED,
    REGION,
    END,
};

TABLE(limit) = {
    VALUE(MOTION, "speed", speed, KILN_SPEED, 0, 10000, LIFE(67), "10 m/s",
          "Highest speed. Each step slows faster particles down to it."),
    END,
};

/* ---- baked winds ----------------------------------------------------------------------------- */

/* Drag in a baked wind: what a grid holds is linear. */
TABLE(baked_drag) = {
    VALUE(MOTION, "strength", pull, KILN_PER_SECOND, 0, 1000, LIFE(47), "0.5",
          "Linear drag: the deceleration is `strength` times the speed."),
    ATTACHED,
    REGION,
    END,
};

/* The kinds of force that a grid can hold: all but limits of the speed, and other grids of this
 * kind. */
#define LINEAR_KINDS                                                                               \
    {.name = "gravity",                                                                            \
     .value = KILN_FORCE_GRAVITY,                                                                  \
     MEMBERS(gravity),                                                                             \
     .shortcut = "acceleration"},                                                                  \
        {.name = "drag", .value = KILN_FORCE_DRAG, MEMBERS(baked_drag), .shortcut = "strength"},   \
        {.name = "curl", .value = KILN_FORCE_CURL, MEMBERS(curl), .shortcut = "strength"},         \
        {.name = "attract",                                                                        \
         .value = KILN_FORCE_ATTRACT,                                                              \
         MEMBERS(attract),                                                                         \
         .shortcut = "strength"},                                                                  \
        {.name = "vortex", .value = KILN_FORCE_VORTEX, MEMBERS(vortex), .shortcut = "speed"},      \
        {.name = "wind",                                                                           \
         .variant = "uniform",                                                                     \
         .value = KILN_FORCE_WIND,                                                                 \
         MEMBERS(wind),                                                                            \
         .shortcut = "velocity"},                                                                  \
        {.name = "wind", .variant = "curl", .value = KILN_FORCE_CURL, MEMBERS(curl)},              \
        {.name = "wind", .variant = "vortex", .value = KILN_FORCE_VORTEX, MEMBERS(vortex)},        \
    {                                                                                              \
        .name = "wind", .variant = "grid", .value = KILN_FORCE_FIELD, MEMBERS(grid)                \
    }

KINDS(baked_kinds) = {
    LINEAR_KINDS,
    {.name = NULL},
};

ITEM_OF_KINDS(baked_force, baked_kinds, kind, .name = "force");
const struct kiln_option *const kiln_baked_force = &baked_force;

TABLE(baked_box) = {
    VECTOR(MOTION, "center", box_center, KILN_METRES, -FAR, FAR, 0, "[0, 0, 0]",
           "Centre of the box."),
    VECTOR(MOTION, "size", box_size, KILN_METRES, 0.001, FAR, 0, NULL, "Lengths of the edges."),
    END,
};

TABLE(baked) = {
    {ROW_AT(MOTION, "box", group, 0, NULL,
            "Box that the grid fills. Outside of it, the air moves as at the nearest edge."),
     MEMBERS(baked_box)},
    INTEGER(MOTION, "cells", cells, 1, 256, "32",
            "Cells of the grid along the longest edge of the box; those along the others are about "
            "as long. Between the points, what the forces do is interpolated, so an eddy should be "
            "some cells wide: the error is 17 % where it is 4, 5 % where it is 8."),
    INTEGER(MOTION, "every", every, 1, 1000, "1",
            "Steps from one writing of the grid to the next. In between, the air stays as it was."),
    {ROW(MOTION, "of", of, of, NULL,
         "Forces whose sum is written to the points of the grid. Their values may vary over time "
         "alone, and drag is linear.")},
    ATTACHED,
    REGION,
    END,
};

/* The kinds of force that move gas: those of a grid, and grids. */
KINDS(gas_kinds) = {
    LINEAR_KINDS,
    {.name = "wind", .variant = "baked", .value = KILN_FORCE_BAKED, MEMBERS(baked)},
    {.name = NULL},
};

ITEM_OF_KINDS(gas_force, gas_kinds, kind, .name = "force");
const struct kiln_option *const kiln_force_of_gas = &gas_force;

TABLE(gas) = {
    {ROW(MOTION, "gas", domain, gas, NULL, "Name of the domain of gas.")},
    VALUE(MOTION, "pull", pull, KILN_PER_SECOND, 0, 1000, TIME(100), "2 1/s",
          "How fast particles take up the velocity of the gas: `pull` times the difference of "
          "the velocities is their acceleration."),
    INTEGER(MOTION, "cells", cells, 1, 256, "64",
            "Cells of the grid from which particles read the velocities, along the longest edge of "
            "the domain. Between its points, velocities are interpolated."),
    REGION,
    END,
};

PUBLIC_KINDS(kiln_force_kinds) = {
    {.name = "gravity",
     .value = KILN_FORCE_GRAVITY,
     MEMBERS(gravity),
     .shortcut = "acceleration",
     .help = "The same acceleration everywhere."},
    {.name = "drag",
     .value = KILN_FORCE_DRAG,
     MEMBERS(drag),
     .shortcut = "strength",
     .help = "Slows particles down."},
    {.name = "curl",
     .value = KILN_FORCE_CURL,
     MEMBERS(curl),
     .shortcut = "strength",
     .help = "Turbulent air in which smoke swirls: noise without divergence."},
    {.name = "attract",
     .value = KILN_FORCE_ATTRACT,
     MEMBERS(attract),
     .shortcut = "strength",
     .help = "A point that attracts particles or repels them (Drone 2007, 7.5.1)."},
    {.name = "vortex",
     .value = KILN_FORCE_VORTEX,
     MEMBERS(vortex),
     .shortcut = "speed",
     .help = "Air that turns around an axis: a whirlwind, or water at a drain."},
    {.name = "limit",
     .value = KILN_FORCE_LIMIT,
     MEMBERS(limit),
     .shortcut = "speed",
     .help = "An upper limit of the speed. Of several limits, the lowest counts."},
    {.name = "wind",
     .variant = "uniform",
     .value = KILN_FORCE_WIND,
     MEMBERS(wind),
     .shortcut = "velocity",
     .help = "Air that has the same velocity everywhere."},
    {.name = "wind",
     .variant = "curl",
     .value = KILN_FORCE_CURL,
     MEMBERS(curl),
     .help = "Another way to write the force curl."},
    {.name = "wind",
     .variant = "vortex",
     .value = KILN_FORCE_VORTEX,
     MEMBERS(vortex),
     .help = "Another way to write the force vortex."},
    {.name = "wind",
     .variant = "grid",
     .value = KILN_FORCE_FIELD,
     MEMBERS(grid),
     .help = "Air whose velocities come from a file (UberFlow 2004, 4.2)."},
    {.name = "wind",
     .variant = "baked",
     .value = KILN_FORCE_BAKED,
     MEMBERS(baked),
     .help = "The sum of other forces, written to a grid that particles read (Heinz 2019, 2.2.5). "
             "It costs less than the forces where there are more particles than points."},
    {.name = "wind",
     .variant = "gas",
     .value = KILN_FORCE_GAS,
     MEMBERS(gas),
     .help =
         "The air of a domain of gas, which carries sparks, ash and leaves. Outside of its box, "
         "it does nothing."},
    {.name = NULL},
};

const char *kiln_force_name(const struct kiln_force *force)
{
    const struct kiln_option_kind *kind = kiln_force_kinds;
    while (kind->value != (int)force->kind)
        kind++;
    return kind->name;
}
