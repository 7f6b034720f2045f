/* Reads the floor's picture, averaged over what a pixel covers of the floor. */
#include "shared/picture_map.h"

layout(binding = KILN_UNIT_FLOOR) uniform sampler2D floor_image;

/* Returns the mean of fetches from a level along what a pixel covers. */
vec3 floor_level(vec2 position, floor_footprint covered, float taps, float level)
{
    vec2 longer = vec2(covered.longer_x, covered.longer_z);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < int(taps); i++) {
        vec2 at = position + longer * floor_tap_of(1.0 / taps, i);
        sum += textureLod(floor_image, at * shapes.floor_map.xy, level).rgb;
    }
    return sum / taps;
}

/* position: on the floor, m, where the ray in the direction meets it at t. */
vec3 floor_picture(vec2 position, vec3 direction, float t)
{
    floor_footprint covered =
        floor_footprint_of(direction, t, view.world_to_view[0], view.world_to_view[1],
                           view.frustum, shapes.floor_map.z);
    float last = float(textureQueryLevels(floor_image) - 1);
    float level = clamp(covered.level, 0.0, last), fine = floor(level);
    vec3 color = floor_level(position, covered, covered.taps, fine);
    if (level == fine)
        return color;
    vec3 coarse = floor_level(position, covered, floor_coarse_taps(covered.taps), fine + 1.0);
    return mix(color, coarse, level - fine);
}
