/* Runs the exactness probe, which tests whether a driver computes the same bits as C, in the
 * compute stage, on test vectors of bits. lib/gpu/probe.c compares the results with those of C. */
#include "shared/probe.h"

layout(local_size_x = 64) in;

layout(std430, binding = PROBE_BIND_VECTORS) readonly buffer vector_block
{
    uint4 vectors[];
};

layout(std430, binding = PROBE_BIND_RESULTS) writeonly buffer result_block
{
    probe_result results[];
};

layout(location = PROBE_AT_COUNT) uniform uint count;

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint i = group * 64u + gl_LocalInvocationID.x;
    if (i < count)
        results[i] = probe_run(vectors[i]);
}
