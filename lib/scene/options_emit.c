/* This file has the option tables of a system and of how its particles are born (Heinz
 * 2019, 2.1.2). */
#include "scene/rows.h"

#define AT(field) offsetof(struct kiln_emitter, field)

/* Members of every shape; the default spread of the directions differs. */
#define PLACE(spread)                                                                              \
    VECTOR(MOTION, "origin", origin, KILN_METRES, -FAR, FAR, TIME, "[0, 0, 0]",                    \
           "Centre of the shape; when it moves, births are spread along the way."),                \
        VECTOR(MOTION, "direction", direction, KILN_PLAIN, -FAR, FAR, TIME, "[0, 1, 0]",           \
               "Middle of the directions; of any length but 0."),                                  \
        VALUE(MOTION, "angle", angle, KILN_ANGLE, 0, KILN_DEG(180), TIME, spread,                  \
              "Largest angle between a particle's direction and the middle one.")

#define TURN                                                                                       \
    VALUE(MOTION, "turn", turn, KILN_ANGULAR_SPEED, KILN_DEG(-36000), KILN_DEG(36000), TIME,       \
          "0 deg/s",                                                                               \
          "The shape turns about its direction; particles get the velocity of their place.")

static const struct kiln_option point[] = {
    PLACE("0 deg"),
    END,
};

static const struct kiln_option sphere[] = {
    PLACE("0 deg"),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0, FAR, TIME, "0.1 m", "Radius."),
    BOOLEAN(MOTION, "outward", outward, "false", "Directions point away from the origin instead."),
    BOOLEAN(MOTION, "surface", surface, "false", "Births on the surface alone."),
    TURN,
    END,
};

static const struct kiln_option box[] = {
    PLACE("0 deg"),
    VECTOR(MOTION, "size", size, KILN_METRES, 0, FAR, TIME, "[1, 1, 1]", "Full edges."),
    BOOLEAN(MOTION, "surface", surface, "false", "Births on the six faces alone."),
    TURN,
    END,
};

static const struct kiln_option disc[] = {
    PLACE("0 deg"),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0, FAR, TIME, "0.5 m",
          "Radius; faces the direction."),
    BOOLEAN(MOTION, "surface", surface, "false", "Births on the rim alone."),
    TURN,
    END,
};

static const struct kiln_option cone[] = {
    PLACE("15 deg"),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0, FAR, TIME, "0 m",
          "Radius of the disc at the apex; particles leave along the cone's own lines."),
    END,
};

static const struct kiln_option line[] = {
    PLACE("0 deg"),
    VECTOR(MOTION, "span", size, KILN_METRES, -FAR, FAR, TIME, "[1, 0, 0]",
           "From its first end to its last; the origin is in the middle."),
    INTEGER(MOTION, "nozzles", nozzles, 0, 65536, "0",
            "Places, in the middle of equal parts of it, that births take in turn; 0: anywhere."),
    TURN,
    END,
};

static const struct kiln_option_kind shapes[] = {
    {.name = "point", .value = KILN_EMITTER_POINT, .members = point, .help = "One place."},
    {.name = "sphere", .value = KILN_EMITTER_SPHERE, .members = sphere, .help = "A ball."},
    {.name = "box", .value = KILN_EMITTER_BOX, .members = box, .help = "A box along the axes."},
    {.name = "disc", .value = KILN_EMITTER_DISC, .members = disc, .help = "A flat disc."},
    {.name = "cone", .value = KILN_EMITTER_CONE, .members = cone, .help = "A nozzle."},
    {.name = "line",
     .value = KILN_EMITTER_LINE,
     .members = line,
     .help = "A line, or a rake of nozzles, whose smoke shows how air flows."},
    {.name = NULL},
};

static const char *const aligns[] = {
    [KILN_ALIGN_WORLD] = "world",
    [KILN_ALIGN_VELOCITY] = "velocity",
    [KILN_ALIGN_NORMAL] = "normal",
    NULL,
};

/* The limit of a count of children, at which a system of them still fits. */
#define COUNT                                                                                      \
    INTEGER(MOTION, "count", parent.count, 1, 65536, "10",                                         \
            "Particles born of one particle of the parent.")
#define ALIGN(words, which)                                                                        \
    CHOICE(MOTION, "align", parent.align, words, "world",                                          \
           "Where the y axis of `from` points: up; " which)
#define TO_VELOCITY "velocity turns it to where the parent's particle flies."

static const char *const aligns_in_flight[] = {
    [KILN_ALIGN_WORLD] = "world",
    [KILN_ALIGN_VELOCITY] = "velocity",
    NULL,
};

static const struct kiln_option death[] = {COUNT, ALIGN(aligns_in_flight, TO_VELOCITY), END};

static const struct kiln_option bounce[] = {
    COUNT,
    ALIGN(aligns, "velocity turns it to where the parent's particle flies on, normal away from "
                  "the surface."),
    END,
};

static const struct kiln_option trail[] = {
    VALUE(MOTION, "rate", parent.rate, KILN_PER_SECOND, 0, 1e6, KILN_ALLOW_LIFE, "20",
          "Particles born a second, while a particle of the parent lives; over its life."),
    ALIGN(aligns_in_flight, TO_VELOCITY),
    END,
};

static const struct kiln_option_kind events[] = {
    {.name = "death",
     .value = KILN_EVENT_DEATH,
     .members = death,
     .shortcut = "count",
     .help = "At the end of its life, not where bounds, a demitter or an impact end it."},
    {.name = "bounce",
     .value = KILN_EVENT_BOUNCE,
     .members = bounce,
     .shortcut = "count",
     .help = "When it first meets a surface; with the velocity that it has afterwards."},
    {.name = "trail",
     .value = KILN_EVENT_TRAIL,
     .members = trail,
     .shortcut = "rate",
     .help = "All along its way, the first one where it is born."},
    {.name = NULL},
};

static const struct kiln_option parent[] = {
    {ROW(MOTION, "system", name, AT(parent.name), NULL, "Of whose particles these are born.")},
    {ROW(MOTION, "on", kind, 0, "{death: {}}", "When, and how many."), .kinds = events,
     .kind_offset = AT(parent.event)},
    END,
};

static const struct kiln_option emit_options[] = {
    {ROW(MOTION, "parent", switch, 0, "none",
         "Born of another system's particles, in the place of rate and bursts; `from` is then "
         "around the parent's particle."),
     .members = parent, .count_offset = AT(parent.enabled)},
    VALUE(MOTION, "rate", rate, KILN_PER_SECOND, 0, 1e7, TIME, "0", "Particles born a second."),
    {ROW(MOTION, "bursts", bursts, AT(bursts), "{}", "Particles born at once, by clip time."),
     LIMITS(KILN_PLAIN, 0, KILN_MAX_PARTICLES), .count_offset = AT(burst_count),
     .max_count = KILN_MAX_BURSTS},
    RANGE(MOTION, "life", life, KILN_SECONDS, 0.001, 10000, TIME, "1 s",
          "How long a particle lives, drawn at its birth."),
    RANGE(MOTION, "speed", speed, KILN_SPEED, 0, 10000, TIME, "1 m/s",
          "Along its direction, drawn at its birth."),
    {ROW(MOTION, "from", kind, 0, "{point: {}}",
         "Where particles are born, and which way they go."),
     .kinds = shapes, .kind_offset = AT(shape)},
    VALUE(MOTION, "inherit", inherit, KILN_FRACTION, 0, 1, TIME, "0",
          "Part of the velocity of the emitter, or of the parent's particle, that they get."),
    END,
};

#undef AT
#define AT(field) offsetof(struct kiln_collide, field)

static const char *const collide_modes[] = {
    [KILN_COLLIDE_SWEPT] = "swept",
    [KILN_COLLIDE_CLAMP] = "clamp",
    NULL,
};

static const struct kiln_option collide_options[] = {
    CHOICE(MOTION, "mode", mode, collide_modes, "swept",
           "swept finds the point of impact; clamp moves a particle inside to the nearest face."),
    VALUE(MOTION, "randomness", randomness, KILN_FRACTION, 0, 1, BOTH, "0",
          "0 reflects like a mirror, 1 into any direction away from the surface."),
    VALUE(MOTION, "slowdown", slowdown, KILN_FRACTION, 0, 1, BOTH, "0.5",
          "Factor on the speed at each impact, after all else."),
    VALUE(MOTION, "restitution", restitution, KILN_FRACTION, 0, 1, BOTH, "1",
          "Part of the speed towards a surface that goes back; randomness turns what comes of it."),
    VALUE(MOTION, "friction", friction, KILN_PLAIN, 0, 100, BOTH, "0",
          "Coulomb's: part of what a surface gives along its normal that is lost along it."),
    BOOLEAN(MOTION, "dies", dies, "false", "A particle ends at its first impact, like rain."),
    END,
};

#undef AT
#define AT(field) offsetof(struct kiln_painting, field)

static const char *const paint_times[] = {
    [KILN_PAINT_IMPACT] = "impact",
    [KILN_PAINT_NEAR] = "near",
    NULL,
};

static const struct kiln_option paint_options[] = {
    CHOICE(MOTION, "when", when, paint_times, "impact",
           "impact: where it bounces or ends, in each step; near: all that is within its radius at "
           "the end of each step."),
    RANGE(MOTION, "radius", radius, KILN_METRES, 0.0001, 1000, TIME, "3 cm",
          "Of what a particle leaves, drawn once for each."),
    VALUE(MOTION, "opacity", opacity, KILN_FRACTION, 0, 1, BOTH, "1", "In the middle."),
    VALUE(MOTION, "soft", soft, KILN_FRACTION, 0, 1, BOTH, "0.3",
          "Outer part of the radius over which it fades."),
    END,
};

#undef AT
#define AT(field) offsetof(struct kiln_system, field)

static const struct kiln_option demitter = {
    .name = "demitter", .type = &kiln_type_bounds, LIMITS(KILN_METRES, -FAR, FAR)};

static const struct kiln_option force = {.name = "force",
                                         .type = &kiln_type_kind,
                                         .kinds = kiln_force_kinds,
                                         .kind_offset = offsetof(struct kiln_force, kind)};

static const struct kiln_option interaction = {.name = "interaction",
                                               .type = &kiln_type_kind,
                                               .kinds = kiln_interaction_kinds,
                                               .kind_offset =
                                                   offsetof(struct kiln_interaction, kind)};

const struct kiln_option kiln_options_system[] = {
    BOOLEAN(MOTION, "enabled", enabled, "true", "A system that is not has no particles."),
    GROUP(MOTION, "emit", AT(emit), emit_options, "How particles are born."),
    {ROW(MOTION, "forces", list, AT(forces), "[]", "What accelerates them, added up."),
     .item = &force, .item_size = sizeof(struct kiln_force), .count_offset = AT(force_count),
     .max_count = KILN_MAX_FORCES},
    {ROW(MOTION, "collide", switch, AT(collide), "none",
         "How they bounce off the boxes and the floor."),
     .members = collide_options, .count_offset = AT(collide.enabled)},
    {ROW(MOTION, "interact", list, AT(interactions), "[]", "What they do to each other."),
     .item = &interaction, .item_size = sizeof(struct kiln_interaction),
     .count_offset = AT(interaction_count), .max_count = KILN_MAX_INTERACTIONS},
    {ROW(MOTION, "paint", switch, AT(paint), "none",
         "They leave their look's colour on meshes that take paint (Drone 2007, 7.6.1)."),
     .members = paint_options, .count_offset = AT(paint.enabled)},
    {ROW(MOTION, "demitters", list, AT(demitters), "[]", "Boxes in which particles die."),
     .item = &demitter, .item_size = sizeof(struct kiln_bounds), .count_offset = AT(demitter_count),
     .max_count = KILN_MAX_DEMITTERS},
    BOUNDS(MOTION, "bounds", bounds, "none", "A box outside of which particles die."),
    GROUP(MOTION, "look", AT(look), kiln_options_look, "What they look like."),
    END,
};
