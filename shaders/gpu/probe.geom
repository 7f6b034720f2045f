/* Runs the exactness probe, which tests whether a driver computes the same bits as C, in the
 * geometry stage. Transform feedback captures the results, and lib/gpu/probe.c compares them with
 * those of C. */
layout(points) in;
layout(points, max_vertices = 1) out;

#include "shared/probe.h"

in vertex_block
{
    uvec4 bits;
}
vertices[];

/* The members of struct probe_result; lib/gpu/probe.c captures them in this order. */
out uvec4 sums;
out uvec4 orders;
out uvec4 roots;
out uvec4 curves;
out uvec4 unit_square;
out uvec4 cross_lerp;
out uvec4 noise_hash;
out uvec4 around;

void main()
{
    probe_result r = probe_run(vertices[0].bits);
    sums = r.sums;
    orders = r.orders;
    roots = r.roots;
    curves = r.curves;
    unit_square = r.unit;
    cross_lerp = r.cross;
    noise_hash = r.noise;
    around = r.around;
    EmitVertex();
    EndPrimitive();
}
