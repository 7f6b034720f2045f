/* Finds the part of the light, 0 to 1, that gets through the smoke to a world position: of the
 * sun's light, and of the sky's light from straight above. Shaders that light particles, meshes,
 * spheres and the backdrop include it; they must declare `backdrop` before.
 *
 * The host has filled grids with the optical depth that light crosses (lib/draw/light/smoke_shadow.h);
 * their third axis points to the light. lib/draw/light/lighting_gl.c binds them to these units. The
 * grids are undefined where there is no smoke, that is where backdrop.counts.w is 0. */
#include "shared/smoke_grid.h"

layout(binding = 4) uniform sampler3D smoke_to_sun;
layout(binding = 5) uniform sampler3D smoke_to_sky;

float light_through_smoke(sampler3D depth, vec4 row_x, vec4 row_y, vec4 row_z, vec3 position)
{
    vec3 at = smoke_grid_place(row_x, row_y, row_z, position);
    return smoke_grid_shades(at) ? smoke_transmittance(textureLod(depth, at, 0.0).r) : 1.0;
}

float sunlight_through_smoke(vec3 position)
{
    if (backdrop.counts.w == 0u)
        return 1.0;
    return light_through_smoke(smoke_to_sun, backdrop.sun_to_grid[0], backdrop.sun_to_grid[1],
                               backdrop.sun_to_grid[2], position);
}

float skylight_through_smoke(vec3 position)
{
    if (backdrop.counts.w == 0u)
        return 1.0;
    return light_through_smoke(smoke_to_sky, backdrop.sky_to_grid[0], backdrop.sky_to_grid[1],
                               backdrop.sky_to_grid[2], position);
}
