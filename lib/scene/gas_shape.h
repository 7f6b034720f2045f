/* Declares what follows from the settings of domains of gas: the sizes of their grids, the memory
 * that they take, and the work that they are. */
#ifndef KILN_SCENE_GAS_SHAPE_H
#define KILN_SCENE_GAS_SHAPE_H

#include "base/footprint.h"
#include "scene/scene.h"

/* Returns the cells along each edge that a domain would have, which may be too many for a
 * struct kiln_gas_shape. */
void kiln_gas_domain_cells(const struct kiln_gas_domain *domain, double cells[3]);

/* Fills in domain->shape. An edge may have at most KILN_MAX_GAS_EDGE cells. */
void kiln_scene_gas_shape(struct kiln_gas_domain *domain);

/* Returns the bytes that so many cells take where gas fills them. */
double kiln_gas_bytes_of(const struct kiln_gas_shape *shape, double cells);

/* Returns how many steps of the gas the least rate of a domain makes of a step of the scene. */
uint32_t kiln_gas_least_substeps(const struct kiln_scene *scene,
                                 const struct kiln_gas_domain *domain);

/* Returns the cells of all enabled domains, and the cells of all steps of the gas up to the last
 * moment of the clip. Where substeps are `auto`, the least number of steps counts. */
uint64_t kiln_gas_cells(const struct kiln_scene *scene);
uint64_t kiln_gas_cell_steps(const struct kiln_scene *scene, uint64_t steps);

/* Returns the bytes of all domains where gas fills them. */
uint64_t kiln_gas_most_bytes(const struct kiln_scene *scene);

/* Adds the memory that the gas of all domains is expected to take (gas_extent.h), and that of what
 * their sources are. */
void kiln_scene_gas_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);

#endif
