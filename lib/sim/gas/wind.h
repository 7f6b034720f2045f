/* Lets particles ride gas: writes the grids of winds of gas, which kernels read as those of baked
 * winds (shared/force_baked.h). */
#ifndef KILN_SIM_GAS_WIND_H
#define KILN_SIM_GAS_WIND_H

#include "base/thread.h"
#include "sim/world/params.h"

/* Writes the grids of all winds of gas for the particles of a step, from the pool's gas after that
 * step of its own. */
bool kiln_gas_winds_write(const struct kiln_scene *scene, struct kiln_pool *pool,
                          const struct kiln_sim_params *params, struct kiln_threads *threads,
                          uint32_t step, struct kiln_error *error);

#endif
