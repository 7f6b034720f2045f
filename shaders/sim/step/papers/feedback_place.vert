/* Technique `feedback`: writes a particle of the stream into its slot; all slots have been emptied.
 * The slot follows from the serial, so the order of the stream does not matter. */
#include "sim/step/blocks.h"

#include "shared/particle.h"

layout(location = 0) in uvec4 position_serial;
layout(location = 1) in uvec4 velocity_birth;

layout(std430, binding = SIM_BIND_RECORDS) writeonly buffer record_block
{
    kiln_particle records[];
};

void main()
{
    uint index = step_params.base + position_serial.w % step_params.capacity;
    records[index].position_serial = position_serial;
    records[index].velocity_birth = velocity_birth;
}
