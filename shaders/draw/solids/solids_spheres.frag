/* A sphere, cast by one ray a pixel and lit like the backdrop. Its silhouette is found at the four
 * samples of a pixel, whose nearest spheres a depth test keeps. */
// variant: SOLIDS=1
// variant: SOLIDS=1 PATTERN=1
// variant: SOLIDS=1 ROUND=1 TURNED=1 MESHES=1 SKY_IMAGE=1 SOFT_SUN=1
#include "shared/draw_layout.h"
#include "shared/shape_layout.h"

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };
layout(std140, binding = KILN_BIND_BACKDROP) uniform backdrop_block { kiln_draw_backdrop backdrop; };
layout(std140, binding = KILN_BIND_SHAPES) uniform shape_block { kiln_draw_shapes shapes; };
layout(binding = 2) uniform sampler2D scene_depth;

#include "draw/backdrop/surface.glsl"
#include "shared/ball_pattern.h"

layout(location = 0) flat in vec4 sphere; /* in view space; w: radius */
layout(location = 1) flat in vec4 albedo; /* a: lit */
layout(location = 2) flat in vec4 glow;
layout(location = 3) flat in vec4 bloom;
#ifdef PATTERN
layout(location = 4) flat in vec4 other; /* a: segments of each colour; 0: none, below 0: a stripe */
layout(location = 5) flat in vec4 pose;
#endif

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_bloom;

/* A rotated grid: no two samples share a row or a column. */
const vec2 SAMPLE_OFFSETS[4] =
    vec2[](vec2(-0.125, -0.375), vec2(0.375, -0.125), vec2(-0.375, 0.125), vec2(0.125, 0.375));

/* The ray through a pixel position in view space, with z of -1: its t is depth. */
vec3 view_ray(vec2 pixel)
{
    vec2 ndc = pixel / view.frustum.zw * 2.0 - 1.0;
    return vec3(ndc.x * view.frustum.x, -ndc.y * view.frustum.y, -1.0);
}

/* The t at which a ray passes the centre most closely, and the square of the radius less that of the
 * distance there: negative for a miss. */
vec2 approach(vec3 ray)
{
    float t = dot(ray, sphere.xyz) / dot(ray, ray);
    vec3 away = ray * t - sphere.xyz;
    return vec2(t, sphere.w * sphere.w - dot(away, away));
}

#ifdef PATTERN

vec3 painted(vec3 normal, vec3 direction, float t)
{
    vec3 twice = -2.0 * cross(pose.xyz, normal);
    vec3 n = normal + twice * pose.w - cross(pose.xyz, twice);
    float facing = max(-dot(direction, normal), 0.0) * inversesqrt(dot(direction, direction));
    float width = 2.0 * view.frustum.y * t / (view.frustum.w * sphere.w * max(facing, 0.1));
    return mix(albedo.rgb, other.rgb, ball_other_part(n, other.a, width));
}

#endif

void main()
{
    int mask = 0;
    for (int i = 0; i < 4; i++)
        mask |= approach(view_ray(gl_FragCoord.xy + SAMPLE_OFFSETS[i])).y >= 0.0 ? 1 << i : 0;
    vec3 ray = view_ray(gl_FragCoord.xy);
    vec2 near = approach(ray);
    float t = near.x - sqrt(max(near.y, 0.0) / dot(ray, ray));
    if (mask == 0 || t > texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r)
        discard;

    vec3 direction = view_to_world(ray);
    vec3 normal = view_to_world(normalize(ray * t - sphere.xyz));
    vec3 point = view.eye.xyz + direction * t;
    vec3 reflected = albedo.rgb;
#ifdef PATTERN
    reflected = painted(normal, direction, t);
#endif
    hit h = hit(t, 0, normal, reflected);
    float sunlit = sun_visibility(point, normal) * sunlight_through_smoke(point);
    vec3 lit = radiance(h, direction, soft_irradiance(h, point), sunlit).rgb;
    vec3 rgb = glow.rgb + mix(reflected, lit, albedo.a);

    gl_SampleMask[0] = mask;
    gl_FragDepth = 1.0 / (1.0 + t); /* a float has its precision near 0: far away */
    out_color = vec4(rgb, 1.0);
    out_bloom = vec4(bloom.rgb * rgb, 1.0);
}
