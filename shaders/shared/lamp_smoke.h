/* Computes where the map of the smoke around a lamp is read. The map has the optical depth of the
 * smoke between the lamp and places around it (lib/draw/light/lamp_smoke.c). It consists of layers,
 * one for each of several distances: 0, the nearest one, and on to the farthest one, each the same
 * factor farther than the one before. A texel of a layer is a direction.
 *
 * The map of a lamp near the smoke has the six faces of a cube in each layer. The outermost texels
 * of two neighbouring faces have the same direction, so that no edge is seen. The map of a lamp far
 * from the smoke has one picture of the smoke instead. GL samples the layers as textures
 * (draw/light/smoke_shadow.glsl); the device `cpu` gathers their texels (draw/light/ray_smoke.h).
 */
#ifndef KILN_SHARED_LAMP_SMOKE_H
#define KILN_SHARED_LAMP_SMOKE_H

#include "shared/draw_layout.h"
#include "shared/real.h"

/* Half the texels across the middles of the outermost texels of a face, and of a picture. */
#define LAMP_SMOKE_FACE_HALF    (0.5f * FLOAT(KILN_LAMP_SMOKE_FACE - 1))
#define LAMP_SMOKE_PICTURE_HALF (0.5f * FLOAT(KILN_LAMP_SMOKE_HEIGHT - 1))

/* A place in a map, in texels from the middle of the first texel of a layer, and in layers. It is
 * inside of the map for all places in the world. */
struct lamp_smoke_place {
    real x, y, layer;
};

/* Sets the texel of the direction from a lamp near the smoke to a place. */
REAL_FN S(lamp_smoke_place) lamp_smoke_in_face(S(lamp_smoke_place) place, real3 from)
{
    const float half_face = LAMP_SMOKE_FACE_HALF, edge = FLOAT(KILN_LAMP_SMOKE_FACE);
    real x = real_abs(from.x), y = real_abs(from.y), z = real_abs(from.z);
    truth on_x = truth_and(x >= y, x >= z);
    truth on_y = truth_and(truth_not(on_x), y >= z);
    real ahead = real_select(on_x, from.x, real_select(on_y, from.y, from.z));
    real aside = real_select(on_x, from.z, from.x), above = real_select(on_y, from.z, from.y);
    real inverse = 1.0f / real_max(real_abs(ahead), real_all(1e-6f));
    real column =
        real_select(on_x, real_all(0.0f), real_select(on_y, real_all(edge), real_all(2.0f * edge)));
    place.x = column + real_clamp((aside * inverse + 1.0f) * half_face, 0.0f, 2.0f * half_face);
    place.y = real_where(ahead < 0.0f, real_all(edge)) +
              real_clamp((above * inverse + 1.0f) * half_face, 0.0f, 2.0f * half_face);
    return place;
}

/* Sets the texel of the direction from a lamp far from the smoke to a place. ahead: unit, to the
 * middle of the smoke; w: 1 / the tangent that the picture shows to each side; right: unit. */
REAL_FN S(lamp_smoke_place) lamp_smoke_in_picture(S(lamp_smoke_place) place, real3 from,
                                                  float4 ahead, float4 right)
{
    const float half_picture = LAMP_SMOKE_PICTURE_HALF;
    real distance = real3_dot_all(from, ahead);
    real scale = ahead.w / real_max(distance, real_all(1e-6f));
    real3 up = real3_cross(real3_all(ahead), real3_all(right));
    real x = real3_dot_all(from, right) * scale, y = real3_dot(from, up) * scale;
    /* No smoke is behind the lamp, nor at the picture's border. */
    x = real_select(distance > 0.0f, x, real_all(-1.0f));
    place.x = real_clamp((x + 1.0f) * half_picture, 0.0f, 2.0f * half_picture);
    place.y = real_clamp((y + 1.0f) * half_picture, 0.0f, 2.0f * half_picture);
    return place;
}

/* from: from the lamp to the place, m. */
REAL_FN S(lamp_smoke_place) lamp_smoke_place_of(real3 from, S(kiln_draw_light) lamp)
{
    float near = lamp.maps.y, layers = lamp.maps.z;
    real distance = real3_length(from) * (1.0f / near);
    real beyond = 1.0f + layers * real_log2(real_max(distance, real_all(1.0f)));
    S(lamp_smoke_place) place;
    place.layer = real_min(real_select(distance < 1.0f, distance, beyond),
                           real_all(FLOAT(KILN_LAMP_SMOKE_LAYERS - 1)));
    place.x = place.y = real_all(0.0f);
    if (lamp.smoke_ahead.w > 0.0f)
        return lamp_smoke_in_picture(place, from, lamp.smoke_ahead, lamp.smoke_right);
    return lamp_smoke_in_face(place, from);
}

#endif
