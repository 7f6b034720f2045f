/* Draws a fragment of a particle that is a mesh, lit like the backdrop; instances.vert computes its
 * triangle. As in solids_spheres.frag, a triangle has one depth and one light in a pixel, though it
 * may cover only some of the four samples: those at the pixel's middle, or at the triangle's edge
 * where the middle is outside of the triangle. */
// variant: SOLIDS=1
// variant: SOLIDS=1 INSTANCES=1 MESHES=1 SKY_IMAGE=1
#include "shared/draw_layout.h"
#include "shared/shape_layout.h"

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };
layout(std140, binding = KILN_BIND_BACKDROP) uniform backdrop_block { kiln_draw_backdrop backdrop; };
layout(std140, binding = KILN_BIND_SHAPES) uniform shape_block { kiln_draw_shapes shapes; };
layout(binding = KILN_UNIT_SCENE_DEPTH) uniform sampler2D scene_depth;

#include "draw/backdrop/surface.glsl"

layout(location = 0) flat in vec4 a; /* corners in view space, m */
layout(location = 1) flat in vec4 b;
layout(location = 2) flat in vec4 c;
layout(location = 3) flat in vec4 normal_a;
layout(location = 4) flat in vec4 normal_b;
layout(location = 5) flat in vec4 normal_c;
layout(location = 6) flat in vec4 middle; /* of the particle, in view space; w: radius of the sphere
                                           * that throws its shadow, m */
layout(location = 7) flat in vec4 albedo; /* a: 1 if lit, 0 if unlit, or between */
layout(location = 8) flat in vec4 glow; /* a: as in solids_spheres.frag */
layout(location = 9) flat in vec4 bloom;

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_bloom;

void main()
{
    vec2 ndc = gl_FragCoord.xy / view.frustum.zw * 2.0 - 1.0;
    vec3 ray = vec3(vec2(ndc.x, -ndc.y) * view.frustum.xy - view.principal.zw, -1.0);
    vec3 face = cross(b.xyz - a.xyz, c.xyz - a.xyz);
    face = dot(face, a.xyz) > 0.0 ? -face : face; /* turned towards the eye */
    float side = dot(cross(b.xyz - a.xyz, c.xyz - a.xyz), face) > 0.0 ? -1.0 : 1.0;
    vec3 parts = vec3(dot(cross(b.xyz, c.xyz - b.xyz), ray), dot(cross(c.xyz, a.xyz - c.xyz), ray),
                      dot(cross(a.xyz, b.xyz - a.xyz), ray));
    parts = max(parts * side, vec3(0.0));
    float sum = parts.x + parts.y + parts.z;
    parts /= max(sum, 1e-30);
    vec3 seen = a.xyz * parts.x + b.xyz * parts.y + c.xyz * parts.z;
    float t = -seen.z;
    if (sum <= 0.0 || t < view.eye.w || t > texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r)
        discard;

    vec3 across = normal_a.xyz * parts.x + normal_b.xyz * parts.y + normal_c.xyz * parts.z;
    across = dot(across, face) < 0.0 ? -across : across; /* both sides are visible */
    vec3 direction = view_to_world(ray);
    vec3 normal = view_to_world(across * inversesqrt(max(dot(across, across), 1e-12)));
    vec3 point = view.eye.xyz + view_to_world(seen);
    /* The shadow ray starts outside of the sphere that throws the mesh's shadow, so that the mesh
     * does not shade itself. */
    float ahead = dot(view_to_world(middle.xyz - seen), backdrop.sun_direction.xyz);
    float outwards = max(ahead + 0.05 * middle.w + 1e-5 * t, 0.0);
    lit_middle = vec4(view.eye.xyz + view_to_world(middle.xyz), 1.0);
    hit h = hit(t, 0, normal, albedo.rgb);
    float sunlit = sun_visibility(point + backdrop.sun_direction.xyz * outwards, normal) *
                   sunlight_through_smoke(point);
    vec3 lit = radiance_before_haze(h, irradiance_without_sun(h, point), sunlit);
    vec3 rgb = behind_haze(glow.rgb + mix(albedo.rgb, lit, albedo.a), t, direction);

    gl_FragDepth = 1.0 / (1.0 + t); /* near is 1, far is 0, as in solids_spheres.frag */
    out_color = vec4(rgb, 1.0) * glow.a;
    out_bloom = vec4(bloom.rgb * rgb, 1.0) * glow.a;
}
