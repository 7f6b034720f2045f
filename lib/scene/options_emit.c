/* This file has the option tables of a particle system: how its particles are born (Heinz 2019,
 * 2.1.2), collide, paint and die. Tables for its look, its forces and its interactions are in
 * options_look.c, options_forces.c and options_interact.c. option/rows.h and scene/rows.h define
 * the macros of the rows; FILLS is the struct that the next tables fill. */
#include "scene/rows.h"

#define FILLS struct kiln_burst

TABLE(burst_options) = {
    {ROW(MOTION, "at", number, time_s, "0 s", "Clip time of the burst."),
     LIMITS(KILN_SECONDS, -100000, 1000000), .is_of_clip = true},
    {ROW(MOTION, "count", counts, count, NULL,
         "Number of particles. Of two numbers, each repetition draws its own between them."),
     LIMITS(KILN_PLAIN, 0, KILN_MAX_PARTICLES)},
    {ROW(MOTION, "every", number, every_s, "0 s",
         "The burst is repeated every so often, at least 1 ms apart. With 0 s it is not repeated."),
     LIMITS(KILN_SECONDS, 0, 1000000)},
    {ROW(MOTION, "most", integer, most, "none",
         "The most repetitions, the first one included. With none, they go on to the end of the "
         "clip."),
     LIMITS(KILN_PLAIN, 1, 1000000), .special_word = "none"},
    {ROW(MOTION, "jitter", number, jitter_s, "0 s",
         "Each repetition comes later by a time that is drawn, of 0 s to this. At most `every`, if "
         "the burst is repeated."),
     LIMITS(KILN_SECONDS, 0, 1000000)},
    END,
};

ITEM_OF_ROWS(burst, burst_options);

#undef FILLS
#define FILLS struct kiln_emitter

/* Options that every shape has. `spread` is the default of `angle`, and `towards` of `direction`.
 */
#define PLACE(spread) PLACE_TO(spread, "[0, 1, 0]")
#define PLACE_TO(spread, towards)                                                                  \
    VECTOR(MOTION, "origin", origin, KILN_METRES, -FAR, FAR, BIRTH(1), "[0, 0, 0]",                \
           "Centre of the shape. When it moves, births are spread along its way."),                \
        VECTOR(MOTION, "direction", direction, KILN_PLAIN, -FAR, FAR, BIRTH(2), towards,           \
               "Mean direction in which particles start, of any length but 0."),                   \
        VALUE(MOTION, "angle", angle, KILN_ANGLE, 0, KILN_DEG(180), BIRTH(3), spread,              \
              "Largest angle between a particle's direction and the mean direction.")

#define TURN                                                                                       \
    VALUE(MOTION, "turn", turn, KILN_ANGULAR_SPEED, KILN_DEG(-36000), KILN_DEG(36000), BIRTH(4),   \
          "0 deg/s",                                                                               \
          "Angular speed at which the shape turns about its direction. Particles get the "         \
          "velocity that the turning shape has where they are born.")

#define ORDERED                                                                                    \
    BOOLEAN(IF_ORDERED, "ordered", ordered, "false",                                               \
            "true puts the particles of a burst at equal distances in the order of their births, " \
            "from one end to the other, instead of at random. Those of `rate` stay at random.")

TABLE(point) = {
    PLACE("0 deg"),
    END,
};

TABLE(sphere) = {
    PLACE("0 deg"),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0, FAR, BIRTH(5), "0.1 m", "Radius."),
    BOOLEAN(MOTION, "outward", outward, "false",
            "Particles start away from the origin instead of along the direction."),
    BOOLEAN(MOTION, "surface", surface, "false", "Particles are born on the surface only."),
    TURN,
    END,
};

TABLE(box) = {
    PLACE("0 deg"),
    VECTOR(MOTION, "size", size, KILN_METRES, 0, FAR, BIRTH(6), "[1, 1, 1]",
           "Lengths of the edges."),
    BOOLEAN(MOTION, "surface", surface, "false", "Particles are born on the six faces only."),
    TURN,
    END,
};

TABLE(disc) = {
    PLACE("0 deg"),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0, FAR, BIRTH(7), "0.5 m",
          "Radius of the disc, which faces the direction."),
    BOOLEAN(MOTION, "surface", surface, "false", "Particles are born on the rim only."),
    TURN,
    END,
};

TABLE(ring) = {
    PLACE("0 deg"),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0, FAR, BIRTH(8), "0.5 m",
          "Radius of the ring, which faces the direction."),
    TURN,
    ORDERED,
    END,
};

TABLE(cone) = {
    PLACE("15 deg"),
    VALUE(
        MOTION, "radius", radius, KILN_METRES, 0, FAR, BIRTH(9), "0 m",
        "Radius of the cone's small end, a disc in which particles are born. They start along the "
        "lines from the tip that the cone would have without this disc."),
    END,
};

TABLE(line) = {
    PLACE("0 deg"),
    VECTOR(
        MOTION, "span", size, KILN_METRES, -FAR, FAR, BIRTH(10), "[1, 0, 0]",
        "Vector from one end of the line to the other. The origin is in the middle of the line."),
    INTEGER(
        MOTION, "nozzles", nozzles, 0, 65536, "0",
        "Number of nozzles at which particles are born in turn. The line is divided into as many "
        "equal parts, with a nozzle in the middle of each. With 0, particles are born anywhere on "
        "the line."),
    TURN,
    ORDERED,
    END,
};

static const char *const places_on_mesh[] = {
    [KILN_ON_SURFACE] = "surface",
    [KILN_ON_VERTICES] = "vertices",
    [KILN_ON_VOLUME] = "volume",
    NULL,
};

TABLE(mesh) = {
    PLACE("0 deg"),
    {ROW(MOTION, "file", mesh, source.file, "none",
         "An OBJ, glTF, GLB, PLY or STL file of triangles, at rest. Without it, there is an "
         "`object`.")},
    {ROW(MOTION, "object", object, source.object, "none",
         "A mesh of the backdrop, by its name or its number, in whose frame the shape lies. Births "
         "are spread along its way, and `inherit` is of its velocity there.")},
    CHOICE(MOTION, "on", source.on, places_on_mesh, "surface",
           "`surface` is all triangles, by their areas. `vertices` is the vertices of the file, "
           "all of which are as likely. `volume` is the inside of a closed mesh."),
    BOOLEAN(MOTION, "outward", outward, "true",
            "The mean direction of a particle is that of the surface where it is born, or of the "
            "normal of the vertex, instead of `direction`. It counts for nothing in a volume."),
    VECTOR(MOTION, "rotation", source.rotation, KILN_ANGLE, KILN_DEG(-36000), KILN_DEG(36000), 0,
           "[0, 0, 0]",
           "Rotation of a file about the x, y and z axes, in this order. An object has its own."),
    {ROW(MOTION, "scale", number, source.scale, "1",
         "Metres in one unit of a file. An object has its own."),
     LIMITS(KILN_PLAIN, 1e-6, 1e6)},
    END,
};

TABLE(image) = {
    PLACE_TO("0 deg", "[0, 0, 1]"),
    {ROW(MOTION, "file", image, source.file, "none",
         "The image. It stands upright around the origin, x to the right and y up. Particles are "
         "born on its pixels, by their alpha, or by their brightness if all of it is opaque: a "
         "pixel that has twice as much gets twice as many.")},
    {ROW(MOTION, "width", number, source.width, "1 m",
         "Width of the image. Its height follows from its proportions."),
     LIMITS(KILN_METRES, 0.001, FAR)},
    {ROW(MOTION, "threshold", number, source.threshold, "0.5",
         "No particle is born on a pixel whose alpha or brightness is not above this, which is "
         "from 0 to 1."),
     LIMITS(KILN_FRACTION, 0, 1)},
    TURN,
    END,
};

TABLE(path) = {
    PLACE("0 deg"),
    {ROW(MOTION, "points", points, source.path.points, NULL,
         "Points that the path goes through smoothly, as that of a node does. Particles are born "
         "all along its length alike."),
     LIMITS(KILN_METRES, -FAR, FAR)},
    BOOLEAN(MOTION, "closed", source.path.closed, "false", "The path ends at its first point."),
    TURN,
    ORDERED,
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
    {.name = "line",
     .value = KILN_EMITTER_LINE,
     MEMBERS(line),
     .help = "A line, or a rake of nozzles, whose smoke shows how air flows."},
    {.name = "mesh",
     .value = KILN_EMITTER_MESH,
     MEMBERS(mesh),
     .help = "The surface of a mesh, of a file or of the backdrop."},
    {.name = "image",
     .value = KILN_EMITTER_IMAGE,
     MEMBERS(image),
     .shortcut = "file",
     .help = "The pixels of an image, such as a logo."},
    {.name = "path",
     .value = KILN_EMITTER_PATH,
     MEMBERS(path),
     .help = "A smooth curve through points."},
    {.name = NULL},
};

static const char *const aligns[] = {
    [KILN_ALIGN_WORLD] = "world",
    [KILN_ALIGN_VELOCITY] = "velocity",
    [KILN_ALIGN_NORMAL] = "normal",
    NULL,
};

/* With 65536 children each, the children of 512 particles fit into KILN_MAX_PARTICLES slots. */
#define COUNT                                                                                      \
    {                                                                                              \
        ROW(MOTION, "count", counts, parent.count, "10",                                           \
            "Number of particles born at the event of one particle of the parent. Of two "         \
            "numbers, each particle of the parent draws its own between them."),                   \
            LIMITS(KILN_PLAIN, 1, 65536)                                                           \
    }
#define ALIGN(words, help_of_others)                                                               \
    CHOICE(MOTION, "align", parent.align, words, "world",                                          \
           "Direction of the y axis of `from`. `world` points it up. " help_of_others)
#define TO_VELOCITY "`velocity` turns it to the velocity of the parent's particle."

static const char *const aligns_in_flight[] = {
    [KILN_ALIGN_WORLD] = "world",
    [KILN_ALIGN_VELOCITY] = "velocity",
    NULL,
};

TABLE(death) = {
    COUNT,
    ALIGN(aligns_in_flight, TO_VELOCITY),
    BOOLEAN(IF_IMPACTS_COUNT, "impact", parent.impact, "false",
            "A death at an impact counts as well (`collide.then`)."),
    END,
};

TABLE(bounce) = {
    COUNT,
    BOOLEAN(
        IF_EACH_BOUNCE, "every", parent.every, "false",
        "Particles are born at each impact, up to `most`. Each draws its own count. At most one "
        "impact counts in a step; a particle that lies on a surface has one in each."),
    INTEGER(IF_EACH_BOUNCE, "most", parent.hits, 1, 1000, "3",
            "With `every`: the number of impacts of one particle that give birth."),
    ALIGN(aligns, "`velocity` turns it to the velocity of the parent's particle after the bounce. "
                  "`normal` turns it away from the surface."),
    END,
};

TABLE(trail) = {
    VALUE(MOTION, "rate", parent.rate, KILN_PER_SECOND, 0, 1e6, SUMMED(11), "20",
          "Particles born a second while a particle of the parent lives. `life` and `random` are "
          "those of the parent's particle."),
    {ROW(IF_BY_METRE, "per_metre", number, parent.per_metre, "0 1/m",
         "Particles born a metre of the way of a particle of the parent, at even distances, "
         "instead of `rate`. With 0, the rate counts."),
     LIMITS(KILN_PER_METRE, 0, 100000)},
    INTEGER(IF_BY_METRE, "most", parent.most, 1, 65536, "256",
            "With `per_metre`: the most particles born of one particle of the parent."),
    ALIGN(aligns_in_flight, TO_VELOCITY),
    END,
};

KINDS(events) = {
    {.name = "death",
     .value = KILN_EVENT_DEATH,
     MEMBERS(death),
     .shortcut = "count",
     .help = "Particles are born when a particle of the parent reaches the end of its life. A "
             "death by bounds or by a demitter does not count, nor one at an impact without "
             "`impact`."},
    {.name = "bounce",
     .value = KILN_EVENT_BOUNCE,
     MEMBERS(bounce),
     .shortcut = "count",
     .help =
         "Particles are born when a particle of the parent first meets a surface, or with `every` "
         "each time. They inherit its velocity after the bounce."},
    {.name = "trail",
     .value = KILN_EVENT_TRAIL,
     MEMBERS(trail),
     .shortcut = "rate",
     .help = "Particles are born all along the way of a particle of the parent: by the rate, the "
             "first one where it is born, and by the metre, when it has gone the first distance."},
    {.name = NULL},
};

#define OF_PARENT(name, field, help)                                                               \
    BOOLEAN(IF_LOOKS_ARE_INHERITED, name, parent.look.field, "false", help)

TABLE(inherited) = {
    OF_PARENT("color", color,
              "Particles have the parent's `look.color` of the moment of their birth instead of "
              "their own."),
    OF_PARENT("size", size,
              "Particles have the parent's `look.size` of the moment of their birth instead of "
              "their own; `look.scale` multiplies it."),
    OF_PARENT("temperature", temperature,
              "Particles have the parent's `look.temperature` of the moment of their birth instead "
              "of their own."),
    END,
};

TABLE(parent) = {
    {ROW(MOTION, "system", name, parent.name, NULL,
         "Name of the system whose particles give birth to these.")},
    KIND(MOTION, "on", events, parent.event, "{death: {}}",
         "The event at which particles are born, and how many are born."),
    GROUP(IF_LOOKS_ARE_INHERITED, "inherit", inherited,
          "What particles have of the look of the parent's particle. Those values of the parent "
          "may vary over life, age and random numbers."),
    END,
};

TABLE(emit_options) = {
    SWITCH(MOTION, "parent", parent, parent.enabled, "none",
           "The particles are born of another system's particles, not by `rate` and `bursts`. The "
           "shape `from` then lies around the parent's particle."),
    VALUE(MOTION, "rate", rate, KILN_PER_SECOND, 0, 1e7, TIME(12), "0", "Particles born a second."),
    {ROW(IF_EMITTED_BY_METRE, "per_metre", number, per_metre, "0 1/m",
         "Particles born a metre of the way of the origin of `from`, at even distances, beside "
         "those of `rate`. The origin moves if it has keys, by the node that it is attached to, or "
         "by the `object` in whose frame it lies."),
     LIMITS(KILN_PER_METRE, 0, 100000)},
    {ROW(MOTION, "bursts", bursts, bursts, "{}",
         "Particles that are born at once: a map of clip times, in seconds, to their numbers, or a "
         "list of bursts that may be repeated. The frame at 0 s shows those of 0 s, at age 0; "
         "another frame shows the bursts before its time. A step has at most 64 bursts."),
     LIMITS(KILN_PLAIN, 0, KILN_MAX_PARTICLES), .item = &burst,
     .item_size = sizeof(struct kiln_burst), COUNTED(bursts, burst_count)},
    RANGE(MOTION, "life", life, KILN_SECONDS, 0.001, 10000, BIRTH(13), "1 s",
          "How long a particle lives. The value is drawn at its birth."),
    RANGE(MOTION, "speed", speed, KILN_SPEED, 0, 10000, BIRTH(14), "1 m/s",
          "Speed of a particle along its direction. The value is drawn at its birth."),
    KIND(MOTION, "from", shapes, shape, "{point: {}}",
         "The shape in which particles are born, and the directions in which they start."),
    ATTACH(IF_EMITTER_IS_ATTACHED,
           "Node that `from` lies in: its place, directions and sizes are in the node's frame. "
           "Births are spread along the node's way. Speeds stay those of the world."),
    VALUE(MOTION, "inherit", inherit, KILN_FRACTION, 0, 1, BIRTH(15), "0",
          "Fraction of the velocity of the emitter, or of the parent's particle, that a particle "
          "gets at its birth."),
    END,
};

#undef FILLS
#define FILLS struct kiln_collide

static const char *const collide_modes[] = {
    [KILN_COLLIDE_SWEPT] = "swept",
    [KILN_COLLIDE_CLAMP] = "clamp",
    NULL,
};

static const char *const thens[] = {
    [KILN_THEN_BOUNCE] = "bounce",
    [KILN_THEN_DIE] = "die",
    [KILN_THEN_STOP] = "stop",
    [KILN_THEN_STICK] = "stick",
    NULL,
};

TABLE(collide_options) = {
    CHOICE(
        MOTION, "mode", mode, collide_modes, "swept",
        "`swept` finds the point of impact on the way of a particle. `clamp` moves a particle that "
        "is inside an object to the nearest face."),
    VALUE(MOTION, "randomness", randomness, KILN_FRACTION, 0, 1, LIFE(16), "0",
          "0 reflects a particle like a mirror. 1 sends it into any direction away from the "
          "surface."),
    VALUE(
        MOTION, "slowdown", slowdown, KILN_FRACTION, 0, 1, LIFE(17), "0.5",
        "Factor on the speed at each impact, applied after restitution, friction and randomness. 1 "
        "keeps the speed, 0 stops the particle."),
    VALUE(
        MOTION, "restitution", restitution, KILN_FRACTION, 0, 1, LIFE(18), "1",
        "Fraction of the speed towards a surface that a particle keeps when it bounces. It counts "
        "before `randomness` turns the velocity."),
    VALUE(MOTION, "friction", friction, KILN_PLAIN, 0, 100, LIFE(19), "0",
          "Coulomb's coefficient of friction. An impact reduces the speed along the surface by at "
          "most this factor times the change of the speed towards the surface."),
    BOOLEAN(MOTION, "dies", dies, "false",
            "A particle ends at its first impact, like rain: another way to write `then: die`."),
    CHOICE(
        IF_STOPS, "then", then, thens, "bounce",
        "What an impact does. `bounce` lets a particle bounce. `die` ends it. `stop` lets it rest "
        "where it hit, without forces, until its life ends; it stays there also if the object "
        "moves on. `stick` is the same, but the particle rides an object that moves or turns."),
    VALUE(IF_NOT_CERTAIN, "chance", chance, KILN_FRACTION, 0, 1, LIFE(99), "1",
          "Chance of the first impact in a step to do what `then` says. Otherwise the particle "
          "bounces."),
    END,
};

#undef FILLS
#define FILLS struct kiln_painting

static const char *const paint_times[] = {
    [KILN_PAINT_IMPACT] = "impact",
    [KILN_PAINT_NEAR] = "near",
    NULL,
};

TABLE(paint_options) = {
    CHOICE(MOTION, "when", when, paint_times, "impact",
           "`impact` paints in each step where a particle bounces or ends. `near` paints all "
           "surface within the radius of a particle at the end of each step."),
    RANGE(MOTION, "radius", radius, KILN_METRES, 0.0001, 1000, BIRTH(20), "3 cm",
          "Radius of the splat that a particle paints, drawn once for each particle."),
    VALUE(MOTION, "opacity", opacity, KILN_FRACTION, 0, 1, LIFE(21), "1",
          "Opacity in the middle of a splat."),
    VALUE(MOTION, "soft", soft, KILN_FRACTION, 0, 1, LIFE(22), "0.3",
          "Outer part of a splat's radius over which the splat fades."),
    END,
};

#undef FILLS
#define FILLS struct kiln_system

ITEM(demitter, demitter, .name = "demitter", LIMITS(KILN_METRES, -FAR, FAR));
ITEM_OF_KINDS(force, kiln_force_kinds, kind, .name = "force");
ITEM_OF_KINDS(interaction, kiln_interaction_kinds, kind, .name = "interaction");

PUBLIC_TABLE(kiln_options_system) = {
    RESOLVED(MOTION, use, "use",
             "Another system, whose keys but `enabled` this one has where it does not have its "
             "own."),
    BOOLEAN(MOTION, "enabled", enabled, "true", "A system that is not enabled has no particles."),
    {ROW(IF_SEED_IS_PINNED, "seed", integer, seed, "auto",
         "Number of the system in all that is drawn at random for its particles. `auto` is its "
         "place: 0 for the first system of the scene, also where systems before it are not "
         "enabled. With a number of its own, a system stays as it is when others are put before "
         "it. Two systems of one number draw the same."),
     LIMITS(KILN_PLAIN, 0, KILN_MAX_SYSTEM_SEED), .special_word = "auto"},
    GROUP_AT(MOTION, "emit", emit, emit_options, "How particles are born."),
    {ROW(IF_SPACE_IS_OF_NODE, "space", attach, space, "none",
         "Node that the particles move with: in each step they are carried as the node moves and "
         "turns, and meet colliders on their way. Their velocities are those within the node. All "
         "else acts in the world."),
     .special_word = "none"},
    LIST(MOTION, "forces", forces, force, force_count, "[]",
         "Forces that accelerate the particles. Their accelerations are added up."),
    SWITCH_AT(MOTION, "collide", collide, collide_options, collide.enabled, "none",
              "How particles bounce off the objects and the floor."),
    LIST(MOTION, "interact", interactions, interaction, interaction_count, "[]",
         "What the particles of the system do to each other."),
    SWITCH_AT(
        MOTION, "paint", paint, paint_options, paint.enabled, "none",
        "Particles leave the colour of their look on meshes that take paint (Drone 2007, 7.6.1)."),
    LIST(MOTION, "demitters", demitters, demitter, demitter_count, "[]",
         "Boxes in which particles die. With `attach: NODE`, a box lies in the frame of a node."),
    BOUNDS(MOTION, "bounds", bounds, "none", "A box outside of which particles die."),
    GROUP_AT(MOTION, "look", look, kiln_options_look, "What the particles look like."),
    END,
};
