/* Runs the exactness probe, which tests whether a driver computes the same bits as C, in the
 * fragment stage. Each texel of `vectors` is a test vector, and the results are written as texels
 * of eight targets. lib/gpu/probe.c compares them with those of C. */
#include "shared/probe.h"

layout(binding = 0) uniform usampler2D vectors;

layout(location = 0) out uvec4 out_sums;
layout(location = 1) out uvec4 out_orders;
layout(location = 2) out uvec4 out_roots;
layout(location = 3) out uvec4 out_curves;
layout(location = 4) out uvec4 out_unit;
layout(location = 5) out uvec4 out_cross;
layout(location = 6) out uvec4 out_noise;
layout(location = 7) out uvec4 out_around;

void main()
{
    probe_result r = probe_run(texelFetch(vectors, ivec2(gl_FragCoord.xy), 0));
    out_sums = r.sums;
    out_orders = r.orders;
    out_roots = r.roots;
    out_curves = r.curves;
    out_unit = r.unit;
    out_cross = r.cross;
    out_noise = r.noise;
    out_around = r.around;
}
