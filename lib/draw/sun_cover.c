/* Outlines along the sun's direction, and how far along it a shape ends. */
#include "draw/sun_cover.h"

/* The part of a disc on the far side of a line, by the line's signed distance in radii. */
static float disc_cover(float distance)
{
    float x = exact_clamp(0.5f + 0.5f * distance, 0.0f, 1.0f);
    return x * x * (3.0f - 2.0f * x);
}

/* Between two parallel lines, the distances to which are positive inside. */
static float strip_cover(float one, float other, float radius)
{
    return fmaxf(disc_cover(one / radius) + disc_cover(other / radius) - 1.0f, 0.0f);
}

/* By the way through and behind a shape until the sun is free. */
static float behind(float way, struct kiln_ball ball)
{
    return exact_clamp(way / fmaxf(ball.radius, 1e-4f), 0.0f, 1.0f);
}

struct slabs {
    float in[3], out[3], inverse[3]; /* along the ray to the sun, m */
};

static struct slabs cross_slabs(float3 center, float3 half_size, float3 from, float3 direction)
{
    const float to[3] = {center.x - from.x, center.y - from.y, center.z - from.z};
    const float half[3] = {half_size.x, half_size.y, half_size.z};
    const float d[3] = {direction.x, direction.y, direction.z};
    struct slabs s;
    for (int i = 0; i < 3; i++) {
        s.inverse[i] = (d[i] < 0.0f ? -1.0f : 1.0f) / fmaxf(fabsf(d[i]), 1e-8f);
        s.in[i] = to[i] * s.inverse[i] - half[i] * fabsf(s.inverse[i]);
        s.out[i] = to[i] * s.inverse[i] + half[i] * fabsf(s.inverse[i]);
    }
    return s;
}

/* How much edges of two directions look like one: 1 where they are parallel. */
static float likeness(float a, float b)
{
    float cosine = a * b / sqrtf(fmaxf((1.0f - a * a) * (1.0f - b * b), 1e-12f));
    float square = fminf(cosine * cosine, 1.0f);
    return square * square * square * square;
}

static float both(float a, float b, float alike)
{
    return a * b + (fminf(a, b) - a * b) * alike;
}

/* Of strips whose edges lie along the axes. At a corner of the outline two covers are multiplied;
 * but a sun across an axis sees two of the strips end at the same edge. */
static float common_cover(const float covers[3], float3 towards)
{
    float yz = likeness(towards.y, towards.z), xz = likeness(towards.x, towards.z);
    float first = both(covers[0], covers[1], likeness(towards.x, towards.y));
    return both(first, covers[2], fmaxf(xz, yz));
}

/* Its outline is the common part of three strips (sun_cover.glsl). Beside it, the way behind is
 * taken at its edge. */
float kiln_box_sun_cover(float3 center, float3 half_size, struct kiln_ball ball,
                         const struct kiln_sun_frame *sun)
{
    float size = sqrtf(float3_dot(half_size, half_size));
    if (kiln_sun_misses(center, size, ball, sun))
        return 0.0f;
    struct slabs s = cross_slabs(center, half_size, ball.center, sun->towards);
    float covers[3], outside = 0.0f;
    for (int i = 0; i < 3; i++) {
        int a = (i + 1) % 3, b = (i + 2) % 3; /* its edges lie along axis i */
        float qa = s.inverse[a] * s.inverse[a], qb = s.inverse[b] * s.inverse[b], sum = qa + qb;
        float scale = 1.0f / sqrtf(sum);
        float one = (s.out[b] - s.in[a]) * scale, other = (s.out[a] - s.in[b]) * scale;
        float one_at = (s.in[a] * qb + s.out[b] * qa) / sum;
        float other_at = (s.in[b] * qa + s.out[a] * qb) / sum;
        covers[i] = fmaxf(disc_cover(one / kiln_sun_penumbra(one_at, ball, sun)) +
                              disc_cover(other / kiln_sun_penumbra(other_at, ball, sun)) - 1.0f,
                          0.0f);
        outside = fmaxf(outside, -fminf(one, other));
    }
    float cover = common_cover(covers, sun->towards);
    float way = INFINITY, step = outside + 1e-3f * size;
    for (int i = 0; i < 3; i++) {
        float climb = 1.0f / s.inverse[i];
        way = fminf(way, s.out[i] +
                             step * sqrtf(fmaxf(1.0f - climb * climb, 0.0f)) * fabsf(s.inverse[i]));
    }
    return cover * behind(way, ball);
}

float kiln_sphere_sun_cover(float3 center, float radius, struct kiln_ball ball,
                            const struct kiln_sun_frame *sun)
{
    float3 to = float3_sub(center, ball.center);
    float ahead = float3_dot(to, sun->towards);
    float3 across = float3_add_scaled(to, sun->towards, -ahead);
    float square = float3_dot(across, across), away = sqrtf(square);
    float disc = kiln_sun_penumbra(ahead, ball, sun);
    float most = fminf(radius / disc, 1.0f);
    float cover = strip_cover(radius - away, radius + away, disc) * most;
    return cover * behind(ahead + sqrtf(fmaxf(radius * radius - square, 0.0f)), ball);
}

/* Its outline is a band along `up`, with round ends. */
float kiln_cylinder_sun_cover(float3 center, float radius, float3 axis, float half_height,
                              struct kiln_ball ball, const struct kiln_sun_frame *sun)
{
    float3 to = float3_sub(center, ball.center);
    float climb = float3_dot(axis, sun->towards);
    float slant = sqrtf(fmaxf(1.0f - climb * climb, 1e-6f));
    /* Seen along its axis, it is round. */
    float3 right =
        slant > 1e-3f ? float3_scale(float3_cross(axis, sun->towards), 1.0f / slant) : sun->right;
    float3 up = float3_cross(sun->towards, right);
    float x = float3_dot(to, right), y = float3_dot(to, up), ahead = float3_dot(to, sun->towards);
    float inside = sqrtf(fmaxf(radius * radius - x * x, 0.0f));
    float end = half_height * slant + fabsf(climb) * inside;
    float disc = kiln_sun_penumbra(ahead, ball, sun);
    float cover = strip_cover(radius - fabsf(x), radius + fabsf(x), disc) *
                  strip_cover(end - fabsf(y), end + fabsf(y), disc);
    if (cover <= 0.0f)
        return 0.0f;
    /* Where the ray at the nearest place inside of the outline leaves its side or its end. */
    float at = exact_clamp(y, -end, end) * (float3_dot(axis, up) < 0.0f ? -1.0f : 1.0f);
    float height = -ahead * climb - at * slant; /* of that place above the middle */
    float beside = -ahead * slant + at * climb; /* away from the axis, on the sun's side */
    float side = (inside - beside) / slant;
    float cap = ((climb < 0.0f ? -half_height : half_height) - height) /
                (climb < 0.0f ? fminf(climb, -1e-6f) : fmaxf(climb, 1e-6f));
    return cover * behind(fminf(side, cap), ball);
}
