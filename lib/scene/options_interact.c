/* This file has the option tables of what particles of a system do to each other. Each kind has a
 * row in kiln_interaction_kinds and a table of members. */
#include "scene/rows.h"

#define AT(field) offsetof(struct kiln_interaction, field)

static const char *const contact_modes[] = {
    [KILN_CONTACT_EXACT] = "exact",
    [KILN_CONTACT_STAGGERED] = "staggered",
    NULL,
};

static const struct kiln_option collide[] = {
    CHOICE(MOTION, "mode", mode, contact_modes, "exact",
           "exact misses no pair that touches; staggered looks at 8 neighbours to each side in the "
           "order of two grids, as the paper does."),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0, 1000, BOTH, "5 cm",
          "Of each particle, as a ball."),
    BOOLEAN(MOTION, "as_drawn", as_drawn, "false",
            "Radii are half of look.size times look.scale instead; the larger are heavier."),
    VALUE(MOTION, "restitution", restitution, KILN_FRACTION, 0, 1, TIME, "1",
          "Part of the speed of approach that is kept; 1 keeps all energy."),
    VALUE(MOTION, "apart", apart, KILN_FRACTION, 0, 1, TIME, "0.5",
          "Part of what overlaps all the same that is pushed apart in a round."),
    {ROW(MOTION, "fastest", value, AT(fastest), "auto",
         "Two that approach each other by no more are found before they meet, and do not pass "
         "through each other, but for who meets another first: that leaves no second collision in "
         "the step. auto: what the speeds of each step ask for, up to two widths of a particle in "
         "a step; 0 foresees nothing. For mode exact."),
     LIMITS(KILN_SPEED, 0, 10000), .clocks = TIME, .word = "auto"},
    INTEGER(MOTION, "rounds", rounds, 1, 64, "4",
            "Collisions that a particle may have in a step; the others wait for the next one."),
    BOOLEAN(MOTION, "spin", spins, "false",
            "They turn, as solid balls: friction acts where they touch each other, and surfaces "
            "(collide.friction), so that they come to roll."),
    VALUE(MOTION, "friction", friction, KILN_PLAIN, 0, 10, TIME, "0.2",
          "Of those that spin, on each other: so much of what they give each other along the line "
          "between them, but no more than stops the slip."),
    RANGE(MOTION, "turning", turning, KILN_ANGULAR_SPEED, KILN_DEG(-36000), KILN_DEG(36000), TIME,
          "0 deg/s", "How fast those that spin turn at birth, drawn for each."),
    VECTOR(MOTION, "axis", axis, KILN_PLAIN, -1000, 1000, TIME, "[0, 0, 0]",
           "About which they turn at birth, of any length; [0, 0, 0] draws one for each."),
    VALUE(MOTION, "rolling", rolling, KILN_FRACTION, 0, 1, TIME, "0",
          "Of those that spin, what rolling costs on surfaces: a moment as if these pushed by so "
          "much of the radius off the middle."),
    END,
};

static const struct kiln_option gravity[] = {
    VALUE(MOTION, "strength", strength, KILN_ACCELERATION, -1e6, 1e6, BOTH, "0.01",
          "Acceleration that each particle causes at a distance of 1 m; below 0 they repel."),
    VALUE(MOTION, "softening", softening, KILN_METRES, 0.0001, 1000, TIME, "5 cm",
          "Distance below which attraction fades, as if particles were clouds so large."),
    {ROW(
        MOTION, "of", name, AT(of), "self",
        "The system whose particles attract, if not these themselves: few heavy ones and many that "
        "only follow take little work. strength is then over the life of those.")},
    END,
};

static const struct kiln_option flock_global[] = {
    VALUE(MOTION, "cohesion", flock.all_cohesion, KILN_ACCELERATION, 0, 1e6, TIME, "0",
          "For each metre, towards the average position."),
    VALUE(MOTION, "alignment", flock.all_alignment, KILN_PER_SECOND, 0, 1000, TIME, "0",
          "Towards the average velocity."),
    END,
};

static const struct kiln_option flock[] = {
    VALUE(MOTION, "radius", flock.radius, KILN_METRES, 0.001, 1000, TIME, "1 m",
          "Of what each sees around itself; the work grows with how many that are."),
    VALUE(MOTION, "view", flock.view, KILN_ANGLE, 0, KILN_DEG(360), TIME, "360 deg",
          "Angle of what it sees, about where it flies."),
    VALUE(MOTION, "space", flock.space, KILN_METRES, 0.001, 1000, TIME, "0.4 m",
          "That it keeps free about itself; at most the radius counts."),
    VALUE(MOTION, "separation", flock.separation, KILN_ACCELERATION, 0, 1e6, TIME, "4 m/s^2",
          "Away from each that is in that space: so strong at no distance, nothing at its edge."),
    VALUE(
        MOTION, "avoidance", flock.avoidance, KILN_ACCELERATION, 0, 1e6, TIME, "0",
        "Out of the way of each that will come into that space: so strong for what is going to be "
        "met head-on and at once."),
    VALUE(MOTION, "horizon", flock.horizon, KILN_SECONDS, 0.001, 1000, TIME, "0.5 s",
          "How soon that is for avoidance to count."),
    VALUE(MOTION, "cohesion", flock.cohesion, KILN_ACCELERATION, 0, 1e6, TIME, "1 m/s^2",
          "For each metre, towards the average position of those that it sees."),
    VALUE(MOTION, "alignment", flock.alignment, KILN_PER_SECOND, 0, 1000, TIME, "1",
          "Towards their average velocity; differences up to twice the top speed count."),
    GROUP(MOTION, "global", 0, flock_global,
          "The same with all of the system, wherever they are, as the paper does."),
    VALUE(MOTION, "acceleration", flock.acceleration, KILN_ACCELERATION, 0, 1e6, TIME, "20 m/s^2",
          "The most by which all of this together steers."),
    VALUE(MOTION, "slowest", flock.slowest, KILN_SPEED, 0, 100000, TIME, "0 m/s",
          "They fly no slower."),
    VALUE(MOTION, "fastest", flock.fastest, KILN_SPEED, 0.001, 100000, TIME, "10 m/s",
          "They fly no faster, but for what forces add."),
    END,
};

const struct kiln_option_kind kiln_interaction_kinds[] = {
    {.name = "collide",
     .value = KILN_INTERACT_COLLIDE,
     .members = collide,
     .shortcut = "radius",
     .help =
         "They bounce off each other like balls (UberFlow 2004, 4.4 and 4.5), and meet surfaces "
         "with their radius (volumes and depth maps of meshes with their centre), from the step "
         "after their birth on; how fast they may be without "
         "passing through each other is a matter of simulation.rate, or of fastest."},
    {.name = "gravity",
     .value = KILN_INTERACT_GRAVITY,
     .members = gravity,
     .shortcut = "strength",
     .help = "Each attracts all others (Drone 2007, 7.4.3), or those of another system attract "
             "these; the "
             "work grows with how many attract times how many are attracted."},
    {.name = "flock",
     .value = KILN_INTERACT_FLOCK,
     .members = flock,
     .shortcut = "radius",
     .help =
         "They fly like birds (Drone 2007, 7.4.4): apart, out of each other's way, together, and "
         "the same way. Forces do the rest: attract is a goal, or a danger where it is "
         "negative."},
    {.name = NULL},
};
