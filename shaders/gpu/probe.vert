/* A vector for probe.geom. */
layout(location = 0) in uvec4 bits;

out vertex_block
{
    uvec4 bits;
}
vertex;

void main()
{
    vertex.bits = bits;
}
