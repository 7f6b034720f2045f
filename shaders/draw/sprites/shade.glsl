/* Shades a place on a billboard. fragment.glsl includes this file for the fragment shaders of
 * particles, as does particles_tiled.comp. lib/draw/sprites/tile_shade.h does the same on the CPU.
 *
 * Two adjacent cells of the atlas are mixed (Heinz 2019, 3.2.4, equation 3.2). The result is lit,
 * the light that the particle emits is added, and the sum fades where the billboard comes near the
 * scene (Heinz 2019, 3.2.6, equation 3.3). The bloom target gets the same colour times
 * quad.bloom.rgb (Heinz 2019, 3.2.5). Colours are premultiplied. With HAZE, quad.cool of colour
 * cells is the haze before them (particle.glsl). */
#include "shared/billboard_place.h"

layout(binding = KILN_UNIT_ATLAS) uniform sampler2DArray atlas;
layout(binding = KILN_UNIT_ATLAS_MOTION) uniform sampler2DArray atlas_motion;
layout(binding = KILN_UNIT_STRIPS) uniform sampler2DArray atlas_strips;

/* The factor on the alpha of additive particles. It is 0 where they cover nothing, and 1 where they
 * cover what is behind them (fire_covers) or their alpha is summed (sum_alpha of struct
 * kiln_particles_draw). */
uniform float additive_alpha;

#if SHAPES

bool is_plain(billboard quad)
{
    return uint(quad.depth.y) >= KILN_CELL_PLAIN;
}

/* Returns the part of a pixel that a plain shape covers. uv and quad.cells are in pixels here: a
 * disc has the radius quad.cells.x, a rectangle the half edges quad.cells.xy. */
float coverage(billboard quad, vec2 uv)
{
    if (uint(quad.depth.y) == KILN_CELL_DISC)
        return clamp(quad.cells.x + 0.5 - length(uv), 0.0, 1.0);
    return edge_cover(quad.cells.x, uv.x, 1.0) * edge_cover(quad.cells.y, uv.y, 1.0);
}

#endif

/* Returns the part of a pixel at uv that a billboard covers. */
float rim_cover(billboard quad, vec2 uv)
{
    if (quad.light_0.a <= 0.0)
        return 1.0;
    return edge_cover(0.5, uv.x - 0.5, quad.light_0.a) * edge_cover(0.5, uv.y - 0.5, quad.light_z.a);
}

/* Returns the factor on opacity near the scene: equation 3.3, clamped to 0 to 1. If quad.depth.z is
 * above 0, the scene file asks for the equation as it is printed (look.soft_formula: literal). That
 * one takes the particle's distance from the eye for its depth and is not clamped; shade() then
 * limits alpha to 1. */
float soft_factor(billboard quad, float depth, float scene)
{
    float visible = step(depth, scene);
    float scale = quad.cool.a;
#if SHAPES
    if (scale < 0.0)
        return billboard_lies_on(-scale, quad.depth.w, scene - depth, depth);
#endif
    if (scale <= 0.0)
        return visible;
    if (quad.depth.z > 0.0)
        return visible * abs(scene - quad.depth.w) * scale;
    return clamp((scene - depth) * scale, 0.0, 1.0);
}

/* Returns the mix of two adjacent cells of a flipbook. A detail that moves from one cell to the
 * next is found in both by following the motion back and forth, so that edges move instead of
 * fading over. */
vec4 cell_between(billboard quad, vec2 uv)
{
    float weight = quad.cells.z;
    vec2 motion = textureLod(atlas_motion, vec3(uv, quad.cells.x), 0.0).xy * quad.bloom.a;
    vec3 from = vec3(uv - weight * motion, quad.cells.x);
    vec3 to = vec3(uv + (1.0 - weight) * motion, quad.cells.y);
    if (int(quad.cells.w) == KILN_STRIP_LEVEL)
        return mix(textureLod(atlas_strips, from, 0.0), textureLod(atlas_strips, to, 0.0), weight);
    return mix(textureLod(atlas, from, quad.cells.w), textureLod(atlas, to, quad.cells.w), weight);
}

/* Shades the billboard at uv. depth, scene: view depths of the billboard and of the scene there,
 * m. */
void shade(billboard quad, vec2 uv, float depth, float scene, out vec4 color, out vec4 bloom)
{
    vec4 cell = cell_between(quad, uv);
    bool is_mask = uint(quad.depth.y) != KILN_CELL_COLOR;
#if SHAPES
    if (is_plain(quad)) /* it has no cells: replaces what cell_between read */
        cell = vec4(0.5, 0.5, 1.0, coverage(quad, uv));
#endif
    vec3 rgb;
    float alpha;
    vec2 slope = vec2(0.0);
    if (is_mask) {
        slope = cell.xy * 2.0 - 1.0;
        alpha = cell.a;
        rgb = mix(quad.cool.rgb, quad.hot.rgb, cell.z);
    } else {
        cell *= cell; /* colour and alpha are stored as square roots, for precision where dark */
        alpha = cell.a;
        rgb = quad.hot.rgb;
    }
    float facing = sqrt(max(1.0 - dot(slope, slope), 0.0));
    vec3 light = quad.light_0.rgb + quad.light_x.rgb * slope.x + quad.light_y.rgb * slope.y +
                 quad.light_z.rgb * facing;
    vec3 reflected = quad.color.rgb * max(light, vec3(0.0));
    if (is_mask)
        rgb = (rgb + reflected) * alpha;
    else
#ifdef HAZE
        rgb = cell.rgb * (rgb + reflected) + quad.cool.rgb * alpha;
#else
        rgb = cell.rgb * (rgb + reflected);
#endif

    /* The second argument of min keeps alpha * fade at 1 or below. */
    float fade = min(quad.color.a * soft_factor(quad, depth, scene), 1.0 / max(alpha, 1e-6));
    fade *= rim_cover(quad, uv);
    alpha *= fade;
    rgb *= fade;
    color = vec4(rgb, quad.hot.a > 0.0 ? additive_alpha * alpha : alpha);
    bloom = vec4(quad.bloom.rgb * rgb, color.a);
}
