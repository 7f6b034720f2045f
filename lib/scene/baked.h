/* Declares what is asked of the baked winds of a scene, whose forces lie within other forces. */
#ifndef KILN_SCENE_BAKED_H
#define KILN_SCENE_BAKED_H

#include "scene/scene.h"

/* Returns force number i of a system, from 0, or NULL if there are fewer. Behind the forces of the
 * system come those of its baked winds. */
const struct kiln_force *kiln_system_force(const struct kiln_system *system, uint32_t i);

/* Writes the path of that force in a file: "systems.a.forces.2.wind.of.0.curl". */
void kiln_system_force_path(const struct kiln_system *system, uint32_t i, char *path, size_t size);

/* Return force number i of a system, or of a domain of gas: the domains have the numbers behind
 * those of the systems. */
const struct kiln_force *kiln_owner_force(const struct kiln_scene *scene, uint32_t owner,
                                          uint32_t i);
void kiln_owner_force_path(const struct kiln_scene *scene, uint32_t owner, uint32_t i, char *path,
                           size_t size);
static inline uint32_t kiln_force_owners(const struct kiln_scene *scene)
{
    return scene->system_count + scene->gas_count;
}

/* Return a force of a domain of gas by its number, and write the path of one, such as
 * "gas.fire.forces.2.curl". */
const struct kiln_force *kiln_gas_force(const struct kiln_gas_domain *domain, uint32_t i);
void kiln_gas_force_path(const struct kiln_gas_domain *domain, uint32_t i, char *path, size_t size);

/* Returns how many samples the grid of a baked wind has, and along each axis. Its cells are about
 * cubes. */
uint64_t kiln_baked_samples(const struct kiln_force *baked, uint32_t size[3]);

/* Returns the step in which the grid of a baked wind was last written that a step, from 1, reads:
 * 1, or a number of writings later. It follows from the step alone, so a run that begins anywhere
 * reads what a whole run does. */
static inline uint32_t kiln_baked_step(const struct kiln_force *baked, uint32_t step)
{
    return step - (step - 1) % baked->every;
}

#endif
