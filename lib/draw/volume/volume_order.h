/* Declares the order in which domains of gas are drawn. */
#ifndef KILN_DRAW_VOLUME_VOLUME_ORDER_H
#define KILN_DRAW_VOLUME_VOLUME_ORDER_H

#include "draw/moment/moment.h"

/* Lists the domains that are drawn, from the farthest to the nearest by their middles. Returns
 * their number. */
uint32_t kiln_volume_order(const struct kiln_scene *scene, const struct kiln_moment *moment,
                           const struct kiln_pool *pool, uint32_t order[KILN_MAX_GAS]);

#endif
