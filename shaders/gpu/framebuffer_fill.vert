/* Makes one triangle that covers the whole viewport, from three vertices without attributes. Every
 * pass over a whole framebuffer draws it (kiln_framebuffer_fill in lib/gpu/framebuffer.c). */
void main()
{
    vec2 corner = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2));
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
