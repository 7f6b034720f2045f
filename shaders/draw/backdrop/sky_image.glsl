/* The sky from an equirectangular picture, whose middle lies towards -z. */

layout(binding = KILN_UNIT_SKY) uniform sampler2D sky_image;

/* Averaged over at least `angle` radians. */
vec3 sky_picture(vec3 direction, float angle)
{
    vec3 d = normalize(direction);
    vec2 at = vec2(0.5 + atan(d.x, -d.z) / (2.0 * PI) + shapes.sky_map.x, acos(clamp(d.y, -1.0, 1.0)) / PI);
    float level = log2(max(angle * shapes.sky_map.z, 1e-6));
    return textureLod(sky_image, at, level).rgb * shapes.sky_map.y;
}
