/* Reads the floor's picture, averaged over what a pixel covers of the floor. */
#include "shared/picture_map.h"

layout(binding = KILN_UNIT_FLOOR) uniform sampler2D floor_image;

/* position: on the floor, m, where the ray in the direction meets it at t. */
vec3 floor_picture(vec2 position, vec3 direction, float t)
{
    floor_footprint covered =
        floor_footprint_of(direction, t, view.world_to_view[0], view.world_to_view[1],
                           view.frustum, shapes.floor_map.z);
    vec2 longer = vec2(covered.longer_x, covered.longer_z);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < int(covered.taps); i++) {
        vec2 at = position + longer * floor_tap_of(covered, i);
        sum += textureLod(floor_image, at * shapes.floor_map.xy, covered.level).rgb;
    }
    return sum / covered.taps;
}
