/* This file has the option tables of domains of gas: their boxes, sources, fire, forces and looks.
 * scene/gas.h says what the values are; gas_settle.c checks them and settles those that stand for
 * others. option/rows.h and scene/rows.h define the macros of the rows.
 *
 * Values vary over time alone. The numbers by which they draw are those of a domain, which has a
 * noise of its own (KILN_SYSTEM_OF_GAS); the forces have 46 to 67 and 94 to 98 of them. */
#include "scene/rows.h"

#define FILLS struct kiln_gas_source

/* ---- sources --------------------------------------------------------------------------------- */

#define ORIGIN                                                                                     \
    VECTOR(MOTION, "origin", emit.origin, KILN_METRES, -FAR, FAR, TIME(1), "[0, 0, 0]",            \
           "Centre of the shape.")
#define DIRECTION                                                                                  \
    VECTOR(MOTION, "direction", emit.direction, KILN_PLAIN, -FAR, FAR, TIME(2), "[0, 1, 0]",       \
           "Direction that the shape faces, of any length but 0.")
#define RADIUS                                                                                     \
    VALUE(MOTION, "radius", emit.radius, KILN_METRES, 0, FAR, TIME(3), "0.25 m", "Radius.")

TABLE(point) = {
    ORIGIN,
    END,
};

#define SURFACE(where)                                                                             \
    BOOLEAN(MOTION, "surface", emit.surface, "false",                                              \
            "The source is " where " alone, and fades to both sides of it within `reach`.")

TABLE(sphere) = {
    ORIGIN,
    RADIUS,
    SURFACE("the surface"),
    END,
};

TABLE(box) = {
    ORIGIN,
    VECTOR(MOTION, "size", emit.size, KILN_METRES, 0, FAR, TIME(4), "[1, 1, 1]",
           "Lengths of the edges."),
    SURFACE("the six faces"),
    END,
};

TABLE(disc) = {
    ORIGIN, DIRECTION, RADIUS, SURFACE("the rim"), END,
};

TABLE(ring) = {
    ORIGIN,
    DIRECTION,
    RADIUS,
    END,
};

TABLE(cone) = {
    ORIGIN,
    DIRECTION,
    VALUE(MOTION, "angle", emit.angle, KILN_ANGLE, 0, KILN_DEG(180), TIME(43), "15 deg",
          "Largest angle between `direction` and the ways on which `outward` blows the gas."),
    VALUE(MOTION, "radius", emit.radius, KILN_METRES, 0, FAR, TIME(44), "0 m",
          "Radius of the cone's small end, a disc, which is the source. `outward` blows along the "
          "lines from the tip that the cone would have without this disc."),
    END,
};

TABLE(line) = {
    ORIGIN,
    VECTOR(
        MOTION, "span", emit.size, KILN_METRES, -FAR, FAR, TIME(5), "[1, 0, 0]",
        "Vector from one end of the line to the other. The origin is in the middle of the line."),
    END,
};

static const char *const places_on_mesh[] = {
    [KILN_ON_SURFACE] = "surface",
    [KILN_ON_VERTICES] = "vertices",
    [KILN_ON_VOLUME] = "volume",
    NULL,
};

TABLE(mesh) = {
    ORIGIN,
    {ROW(MOTION, "file", mesh, emit.source.file, "none",
         "An OBJ, glTF, GLB, PLY or STL file of triangles, at rest. Without it, there is an "
         "`object`.")},
    {ROW(MOTION, "object", object, emit.source.object, "none",
         "A mesh of the backdrop, in whose frame the shape lies.")},
    CHOICE(MOTION, "on", emit.source.on, places_on_mesh, "surface",
           "`surface` is all triangles, `vertices` the vertices of the file, `volume` the inside "
           "of a closed mesh."),
    VECTOR(MOTION, "rotation", emit.source.rotation, KILN_ANGLE, KILN_DEG(-36000), KILN_DEG(36000),
           0, "[0, 0, 0]", "Rotation of a file about the x, y and z axes, in this order."),
    {ROW(MOTION, "scale", number, emit.source.scale, "1", "Metres in one unit of a file."),
     LIMITS(KILN_PLAIN, 1e-6, 1e6)},
    END,
};

TABLE(image) = {
    ORIGIN,
    {ROW(MOTION, "file", image, emit.source.file, "none",
         "The image. It stands upright around the origin, x to the right and y up. Its pixels "
         "count by their alpha, or by their brightness if all of it is opaque.")},
    {ROW(MOTION, "width", number, emit.source.width, "1 m",
         "Width of the image. Its height follows from its proportions."),
     LIMITS(KILN_METRES, 0.001, FAR)},
    {ROW(MOTION, "threshold", number, emit.source.threshold, "0.5",
         "A pixel whose alpha or brightness is not above this, from 0 to 1, is no part of the "
         "shape."),
     LIMITS(KILN_FRACTION, 0, 1)},
    END,
};

TABLE(path) = {
    ORIGIN,
    {ROW(MOTION, "points", points, emit.source.path.points, NULL,
         "Points that the path goes through smoothly, as that of a node does."),
     LIMITS(KILN_METRES, -FAR, FAR)},
    BOOLEAN(MOTION, "closed", emit.source.path.closed, "false",
            "The path ends at its first point."),
    END,
};

TABLE(particles) = {
    {ROW(MOTION, "name", system, system_name, NULL, "Name of the system.")},
    END,
};

KINDS(shapes) = {
    {.name = "point", .value = KILN_EMITTER_POINT, MEMBERS(point), .help = "One place."},
    {.name = "sphere", .value = KILN_EMITTER_SPHERE, MEMBERS(sphere), .help = "A ball."},
    {.name = "box",
     .value = KILN_EMITTER_BOX,
     MEMBERS(box),
     .help = "A box whose edges lie along the axes."},
    {.name = "disc", .value = KILN_EMITTER_DISC, MEMBERS(disc), .help = "A flat disc."},
    {.name = "ring", .value = KILN_EMITTER_RING, MEMBERS(ring), .help = "The rim of a disc."},
    {.name = "cone",
     .value = KILN_EMITTER_CONE,
     MEMBERS(cone),
     .help = "A nozzle, whose jet widens."},
    {.name = "line", .value = KILN_EMITTER_LINE, MEMBERS(line), .help = "A line."},
    {.name = "mesh",
     .value = KILN_EMITTER_MESH,
     MEMBERS(mesh),
     .help = "A mesh, of a file or of the backdrop."},
    {.name = "image",
     .value = KILN_EMITTER_IMAGE,
     MEMBERS(image),
     .shortcut = "file",
     .help = "The pixels of an image, such as a logo."},
    {.name = "path",
     .value = KILN_EMITTER_PATH,
     MEMBERS(path),
     .help = "A smooth curve through points."},
    {.name = "system",
     .value = KILN_EMITTER_SYSTEM,
     MEMBERS(particles),
     .shortcut = "name",
     .help = "The particles of a system, each of which is a source. A step of the gas has them "
             "where the step before has left them."},
    {.name = NULL},
};

TABLE(source_noise) = {
    VALUE(MOTION, "amount", noise, KILN_FRACTION, 0, 1, TIME(15), "0.5",
          "Part of fuel, temperature, smoke and speed that is missing where the noise is lowest. "
          "0 is an even source."),
    {ROW(MOTION, "size", value, noise_size, "auto",
         "Size of the largest eddies of the noise. `auto` is a 16th of the longest edge of the "
         "domain."),
     LIMITS(KILN_METRES, 0.0001, FAR), .clocks = TIME(16), .special_word = "auto"},
    VALUE(MOTION, "speed", noise_speed, KILN_SPEED, 0, 1000, TIME(17), "0.5 m/s",
          "Speed at which the noise drifts upwards and changes."),
    END,
};

TABLE(source) = {
    KIND(MOTION, "from", shapes, emit.shape, "{point: {}}",
         "The shape of the source, or the system whose particles are sources."),
    {ROW(MOTION, "attach", attach, emit.attach, "none",
         "Node that `from` lies in: its places, directions and sizes are in the node's frame. "
         "Without one, it lies in the node of the domain."),
     .special_word = "none"},
    {ROW(MOTION, "reach", value, reach, "auto",
         "Over so many metres from the shape, or from a particle, the source fades to nothing. "
         "`auto` is a 16th of the longest edge of the domain, or 1.5 cells if that is more."),
     LIMITS(KILN_METRES, 0, FAR), .clocks = TIME(14), .special_word = "auto"},
    VALUE(MOTION, "rate", rate, KILN_PER_SECOND, 0, 10000, TIME(6), "20 1/s",
          "How fast the gas at the source takes on what the source says: after 1/`rate` seconds, "
          "63 % of the difference is gone. 0 1/s turns the source off."),
    VALUE(MOTION, "fuel", fuel, KILN_FRACTION, 0, 1, TIME(7), "1",
          "Part of the gas that is unburnt fuel. Gas that has more keeps it."),
    VALUE(MOTION, "temperature", temperature, KILN_PLAIN, 0, 10, TIME(8), "0.65",
          "Temperature: 0 is that of the air, 1 the hot end of `look.kelvin`. Hotter gas stays "
          "so."),
    VALUE(MOTION, "smoke", smoke, KILN_PLAIN, 0, 1000, TIME(9), "0",
          "Density of the smoke, of which `look.extinction` says how dark it is. Denser smoke "
          "stays so."),
    {ROW(MOTION, "color", color, color, "albedo",
         "Colour of the smoke. `albedo` is that of the look. Where one source of a domain has a "
         "colour, all smoke of it carries one, which takes a quarter more memory."),
     LIMITS(KILN_PLAIN, 0, 1), .clocks = TIME(10), .special_word = "albedo"},
    VECTOR(MOTION, "velocity", velocity, KILN_SPEED, -1000, 1000, TIME(11), "[0, 0, 0]",
           "Velocity that the gas takes on. Where `velocity`, `outward` and `inherit` are 0, the "
           "source leaves velocities as they are."),
    VALUE(MOTION, "outward", outward, KILN_SPEED, -1000, 1000, TIME(12), "0 m/s",
          "Speed away from the origin of the shape, or from the particle, that is added to "
          "`velocity`. Of a cone, it is the speed along the lines of its jet."),
    VALUE(MOTION, "inherit", inherit, KILN_FRACTION, 0, 1, TIME(13), "0",
          "Fraction of the velocity of the shape, or of the particle, that is added, too."),
    GROUP(MOTION, "noise", source_noise, "Noise that breaks up the source."),
    END,
};

ITEM_OF_ROWS(gas_source, source);

/* ---- fire and look --------------------------------------------------------------------------- */

#undef FILLS
#define FILLS struct kiln_gas_burn

TABLE(burn) = {
    VALUE(MOTION, "ignition", ignition, KILN_PLAIN, 0, 10, TIME(18), "0.25",
          "Temperature from which fuel burns."),
    VALUE(MOTION, "rate", rate, KILN_PER_SECOND, 0, 1000, TIME(19), "3.5 1/s",
          "How fast hot fuel burns: after 1/`rate` seconds, 63 % of it is gone."),
    VALUE(MOTION, "heat", heat, KILN_PLAIN, 0, 100, TIME(20), "2",
          "Temperature that a cell full of fuel adds as it burns."),
    VALUE(MOTION, "soot", soot, KILN_PLAIN, 0, 1000, TIME(21), "0.12",
          "Smoke that a cell full of fuel leaves."),
    VALUE(MOTION, "expand", expand, KILN_PLAIN, 0, 1000, TIME(22), "1",
          "Volumes of gas that a volume of fuel adds as it burns. Little makes a quiet fire, 20 an "
          "explosion."),
    VALUE(MOTION, "life", life, KILN_SECONDS, 0.001, 1000, TIME(23), "0.5 s",
          "How long a flame glows behind the fuel that has burnt."),
    VALUE(MOTION, "gain", gain, KILN_SECONDS, 0.0001, 1000, TIME(24), "0.094 s",
          "A cell that burns as fast as a full one for so long is a whole flame."),
    VALUE(MOTION, "clear", clear, KILN_PER_SECOND, 0, 1000, TIME(25), "2 1/s",
          "Rate at which smoke burns in a whole flame."),
    END,
};

#undef FILLS
#define FILLS struct kiln_gas_turbulence

TABLE(turbulence) = {
    VALUE(MOTION, "strength", strength, KILN_ACCELERATION, 0, 10000, TIME(32), "9 m/s^2",
          "Typical acceleration of gas by the noise."),
    {ROW(MOTION, "size", value, size, "auto",
         "Size of its largest eddies. `auto` is a tenth of the longest edge of the domain."),
     LIMITS(KILN_METRES, 0.0001, FAR), .clocks = TIME(33), .special_word = "auto"},
    VALUE(MOTION, "speed", speed, KILN_SPEED, 0, 1000, TIME(34), "0.5 m/s",
          "Speed at which the noise rises."),
    INTEGER(MOTION, "octaves", octaves, 1, 4, "3", "Number of layers of ever smaller eddies."),
    END,
};

#undef FILLS
#define FILLS struct kiln_gas_look

static const char *const resolutions[] = {
    [KILN_GAS_FULL] = "full",
    [KILN_GAS_HALF] = "half",
    NULL,
};

TABLE(gas_look) = {
    VALUE(LOOK, "extinction", extinction, KILN_PER_METRE, 0, 100000, TIME(36), "4 1/m",
          "Light that smoke of density 1 takes away: after 1/`extinction` metres, 37 % is left."),
    COLOR(LOOK, "albedo", albedo, 1, TIME(37), "0.5",
          "Part of that light that smoke scatters instead of absorbing it: soot is dark, steam is "
          "0.95. It is the colour of smoke in white light."),
    VALUE(LOOK, "scattering", scattering, KILN_PLAIN, -0.99, 0.99, TIME(38), "0.5",
          "Where smoke scatters light to (g of Henyey and Greenstein): 0 is all directions alike, "
          "towards 1 is ahead, so that smoke before the sun has bright edges."),
    RANGE(LOOK, "kelvin", kelvins, KILN_KELVIN, 0, 20000, TIME(39), "[600, 2050]",
          "Temperatures of black bodies whose colours flames have at temperature 0 and 1."),
    VALUE(LOOK, "intensity", intensity, KILN_PLAIN, 0, 1000000, TIME(40), "85",
          "Light of a metre of whole flame at temperature 1. 0 makes flames dark."),
    VALUE(LOOK, "absorption", absorption, KILN_PER_METRE, 0, 100000, TIME(41), "4 1/m",
          "Light that whole flames take away. Fire is transparent where it is 0."),
    VALUE(LOOK, "bloom", bloom, KILN_FRACTION, 0, 100, TIME(42), "0.18",
          "Part of the light of flames that goes to the bloom."),
    VALUE(LOOK, "glow", glow, KILN_PLAIN, 0, 1000, TIME(92), "1",
          "Factor on the light of flames in their own smoke. 0: they do not light it."),
    VALUE(LOOK, "light", light, KILN_PLAIN, 0, 1000, TIME(93), "5",
          "Factor on the light of flames on floor, objects and particles. 0: they light nothing."),
    BOOLEAN(LOOK, "lights", lights, "true", "Sun, sky and lamps light the smoke."),
    BOOLEAN(LOOK, "shadow", shadow, "true", "Gas throws shadows on floor, objects and particles."),
    CHOICE(LOOK, "resolution", resolution, resolutions, "half",
           "Pixels through which rays march. full: all of them. half: every second one of every "
           "second row, and all where the light of gas, or the depth of the scene, changes within "
           "few pixels; the others take the light of their neighbours. It is faster, and keeps "
           "edges."),
    END,
};

/* ---- domains --------------------------------------------------------------------------------- */

#undef FILLS
#define FILLS struct kiln_gas_domain

TABLE(domain_box) = {
    {ROW(MOTION, "center", vector, center, "auto",
         "Centre of the box. `auto` lets the box stand on y = 0, with the origin in the middle of "
         "its bottom."),
     LIMITS(KILN_METRES, -FAR, FAR), .special_word = "auto"},
    VECTOR(MOTION, "size", size, KILN_METRES, 0.001, FAR, 0, NULL,
           "Lengths of the edges. Each has a multiple of 16 cells: the box grows to whole ones, at "
           "its top, and on all four sides alike."),
    END,
};

static const char *const side_words[] = {
    [KILN_SIDE_OPEN] = "open",
    [KILN_SIDE_CLOSED] = "closed",
    NULL,
};

#define SIDE(name, number, def, where)                                                             \
    CHOICE(MOTION, name, sides[number], side_words, def,                                           \
           where " `open` lets gas and air through, `closed` is a wall.")

TABLE(sides) = {
    SIDE("left", 0, "open", "The side at the least x."),
    SIDE("right", 1, "open", "The side at the greatest x."),
    SIDE("bottom", 2, "closed", "The side at the least y."),
    SIDE("top", 3, "open", "The side at the greatest y."),
    SIDE("back", 4, "open", "The side at the least z."),
    SIDE("front", 5, "open", "The side at the greatest z."),
    END,
};

TABLE(cooling) = {
    VALUE(MOTION, "glow", cool_glow, KILN_PER_SECOND, 0, 1000, TIME(28), "0.6 1/s",
          "Rate of cooling by light at temperature 1; it goes by the fourth power of the "
          "temperature."),
    VALUE(MOTION, "even", cool_even, KILN_PER_SECOND, 0, 1000, TIME(29), "0.25 1/s",
          "Temperature that gas loses a second, however hot it is."),
    END,
};

TABLE(pressure) = {
    INTEGER(MOTION, "cycles", cycles, 1, 16, "2",
            "Cycles of multigrid by which a step finds the pressure. More leave less divergence, "
            "so smoke keeps its volume better."),
    {ROW(MOTION, "residual", number, residual, "0",
         "Part of the divergence that a step may leave. It takes more cycles where it must, and a "
         "warning says once if that is not enough. 0 takes what `cycles` leave."),
     LIMITS(KILN_FRACTION, 0, 1)},
    END,
};

PUBLIC_TABLE(kiln_options_gas) = {
    RESOLVED(MOTION, use, "use",
             "Another domain, whose keys but `enabled` this one has where it does not have its "
             "own."),
    BOOLEAN(MOTION, "enabled", enabled, "true", "A domain that is not enabled has no gas."),
    ATTACH(MOTION, "Node that the domain lies in: its box, sources and directions are in the frame "
                   "of the node, and move and turn with it. Gas keeps its velocity in the world."),
    {ROW_AT(MOTION, "box", group, 0, NULL, "Box in which gas flows. Gas that leaves it is gone."),
     MEMBERS(domain_box)},
    {ROW(MOTION, "cell", number, cell, "0 m",
         "Edge of a cell: half of it makes the gas twice as fine, and takes eight times the memory "
         "and up to sixteen times the time. With 0 m, `cells` counts."),
     LIMITS(KILN_METRES, 0, 1000)},
    {ROW(MOTION, "cells", integer, cell_count, "auto",
         "Cells along the longest edge of the box, instead of `cell`, rounded up to a multiple of "
         "16. `auto` is 128, or as many as `cell` makes."),
     LIMITS(KILN_PLAIN, KILN_GAS_STRIDE, KILN_MAX_GAS_EDGE), .special_word = "auto"},
    GROUP(MOTION, "sides", sides, "What the six sides of the box are."),
    {ROW(MOTION, "rate", number, rate, "0",
         "Least number of steps of the gas a second, where that is more than simulation.rate. With "
         "0, a step of the scene is one of the gas, or more where `substeps` or the speed of the "
         "gas say so."),
     LIMITS(KILN_PLAIN, 0, 100000)},
    {ROW(MOTION, "substeps", integer, substeps_given, "auto",
         "Steps of the gas in each step of the scene. `auto` takes as many as it needs for gas to "
         "move 2 cells at most in one, up to 16. Gas that would move farther is held back."),
     LIMITS(KILN_PLAIN, 1, KILN_MAX_SUBSTEPS), .special_word = "auto"},
    LIST(MOTION, "sources", sources, gas_source, source_count, "[]",
         "What gives the gas its fuel, heat, smoke and speed."),
    SWITCH_AT(MOTION, "burn", burn, burn, burn.enabled, "{}",
              "How fuel burns. With none, it does not."),
    VALUE(MOTION, "buoyancy", buoyancy, KILN_ACCELERATION, -1000, 1000, TIME(26), "9 m/s^2",
          "Upward acceleration of gas at temperature 1. It acts along y of the world."),
    VALUE(MOTION, "smoke_weight", weight, KILN_ACCELERATION, -1000, 1000, TIME(27), "0 m/s^2",
          "Downward acceleration of gas with smoke of density 1."),
    GROUP(MOTION, "cooling", cooling, "How gas loses its heat."),
    VALUE(MOTION, "decay", decay, KILN_PER_SECOND, 0, 1000, TIME(30), "0.6 1/s",
          "Rate at which smoke fades: after 1/`decay` seconds, 37 % is left. With 0, it stays."),
    VALUE(MOTION, "vorticity", vorticity, KILN_PLAIN, 0, 2, TIME(31), "0.5",
          "Strength of vorticity confinement, which keeps small eddies turning. 0 is none, 1 is "
          "wild."),
    GROUP_AT(MOTION, "turbulence", turbulence, turbulence,
             "Noise that stirs the gas, where there is gas."),
    VALUE(MOTION, "drag", drag, KILN_PER_SECOND, 0, 1000, TIME(35), "0.05 1/s",
          "Rate at which gas slows down."),
    {ROW_AT(MOTION, "forces", forces, OFFSET_OF_ARRAY(forces, kiln_force_kinds), "[]",
            "Forces that accelerate the gas: those that a baked wind may have, and baked winds. "
            "Their values vary over time alone."),
     .item_size = sizeof(struct kiln_force), COUNTED(forces, force_count)},
    BOOLEAN(MOTION, "collide", collide, "true",
            "Gas flows around the objects and the floor that particles collide with."),
    GROUP(MOTION, "pressure", pressure, "How exactly the pressure is found."),
    INTEGER(
        OF_DETAIL, "detail", detail, 1, 4, "1",
        "Factor on the drawn resolution, 1, 2 or 4: edges are drawn steeper than the cells have "
        "them, and torn by finer noise, which moves with the gas. It costs time of drawing, "
        "and memory, but no steps."),
    GROUP_AT(LOOK, "look", look, gas_look, "What the gas looks like."),
    END,
};
