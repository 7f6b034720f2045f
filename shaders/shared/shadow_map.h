/* Computes which texels of the sun's shadow maps a receiver reads, and how much of the sun they
 * hide: maps of the backdrop's meshes, and tiles of silhouettes of mesh particles. GL samples the
 * maps as textures (draw/backdrop/mesh_trace.glsl, draw/light/solid_shadow.glsl); the device `cpu`
 * gathers their texels (draw/backdrop/ray_sun.h). sun: unit, towards the sun; right, up: unit,
 * across it; spread: tangent of the angle that the sun's radius has in the sky. */
#ifndef KILN_SHARED_SHADOW_MAP_H
#define KILN_SHARED_SHADOW_MAP_H

#include "shared/light_cover.h"
#include "shared/shape_layout.h"

/* ---- meshes of the backdrop ------------------------------------------------------------------ */

#define SHADOW_TEXEL (1.0f / FLOAT(KILN_SHADOW_EDGE))

/* A receiver in a mesh's map: its texture coordinates and depth (0 nearest to the sun, 1 farthest);
 * how the depth of its plane changes with the coordinates; and the least depth by which a blocker
 * must lie before it. */
struct shadow_receiver {
    real u, v, depth;
    real slope_u, slope_v;
    real slack;
};

/* Returns a receiver in the map of a mesh. center: the mesh's bounding sphere; point, normal: of
 * the receiver. */
REAL_FN S(shadow_receiver) shadow_receiver_of(float4 center, real3 point, real3 normal, float4 sun,
                                              float4 right, float4 up)
{
    real3 from = real3_sub(point, real3_all(center));
    float scale = 0.5f / (center.w * (1.0f + KILN_SHADOW_MARGIN));
    real facing = 1.0f / real_max(real3_dot_all(normal, sun), real_all(0.05f));
    S(shadow_receiver) at;
    at.u = 0.5f + real3_dot_all(from, right) * scale;
    at.v = 0.5f + real3_dot_all(from, up) * scale;
    at.depth = 0.5f - real3_dot_all(from, sun) * scale;
    at.slope_u = real3_dot_all(normal, right) * facing;
    at.slope_v = real3_dot_all(normal, up) * facing;
    at.slack = 1.5f * SHADOW_TEXEL * (1.0f + 0.5f * (real_abs(at.slope_u) + real_abs(at.slope_v)));
    return at;
}

/* Returns the width, in texture coordinates, of the penumbra of a blocker that is nearest to the
 * sun. A first fetch looks for any blocker over twice this width. */
REAL_FN real shadow_widest(S(shadow_receiver) at, float spread)
{
    return real_max(spread * at.depth, real_all(SHADOW_TEXEL));
}

/* Returns the level between mipmaps whose texels have such a width, in texels of the finest: 0 for
 * one texel. Between two mipmaps, the level grows linearly with the width. */
REAL_FN real shadow_level_of(real texels)
{
    return real_of(real_bits(texels)) * (1.0f / 8388608.0f) - 127.0f;
}

/* Returns the level whose texels have this width, in texture coordinates. */
REAL_FN real shadow_level(real width)
{
    return shadow_level_of(width * (1.0f / SHADOW_TEXEL));
}

/* Returns the mean depth of the mesh in the map, from the two numbers of a fetch: cover, and depth
 * times cover. */
REAL_FN real shadow_depth(real cover, real distance)
{
    return distance / real_max(cover, real_all(1e-4f));
}

/* Returns the width of the penumbra, from the gap between the blocker that the first fetch found
 * and the receiver. Four bilinear fetches, half of this width aside, make the tent filter of nine.
 */
REAL_FN real shadow_width(S(shadow_receiver) at, float spread, real cover, real distance)
{
    real gap = at.depth - real_min(shadow_depth(cover, distance), at.depth);
    return real_max(0.75f * spread * gap, real_all(SHADOW_TEXEL));
}

/* Returns the part of the sun that one of the four fetches around a receiver adds to the covered
 * part. ramp: 1 / (slack + width of the fetch). */
REAL_FN real shadow_tap(S(shadow_receiver) at, real aside_u, real aside_v, real cover,
                        real distance, real ramp)
{
    real depth = at.depth + (at.slope_u * aside_u + at.slope_v * aside_v);
    real before = depth * cover - distance; /* times cover */
    real part = real_min(before * ramp - 0.5f * cover, cover);
    return 0.25f * real_max(part, real_all(0.0f));
}

/* ---- silhouettes of mesh particles ----------------------------------------------------------- */

/* The place where a receiver reads a tile: texture coordinates in it; the level whose texels are as
 * large as the sun's radius there; the last level; and the weight of the mesh's bounding sphere in
 * place of its silhouette, 0 to 1, which grows as the sun's blur exceeds the mesh's size. */
struct silhouette_place {
    real u, v, level, last, round;
    truth before; /* the mesh is on the sun's side of the receiver */
};

/* Returns where a receiver reads a tile. towards: from the receiver to the mesh's centre, m; edge:
 * of the tile, texels; reach: half of the tile's edge in the world, m. */
REAL_FN S(silhouette_place) silhouette_place_of(real3 towards, real edge, real reach, float4 sun,
                                                float4 right, float4 up, float spread)
{
    real t = real3_dot_all(towards, sun), scale = 0.5f / reach;
    real radius = real_max(t * spread, real_all(1e-5f));
    S(silhouette_place) at;
    at.u = 0.5f - real3_dot_all(towards, right) * scale;
    at.v = 0.5f - real3_dot_all(towards, up) * scale;
    at.last = real_floor(real_log2(edge) + 0.5f);
    real level = real_log2(real_max(radius * edge * scale, real_all(1.0f)));
    at.level = real_max(real_min(level, at.last), real_all(0.0f));
    at.round = real_clamp01((radius / reach - KILN_INSTANCE_SHARP) *
                            (1.0f / (KILN_INSTANCE_ROUND - KILN_INSTANCE_SHARP)));
    at.before = t > 0.0f;
    return at;
}

/* Returns the part of the sun that a mesh covers. cover: the part that the tile covers; ball: the
 * part that the bounding sphere covers. */
REAL_FN real silhouette_covers(S(silhouette_place) at, real cover, real ball)
{
    real seen = real_where(at.before, cover);
    return seen + (ball - seen) * at.round;
}

#endif
