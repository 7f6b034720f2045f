/* Maps rays to the pictures of the floor and of the sky: where in the picture a ray reads, and over
 * how many texels it averages. GL samples the pictures as textures (draw/backdrop/floor_image.glsl,
 * sky_image.glsl); the device `cpu` reads their mipmaps (draw/backdrop/ray_picture.h). */
#ifndef KILN_SHARED_PICTURE_MAP_H
#define KILN_SHARED_PICTURE_MAP_H

#include "shared/real.h"

/* The most fetches along the longer edge of the part of the floor that a pixel covers. */
#define FLOOR_TAPS 8

/* The footprint of a pixel on the floor, a parallelogram. Its shorter edge chooses the level that
 * is fetched: one between two levels. The fetches from the finer one lie along its longer edge, m,
 * one for each texel that the edge is long; `taps` is their number, a whole one. */
struct floor_footprint {
    real longer_x, longer_z, level, taps;
};

/* How far a place on the floor moves, m. */
struct floor_shift {
    real x, z;
};

/* Returns how far the place on the floor that a ray meets at t moves when the ray's direction
 * changes by factor times row. row: a row of the camera's rotation from world to view. */
REAL_FN S(floor_shift) floor_shift_of(real3 direction, float4 row, float factor, real t)
{
    real climb = (row.y * factor) / direction.y;
    S(floor_shift) shift;
    shift.x = t * (row.x * factor - direction.x * climb);
    shift.z = t * (row.z * factor - direction.z * climb);
    return shift;
}

/* Returns the footprint of the pixel of a ray that meets the floor at t. right, up: the
 * camera's first two rows; frustum: that of struct kiln_view; texels_a_m: of the picture. */
REAL_FN S(floor_footprint) floor_footprint_of(real3 direction, real t, float4 right, float4 up,
                                              float4 frustum, float texels_a_m)
{
    S(floor_shift) u = floor_shift_of(direction, right, 2.0f * frustum.x / frustum.z, t);
    S(floor_shift) v = floor_shift_of(direction, up, 2.0f * frustum.y / frustum.w, t);
    real u2 = u.x * u.x + u.z * u.z, v2 = v.x * v.x + v.z * v.z;
    truth along_u = u2 > v2;
    real square = real_max(real_select(along_u, u2, v2), real_all(1e-18f));
    real inverse = real_rsqrt(square);
    /* The width is the area over the length, since the two edges need not be perpendicular. */
    real width = real_abs(u.x * v.z - u.z * v.x) * inverse;
    real covered = real_max(width, square * inverse * (1.0f / FLOAT(FLOOR_TAPS)));
    S(floor_footprint) footprint;
    footprint.longer_x = real_select(along_u, u.x, v.x);
    footprint.longer_z = real_select(along_u, u.z, v.z);
    real texels = real_min(real_max(covered * texels_a_m, real_all(1e-6f)), real_all(1e9f));
    footprint.level = real_log2(texels);
    real length = square * inverse * texels_a_m;
    footprint.taps = real_clamp(real_floor(length / real_max(texels, real_all(1.0f)) + 0.99f), 1.0f,
                                FLOAT(FLOOR_TAPS));
    return footprint;
}

/* Returns where fetch i from a level lies along the longer edge, as a part of it from the middle.
 * part: 1 / the number of fetches. */
REAL_FN real floor_tap_of(real part, int i)
{
    return (FLOAT(i) + 0.5f) * part - 0.5f;
}

/* Returns the number of fetches from the coarser level, whose texels are twice as large. */
REAL_FN real floor_coarse_taps(real taps)
{
    return real_floor(0.5f * taps + 0.5f);
}

/* Texture coordinates. */
struct sky_place {
    real u, v;
};

/* Returns where a direction is in an equirectangular picture, whose middle lies towards -z. turn: a
 * part of a full turn that is added. u may be beyond 0 and 1, where the picture repeats. */
REAL_FN S(sky_place) sky_place_of(real3 direction, float turn)
{
    real square = direction.x * direction.x + direction.z * direction.z;
    real across = square * real_rsqrt(real_max(square, real_all(1e-30f)));
    S(sky_place) at;
    at.u = real_atan2(direction.x, -direction.z) * (0.5f / 3.14159265f) + (0.5f + turn);
    at.v = real_atan2(across, direction.y) * (1.0f / 3.14159265f);
    return at;
}

#endif
