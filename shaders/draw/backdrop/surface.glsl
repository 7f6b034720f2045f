/* A point of a surface and the light that it sends to the eye: sky, sun with its shadow, point lights,
 * haze, less what smoke keeps off. For shaders that have the blocks `view` and `backdrop`, and
 * `shapes` with the defines of backdrop.frag. */
#include "draw/light/smoke_shadow.glsl"

const float FAR = 1e9;
const float PI = 3.14159265;

/* The sky's surface is -1, the floor's 0; a face of a box has a number of its own, below 1000. */
const int SURFACE_SPHERES = 1000;
const int SURFACE_CYLINDERS = 1100; /* side and ends */
const int SURFACE_TURNED = 1200;    /* as boxes */
const int SURFACE_CAPSULES = 2200;
const int SURFACE_PLANES = 2250;
const int SURFACE_MESHES = 2300; /* 4 of each; nothing is above these */
struct hit {
    float t;
    int surface;
    vec3 normal;
    vec3 albedo;
};

vec3 view_to_world(vec3 v)
{
    return view.world_to_view[0].xyz * v.x + view.world_to_view[1].xyz * v.y +
           view.world_to_view[2].xyz * v.z;
}

/* The ray through a pixel position, with view-space z of -1: its t is view-space depth. */
vec3 ray_direction(vec2 pixel)
{
    vec2 ndc = pixel / view.frustum.zw * 2.0 - 1.0;
    return view_to_world(vec3(ndc.x * view.frustum.x, -ndc.y * view.frustum.y, -1.0));
}

vec3 safe_inverse(vec3 direction)
{
    vec3 magnitude = max(abs(direction), vec3(1e-8));
    return mix(vec3(1.0), vec3(-1.0), lessThan(direction, vec3(0.0))) / magnitude;
}

/* Slabs: entry and exit of the ray through box i. */
vec2 box_interval(int i, vec3 origin, vec3 inverse)
{
    vec3 center = (backdrop.box_center[i].xyz - origin) * inverse;
    vec3 extent = backdrop.box_half[i].xyz * abs(inverse);
    vec3 near = center - extent;
    vec3 far = center + extent;
    return vec2(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
}

/* What is left of the sky beside a box, in whose frame the vectors are: falls off with the distance
 * in units of the box. Not a solid angle, but it anchors a box to the floor. */
float box_sky_visibility(vec3 towards, vec3 halves, vec3 normal)
{
    float away = length(max(abs(towards) - halves, vec3(0.0)));
    float facing = clamp(dot(towards, normal) * inversesqrt(dot(towards, towards)) + 0.4, 0.0, 1.0);
    float size = min(min(halves.x, halves.y), halves.z);
    bool outside = dot(towards, normal) > -dot(halves, abs(normal)) + 1e-3;
    float fall = 1.0 / (1.0 + 2.0 * away / size);
    return outside ? 1.0 - 0.7 * facing * fall * fall : 1.0;
}

#ifdef SOFT_SUN
#include "draw/light/sun_cover.glsl"
#endif
#if defined(ROUND) || defined(TURNED)
#include "draw/backdrop/round_interval.glsl"
#endif
#ifdef ROUND
#include "draw/backdrop/round.glsl"
#endif
#ifdef TURNED
#include "draw/backdrop/turned.glsl"
#endif
#ifdef MESHES
#include "draw/backdrop/mesh_trace.glsl"
#endif
#ifdef SOLIDS
#include "draw/light/solid_shadow.glsl"
#endif
#ifdef SKY_IMAGE
#include "draw/backdrop/sky_image.glsl"
#endif

/* The sun's light that boxes let through. */
#ifdef SOFT_SUN

float box_sun_visibility(vec3 origin)
{
    float visible = 1.0;
    vec3 inverse = safe_inverse(backdrop.sun_direction.xyz);
    vec3 alike = edges_alike(backdrop.sun_direction.xyz);
    for (int i = 0; i < int(backdrop.counts.x); i++) {
        vec3 center = (backdrop.box_center[i].xyz - origin) * inverse;
        vec3 extent = backdrop.box_half[i].xyz * abs(inverse);
        visible *= 1.0 - box_cover(center - extent, center + extent, inverse, alike,
                                   shapes.sun_right.w);
    }
    return visible;
}

#else

float box_sun_visibility(vec3 origin)
{
    vec3 inverse = safe_inverse(backdrop.sun_direction.xyz);
    for (int i = 0; i < int(backdrop.counts.x); i++) {
        vec2 interval = box_interval(i, origin, inverse);
        if (max(interval.x, 0.0) < interval.y)
            return 0.0;
    }
    return 1.0;
}

#endif

float sun_visibility(vec3 point, vec3 normal)
{
    vec3 origin = point + normal * 1e-3;
    float visible = box_sun_visibility(origin);
#ifdef ROUND
    visible *= round_sun_visibility(origin);
#endif
#ifdef TURNED
    visible *= turned_sun_visibility(origin);
#endif
#ifdef MESHES
    visible *= mesh_sun_visibility(origin, normal);
#endif
#ifdef SOLIDS
    visible *= solid_sun_visibility(origin);
#endif
    return visible;
}

float sky_visibility(vec3 point, vec3 normal)
{
    float visible = 1.0;
    for (int i = 0; i < int(backdrop.counts.x); i++) {
        vec3 towards = backdrop.box_center[i].xyz - point;
        visible *= box_sky_visibility(towards, backdrop.box_half[i].xyz, normal);
    }
#ifdef ROUND
    visible *= round_sky_visibility(point, normal);
#endif
#ifdef TURNED
    visible *= turned_sky_visibility(point, normal);
#endif
#ifdef MESHES
    visible *= mesh_sky_visibility(point, normal);
#endif
    return visible;
}

vec3 sky(vec3 direction)
{
#ifdef SKY_IMAGE
    return sky_picture(direction, 2.0 * view.frustum.y / view.frustum.w);
#endif
    float up = clamp(normalize(direction).y, 0.0, 1.0);
    return mix(backdrop.sky_horizon.rgb, backdrop.sky_top.rgb, 1.0 - exp(-4.0 * up));
}

/* What the floor fades into far away. */
vec3 horizon(vec3 direction)
{
#ifdef SKY_IMAGE
    return sky_picture(vec3(direction.x, 0.0, direction.z), 0.1);
#endif
    return backdrop.sky_horizon.rgb;
}

/* What arrives from the sky and the point lights. */
vec3 soft_irradiance(hit h, vec3 point)
{
    vec3 ambient = mix(backdrop.sky_horizon.rgb, backdrop.sky_top.rgb, 0.5 + 0.5 * h.normal.y);
    vec3 irradiance =
        PI * ambient * sky_visibility(point, h.normal) * skylight_through_smoke(point);
    for (int i = 0; i < int(backdrop.counts.y); i++) {
        vec3 towards = backdrop.lights[i].position_radius2.xyz - point;
        float d2 = dot(towards, towards);
        float cosine = max(dot(h.normal, towards) * inversesqrt(max(d2, 1e-9)), 0.0);
        irradiance += PI * backdrop.lights[i].color.rgb * cosine /
                      (d2 + backdrop.lights[i].position_radius2.w);
    }
    return irradiance;
}

/* Light that the surface sends along the ray. Lambert: radiance = albedo / pi * irradiance. */
vec4 radiance(hit h, vec3 direction, vec3 irradiance, float sunlit)
{
    bool transparent = backdrop.counts.z != 0u;
    if (h.surface < 0)
        return transparent ? vec4(0.0) : vec4(sky(direction), 1.0);
    float facing = max(dot(h.normal, backdrop.sun_direction.xyz), 0.0);
    vec3 color = h.albedo / PI * (irradiance + backdrop.sun_color.rgb * facing * sunlit);
    float clear = transparent ? 1.0 : exp(-backdrop.floor_params.z * h.t * length(direction));
    return vec4(mix(horizon(direction), color, clear), 1.0);
}
