/* Draws the scene behind the particles by ray casting: a sky gradient, a floor that fades into the
 * horizon, shapes, a sun with shadows, and point lights. View-space depth goes to a texture of
 * its own, for soft particles (Heinz 2019, 3.2.1 and 3.2.6). Defines compile in the parts that not
 * every scene has: KILN_SHAPES (kinds of shapes), MESHES, shadows of particles that are SOLIDS or
 * INSTANCES of meshes, PAINT on meshes, FLOOR_IMAGE, FLOOR_GLOSS, SKY_IMAGE.
 *
 * lib/draw/backdrop/backdrop_gl.c runs two passes. The first casts one ray through the centre of
 * each pixel and notes which surface it hits. The second, with at_edges, casts SAMPLES rays more a
 * pixel at edges, which are where neighbouring pixels hit different surfaces: backdrop.vert finds
 * the tiles that have edges, this shader their pixels. Those rays of a pixel that hit one smooth
 * piece of surface share a colour, unless a shadow parts the pixel. Both passes are one program,
 * since most of the time of a first frame is the compiler's. */
// variant: KILN_SHAPES(ROW)=
// variant: KILN_SHAPES(ROW)=ROW(BOX,box)
// variant: KILN_SHAPES(ROW)=ROW(CYLINDER,cylinder)ROW(PLANE,plane)
// variant: KILN_SHAPES(ROW)=ROW(CAPSULE,capsule)
// variant:
// variant: SHAPES_STORED=1 KILN_SHAPES(ROW)=ROW(BOX,box)ROW(CAPSULE,capsule)
// variant: MESHES=1
// variant: MESHES=1 PAINT=1
// variant: MESHES=1 MANY_MESHES=1
// variant: SOLIDS=1
// variant: MESHES=1 FLOOR_IMAGE=1 SKY_IMAGE=1
// variant: FLOOR_GLOSS=1
// variant: FLOOR_GLOSS=1 NO_SMOKE=1 NO_RECTANGLES=1 NO_LAMP_SHADOWS=1
// variant: SOLIDS=1 MESHES=1 NO_SUN=1 NO_SMOKE=1 NO_LAMPS=1 NO_LAMP_SHADOWS=1 NO_RECTANGLES=1
// variant: MESHES=1 PAINT=1 SOLIDS=1 INSTANCES=1 FLOOR_IMAGE=1 FLOOR_GLOSS=1 SKY_IMAGE=1
#include "shared/draw_layout.h"
#include "shared/shape_layout.h"

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };
layout(std140, binding = KILN_BIND_BACKDROP) uniform backdrop_block { kiln_draw_backdrop backdrop; };
layout(std140, binding = KILN_BIND_SHAPES) uniform shape_block { kiln_draw_shapes shapes; };

layout(location = BACKDROP_AT_EDGES) uniform bool at_edges;

layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_depth;
layout(location = 2) out float out_surface; /* a number that differs between the two sides of an
                                             * edge */

const int SAMPLES = KILN_EDGE_SAMPLES;

#include "draw/backdrop/surface.glsl"
#include "shared/floor.h"

#ifdef FLOOR_IMAGE
#include "draw/backdrop/floor_image.glsl"
#endif

/* Returns the extent of the floor that a pixel covers. */
floor_extent floor_extent_along(vec3 direction, float t)
{
    return floor_extent_of(direction, t, 2.0 * view.frustum.y / view.frustum.w);
}

vec3 floor_albedo(vec2 position, vec3 direction, float t)
{
    vec3 color = backdrop.floor_color.rgb;
    float edge = backdrop.floor_params.y;
    return edge <= 0.0 ? color
                       : color * floor_checkers(position.x, position.y, edge,
                                                floor_extent_along(direction, t));
}

#ifdef FLOOR_GLOSS
#include "draw/backdrop/floor_gloss.glsl"
#endif

/* Returns the floor's albedo where a ray hits it, and the ray's t there in w. A ray that misses the
 * floor gets a t beyond FAR. */
vec4 floor_along(vec3 origin, vec3 direction)
{
    float height = origin.y - backdrop.floor_color.w;
    float t = ray_cross_plane(height, direction.y);
    if (backdrop.floor_params.x <= 0.0 || t > FAR)
        return vec4(vec3(0.0), 2.0 * FAR);
    vec2 position = (origin + direction * t).xz;
#ifdef FLOOR_IMAGE
    return vec4(floor_picture(position, direction, t), t);
#else
    return vec4(floor_albedo(position, direction, t), t);
#endif
}

/* Returns the nearest surface that a ray hits. ground: the result of floor_along for the ray;
 * layer: the layer of the rasterised meshes with the hits of this ray, or -1 if there is none. */
hit trace(vec3 origin, vec3 direction, vec4 ground, int layer)
{
    hit nearest = hit(FAR, -1, vec3(0.0, 1.0, 0.0), vec3(0.0));
    trace_shapes(origin, direction, nearest);
#ifdef MESHES
    if (layer >= 0)
        trace_meshes(layer, nearest);
#endif
    if (ground.w < nearest.t)
        nearest = hit(ground.w, 0, vec3(0.0, 1.0, 0.0), ground.rgb);
    return nearest;
}

/* Rays of the pixel: 0: that through its centre; then its samples. The piece of surface that each
 * hits has the number of the first ray that hits it; where the pixel is not lit evenly, each sample
 * has a piece of its own. */
hit ray_hits[1 + SAMPLES];
vec3 ray_points[1 + SAMPLES];
int ray_pieces[1 + SAMPLES];
bool lit_evenly = false;

bool share_piece(hit a, vec3 at, hit b, vec3 other)
{
    vec3 way = other - at;
    float off = dot(way, a.normal);
    bool bends_little = dot(a.normal, b.normal) >= KILN_PIECE_COSINE &&
                        off * off <= KILN_PIECE_SLOPE * KILN_PIECE_SLOPE * dot(way, way);
    return a.surface == b.surface && (a.surface < 0 || bends_little);
}

/* Notes what a ray hits, and returns whether light must be computed there. At edges, the centre
 * needs it only for samples on the same piece. */
bool needs_light(int ray, hit h, vec3 point)
{
    ray_hits[ray] = h;
    ray_points[ray] = point;
    ray_pieces[ray] = ray;
    for (int before = ray - 1; before >= 0; before--) {
        bool same = share_piece(ray_hits[before], ray_points[before], h, point);
        ray_pieces[ray] = same ? ray_pieces[before] : ray_pieces[ray];
    }
    ray_pieces[ray] = lit_evenly ? ray_pieces[ray] : ray;
    return ray_pieces[ray] == ray && (ray > 0 || lit_evenly || !at_edges);
}

/* Holds the colour of a ray from the eye and the light at its first hit. */
struct shaded_ray {
    vec4 color;
    float sunlit; /* part of the sun, 0 to 1, that no object hides from the hit */
    float hidden; /* part of its other light that shadows of lamps take */
};

/* Follows a ray from the eye and, where it hits a glossy floor, the reflected ray. The colour is
 * unset where no light is needed. Both rays run in one loop, since compilers take minutes over a
 * second copy of this code. The loop has its test at the end, since software GL runs the body of a
 * loop with its test at the start once more than needed. layer: as for trace; 0 is the centre. */
shaded_ray shade_eye_ray(vec3 direction, int layer)
{
    shaded_ray shaded;
    vec3 origin = view.eye.xyz;
    vec4 ground = floor_along(origin, direction);
    bool first = true, goes_on = false;
#ifdef FLOOR_GLOSS
    reflection m = reflection_along(direction);
#endif
    do {
        hit h = trace(origin, direction, ground, first ? layer : -1);
        vec3 point = origin + direction * h.t;
        if (first && !needs_light(layer, h, point))
            break;
        float sunlit = sun_visibility(point, h.normal);
        float arriving = sunlit * sunlight_through_smoke(point);
        arrived light = skylight(h, point);
        vec3 mirrored = vec3(0.0);
        for (int i = 0; i < lamp_count(); i++) {
            float seen = add_lamp(i, h, point, light);
#ifdef FLOOR_GLOSS
            mirrored += seen * reflected_lamp(i, point, m);
#endif
        }
        vec4 color = radiance(h, direction, light.irradiance, arriving);
        if (first)
            shaded = shaded_ray(color, sunlit, light.hidden / max(light.all, 1e-6));
        if (first && h.surface < 0)
            shaded.color.rgb += sun_disc(direction);
#ifdef FLOOR_GLOSS
        if (!first)
            shaded.color.rgb += m.part * m.at.reflectance * color.rgb;
        goes_on = first && h.surface == 0;
        if (goes_on)
            shaded.color.rgb += m.part * mirrored + arriving * m.sun;
        origin = point;
        direction = m.at.direction;
        ground.w = 2.0 * FAR;
        first = false;
#endif
    } while (goes_on);
    return shaded;
}

#include "shared/edge_mean.h"

const vec2 SAMPLE_OFFSETS[KILN_EDGE_SAMPLES] = vec2[](KILN_EDGE_OFFSETS(vec2));

#include "draw/backdrop/backdrop_edges.glsl"

/* Returns the number of the surface at the pixel's centre. */
float surface_number(hit h, shaded_ray center)
{
    bool sunny = dot(h.normal, backdrop.sun_direction.xyz) > 0.0 &&
                 dot(backdrop.sun_color.rgb, vec3(1.0)) > 0.0;
    float light = (sunny ? center.sunlit : 0.0) - center.hidden;
    float number = float(4 * h.surface) + (h.surface >= 0 ? light : 0.0);
#ifdef MESHES
    number += has_mesh_edge(h.surface) ? KILN_EDGE_MARK : 0.0;
#endif
    return number;
}

/* Returns the mean of the samples' colours. */
vec4 mean_color(vec4 colors[1 + SAMPLES])
{
    edge_sum sum = edge_sum_none();
    for (int ray = 1; ray <= SAMPLES; ray++) {
        vec4 color = colors[ray_pieces[ray]];
        sum = edge_add(sum, color.rgb, color.a, 1.0 / float(SAMPLES), view.exposure.x);
    }
    return vec4(edge_mean(sum), sum.alpha);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (at_edges && !is_edge(pixel))
        discard;
    lit_evenly = at_edges && is_lit_evenly(pixel);
    vec4 colors[1 + SAMPLES];
    shaded_ray center;
    int ray = 0, last = at_edges ? SAMPLES : 0;
    do {
        vec2 offset = ray == 0 ? vec2(0.5) : SAMPLE_OFFSETS[ray - 1];
        shaded_ray shaded = shade_eye_ray(ray_direction(vec2(pixel) + offset), ray);
        colors[ray] = shaded.color;
        if (ray == 0)
            center = shaded;
        ray++;
    } while (ray <= last);
    out_color = at_edges ? mean_color(colors) : colors[0];
    out_depth = ray_hits[0].t;
    out_surface = surface_number(ray_hits[0], center);
}
