/* The scene behind the particles, cast analytically: a sky gradient, a floor that fades into the
 * horizon, boxes, one sun with hard shadows, point lights. View-space depth goes to a texture of its
 * own, for soft particles (Heinz 2019, 3.2.1 and 3.2.6).
 *
 * Two passes: one ray through the centre of each pixel, which also notes what it hit; then SAMPLES
 * rays a pixel where backdrop_edges.vert finds that neighbours hit different things.
 */
// variant: SAMPLES=1
// variant: SAMPLES=4
#include "shared/draw_layout.h"

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };
layout(std140, binding = KILN_BIND_BACKDROP) uniform backdrop_block { kiln_draw_backdrop backdrop; };

#include "draw/smoke_shadow.glsl"

layout(location = 0) out vec4 out_color;
#if SAMPLES == 1
layout(location = 1) out float out_depth;
layout(location = 2) out float out_surface; /* a number that changes at every edge */
#endif

const float FAR = 1e9;
const float PI = 3.14159265;

/* The sky's surface is -1, the floor's 0; a face of a box has a number of its own. */
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

vec3 box_normal(int i, vec3 point)
{
    vec3 local = (point - backdrop.box_center[i].xyz) / backdrop.box_half[i].xyz;
    vec3 a = abs(local);
    vec3 axis = vec3(a.x >= a.y && a.x >= a.z, a.y > a.x && a.y >= a.z, a.z > a.x && a.z > a.y);
    return axis * sign(local);
}

/* The integral of a square wave of period 2. */
vec2 square_integral(vec2 x)
{
    return 1.0 - abs(fract(x * 0.5) * 2.0 - 1.0);
}

/* Squares of two shades, averaged over the footprint of a pixel, so that they do not alias. */
vec3 floor_albedo(vec2 position, vec2 footprint)
{
    vec3 color = backdrop.floor_color.rgb;
    float edge = backdrop.floor_params.y;
    if (edge <= 0.0)
        return color;
    vec2 width = max(footprint / edge, vec2(1e-3));
    vec2 p = position / edge;
    vec2 wave = (square_integral(p + 0.5 * width) - square_integral(p - 0.5 * width)) / width;
    return color * (1.0 + 0.2 * wave.x * wave.y);
}

hit trace(vec3 origin, vec3 direction)
{
    hit nearest = hit(FAR, -1, vec3(0.0, 1.0, 0.0), vec3(0.0));
    vec3 inverse = safe_inverse(direction);
    int found = -1;
    for (int i = 0; i < int(backdrop.counts.x); i++) {
        vec2 interval = box_interval(i, origin, inverse);
        if (interval.x <= interval.y && interval.x > 0.0 && interval.x < nearest.t) {
            nearest.t = interval.x;
            found = i;
        }
    }
    if (found >= 0) {
        nearest.normal = box_normal(found, origin + direction * nearest.t);
        nearest.albedo = backdrop.box_color[found].rgb;
        nearest.surface = 14 + 27 * found + int(dot(nearest.normal, vec3(1.0, 3.0, 9.0)));
    }
    float height = origin.y - backdrop.floor_color.w;
    if (backdrop.floor_params.x > 0.0 && direction.y < -1e-6 && height > 0.0) {
        float t = height / -direction.y;
        if (t < nearest.t) {
            /* The floor that one pixel covers: longer along the view where it is seen flat. */
            float pixel = 2.0 * view.frustum.y / view.frustum.w * t;
            vec2 along = abs(direction.xz) / max(length(direction.xz), 1e-6);
            vec2 footprint = pixel * (1.0 + along * length(direction) / -direction.y);
            vec2 position = (origin + direction * t).xz;
            nearest = hit(t, 0, vec3(0.0, 1.0, 0.0), floor_albedo(position, footprint));
        }
    }
    return nearest;
}

float sun_visibility(vec3 point, vec3 normal)
{
    vec3 origin = point + normal * 1e-3;
    vec3 inverse = safe_inverse(backdrop.sun_direction.xyz);
    for (int i = 0; i < int(backdrop.counts.x); i++) {
        vec2 interval = box_interval(i, origin, inverse);
        if (max(interval.x, 0.0) < interval.y)
            return 0.0;
    }
    return 1.0;
}

/* How much of the sky the boxes near a point hide: falls off with the distance in units of the box.
 * Not a solid angle, but it anchors a box to the floor. */
float sky_visibility(vec3 point, vec3 normal)
{
    float visible = 1.0;
    for (int i = 0; i < int(backdrop.counts.x); i++) {
        vec3 towards = backdrop.box_center[i].xyz - point;
        vec3 halves = backdrop.box_half[i].xyz;
        float away = length(max(abs(towards) - halves, vec3(0.0)));
        float facing = clamp(dot(towards, normal) * inversesqrt(dot(towards, towards)) + 0.4, 0.0, 1.0);
        float size = min(min(halves.x, halves.y), halves.z);
        bool outside = dot(towards, normal) > -dot(halves, abs(normal)) + 1e-3;
        if (outside) {
            float fall = 1.0 / (1.0 + 2.0 * away / size);
            visible *= 1.0 - 0.7 * facing * fall * fall;
        }
    }
    return visible;
}

vec3 sky(vec3 direction)
{
    float up = clamp(normalize(direction).y, 0.0, 1.0);
    return mix(backdrop.sky_horizon.rgb, backdrop.sky_top.rgb, 1.0 - exp(-4.0 * up));
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
    return vec4(mix(backdrop.sky_horizon.rgb, color, clear), 1.0);
}

#if SAMPLES == 1

void main()
{
    vec3 direction = ray_direction(gl_FragCoord.xy);
    hit h = trace(view.eye.xyz, direction);
    vec3 point = view.eye.xyz + direction * h.t;
    float sunlit = sun_visibility(point, h.normal);
    out_color = radiance(h, direction, soft_irradiance(h, point),
                         sunlit * sunlight_through_smoke(point));
    out_depth = h.t;
    out_surface = float(2 * h.surface) + (h.surface < 0 ? 0.0 : sunlit);
}

#else

/* A rotated grid: no two samples share a row or a column. */
const vec2 SAMPLE_OFFSETS[4] =
    vec2[](vec2(0.375, 0.125), vec2(0.875, 0.375), vec2(0.125, 0.625), vec2(0.625, 0.875));

void main()
{
    vec4 sum = vec4(0.0);
    for (int s = 0; s < SAMPLES; s++) {
        vec3 direction = ray_direction(floor(gl_FragCoord.xy) + SAMPLE_OFFSETS[s]);
        hit h = trace(view.eye.xyz, direction);
        vec3 point = view.eye.xyz + direction * h.t;
        sum += radiance(h, direction, soft_irradiance(h, point),
                        sun_visibility(point, h.normal) * sunlight_through_smoke(point));
    }
    out_color = sum / float(SAMPLES);
}

#endif
