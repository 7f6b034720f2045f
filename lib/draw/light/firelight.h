/* This header declares the light of fire on the backdrop and on smoke: the emission of particles,
 * gathered into a few moving point lights. */
#ifndef KILN_DRAW_LIGHT_FIRELIGHT_H
#define KILN_DRAW_LIGHT_FIRELIGHT_H

#include "base/thread.h"
#include "draw/moment/appearance.h"

/* Gathers the lights of all systems with look.light and returns their number. lights has room for
 * KILN_MAX_FIRE_LIGHTS. */
uint32_t kiln_firelight_gather(const struct kiln_moment *moment, struct kiln_threads *threads,
                               struct kiln_draw_light *lights);

#endif
