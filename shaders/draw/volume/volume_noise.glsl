/* Computes gradient noise, as lib/draw/volume/volume_noise.h does on the host. */

/* Returns random bits for a point of the lattice. */
uint noise_bits(uvec3 at)
{
    uint h = at.x * 0x8da6b343u + at.y * 0xd8163841u + at.z * 0xcb1ab31fu;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return h ^ h >> 15;
}

/* Returns the product of the gradient at a point of the lattice and the way from there. */
float noise_slope(uvec3 low, uvec3 corner, vec3 way)
{
    uint bits = noise_bits(low + corner);
    vec3 gradient = vec3(uvec3(bits, bits >> 3, bits >> 6) & 7u) - 3.5;
    return dot(gradient, way - vec3(corner));
}

/* Returns noise with mean 0 and mean square 1 at a place, in cells of its lattice. */
float noise_at(vec3 place)
{
    vec3 low = floor(place), way = place - low;
    uvec3 at = uvec3(ivec3(low));
    vec3 fade = way * way * way * (10.0 + way * (6.0 * way - 15.0));
    vec4 ends;
    ends.x = mix(noise_slope(at, uvec3(0, 0, 0), way), noise_slope(at, uvec3(1, 0, 0), way), fade.x);
    ends.y = mix(noise_slope(at, uvec3(0, 1, 0), way), noise_slope(at, uvec3(1, 1, 0), way), fade.x);
    ends.z = mix(noise_slope(at, uvec3(0, 0, 1), way), noise_slope(at, uvec3(1, 0, 1), way), fade.x);
    ends.w = mix(noise_slope(at, uvec3(0, 1, 1), way), noise_slope(at, uvec3(1, 1, 1), way), fade.x);
    vec2 rows = mix(ends.xz, ends.yw, fade.y);
    return GAS_NOISE_UNIT * mix(rows.x, rows.y, fade.z);
}
