/* Holds the bodies of a system while their pushes are gathered on the host, and declares how the
 * bodies are sorted. */
#ifndef KILN_SIM_CROWD_INTERACT_CROWD_H
#define KILN_SIM_CROWD_INTERACT_CROWD_H

#include <stdatomic.h>

#include "shared/interact_collide.h"
#include "shared/spin.h"
#include "sim/crowd/interact.h"

struct kiln_interact_crowd {
    struct kiln_crowd view;
    struct kiln_threads *threads;
    const struct kiln_particle *records; /* records of the system */
    struct kiln_body *bodies, *after;
    uint32_t *cell_ends, *partners, *order;
    float4 *pushes;          /* pushes of the system */
    struct kiln_spin *spins; /* spins of the system; NULL unless its particles spin */
    uint32_t count;          /* number of bodies */
    bool later;              /* true in all rounds but the first */
    atomic_uint met;         /* number of bodies that have a partner */
};

/* Sorts bodies into cells. Fills bodies and count, and cell_ends with the index behind each cell's
 * last body; order is scratch memory. */
void kiln_interact_into_cells(struct kiln_interact_crowd *crowd);

/* Makes body number `at` from a slot of the system. */
static inline void crowd_put_body(struct kiln_interact_crowd *crowd, uint32_t at, uint32_t slot)
{
    const struct kiln_interact_params *params = crowd->view.params;
    crowd->bodies[at] = body_of(&crowd->view, crowd->records[slot], slot);
    if (params->spins)
        crowd->bodies[params->used + at].position_radius = crowd->spins[slot].rate;
}

/* Returns whether a body has no part in the rounds after the first. */
static inline bool crowd_sits_out(const struct kiln_interact_crowd *crowd, size_t body)
{
    return crowd->later && crowd->partners[body] == INTERACT_NOBODY;
}

/* Notes the partner of a body in this round. */
static inline void crowd_note(struct kiln_interact_crowd *crowd, size_t body, uint32_t partner)
{
    crowd->partners[body] = crowd->later ? contact_later(partner) : partner;
}

/* Finds the partner of body `self`, or INTERACT_NOBODY. */
typedef uint32_t crowd_find(const struct kiln_interact_crowd *crowd, uint32_t self);

/* Finds and notes the partners of bodies begin to end - 1. It is inlined with the function that it
 * calls for each. */
static inline __attribute__((always_inline)) void
crowd_find_partners(struct kiln_interact_crowd *crowd, size_t begin, size_t end, crowd_find *find)
{
    uint32_t met = 0;
    for (size_t i = begin; i < end; i++) {
        if (crowd_sits_out(crowd, i))
            continue;
        const uint32_t partner = find(crowd, (uint32_t)i);
        crowd_note(crowd, i, partner);
        met += partner != INTERACT_NOBODY;
    }
    atomic_fetch_add(&crowd->met, met);
}

#endif
