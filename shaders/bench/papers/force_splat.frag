/* Computes the acceleration that the body of a quad gives to the body of a texel. It is softened as
 * in shared/interact_gravity.h, which has its own arithmetic. Blending sums the accelerations of
 * all quads (Drone 2007, 7.4.3.1). */
#include "shared/papers/bench_layout.h"

layout(binding = 0) uniform sampler2D bodies; /* place, m, and strength, m/s^2 at 1 m */

layout(location = SPLAT_AT_ROW) uniform uint row; /* texels in a row */
layout(location = SPLAT_AT_SOFTENING) uniform float softening_square;

flat in uint number;

layout(location = 0) out vec4 acceleration;

void main()
{
    vec4 source = texelFetch(bodies, ivec2(int(number % row), int(number / row)), 0);
    vec3 to = source.xyz - texelFetch(bodies, ivec2(gl_FragCoord.xy), 0).xyz;
    float inverse = inversesqrt(dot(to, to) + softening_square);
    acceleration = vec4(to * (inverse * inverse * inverse * source.w), 0.0);
}
