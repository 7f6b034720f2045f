/* Keeps what the solids of a scene do to a domain of gas: the cells that lie in them, the faces
 * that they shut, and their velocities there. All colliders take part, as they meet particles
 * (shared/collide.h); thin ones shut the faces between cells that lie on both sides. */
#ifndef KILN_SIM_GAS_SOLIDS_H
#define KILN_SIM_GAS_SOLIDS_H

#include "scene/scene.h"
#include "sim/gas/solver.h"
#include "sim/world/params.h"

/* Where a collider was when walls were made last. */
struct gas_collider_place {
    struct gas_region region; /* bricks of the window that its bounds reach */
    bool moves;
};

struct gas_solids {
    const struct kiln_scene *scene;
    const struct kiln_gas_domain *domain;
    struct kiln_threads *threads;
    struct gas_wall **walls;      /* of each brick of the window; NULL: no solid reaches it */
    uint32_t window;              /* of the gas, that `walls` are of */
    struct kiln_gas_place bricks; /* of that window */
    struct gas_collider_place places[KILN_MAX_COLLIDERS];
    bool any;      /* a brick has a wall */
    float since;   /* part of the step after which walls were made last */
    uint32_t made; /* grows whenever walls are made */
    /* Cells that solids took when walls were made last, of bricks that they reach. */
    struct gas_emptied *emptied;
    size_t emptied_count;
};

void gas_solids_init(struct gas_solids *solids, const struct kiln_scene *scene,
                     const struct kiln_gas_domain *domain, struct kiln_threads *threads);
void gas_solids_finish(struct gas_solids *solids);

/* Returns whether anything solid may reach the domain. */
bool gas_solids_wanted(const struct kiln_scene *scene, const struct kiln_gas_domain *domain);

/* Returns whether the walls are those of a gas's window. */
bool gas_solids_are_of(const struct gas_solids *solids, const struct kiln_gas *gas);

/* Makes the walls of a gas's window after the part `since` of a step, at a clip time, and fills
 * `open` of the levels. sim: has the colliders of the step. False when memory is short. */
bool gas_solids_move(struct gas_solids *solids, const struct kiln_gas *gas,
                     const struct gas_levels *levels, const struct kiln_sim *sim, float since,
                     float time_s);

#endif
