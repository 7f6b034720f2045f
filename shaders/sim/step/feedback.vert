/* Technique `feedback`: a record goes on to the geometry shader as it is. In integers: this stage
 * may flush denormal floats. An emitter is a vertex as well; its record is of no account. */
layout(location = 0) in uvec4 position_serial;
layout(location = 1) in uvec4 velocity_birth;

out vertex_block
{
    uvec4 position_serial;
    uvec4 velocity_birth;
    uint number; /* of the slot, or of the emitter */
}
vertex;

void main()
{
    vertex.position_serial = position_serial;
    vertex.velocity_birth = velocity_birth;
    vertex.number = uint(gl_VertexID);
}
