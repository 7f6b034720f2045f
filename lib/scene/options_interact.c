/* This file has the option tables of what particles of a system do to each other. Each kind has a
 * row in kiln_interaction_kinds and a table of members. */
#include "scene/rows.h"

#define FILLS struct kiln_interaction

static const char *const contact_modes[] = {
    [KILN_CONTACT_EXACT] = "exact",
    [KILN_CONTACT_STAGGERED] = "staggered",
    NULL,
};

TABLE(collide) = {
    CHOICE(
        MOTION, "mode", mode, contact_modes, "exact",
        "`exact` misses no pair that touches. `staggered` tests 8 neighbours to each side in the "
        "order of two grids, as the paper does."),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0, 1000, LIFE(68), "5 cm",
          "Radius of each particle, which collides as a ball."),
    BOOLEAN(MOTION, "as_drawn", as_drawn, "false",
            "Radii are half of look.size times look.scale instead of `radius`. Larger particles "
            "are heavier."),
    VALUE(MOTION, "restitution", restitution, KILN_FRACTION, 0, 1, TIME(69), "1",
          "Fraction of the speed of approach that two particles keep when they bounce; 1 keeps all "
          "energy."),
    VALUE(MOTION, "apart", apart, KILN_FRACTION, 0, 1, TIME(70), "0.5",
          "Fraction of an overlap of two particles that is pushed apart in a round."),
    {ROW(MOTION, "fastest", value, fastest, "auto",
         "Speed of approach up to which a pair is found before it meets, for mode exact. Such a "
         "pair does not pass through each other, unless one of the two has another collision first "
         "in the same step. `auto` takes the speed from the particles of each step, up to two "
         "widths "
         "of a particle in a step. 0 looks for no pair ahead of time."),
     LIMITS(KILN_SPEED, 0, 10000), .clocks = TIME(71), .special_word = "auto"},
    INTEGER(MOTION, "rounds", rounds, 1, 64, "4",
            "Collisions that a particle may have in a step. Further collisions wait for the next "
            "step."),
    BOOLEAN(MOTION, "spin", spins, "false",
            "Particles turn as solid balls. Friction acts where they touch each other and where "
            "they touch surfaces (collide.friction), so that they come to roll."),
    VALUE(MOTION, "friction", friction, KILN_PLAIN, 0, 10, TIME(72), "0.2",
          "Coefficient of friction between two particles that spin: the impulse along the contact "
          "as a part of the impulse between their centres, limited to what stops the slip."),
    RANGE(MOTION, "turning", turning, KILN_ANGULAR_SPEED, KILN_DEG(-36000), KILN_DEG(36000),
          TIME(73), "0 deg/s",
          "Angular speed at birth of particles that spin, chosen at random for each particle."),
    VECTOR(MOTION, "axis", axis, KILN_PLAIN, -1000, 1000, TIME(74), "[0, 0, 0]",
           "Axis about which a particle turns at birth, of any length. [0, 0, 0] stands for an "
           "axis chosen at random for each particle."),
    VALUE(MOTION, "rolling", rolling, KILN_FRACTION, 0, 1, TIME(75), "0",
          "Rolling resistance on surfaces of particles that spin: the surface pushes as if it "
          "touched the ball off its middle by this part of the radius."),
    END,
};

TABLE(gravity) = {
    VALUE(MOTION, "strength", strength, KILN_ACCELERATION, -1e6, 1e6, LIFE(76), "0.01",
          "Acceleration that each particle causes at a distance of 1 m. With a value below 0, "
          "particles repel each other."),
    VALUE(MOTION, "softening", softening, KILN_METRES, 0.0001, 1000, TIME(77), "5 cm",
          "Softening length: the distance below which attraction fades, as if each particle were a "
          "cloud of this size."),
    {ROW(MOTION, "of", name, of, "self",
         "The system whose particles attract the particles of this system. `self` means that "
         "particles of this system attract each other. A few heavy particles that attract many "
         "light ones take little work. `strength` varies over the life of the particles that "
         "attract.")},
    END,
};

TABLE(flock_global) = {
    VALUE(
        MOTION, "cohesion", flock.all_cohesion, KILN_ACCELERATION, 0, 1e6, TIME(78), "0",
        "Acceleration towards the average position of all particles, for each metre of distance."),
    VALUE(MOTION, "alignment", flock.all_alignment, KILN_PER_SECOND, 0, 1000, TIME(79), "0",
          "Rate at which a particle takes up the average velocity of all particles."),
    END,
};

TABLE(flock) = {
    VALUE(MOTION, "radius", flock.radius, KILN_METRES, 0.001, 1000, TIME(80), "1 m",
          "Radius within which a particle sees others. The work grows with the number of particles "
          "that are seen."),
    VALUE(MOTION, "view", flock.view, KILN_ANGLE, 0, KILN_DEG(360), TIME(81), "360 deg",
          "Angle of the field of view, centred on the direction of flight."),
    VALUE(MOTION, "space", flock.space, KILN_METRES, 0.001, 1000, TIME(82), "0.4 m",
          "Distance that a particle keeps free around itself. A value above radius counts as "
          "radius."),
    VALUE(MOTION, "separation", flock.separation, KILN_ACCELERATION, 0, 1e6, TIME(83), "4 m/s^2",
          "Acceleration away from each particle within `space`, at a distance of 0. It falls to "
          "nothing at the edge of the space."),
    VALUE(MOTION, "avoidance", flock.avoidance, KILN_ACCELERATION, 0, 1e6, TIME(84), "0",
          "Acceleration out of the way of each particle that will come within `space`, for one "
          "that is going to be met head-on and at once."),
    VALUE(MOTION, "horizon", flock.horizon, KILN_SECONDS, 0.001, 1000, TIME(85), "0.5 s",
          "How far ahead in time avoidance looks."),
    VALUE(MOTION, "cohesion", flock.cohesion, KILN_ACCELERATION, 0, 1e6, TIME(86), "1 m/s^2",
          "Acceleration towards the average position of the particles that a particle sees, for "
          "each metre of distance."),
    VALUE(MOTION, "alignment", flock.alignment, KILN_PER_SECOND, 0, 1000, TIME(87), "1",
          "Rate at which a particle takes up the average velocity of the particles that it sees. "
          "Differences of velocity count up to twice `fastest`."),
    GROUP(MOTION, "global", flock_global,
          "Cohesion and alignment with all particles of the system at any distance, as in the "
          "paper."),
    VALUE(MOTION, "acceleration", flock.acceleration, KILN_ACCELERATION, 0, 1e6, TIME(88),
          "20 m/s^2", "Largest acceleration by which all of this together steers a particle."),
    VALUE(MOTION, "slowest", flock.slowest, KILN_SPEED, 0, 100000, TIME(89), "0 m/s",
          "Lowest speed of a particle."),
    VALUE(MOTION, "fastest", flock.fastest, KILN_SPEED, 0.001, 100000, TIME(90), "10 m/s",
          "Highest speed of a particle, before forces are added."),
    END,
};

PUBLIC_KINDS(kiln_interaction_kinds) = {
    {.name = "collide",
     .value = KILN_INTERACT_COLLIDE,
     MEMBERS(collide),
     .shortcut = "radius",
     .help = "Particles bounce off each other like balls (UberFlow 2004, 4.4 and 4.5), from the "
             "step after their birth on. They meet surfaces with their radius, but volumes and "
             "depth maps of meshes with their centre. A higher simulation.rate or `fastest` lets "
             "faster particles collide without passing through each other."},
    {.name = "gravity",
     .value = KILN_INTERACT_GRAVITY,
     MEMBERS(gravity),
     .shortcut = "strength",
     .help = "Each particle attracts all others (Drone 2007, 7.4.3), or the particles of another "
             "system attract the particles of this one. The work grows with the number that "
             "attract times the number that are attracted."},
    {.name = "flock",
     .value = KILN_INTERACT_FLOCK,
     MEMBERS(flock),
     .shortcut = "radius",
     .help = "Particles fly like birds (Drone 2007, 7.4.4): they keep apart, avoid each other, "
             "stay together and fly the same way. Forces add goals and dangers: attract is a goal, "
             "or a danger where its strength is negative."},
    {.name = NULL},
};
