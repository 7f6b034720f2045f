/* This file tabulates the light of flames. Between two entries of a usual table, the light at 1000
 * kelvin changes by a tenth; interpolated linearly, it is right within a five-hundredth. */
#include "draw/light/flame_colors.h"

void kiln_flame_colors_fill(struct kiln_flame_colors *colors, const struct kiln_observer *observer,
                            float cold_kelvin, float hot_kelvin)
{
    if (colors->kelvin[0] == cold_kelvin && colors->kelvin[1] == hot_kelvin)
        return;
    colors->kelvin[0] = cold_kelvin;
    colors->kelvin[1] = hot_kelvin;
    const float luminance = kiln_blackbody_luminance(observer, hot_kelvin);
    for (int i = 0; i <= FLAME_COLORS; i++) {
        const float temperature = (float)i * (FLAME_HOTTEST / (float)FLAME_COLORS);
        const float kelvin = cold_kelvin + (hot_kelvin - cold_kelvin) * temperature;
        float rgb[3];
        kiln_blackbody_light(observer, kelvin, luminance, rgb);
        colors->rgb[i] = (float4){rgb[0], rgb[1], rgb[2],
                                  0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]};
    }
}
