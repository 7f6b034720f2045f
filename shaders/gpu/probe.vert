/* Passes a vector of bits to probe.geom unchanged. */
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
