/* Finds partners as the paper does, in two staggered grids (UberFlow 2004, 4.3 and 4.4, figure 3).
 *
 * Bodies are sorted by their cells in a grid, in ascending order of x, y, z, and also by the cells
 * of a grid that is shifted by half a cell along all axes. In both orders, each body looks at the 8
 * bodies before it and the 8 behind it (as in experiment E4 of the paper) and takes the closest. A
 * partner that is farther away in both orders is missed: across faces of cells other than along z,
 * or where cells are crowded. */
#ifndef KILN_SHARED_PAPERS_INTERACT_STAGGERED_H
#define KILN_SHARED_PAPERS_INTERACT_STAGGERED_H

#include "shared/interact_collide.h"

/* In C, the order of the crowd. In GLSL, the buffer of sim/crowd/papers/staggered.glsl. */
#ifdef GL_core_profile
#define ORDER(i) body_order[i]
#else
#define ORDER(i) crowd->order[i]
#endif

#define STAGGER_WINDOW 8u

/* Cells along an axis; bodies farther out count as in the outermost cell. */
#define STAGGER_CELLS 2097152

/* The key of a cell, in 63 bits; all bits are set for slots without a body. */
struct stagger_key {
    uint high, low;
};

FN uint stagger_along(CROWD_PARAM float metres, float aside)
{
    EXACT float at = metres * INTERACT(cells_per_metre) + aside;
    EXACT float held = exact_clamp(at, -1048576.0f, 1048575.0f);
    return UINT(INT(FLOOR(held)) + STAGGER_CELLS / 2);
}

/* Returns the key of a place. aside: shift of the grid, in cells. */
FN S(stagger_key) stagger_key_of(CROWD_PARAM float3 p, float aside)
{
    uint x = stagger_along(CROWD p.x, aside);
    uint y = stagger_along(CROWD p.y, aside);
    uint z = stagger_along(CROWD p.z, aside);
    S(stagger_key) key;
    key.high = (x << 10u) | (y >> 11u);
    key.low = (y << 21u) | z;
    return key;
}

/* Finds the partner of a body. Bodies lie in the order of the first grid. ORDER has the body at
 * each place of the second grid and then, from `used` on, the place of each body. */
FN uint stagger_find(CROWD_PARAM uint self, uint count)
{
    S(kiln_body) a = BODY(self);
    uint places = INTERACT(used);
    uint place = ORDER(places + self);
    S(contact_choice) best = contact_no_choice();
    for (uint step = 1u; step <= STAGGER_WINDOW; step++) {
        uint before = self >= step ? self - step : self;
        uint behind = self + step < count ? self + step : self;
        uint place_before = place >= step ? place - step : place;
        uint place_behind = place + step < count ? place + step : place;
        uint other_before = ORDER(place_before);
        uint other_behind = ORDER(place_behind);
        best = contact_choose(CROWD best, a, BODY(before), before);
        best = contact_choose(CROWD best, a, BODY(behind), behind);
        best = contact_choose(CROWD best, a, BODY(other_before), other_before);
        best = contact_choose(CROWD best, a, BODY(other_behind), other_behind);
    }
    return best.partner;
}

#endif
