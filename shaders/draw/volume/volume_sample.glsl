/* Samples the blocks of a domain of gas for a step of a ray, and adds the step's light, as
 * lib/draw/volume/volume_sample.h, volume_detail.h and volume_march_simd.c do on the host. */

/* A block in the array of cells: rows and planes have one cell more than a brick has. */
const uint EDGE = 9u, PLANE = EDGE * EDGE, BLOCK = EDGE * PLANE;

/* Holds the place of a step's sample. */
struct step_place {
    vec3 at, part;        /* in the window, cells; the way to the next cell */
    uint cell;            /* number of the cell among those of all blocks */
    bool some;            /* false: nothing is seen there */
    float middle, span;   /* of the step's segment, cells */
    float leaves;         /* where the ray leaves the cube */
};

/* Holds the gas at a sample, and the light that reaches it. */
struct gas_cell {
    float smoke, flame, temperature, sun, scattered;
    vec3 light, tint;
};

step_place find_place(ray r, float number)
{
    step_place s;
    float begin = max(number * march.up.w, r.from), end = min((number + 1.0) * march.up.w, r.to);
    s.middle = 0.5 * (begin + end);
    s.at = clamp(march.eye.xyz + r.way * s.middle - 0.5, vec3(0.0), vec3(march.cells.xyz - 1u));
    uvec3 cell = uvec3(s.at), cube = cell >> 2, within = cell & 7u;
    s.part = s.at - vec3(cell);
    vec3 side = vec3(ivec3(cube) + ivec3(greaterThan(r.way, vec3(0.0)))) * 4.0 + 0.5;
    vec3 leaves = (side - march.eye.xyz) * r.inverse;
    s.leaves = min(leaves.x, min(leaves.y, leaves.z));
    int block = int(places[(cube.z * 2u * march.bricks.y + cube.y) * 2u * march.bricks.x + cube.x]);
    s.some = begin < end && block >= 0;
    s.cell = s.some ? uint(block) * BLOCK + within.z * PLANE + within.y * EDGE + within.x : 0u;
    s.span = s.some ? end - begin : 0.0;
    return s;
}

/* Interpolates between eight cells of an array, which has `stride` elements a cell. */
#define INTERPOLATE(array, s, stride, offset)                                                      \
    mix(mix(mix(array[((s).cell) * stride + offset], array[((s).cell + 1u) * stride + offset],     \
                (s).part.x),                                                                       \
            mix(array[((s).cell + EDGE) * stride + offset],                                        \
                array[((s).cell + EDGE + 1u) * stride + offset], (s).part.x),                      \
            (s).part.y),                                                                           \
        mix(mix(array[((s).cell + PLANE) * stride + offset],                                       \
                array[((s).cell + PLANE + 1u) * stride + offset], (s).part.x),                     \
            mix(array[((s).cell + PLANE + EDGE) * stride + offset],                                \
                array[((s).cell + PLANE + EDGE + 1u) * stride + offset], (s).part.x),              \
            (s).part.y),                                                                           \
        (s).part.z)

gas_cell sample_gas(step_place s)
{
    vec4 low = INTERPOLATE(blocks, s, 2u, 0u), high = INTERPOLATE(blocks, s, 2u, 1u);
    gas_cell g = gas_cell(max(low.x, 0.0), max(low.y, 0.0), low.z, low.w, high.x, high.yzw,
                          vec3(0.0));
    g.tint = (march.cells.w & MARCH_COLORED) != 0u ? INTERPOLATE(tints, s, 1u, 0u).rgb
                                                   : g.smoke * march.albedo.rgb;
    return g;
}

/* Returns the noise of a group of ways at a place in its lattice. */
float noise_of_group(vec3 place)
{
    float sum = noise_at(place);
    if (march.detail.z > 1.0)
        sum += GAS_OCTAVE * noise_at(2.0 * place);
    return sum;
}

/* Returns the noise of gas by both groups of ways, and its mean square. calm: of the groups. */
vec2 noise_of(step_place s, vec2 calm)
{
    vec3 place = s.at + march.lattice.xyz;
    vec2 weights = march.detail.xy * calm;
    float squares = dot(weights, weights);
    float scale = 1.0 / sqrt(max(squares, 0.25)), noise = 0.0;
    vec3 first = (place + march.lattice.w * INTERPOLATE(finer, s, 2u, 0u).xyz) / GAS_NOISE_CELL;
    vec3 second = (place + march.lattice.w * INTERPOLATE(finer, s, 2u, 1u).xyz) / GAS_NOISE_CELL;
    if (weights.x > 0.0)
        noise += weights.x * scale * noise_of_group(first);
    if (weights.y > 0.0)
        noise += weights.y * scale * noise_of_group(second + GAS_NOISE_APART);
    float octaves = march.detail.z > 1.0 ? GAS_TWO_OCTAVES : 1.0;
    return vec2(noise, squares * scale * scale * octaves);
}

/* Returns the part of gas of a thickness that is drawn. edge: the thickness of which half is. */
float part_at_edge(float thickness, float edge)
{
    return smoothstep(0.0, 1.0, (thickness - edge) / GAS_EDGE_WIDTH + 0.5);
}

/* Changes sampled gas by noise, and makes its edges steeper, if the step changes the ray enough for
 * its noise to be seen. */
void add_detail(ray r, step_place s, inout gas_cell g)
{
    float amount = g.smoke * march.albedo.w + g.flame * (march.detail.w + march.to_sun.w);
    if (r.clear * s.span * march.right.w * amount <= GAS_DETAIL_SEEN)
        return;
    vec4 edges = INTERPOLATE(finer, s, 1u, march.picture.w);
    vec2 noise = noise_of(s, edges.zw);
    float value = GAS_DETAIL * noise.x, variance = GAS_DETAIL * GAS_DETAIL * noise.y;
    float smoke = exp(value - 0.5 * variance) *
                  part_at_edge(edges.x + GAS_SMOKE_TORN * noise.x, GAS_SMOKE_EDGE);
    g.smoke *= smoke;
    g.tint *= smoke;
    g.flame *= exp(0.5 * value - 0.125 * variance) *
               part_at_edge(edges.y + GAS_FLAME_TORN * noise.x, GAS_FLAME_EDGE);
}

/* Returns the light of flames by their temperature. */
vec3 flame_light(float temperature)
{
    float most = float(FLAME_COLORS);
    float place = clamp(temperature * (most / FLAME_HOTTEST), 0.0, most - 0.001);
    uint low = uint(place);
    return mix(march.colors[low].rgb, march.colors[low + 1u].rgb, place - float(low));
}

/* Finds where the ray becomes half opaque, if it does in a step. before: optical depth. */
void find_halfway(inout ray r, step_place s, float before)
{
    if (before >= r.half_depth || r.half_depth > r.depth)
        return;
    float part = (r.half_depth - before) / max(r.depth - before, 1e-20);
    r.half_place = s.middle + s.span * (part - 0.5);
}

/* Adds the light of a step, and dims what is behind it. */
void add_step(inout ray r, step_place s, gas_cell g)
{
    float extinction = g.smoke * march.albedo.w + g.flame * march.detail.w;
    float len = s.span * march.right.w, depth = extinction * len, left = exp(-depth);
    float thick = (1.0 - left) / max(extinction, 1e-20), thin = len * (1.0 - 0.5 * depth);
    float seen = r.clear * (depth > 1e-3 ? thick : thin);
    float sun = g.sun * r.first + g.scattered * r.wide;
    r.smoke += seen * march.albedo.w * g.tint * (sun * march.sun.rgb + g.light);
    float amount = seen * (extinction + g.flame);
    r.weight += amount;
    r.far += amount * s.middle;
    r.flame += seen * g.flame * march.to_sun.w * flame_light(g.temperature);
    float before = r.depth;
    r.clear *= left;
    r.depth += depth;
    find_halfway(r, s, before);
    if (r.clear < VOLUME_OPAQUE_BELOW)
        r.clear = r.to = 0.0;
}
