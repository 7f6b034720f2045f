/* Reads the sky from an equirectangular picture (shared/picture_map.h). */
#include "shared/picture_map.h"

layout(binding = KILN_UNIT_SKY) uniform sampler2D sky_image;

/* Returns the sky in a direction, averaged over at least `angle` radians. */
vec3 sky_picture(vec3 direction, float angle)
{
    sky_place at = sky_place_of(direction, shapes.sky_map.x);
    float level = log2(max(angle * shapes.sky_map.z, 1e-6));
    return textureLod(sky_image, vec2(at.u, at.v), level).rgb * shapes.sky_map.y;
}
