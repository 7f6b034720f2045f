/* Scene, particles and fire as one picture of light (Heinz 2019, figure 3.1). */
layout(binding = 0) uniform sampler2D scene;
layout(binding = 1) uniform sampler2D particles; /* premultiplied: all (merged), or smoke */
layout(binding = 2) uniform sampler2D fire;      /* premultiplied, alpha summed (separate) */

uniform bool separate_fire;
uniform bool scene_alone; /* which holds the particles already: the sum of a shutter */

vec4 composed(ivec2 pixel)
{
    vec4 color = texelFetch(scene, pixel, 0);
    if (scene_alone)
        return color;
    vec4 over = texelFetch(particles, pixel, 0);
    color = over + color * (1.0 - over.a);
    if (separate_fire) {
        vec4 flame = texelFetch(fire, pixel, 0);
        flame.a = min(flame.a, 1.0);
        color = flame + color * (1.0 - flame.a);
    }
    return color;
}
