/* Runs the exactness probe in the fragment stage: vectors are texels, and the results are written
 * as the texels of eight targets. lib/gpu/probe.c compares them with C. */
#include "shared/probe.h"

layout(binding = 0) uniform usampler2D vectors;

layout(location = 0) out uvec4 sums;
layout(location = 1) out uvec4 orders;
layout(location = 2) out uvec4 roots;
layout(location = 3) out uvec4 curves;
layout(location = 4) out uvec4 unit_square;
layout(location = 5) out uvec4 cross_lerp;
layout(location = 6) out uvec4 noise_hash;
layout(location = 7) out uvec4 around;

void main()
{
    probe_result r = probe_run(texelFetch(vectors, ivec2(gl_FragCoord.xy), 0));
    sums = r.sums;
    orders = r.orders;
    roots = r.roots;
    curves = r.curves;
    unit_square = r.unit;
    cross_lerp = r.cross;
    noise_hash = r.noise;
    around = r.around;
}
