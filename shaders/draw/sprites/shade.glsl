/* Shades a place on a billboard. Two adjacent cells of the atlas are mixed (Heinz 2019, 3.2.4,
 * equation 3.2), lit or emitting, and faded where the billboard comes near the scene (3.2.6,
 * equation 3.3). The bloom target gets the same light, weighted (3.2.5). Colours are
 * premultiplied. */
layout(binding = 1) uniform sampler2DArray atlas;
layout(binding = 3) uniform sampler2DArray atlas_motion;

uniform float additive_alpha; /* 0: additive particles cover nothing; 1: they cover, or their alpha
                               * is summed */

#if SHAPES

bool is_plain(billboard quad)
{
    return uint(quad.depth.y) >= KILN_CELL_PLAIN;
}

/* Returns the part of a pixel inside a disc or rectangle whose half edges are quad.cells.xy. */
float coverage(billboard quad, vec2 uv)
{
    if (uint(quad.depth.y) == KILN_CELL_DISC)
        return clamp(quad.cells.x + 0.5 - length(uv), 0.0, 1.0);
    vec2 inside = clamp(quad.cells.xy + 0.5 - abs(uv), 0.0, 1.0);
    return inside.x * inside.y;
}

#endif

/* Returns the factor of opacity near the scene: equation 3.3, clamped to a fade. If the look asks
 * for the equation as it is printed, it takes the particle's distance for its depth and has no
 * bound, so that far from the scene only the bound of alpha remains. */
float soft_factor(billboard quad, float depth, float scene)
{
    float visible = step(depth, scene);
    float scale = quad.cool.a;
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
    float part = quad.cells.z;
    vec2 way = textureLod(atlas_motion, vec3(uv, quad.cells.x), 0.0).xy * quad.bloom.a;
    vec4 from = textureLod(atlas, vec3(uv - part * way, quad.cells.x), quad.cells.w);
    vec4 to = textureLod(atlas, vec3(uv + (1.0 - part) * way, quad.cells.y), quad.cells.w);
    return mix(from, to, part);
}

/* Shades the billboard at uv. depth, scene: view depths of the billboard and of the scene there,
 * m. */
void shade(billboard quad, vec2 uv, float depth, float scene, out vec4 color, out vec4 bloom)
{
    vec4 cell = cell_between(quad, uv);
    bool masks = uint(quad.depth.y) != KILN_CELL_COLOR;
#if SHAPES
    if (is_plain(quad))
        cell = vec4(0.5, 0.5, 1.0, coverage(quad, uv));
#endif
    vec3 rgb;
    float alpha;
    vec2 slope = vec2(0.0);
    if (masks) {
        slope = cell.xy * 2.0 - 1.0;
        alpha = cell.a;
        rgb = mix(quad.cool.rgb, quad.hot.rgb, cell.z);
    } else {
        cell *= cell; /* cells store square roots of colours, which spends 8 bits better */
        alpha = cell.a;
        rgb = quad.hot.rgb;
    }
    float facing = sqrt(max(1.0 - dot(slope, slope), 0.0));
    vec3 light = quad.light_0.rgb + quad.light_x.rgb * slope.x + quad.light_y.rgb * slope.y +
                 quad.light_z.rgb * facing;
    vec3 covering = quad.color.rgb * max(light, vec3(0.0));
    if (masks)
        rgb = (rgb + covering) * alpha;
    else
        rgb = cell.rgb * (rgb + covering);

    /* The bound keeps alpha at 1 or below. */
    float fade = min(quad.color.a * soft_factor(quad, depth, scene), 1.0 / max(alpha, 1e-6));
    alpha *= fade;
    rgb *= fade;
    color = vec4(rgb, quad.hot.a > 0.0 ? additive_alpha * alpha : alpha);
    bloom = vec4(quad.bloom.rgb * rgb, color.a);
}
