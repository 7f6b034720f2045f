/* The light that fire sheds on backdrop and smoke: what its particles emit, gathered into a few
 * moving point lights. */
#ifndef KILN_DRAW_FIRELIGHT_H
#define KILN_DRAW_FIRELIGHT_H

#include "draw/living.h"

/* Gathers the lights of all systems with look.light into lights (KILN_MAX_FIRE_LIGHTS) and returns
 * how many there are. records: of the pool; table: of kiln_looks_sample at the view's time. */
uint32_t kiln_firelight_gather(const struct kiln_scene *scene, const struct kiln_pool *pool,
                               const struct kiln_particle *records, const struct kiln_view *view,
                               const float4 *table, struct kiln_draw_light *lights);

/* Whether a system sheds light at all. */
bool kiln_firelight_exists(const struct kiln_scene *scene);

#endif
