/* Technique `feedback`: passes a record to the geometry shader unchanged. Its words are integers,
 * since this stage may flush denormal floats. For feedback_emit.geom a vertex is an emitter, whose
 * record is not used. */
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
