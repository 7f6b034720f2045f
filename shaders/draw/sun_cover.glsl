/* Penumbras without samples: how much of the sun's disc, which a point sees through a disc of some
 * radius at the distance of an edge, lies beyond that edge. */

/* The part of a disc on the far side of a line, by the line's signed distance from the centre in
 * radii: a cubic within 1.5 % of the exact circle segment. */
float disc_cover(float distance)
{
    float x = clamp(0.5 + 0.5 * distance, 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
}

/* Between two parallel lines, the distances to which are positive inside. */
float strip_cover(float one, float other, float radius)
{
    float scale = 1.0 / max(radius, 1e-5);
    return max(disc_cover(one * scale) + disc_cover(other * scale) - 1.0, 0.0);
}

/* A box's outline along the sun's direction is a hexagon, the common part of three strips, each
 * between the line where the upper face of one axis meets the lower face of another, and its
 * opposite. Along an edge this is the exact cover; at a corner two covers are multiplied. The
 * vectors are of two axes: where the ray enters and leaves their slabs, and the inverse of its
 * direction. */
float box_strip(vec2 near, vec2 far, vec2 inverse, float spread)
{
    vec2 square = inverse * inverse;
    float sum = square.x + square.y;
    /* The edge of x's entry and y's exit, and the opposite one: how far aside they pass, and how
     * far along the ray that is. */
    vec2 aside = (far.yx - near.xy) * inversesqrt(sum);
    vec2 along = (near.xy * square.yx + far.yx * square.xy) / sum;
    vec2 radius = max(along * spread, vec2(1e-5));
    return max(disc_cover(aside.x / radius.x) + disc_cover(aside.y / radius.y) - 1.0, 0.0);
}

float box_cover(vec3 near, vec3 far, vec3 inverse, float spread)
{
    float ahead = min(min(far.x, far.y), far.z) > 0.0 ? 1.0 : 0.0;
    return ahead * box_strip(near.xy, far.xy, inverse.xy, spread) *
           box_strip(near.yz, far.yz, inverse.yz, spread) *
           box_strip(near.xz, far.xz, inverse.xz, spread);
}
