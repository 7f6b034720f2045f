/* Declares the light that flames emit by their temperature: that of a black body, by Planck's law,
 * in parts of its luminance at temperature 1. */
#ifndef KILN_DRAW_LIGHT_FLAME_COLORS_H
#define KILN_DRAW_LIGHT_FLAME_COLORS_H

#include "asset/atlas/blackbody.h"
#include "shared/exact.h"
#include "shared/flame_table.h"

struct kiln_flame_colors {
    /* rgb at temperatures from 0 to FLAME_HOTTEST; w: luminance */
    float4 rgb[FLAME_COLORS + 1];
    float kelvin[2]; /* at temperature 0 and 1 */
};

/* Fills the table, unless it has these temperatures already. */
void kiln_flame_colors_fill(struct kiln_flame_colors *colors, const struct kiln_observer *observer,
                            float cold_kelvin, float hot_kelvin);

/* Returns the light of a temperature, without interpolation. */
static inline float4 kiln_flame_color_near(const struct kiln_flame_colors *colors,
                                           float temperature)
{
    const float most = (float)FLAME_COLORS;
    float place = temperature * (most / FLAME_HOTTEST) + 0.5f;
    place = place > 0.0f ? place : 0.0f;
    return colors->rgb[place < most ? exact_int(place) : FLAME_COLORS];
}

#endif
