/* Blends scene, particles and fire into one picture of light (Heinz 2019, figure 3.1). */
layout(binding = 0) uniform sampler2D scene;
layout(binding = 1) uniform sampler2D particles; /* premultiplied: all particles, or smoke alone
                                                  * (separate) */
layout(binding = 2) uniform sampler2D fire;      /* premultiplied, alpha summed; for separate_fire */

uniform bool separate_fire;
uniform bool scene_alone; /* the scene is a sum of the shutter, which has the particles already */

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
