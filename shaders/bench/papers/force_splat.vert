/* Makes a quad over the whole force texture for each body that pulls, and passes on the body's
 * number (Drone 2007, 7.4.2). */
flat out uint number;

void main()
{
    number = uint(gl_InstanceID);
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
