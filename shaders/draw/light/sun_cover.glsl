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
 * direction; outside becomes at least how far the ray is from the strip, m. */
float box_strip(vec2 near, vec2 far, vec2 inverse, float spread, inout float outside)
{
    vec2 square = inverse * inverse;
    float sum = square.x + square.y;
    /* The edge of x's entry and y's exit, and the opposite one: how far aside they pass, and how
     * far along the ray that is. */
    vec2 aside = (far.yx - near.xy) * inversesqrt(sum);
    vec2 along = (near.xy * square.yx + far.yx * square.xy) / sum;
    outside = max(outside, -min(aside.x, aside.y));
    vec2 radius = max(along * spread, vec2(1e-5));
    return max(disc_cover(aside.x / radius.x) + disc_cover(aside.y / radius.y) - 1.0, 0.0);
}

/* How much the edges along two of the axes look like one direction towards the sun: x is of y and z,
 * and so on. A sun across an axis sees two of the strips end at the same edge, which must count
 * once. */
vec3 edges_alike(vec3 towards)
{
    vec3 square = towards * towards, aside = 1.0 - square;
    vec3 cosine = square.yxx * square.zzy / max(aside.yxx * aside.zzy, 1e-12);
    cosine = min(cosine, 1.0);
    cosine *= cosine;
    return cosine * cosine;
}

float both_strips(float a, float b, float alike)
{
    return a * b + (min(a, b) - a * b) * alike;
}

/* It hides the sun if it is ahead of the ray or, where that only passes it, of one as far aside as
 * its outline, which leaves a slab so much later at most; and as rounding puts it, which is less
 * than surfaces are away from themselves. */
float box_cover(vec3 near, vec3 far, vec3 inverse, vec3 alike, float spread)
{
    float outside = 0.0;
    float xy = box_strip(near.xy, far.xy, inverse.xy, spread, outside);
    float yz = box_strip(near.yz, far.yz, inverse.yz, spread, outside);
    float xz = box_strip(near.xz, far.xz, inverse.xz, spread, outside);
    vec3 later = far + (outside + 1e-4) * sqrt(max(inverse * inverse - 1.0, vec3(0.0)));
    float ahead = min(min(later.x, later.y), later.z) > 0.0 ? 1.0 : 0.0;
    return ahead * both_strips(both_strips(yz, xz, alike.z), xy, max(alike.x, alike.y));
}
