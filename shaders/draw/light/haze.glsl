/* Computes the colour of haze for sprites and gas. lib/draw/vector/haze_color.h does the same on the
 * host. The shader that includes this file declares the uniform block `backdrop`. */
#include "shared/haze.h"
#include "shared/surface_light.h"

/* Returns the colour of haze in a level direction. */
vec3 haze_toward(vec3 level)
{
    vec3 color = backdrop.sky_horizon.rgb;
    if (backdrop.counts.x != 0u) {
        float place = haze_place(level);
        int low = int(place), parts = KILN_HAZE_PARTS - 1;
        color = mix(backdrop.haze[low & parts].rgb, backdrop.haze[(low + 1) & parts].rgb,
                    place - float(low));
    }
    if (backdrop.sky_horizon.w <= 0.0)
        return color;
    float glow = sky_glow(level, backdrop.sun_direction, backdrop.floor_params.w);
    return color + backdrop.sun_color.rgb * (backdrop.sky_horizon.w * glow);
}
