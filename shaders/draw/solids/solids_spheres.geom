/* Makes the rectangle of the picture that a sphere covers, for solids_spheres.frag. It lies between
 * the tangents from the eye, and is a pixel larger on every side, since a driver may have a pixel's
 * samples elsewhere than the fragment shader. A sphere that reaches the near plane is not drawn. */
// variant:
// variant: PATTERN=1
#include "shared/draw_layout.h"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };

layout(location = 0) in vec4 center[];
layout(location = 1) in vec4 reflected[];
layout(location = 2) in vec4 emitted[];
layout(location = 3) in vec4 bloom_weights[];
#ifdef PATTERN
layout(location = 4) in vec4 second_albedo[];
layout(location = 5) in vec4 ball_pose[];
#endif

layout(location = 0) flat out vec4 sphere;
layout(location = 1) flat out vec4 albedo;
layout(location = 2) flat out vec4 glow;
layout(location = 3) flat out vec4 bloom;
#ifdef PATTERN
layout(location = 4) flat out vec4 other;
layout(location = 5) flat out vec4 pose;
#endif

/* Returns the slopes of the two tangents from the eye at a circle, in a plane through the eye. x:
 * of the circle's middle, sideways; depth: ahead of the eye. */
vec2 tangents(float x, float depth, float radius)
{
    float t = sqrt(max(x * x + depth * depth - radius * radius, 0.0));
    return vec2((x * t - depth * radius) / (depth * t + x * radius),
                (x * t + depth * radius) / (depth * t - x * radius));
}

void main()
{
    float radius = center[0].w, depth = -center[0].z;
    if (radius <= 0.0 || depth - radius <= view.eye.w)
        return;
    vec2 pixel = 2.0 / view.frustum.zw;
    vec2 x = tangents(center[0].x, depth, radius) + view.principal.z;
    vec2 y = tangents(-center[0].y, depth, radius) - view.principal.w;
    x = x / view.frustum.x + vec2(-pixel.x, pixel.x);
    y = y / view.frustum.y + vec2(-pixel.y, pixel.y);
    for (int i = 0; i < 4; i++) {
        gl_Position = vec4(i < 2 ? x.x : x.y, (i & 1) == 0 ? y.x : y.y, 0.0, 1.0);
        sphere = center[0];
        albedo = reflected[0];
        glow = emitted[0];
        bloom = bloom_weights[0];
#ifdef PATTERN
        other = second_albedo[0];
        pose = ball_pose[0];
#endif
        EmitVertex();
    }
    EndPrimitive();
}
