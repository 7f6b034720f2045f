/* What particles of a system do to each other: a row in kiln_interaction_kinds and a table of
 * members for each kind. */
#include "scene/option_rows.h"

#define AT(field) offsetof(struct kiln_interaction, field)

static const char *const contact_modes[] = {
    [KILN_CONTACT_EXACT] = "exact",
    [KILN_CONTACT_STAGGERED] = "staggered",
    NULL,
};

static const struct kiln_option collide[] = {
    CHOICE("mode", mode, contact_modes, "exact",
           "exact misses no pair that touches; staggered looks at 8 neighbours to each side in the "
           "order of two grids, as the paper does."),
    VALUE("radius", radius, KILN_METRES, 0, 1000, BOTH, "5 cm", "Of each particle, as a ball."),
    BOOLEAN("as_drawn", as_drawn, "false",
            "Radii are half of look.size times look.scale instead; the larger are heavier."),
    VALUE("restitution", restitution, KILN_FRACTION, 0, 1, TIME, "1",
          "Part of the speed of approach that is kept; 1 keeps all energy."),
    VALUE("apart", apart, KILN_FRACTION, 0, 1, TIME, "0.5",
          "Part of what overlaps all the same that is pushed apart in a round."),
    INTEGER("rounds", rounds, 1, 64, "4",
            "Collisions that a particle may have in a step; the others wait for the next one."),
    END,
};

static const struct kiln_option gravity[] = {
    VALUE("strength", strength, KILN_ACCELERATION, -1e6, 1e6, BOTH, "0.01",
          "Acceleration that each particle causes at a distance of 1 m; below 0 they repel."),
    VALUE("softening", softening, KILN_METRES, 0.0001, 1000, TIME, "5 cm",
          "Distance below which attraction fades, as if particles were clouds so large."),
    END,
};

const struct kiln_option_kind kiln_interaction_kinds[] = {
    {.name = "collide",
     .value = KILN_INTERACT_COLLIDE,
     .members = collide,
     .shortcut = "radius",
     .help =
         "They bounce off each other like balls (UberFlow 2004, 4.4 and 4.5), and meet surfaces "
         "with their radius; how fast they may be without passing through each other is a matter "
         "of simulation.rate."},
    {.name = "gravity",
     .value = KILN_INTERACT_GRAVITY,
     .members = gravity,
     .shortcut = "strength",
     .help =
         "Each attracts all others (Drone 2007, 7.4.3); the work grows with the square of their "
         "number."},
    {.name = NULL},
};
