/* Computes which texels of a lamp's shadow maps a point of a surface reads, and how much of the
 * lamp they hide. A lamp has six maps, the faces of a cube around it, which show the backdrop's
 * meshes (lib/draw/light/lamp_map.c), and six that show solid particles
 * (lib/draw/light/lamp_solids.c). Each face shows more than its sixth of all directions, so that a
 * blurred shadow does not end at an edge of the cube. GL samples the maps as textures
 * (draw/backdrop/mesh_trace.glsl, draw/light/lamp_solids.glsl); the device `cpu` reads them by
 * itself (lib/draw/light/ray_lamp.h).
 */
#ifndef KILN_SHARED_LAMP_MAP_H
#define KILN_SHARED_LAMP_MAP_H

#include "shared/shadow_map.h"

#define LAMP_TEXEL (1.0f / FLOAT(KILN_LAMP_EDGE))

/* Widest blur of a shadow, in texture coordinates: the part of a face that lies beside its sixth.
 */
#define LAMP_WIDEST ((KILN_LAMP_RANGE - 1.0f) / (2.0f * KILN_LAMP_RANGE))

/* A point in the maps: its face, 0 to 5, and as in any shadow map its place there, for which depth
 * is the distance along the face's axis, as a part of `far`. */
struct lamp_place {
    real face;
    real distance; /* along the face's axis, m */
    S(shadow_receiver) at;
};

/* from: from the lamp to the point, m; normal: of the surface there; far: distance that the maps
 * reach, m. */
REAL_FN S(lamp_place) lamp_place_of(real3 from, real3 normal, float far)
{
    real x = real_abs(from.x), y = real_abs(from.y), z = real_abs(from.z);
    truth on_x = truth_and(x >= y, x >= z);
    truth on_y = truth_and(truth_not(on_x), y >= z);
    real ahead = real_select(on_x, from.x, real_select(on_y, from.y, from.z));
    real aside = real_select(on_x, from.z, from.x), above = real_select(on_y, from.z, from.y);
    real normal_ahead = real_select(on_x, normal.x, real_select(on_y, normal.y, normal.z));
    real normal_aside = real_select(on_x, normal.z, normal.x);
    real normal_above = real_select(on_y, normal.z, normal.y);
    real sign = real_sign_one(ahead);

    S(lamp_place) place;
    place.distance = real_max(real_abs(ahead), real_all(1e-4f));
    place.face =
        real_select(on_x, real_all(0.0f), real_select(on_y, real_all(2.0f), real_all(4.0f))) +
        real_where(ahead < 0.0f, real_all(1.0f));
    real nearness = 1.0f / place.distance;
    real right = aside * nearness, up = above * nearness;
    place.at.u = 0.5f + right * (0.5f / KILN_LAMP_RANGE);
    place.at.v = 0.5f - up * (0.5f / KILN_LAMP_RANGE);
    place.at.depth = place.distance * (1.0f / far);

    /* The plane of the surface has the depth 1 / (normal * (right, up, sign)), times a constant. */
    real facing = -(normal_aside * right + normal_above * up + normal_ahead * sign);
    real inverse = 1.0f / real_max(facing, real_all(0.05f));
    real wide = 2.0f * KILN_LAMP_RANGE * place.at.depth; /* of a face there, in units of depth */
    real tilt_right = normal_aside * inverse, tilt_up = normal_above * inverse;
    place.at.slope_u = tilt_right * wide;
    place.at.slope_v = -(tilt_up * wide);
    place.at.slack =
        1.5f * LAMP_TEXEL * wide * (1.0f + 0.5f * (real_abs(tilt_right) + real_abs(tilt_up)));
    return place;
}

/* Returns the width, in texture coordinates, of the penumbra that a blocker at a distance makes,
 * however wide. radius: of the lamp, m; lit: of the ball that is lit, m; 0 for a point. */
REAL_FN real lamp_true_penumbra(S(lamp_place) place, float radius, real lit, real blocker)
{
    real gap = real_max(place.distance - blocker, real_all(0.0f));
    real near = real_max(blocker, real_all(1e-3f));
    real tangent = (radius * gap + lit * near) / (place.distance * near);
    return tangent * (0.5f / KILN_LAMP_RANGE);
}

/* Returns the width of lamp_true_penumbra that maps can show. */
REAL_FN real lamp_penumbra(S(lamp_place) place, float radius, real lit, real blocker)
{
    return real_clamp(lamp_true_penumbra(place, radius, lit, blocker), LAMP_TEXEL, LAMP_WIDEST);
}

/* Returns the width of the widest penumbra that a blocker outside of the lamp makes. A first fetch
 * looks for any blocker over twice this width. */
REAL_FN real lamp_widest(S(lamp_place) place, float radius, real lit)
{
    return lamp_penumbra(place, radius, lit, real_all(exact_max(radius, 0.02f)));
}

/* Returns the width of the penumbra of the blocker that the first fetch found, as shadow_width. */
REAL_FN real lamp_width(S(lamp_place) place, float radius, real lit, float far, real cover,
                        real distance)
{
    return real_max(0.75f * lamp_penumbra(place, radius, lit, far * shadow_depth(cover, distance)),
                    real_all(LAMP_TEXEL));
}

/* Returns the level whose texels have this width, in texture coordinates. */
REAL_FN real lamp_level(real width)
{
    return shadow_level_of(width * FLOAT(KILN_LAMP_EDGE));
}

/* ---- solid particles ------------------------------------------------------------------------- */

/* In these maps depth is the distance from the lamp. A solid has one distance, that of its middle,
 * so it does not shade itself. A texel has the cover, and that times the means of distance, of
 * squared distance, and of how narrow solids are: (LAMP_WIDEST / the solid's radius in the map)^2,
 * at most 1.
 *
 * A surface of the backdrop is not in the maps: it is before or behind all that a fetch finds. But
 * around a lit solid, a fetch finds this solid as well as what shades it. To it, a fetch stands for
 * two distances, its own and another; the two means tell the other one and its part. */
struct lamp_solid_place {
    S(lamp_place) place;   /* in maps of meshes */
    S(shadow_receiver) at; /* in maps of solids */
    real stretch;          /* distance from the lamp / distance along the face's axis */
};

/* Returns the place of a point in the maps. from, normal, far: as for lamp_place_of; on_solid: 1
 * where the point is of a solid whose middle has the distance `middle` from the lamp, m. */
REAL_FN S(lamp_solid_place) lamp_solid_place_of(real3 from, real3 normal, float far, truth on_solid,
                                                real middle)
{
    S(lamp_solid_place) to;
    to.place = lamp_place_of(from, normal, far);
    const float wide = 2.0f * KILN_LAMP_RANGE;
    real right = (to.place.at.u - 0.5f) * wide, up = (0.5f - to.place.at.v) * wide;
    real square = 1.0f + right * right + up * up, inverse = real_rsqrt(square);
    to.stretch = square * inverse;
    real bend = to.place.at.depth * wide * inverse;
    to.at.u = to.place.at.u;
    to.at.v = to.place.at.v;
    to.at.depth = real_select(on_solid, middle * (1.0f / far), to.place.at.depth * to.stretch);
    to.at.slope_u =
        real_where(truth_not(on_solid), to.place.at.slope_u * to.stretch + right * bend);
    to.at.slope_v = real_where(truth_not(on_solid), to.place.at.slope_v * to.stretch - up * bend);
    to.at.slack = 0.5f * LAMP_TEXEL * wide * to.at.depth;
    return to;
}

/* Returns the width of the penumbra of what the first fetch found, as lamp_width. */
REAL_FN real lamp_solid_width(S(lamp_solid_place) to, float radius, real lit, float far, real cover,
                              real distance)
{
    return lamp_width(to.place, radius, lit, far, cover, distance / to.stretch);
}

/* Returns what lamp_solid_width takes as `distance` for a lit solid: that of the other distance. */
REAL_FN real lamp_other_distance(S(shadow_receiver) at, real cover, real distance, real square)
{
    real mean = shadow_depth(cover, distance);
    real before = real_max(at.depth - mean, 0.5f * at.slack);
    real spread = real_max(shadow_depth(cover, square) - mean * mean, real_all(0.0f));
    return cover * real_max(at.depth - (spread + before * before) / before, real_all(0.0f));
}

/* Returns the part of the lamp that one of the four fetches around a lit solid adds to the covered
 * part, as shadow_tap: Chebyshev's bound, which is exact for two distances (Donnelly and Lauritzen,
 * Variance Shadow Maps, 2006). */
REAL_FN real lamp_solid_tap(S(shadow_receiver) at, real cover, real distance, real square)
{
    real mean = shadow_depth(cover, distance);
    real before = at.depth - mean;
    real spread = real_max(shadow_depth(cover, square) - mean * mean, real_all(0.0f));
    real behind = before * before;
    real part = behind / real_max(behind + spread, real_all(1e-12f));
    return 0.25f * cover * part * real_clamp01(before / at.slack - 0.5f);
}

/* Returns the cover by solids from that of blurred maps. Where the penumbra is wider than maps can
 * show, a solid that is smaller covers less. found, narrow: from the first fetch; distance: as for
 * lamp_solid_width. */
REAL_FN real lamp_thin_cover(S(lamp_solid_place) to, float radius, real lit, float far, real found,
                             real distance, real narrow, real cover)
{
    real blocker = far * shadow_depth(found, distance / to.stretch);
    real width = lamp_true_penumbra(to.place, radius, lit, blocker);
    real part = LAMP_WIDEST / real_max(width, real_all(LAMP_WIDEST));
    return cover *
           real_min(part * part * found / real_max(narrow, real_all(1e-5f)), real_all(1.0f));
}

#endif
