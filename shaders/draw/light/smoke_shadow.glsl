/* Finds the part of the light, 0 to 1, that gets through the smoke to a world position: of the sun's
 * light, and of the sky's light from straight above. Shaders that light particles, meshes, spheres
 * and the backdrop include it; they must declare `backdrop` before.
 *
 * The host has filled grids with the optical depth that light crosses (lib/draw/light/smoke_shadow.h);
 * their third axis points to the light. lib/draw/light/lighting_gl.c binds them to these units.
 * lib/draw/light/ray_smoke.h computes the same on the processor, so both must change together. The
 * grids are undefined where there is no smoke, that is where backdrop.counts.w is 0. */
layout(binding = 4) uniform sampler3D smoke_to_sun;
layout(binding = 5) uniform sampler3D smoke_to_sky;

float smoke_transmittance(sampler3D depth, vec4 row_x, vec4 row_y, vec4 row_z, vec3 position)
{
    vec4 p = vec4(position, 1.0);
    vec3 at = vec3(dot(row_x, p), dot(row_y, p), dot(row_z, p));
    /* Beside the smoke, or between it and the light. */
    if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at, vec3(1.0))))
        return 1.0;
    return exp(-textureLod(depth, at, 0.0).r);
}

float sunlight_through_smoke(vec3 position)
{
    if (backdrop.counts.w == 0u)
        return 1.0;
    return smoke_transmittance(smoke_to_sun, backdrop.sun_to_grid[0], backdrop.sun_to_grid[1],
                               backdrop.sun_to_grid[2], position);
}

float skylight_through_smoke(vec3 position)
{
    if (backdrop.counts.w == 0u)
        return 1.0;
    return smoke_transmittance(smoke_to_sky, backdrop.sky_to_grid[0], backdrop.sky_to_grid[1],
                               backdrop.sky_to_grid[2], position);
}
