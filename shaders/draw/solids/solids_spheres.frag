/* Draws one opaque sphere particle for the technique backdrop=gl. lib/draw/solids/solids_gl.c draws
 * all spheres with it into textures of four samples a pixel: solids_spheres.vert finds a sphere's
 * place and look, solids_spheres.geom makes the rectangle that it covers, and this shader casts
 * rays.
 *
 * One ray through the middle of the pixel finds depth and light, so that lighting is computed once
 * a pixel. Four more rays find which of the pixel's samples the sphere covers, so that silhouettes
 * are smooth. A depth test for each sample keeps the nearest sphere, and solids_resolve.frag puts
 * the mean of the samples over the backdrop. A sphere is lit by the functions that light the
 * backdrop.
 *
 * If the middle ray misses the sphere but a sample's ray hits it, depth and light are computed at
 * the point of the middle ray that is nearest to the sphere's centre. lib/draw/solids/solid_simd.c
 * draws the same picture on the host, with samples at the same places. */
// variant: SOLIDS=1
// variant: SOLIDS=1 PATTERN=1
// variant: SOLIDS=1 SHAPES_STORED=1
// variant: SOLIDS=1 MESHES=1 SKY_IMAGE=1
#include "shared/draw_layout.h"
#include "shared/shape_layout.h"

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };
layout(std140, binding = KILN_BIND_BACKDROP) uniform backdrop_block { kiln_draw_backdrop backdrop; };
layout(std140, binding = KILN_BIND_SHAPES) uniform shape_block { kiln_draw_shapes shapes; };
layout(binding = KILN_UNIT_SCENE_DEPTH) uniform sampler2D scene_depth;

#include "draw/backdrop/surface.glsl"
#include "shared/ball_pattern.h"

layout(location = 0) flat in vec4 sphere; /* in view space; w: radius */
layout(location = 1) flat in vec4 albedo; /* a: from 0, unlit, to 1, lit */
layout(location = 2) flat in vec4 glow;  /* light that the sphere emits; a: below 1 where it is
                                          * drawn larger than it is, to fill a pixel */
layout(location = 3) flat in vec4 bloom; /* weights of the colour in the bloom */
#ifdef PATTERN
layout(location = 4) flat in vec4 second_albedo; /* a: number of the pattern's segments of each
                                                  * colour; 0: no pattern, below 0: a stripe */
layout(location = 5) flat in vec4 pose; /* quaternion that turns the ball into the world */
#endif

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_bloom;

/* The positions of a pixel's samples, px from its middle, form a rotated grid, in which no two
 * samples share a row or a column. The driver's own samples may lie elsewhere, since
 * solids_resolve.frag takes the mean of all four. */
const vec2 SAMPLE_OFFSETS[4] =
    vec2[](vec2(-0.125, -0.375), vec2(0.375, -0.125), vec2(-0.375, 0.125), vec2(0.125, 0.375));

/* Returns the ray from the eye through a position in the picture, px, in view space. Its z is -1,
 * so the t of a point on it is the point's depth. */
vec3 view_ray(vec2 pixel)
{
    vec2 ndc = pixel / view.frustum.zw * 2.0 - 1.0;
    return vec3(vec2(ndc.x, -ndc.y) * view.frustum.xy - view.principal.zw, -1.0);
}

/* Returns the t at which a ray is nearest to the sphere's centre, and the square of the radius
 * minus the square of that distance, which is negative if the ray misses the sphere. */
vec2 closest_approach(vec3 ray)
{
    float t = dot(ray, sphere.xyz) / dot(ray, ray);
    vec3 away = ray * t - sphere.xyz;
    return vec2(t, sphere.w * sphere.w - dot(away, away));
}

#ifdef PATTERN

/* Returns the albedo of the sphere's pattern where its normal is `normal`. The conjugate of
 * pose turns the normal into the ball's own axes. */
vec3 pattern_albedo(vec3 normal, vec3 direction, float t)
{
    vec3 twice = -2.0 * cross(pose.xyz, normal);
    vec3 n = normal + twice * pose.w - cross(pose.xyz, twice);
    float facing = max(-dot(direction, normal), 0.0) * inversesqrt(dot(direction, direction));
    float width = 2.0 * view.frustum.y * t / (view.frustum.w * sphere.w * max(facing, 0.1));
    return mix(albedo.rgb, second_albedo.rgb, ball_other_part(n, second_albedo.a, width));
}

#endif

void main()
{
    int mask = 0;
    for (int i = 0; i < 4; i++) {
        vec3 ray = view_ray(gl_FragCoord.xy + SAMPLE_OFFSETS[i]);
        mask |= closest_approach(ray).y >= 0.0 ? 1 << i : 0;
    }
    vec3 ray = view_ray(gl_FragCoord.xy);
    vec2 approach = closest_approach(ray);
    float t = approach.x - sqrt(max(approach.y, 0.0) / dot(ray, ray));
    if (mask == 0 || t > texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r)
        discard;

    vec3 direction = view_to_world(ray);
    vec3 normal = view_to_world(normalize(ray * t - sphere.xyz));
    vec3 point = view.eye.xyz + direction * t;
    vec3 reflected = albedo.rgb;
#ifdef PATTERN
    reflected = pattern_albedo(normal, direction, t);
#endif
    lit_middle = vec4(view.eye.xyz + view_to_world(sphere.xyz), 1.0);
    hit h = hit(t, 0, normal, reflected);
    float sunlit = sun_visibility(point, normal) * sunlight_through_smoke(point);
    vec3 lit = radiance_before_haze(h, irradiance_without_sun(h, point), sunlit);
    vec3 rgb = behind_haze(glow.rgb + mix(reflected, lit, albedo.a), t, direction);

    gl_SampleMask[0] = mask;
    /* The depth is 1 at the eye and 0 far away, since floats are most precise near 0.
     * solids_resolve.frag computes t from it. */
    gl_FragDepth = 1.0 / (1.0 + t);
    out_color = vec4(rgb, 1.0) * glow.a;
    out_bloom = vec4(bloom.rgb * rgb, 1.0) * glow.a;
}
