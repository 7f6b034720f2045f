/* Declares how far the gas of a domain is expected to spread. */
#ifndef KILN_SCENE_GAS_EXTENT_H
#define KILN_SCENE_GAS_EXTENT_H

#include "scene/scene.h"

struct kiln_gas_extent {
    struct kiln_gas_place cells; /* of the window; all 0: there is no gas */
    uint64_t bricks;             /* that are active */
};

/* Returns what gas is expected to fill of a domain at a clip time, or at most up to it. */
struct kiln_gas_extent kiln_gas_extent_at(const struct kiln_scene *scene, uint32_t domain,
                                          double time_s);

/* Returns the same for the end of the clip. */
struct kiln_gas_extent kiln_gas_extent(const struct kiln_scene *scene, uint32_t domain);

#endif
