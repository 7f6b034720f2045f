/* Finds the light that a point of a surface sends to the eye. The sky, the sun and the point lights
 * light the surface; objects shade it from sky and sun, smoke dims these two, and haze covers what
 * is far away. backdrop.frag includes this file for all surfaces of the backdrop, and the fragment
 * shaders in shaders/draw/solids include it for solid particles.
 *
 * The including shader declares the blocks `view`, `backdrop` and `shapes`. Defines compile in the
 * shadows of what not every scene has: KILN_SHAPES (kinds of shapes), MESHES, SOLIDS (solid
 * particles). SKY_IMAGE takes the sky from an image. Other defines leave out what the scene has
 * none of: NO_SUN, NO_SMOKE (smoke that throws shadows), NO_LAMPS (lamps and light of fire),
 * NO_LAMP_SHADOWS, NO_RECTANGLES (lamps that are rectangles). */
#include "draw/light/smoke_shadow.glsl"
#include "shared/haze.h"
#include "shared/lamp.h"
#include "shared/light_cover.h"
#include "shared/surface_light.h"

const float FAR = 1e9; /* the t of a ray that hits nothing, m */
const float PI = SURFACE_PI;

/* Describes the point that a ray hits. */
struct hit {
    float t;     /* the point is origin + t * direction */
    int surface; /* KILN_SURFACE_*; 0: the floor; -1: nothing, so the sky */
    vec3 normal; /* unit */
    vec3 albedo;
};

vec3 view_to_world(vec3 v)
{
    return view.world_to_view[0].xyz * v.x + view.world_to_view[1].xyz * v.y +
           view.world_to_view[2].xyz * v.z;
}

/* Returns the world-space direction of the ray through a position in the picture, given in pixels.
 * The direction has a view-space z of -1, so the t of a point on the ray is the point's view-space
 * depth. */
vec3 ray_direction(vec2 pixel)
{
    vec2 ndc = pixel / view.frustum.zw * 2.0 - 1.0;
    return view_to_world(vec3(vec2(ndc.x, -ndc.y) * view.frustum.xy - view.principal.zw, -1.0));
}

#include "draw/backdrop/shapes.glsl"
#ifdef MESHES
#include "draw/backdrop/mesh_trace.glsl"
#endif
#ifdef SOLIDS
#include "draw/light/solid_shadow.glsl"
#include "draw/light/lamp_solids.glsl"
#endif
#ifdef SKY_IMAGE
#include "draw/backdrop/sky_image.glsl"
#endif

/* Returns the part of the sun, 0 to 1, that the objects leave visible from a point of a surface. */
float sun_visibility(vec3 point, vec3 normal)
{
#ifdef NO_SUN
    return 0.0;
#else
    vec3 origin = point + normal * LIGHT_START;
    float visible = shapes_light_visibility(
        -1, origin, sun_way_of(backdrop.sun_direction, shapes.sun_right.w, 0.0));
#ifdef MESHES
    visible *= mesh_sun_visibility(origin, normal);
#endif
#ifdef SOLIDS
    visible *= solid_sun_visibility(origin);
#endif
    return visible;
#endif
}

/* Returns the part of the sky, 0 to 1, that the objects leave visible from a point of a surface.
 * Solid particles do not count. */
float sky_visibility(vec3 point, vec3 normal)
{
    float visible = shapes_sky_visibility(point, normal);
#ifdef MESHES
    visible *= mesh_sky_visibility(point, normal);
#endif
    return visible;
}

/* Returns the glow around the sun. */
vec3 sun_glow(vec3 direction)
{
    if (backdrop.sky_horizon.w <= 0.0)
        return vec3(0.0);
    float glow = sky_glow(direction, backdrop.sun_direction, backdrop.floor_params.w);
    return backdrop.sun_color.rgb * (backdrop.sky_horizon.w * glow);
}

/* Returns the sun's disc, for a ray from the eye that hits nothing. */
vec3 sun_disc(vec3 direction)
{
    if (backdrop.sky_top.w <= 0.0 || backdrop.counts.z != 0u)
        return vec3(0.0);
    float pixel = 2.0 * view.frustum.y / view.frustum.w;
    return backdrop.sun_color.rgb *
           (backdrop.sky_top.w * sky_disc(direction, backdrop.sun_direction, pixel));
}

/* Returns the sky without the sun's disc. */
vec3 sky(vec3 direction)
{
#ifdef SKY_IMAGE
    vec3 color = sky_picture(direction, 2.0 * view.frustum.y / view.frustum.w);
#else
    vec3 color = sky_gradient(backdrop.sky_horizon, backdrop.sky_top, direction);
#endif
    return color + sun_glow(direction);
}

/* Returns the colour of the haze, into which surfaces fade far away. */
vec3 horizon(vec3 direction)
{
    vec3 level = vec3(direction.x, 0.0, direction.z);
#ifdef SKY_IMAGE
    return sky_picture(level, 0.1) + sun_glow(level);
#else
    return backdrop.sky_horizon.rgb + sun_glow(level);
#endif
}

/* Returns the part of lamp i, 0 to 1, that a point sees past the backdrop's objects and past solid
 * particles. */
float lamp_visibility(int i, vec3 point, vec3 normal)
{
#ifdef NO_LAMP_SHADOWS
    return 1.0;
#else
    vec3 origin = point + normal * LIGHT_START;
    light_way way = lamp_way_to(backdrop.lights[i], origin, normal, 0.0);
    float visible = shapes_light_visibility(i, origin, way);
#if defined MESHES || defined SOLIDS
    way = lamp_way_of(backdrop.lights[i].position_radius2.xyz - origin, backdrop.lights[i].color.w,
                      0.0);
#endif
#ifdef MESHES
    visible *= 1.0 - mesh_lamp_cover(i, normal, way);
#endif
#ifdef SOLIDS
    visible *= 1.0 - solid_lamp_cover(i, normal, way);
#endif
    return visible;
#endif
}

/* Holds the light of sky and lamps that arrives at a point. */
struct arrived {
    vec3 irradiance;
    /* The brightness of it without shadows and cones of lamps; that of what they take. */
    float all, hidden;
};

/* Returns the light of the sky. */
arrived skylight(hit h, vec3 point)
{
    vec3 ambient = sky_ambient(backdrop.sky_horizon, backdrop.sky_top, h.normal);
    vec3 irradiance =
        PI * ambient * sky_visibility(point, h.normal) * skylight_through_smoke(point);
    return arrived(irradiance, dot(irradiance, vec3(1.0)), 0.0);
}

/* Adds the light of lamp i. Returns the part of the lamp that the point sees past objects and
 * within the lamp's cone. */
float add_lamp(int i, hit h, vec3 point, inout arrived light)
{
    vec3 towards = backdrop.lights[i].position_radius2.xyz - point;
    vec3 color = backdrop.lights[i].color.rgb;
    float part = lamp_irradiance(backdrop.lights[i], towards, h.normal);
    float seen = lamp_cone(backdrop.lights[i], towards);
    if (part * seen > 0.0)
        seen *= lamp_visibility(i, point, h.normal) *
                smoke_transmittance(smoke_depth_to_lamp(i, point));
    float all = dot(color, vec3(part));
    light.irradiance += color * (part * seen);
    light.all += all;
    light.hidden += all * (1.0 - seen);
    return seen;
}

/* Returns how many lamps there are. */
int lamp_count()
{
#ifdef NO_LAMPS
    return 0;
#else
    return int(backdrop.counts.y);
#endif
}

/* Returns the irradiance from the sky and the lamps. */
vec3 irradiance_without_sun(hit h, vec3 point)
{
    arrived light = skylight(h, point);
    for (int i = 0; i < lamp_count(); i++)
        add_lamp(i, h, point, light);
    return light.irradiance;
}

/* Returns a colour with the haze in front of it. t: of the ray from the eye along the direction. */
vec3 behind_haze(vec3 color, float t, vec3 direction)
{
    bool transparent = backdrop.counts.z != 0u;
    float clear = transparent ? 1.0 : haze_clear(backdrop.floor_params.z, t, length(direction));
    return mix(horizon(direction), color, clear);
}

/* Returns the light that a diffuse surface sends, without haze: radiance = albedo / pi *
 * irradiance. */
vec3 radiance_before_haze(hit h, vec3 irradiance, float sunlit)
{
    float facing = max(dot(h.normal, backdrop.sun_direction.xyz), 0.0);
    return h.albedo / PI * (irradiance + backdrop.sun_color.rgb * facing * sunlit);
}

/* Returns the light that a surface sends along a ray, premultiplied, and its alpha. `irradiance` is
 * that of irradiance_without_sun. `sunlit` is the part of the sun, 0 to 1, that objects and smoke
 * let through. */
vec4 radiance(hit h, vec3 direction, vec3 irradiance, float sunlit)
{
    bool transparent = backdrop.counts.z != 0u;
    if (h.surface < 0)
        return transparent ? vec4(0.0) : vec4(sky(direction), 1.0);
    vec3 color = radiance_before_haze(h, irradiance, sunlit);
    return vec4(behind_haze(color, h.t, direction), 1.0);
}
