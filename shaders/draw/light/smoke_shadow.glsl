/* Finds the optical depth of the smoke between a light and a world position: for the sun, for the
 * sky's light from straight above, and for lamps. Shaders that light particles, meshes, spheres and
 * the backdrop include this file; they must declare `backdrop` before.
 *
 * The host has filled the grids of sun and sky (lib/draw/light/smoke_shadow.h), whose third axis
 * points to the light, and the maps of lamps (lib/draw/light/lamp_smoke.h).
 * lib/draw/light/lighting_gl.c binds them to these units. They are undefined where there is no
 * smoke, that is where backdrop.counts.w is 0. With NO_SMOKE, there never is any. */
#include "shared/lamp_smoke.h"
#include "shared/smoke_grid.h"

#ifdef NO_SMOKE

float smoke_depth_to_sun(vec3 position)
{
    return 0.0;
}

float smoke_depth_to_sky(vec3 position)
{
    return 0.0;
}

float smoke_depth_to_lamp(int i, vec3 position)
{
    return 0.0;
}

#else

layout(binding = KILN_UNIT_SMOKE_SUN) uniform sampler3D smoke_to_sun;
layout(binding = KILN_UNIT_SMOKE_SKY) uniform sampler3D smoke_to_sky;
layout(binding = KILN_UNIT_LAMP_SMOKE) uniform sampler2DArray smoke_to_lamps;

float smoke_depth_in(sampler3D depth, vec4 row_x, vec4 row_y, vec4 row_z, vec3 position)
{
    vec3 at = smoke_grid_place(row_x, row_y, row_z, position);
    return smoke_grid_shades(at) ? textureLod(depth, at, 0.0).r : 0.0;
}

float smoke_depth_to_sun(vec3 position)
{
    if (backdrop.counts.w == 0u)
        return 0.0;
    return smoke_depth_in(smoke_to_sun, backdrop.sun_to_grid[0], backdrop.sun_to_grid[1],
                          backdrop.sun_to_grid[2], position);
}

float smoke_depth_to_sky(vec3 position)
{
    if (backdrop.counts.w == 0u)
        return 0.0;
    return smoke_depth_in(smoke_to_sky, backdrop.sky_to_grid[0], backdrop.sky_to_grid[1],
                          backdrop.sky_to_grid[2], position);
}

float smoke_depth_to_lamp(int i, vec3 position)
{
    if (backdrop.counts.w == 0u || backdrop.lights[i].casters.z == 0u)
        return 0.0;
    lamp_smoke_place place = lamp_smoke_place_of(
        position - backdrop.lights[i].position_radius2.xyz, backdrop.lights[i]);
    vec2 size = vec2(KILN_LAMP_SMOKE_WIDTH, KILN_LAMP_SMOKE_HEIGHT);
    vec2 at = (vec2(place.x, place.y) + 0.5) / size;
    float first = floor(min(place.layer, float(KILN_LAMP_SMOKE_LAYERS - 2)));
    float layer = first + float(KILN_LAMP_SMOKE_LAYERS * int(backdrop.lights[i].casters.z - 1u));
    return mix(textureLod(smoke_to_lamps, vec3(at, layer), 0.0).r,
               textureLod(smoke_to_lamps, vec3(at, layer + 1.0), 0.0).r, place.layer - first);
}

#endif

/* Return the part of the light of sun and sky that smoke lets through. */
float sunlight_through_smoke(vec3 position)
{
    return smoke_transmittance(smoke_depth_to_sun(position));
}

float skylight_through_smoke(vec3 position)
{
    return smoke_transmittance(smoke_depth_to_sky(position));
}
