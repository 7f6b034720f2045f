/* Covered, and how deep: see cover_before in mesh_trace.glsl. */
layout(location = 0) in float depth;

layout(location = 0) out vec2 out_seen;

void main()
{
    out_seen = vec2(1.0, depth);
}
