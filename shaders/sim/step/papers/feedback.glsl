/* Declares the inputs and the stream of the geometry shaders of technique `feedback`: feedback.geom
 * and feedback_emit.geom. */
#ifndef KILN_SIM_STEP_PAPERS_FEEDBACK_GLSL
#define KILN_SIM_STEP_PAPERS_FEEDBACK_GLSL

#include "sim/step/slot.glsl"

in vertex_block
{
    uvec4 position_serial;
    uvec4 velocity_birth;
    uint number;
}
vertices[];

/* A record of the stream, which transform feedback captures. */
out uvec4 stream_position_serial;
out uvec4 stream_velocity_birth;

void write_particle(kiln_particle p)
{
    stream_position_serial = p.position_serial;
    stream_velocity_birth = p.velocity_birth;
    EmitVertex();
    EndPrimitive();
}

#endif
