/* Makes one particle: make_particle computes all that its billboard needs from the particle's record,
 * the look of its system and the clock.
 *
 * Shaders that turn particles into billboards include it: particles_geometry.vert and
 * particles_instanced.vert for quads that GL draws, and particles_tiled_make.comp for sprites of the
 * technique `tiled`. They first include draw/moment/record.glsl and billboard.glsl, and declare the
 * variables that make_particle fills in:
 *     vec4 center;        the particle's place in view space; w: LOOK_* shape
 *     vec4 right;         half an edge of the billboard in view space; w: half the width of a point or
 *                         line, px
 *     vec4 up;            half of the other edge; of a line, the whole way from its head to its tail
 *     billboard particle; what the shading reads
 *
 * The host defines SHAPES as 1 for a scene with points, lines or billboards that are not parallel to
 * the picture, and SUN_SHADE for one whose backdrop shades particles (kiln_geometry_defines in
 * lib/draw/sprites/particles_geometry.c); other scenes get a faster shader without that code.
 *
 * lib/draw/sprites/sprite_simd.c computes the same for technique `cpu`, and tests/support/true_sprite.h
 * is the definition that tests compare with. All must change together, since every technique makes the
 * same picture but for rounding. */
layout(std140, binding = KILN_BIND_BACKDROP) uniform backdrop_block { kiln_draw_backdrop backdrop; };

#include "draw/light/smoke_shadow.glsl"

#ifdef SUN_SHADE
layout(binding = KILN_UNIT_SUN_SHADE) uniform sampler2D sun_shade;
#endif

/* The plane of a billboard: unit vectors in view space. */
struct plane {
    vec3 right, up, normal;
};

const float PI = 3.14159265;

vec3 world_to_view_vector(vec3 v)
{
    return vec3(dot(view.world_to_view[0].xyz, v), dot(view.world_to_view[1].xyz, v),
                dot(view.world_to_view[2].xyz, v));
}

/* Adds a light to the particle. Smoke scatters light, so the side of a sprite that faces away from the
 * light is dimmer but not black: half of the light counts as ambient, and half depends on the normal. */
void add_light(vec3 radiance, vec3 direction, plane p)
{
    vec3 v = world_to_view_vector(direction);
    particle.light_0.rgb += 0.5 * radiance;
    particle.light_x.rgb += 0.5 * radiance * dot(v, p.right);
    particle.light_y.rgb += 0.5 * radiance * dot(v, p.up);
    particle.light_z.rgb += 0.5 * radiance * dot(v, p.normal);
}

/* Returns the part of the sun, 0 to 1, that objects of the backdrop do not hide from a particle. */
float sunlight_past_backdrop(uint slot)
{
#ifdef SUN_SHADE
    ivec2 at = ivec2(slot % uint(KILN_SUN_SHADE_ROW), slot / uint(KILN_SUN_SHADE_ROW));
    if (backdrop.sun_color.w > 0.0)
        return texelFetch(sun_shade, at, 0).r;
#endif
    return 1.0;
}

/* Computes the light on a particle: the part `lit` is that of the sky, the sun and the lights of the
 * backdrop; the rest is light of strength 1 from all sides. */
void light_particle(float lit, uint slot, vec3 position, plane p)
{
    particle.light_0 = vec4(1.0 - lit);
    particle.light_x = particle.light_y = particle.light_z = vec4(0.0);
    if (lit <= 0.0)
        return;
    /* The light of the horizon crosses less smoke than the light from above. */
    float sky = skylight_through_smoke(position);
    float sun = sunlight_through_smoke(position) * sunlight_past_backdrop(slot);
    particle.light_0.rgb += backdrop.sky_horizon.rgb * lit * sqrt(sky);
    add_light(backdrop.sky_top.rgb * lit * sky, vec3(0.0, 1.0, 0.0), p);
    add_light(backdrop.sun_color.rgb * lit * sun / PI, backdrop.sun_direction.xyz, p);
    for (int i = 0; i < int(backdrop.counts.y); i++) {
        vec3 towards = backdrop.lights[i].position_radius2.xyz - position;
        float d2 = dot(towards, towards);
        float falloff = 1.0 / (d2 + backdrop.lights[i].position_radius2.w);
        add_light(backdrop.lights[i].color.rgb * lit * falloff,
                  towards * inversesqrt(max(d2, 1e-9)), p);
    }
}

/* Chooses one of the system's textures at random; a particle always gets the same one. */
uint4 choose_texture(uint system, uint stream)
{
    uint count = looks[system].flags.w;
    uint chosen = uint(random_unit(stream, RANDOM_TEXTURE) * float(count));
    return looks[system].textures[min(chosen, count - 1u)];
}

/* Chooses two adjacent cells of the atlas and the mix between them (Heinz 2019, equation 3.2). `passes`
 * is how often the particle has gone through its cells until now. The last number is the level of
 * detail. */
vec4 choose_cells(uint4 atlas, float passes, bool random_start, uint stream, float diameter_px)
{
    float cells = float(atlas.y);
    float position = passes * (cells - 1.0);
    if (random_start)
        position += random_unit(stream, RANDOM_CELL) * cells;
    float first = floor(position);
    float base = float(atlas.x);
    float level = floor(log2(max(float(KILN_ATLAS_CELL) / max(diameter_px, 1.0), 1.0)));
    return vec4(base + mod(first, cells), base + mod(first + 1.0, cells), position - first, level);
}

/* Returns the upward direction of the billboard in its plane, as a unit vector in xy, and half its
 * length in z. A stretched particle points along its velocity; one that is slow keeps the direction of
 * its angle. */
vec3 point_up(float angle, float half_size, float stretch, vec2 moving, uint facing)
{
    vec3 up = vec3(-sin(angle), cos(angle), half_size);
    if (facing == LOOK_AXIAL)
        return vec3(0.0, 1.0, half_size + 0.5 * abs(moving.y) * stretch);
    if (stretch > 0.0 || facing == LOOK_VELOCITY) {
        float speed = length(moving);
        vec2 turned = mix(up.xy, moving / max(speed, 1e-4), smoothstep(0.05, 0.2, speed));
        up.xy = normalize(turned + vec2(0.0, 1e-5));
        up.z += 0.5 * speed * stretch;
    }
    return up;
}

/* Makes each half edge of a billboard at least as long as `least`. Returns the factor for its opacity
 * that makes up for the larger area. */
float widen(inout float half_width, inout float half_length, float least)
{
    float area = half_width * half_length;
    half_width = max(half_width, least);
    half_length = max(half_length, least);
    return area / (half_width * half_length);
}

#if SHAPES

/* Returns the plane that a billboard turns in (Heinz 2019, 2.1.1). Where the direction that is to be
 * up points at the eye, the billboard's right is the picture's. */
plane facing_plane(uint facing, vec3 axis, vec3 center)
{
    bool to_eye = facing == LOOK_VIEWPOINT || facing == LOOK_AXIAL;
    bool in_picture = facing == LOOK_SCREEN || facing == LOOK_VELOCITY;
    vec3 normal = to_eye ? -normalize(center) : vec3(0.0, 0.0, 1.0);
    vec3 upward = in_picture ? vec3(0.0, 1.0, 0.0) : world_to_view_vector(axis);
    vec3 sideways = cross(upward, normal);
    if (dot(sideways, sideways) < 1e-8)
        sideways = vec3(1.0, 0.0, 0.0) - normal * normal.x;
    sideways = normalize(sideways);
    if (facing != LOOK_AXIAL)
        return plane(sideways, cross(normal, sideways), normal);
    return plane(sideways, upward, cross(sideways, upward));
}

/* Turns the particle into a point or a line, which has no texture. If it is narrower than a pixel, it
 * is drawn one pixel wide, with less opacity instead. */
void make_plain(uint4 form, vec2 widths_px, float size_px, vec3 moving, float stretch)
{
    bool is_line = form.x == LOOK_LINE;
    float width = is_line ? widths_px.y : widths_px.x > 0.0 ? widths_px.x : size_px;
    float thin = min(width, 1.0);
    center.w = float(form.x);
    right.w = 0.5 * max(width, 1.0);
    up.xyz = is_line ? moving * -(form.w != 0u ? view.clock.z : stretch) : vec3(0.0);
    particle.color.a *= is_line ? thin : thin * thin;
    particle.depth.y = float(!is_line && form.z != 0u ? KILN_CELL_DISC : KILN_CELL_PLAIN);
}

#endif

/* Makes the particle of a draw entry: the system in its highest 8 bits, the slot in the other 24. */
void make_particle(uint entry)
{
    uint system = entry >> 24;
    kiln_particle record = records[entry & 0xffffffu];
    uint stream = particle_stream(looks[system].derived, record);
    float age = particle_age(record, view.clock_step.x, view.clock.y);
    float life = particle_progress(age, particle_life_s(looks[system].derived, record));
    vec4 shape = look_at(system, KILN_LOOK_SHAPE, life);
    vec4 spread = look_at(system, KILN_LOOK_SPREAD, life);
    vec4 turn = look_at(system, KILN_LOOK_TURN, life);
    vec4 hot = look_at(system, KILN_LOOK_HOT, life);
    vec4 cool = look_at(system, KILN_LOOK_COOL, life);
    vec4 cover = look_at(system, KILN_LOOK_COVER, life);

    vec3 position = particle_position(record);
    center = vec4(world_to_view_point(position), 0.0);
    float depth = -center.z;

    float scale = mix(spread.x, spread.y, random_unit(stream, RANDOM_SCALE));
    float half_size = 0.5 * shape.x * scale;
    float angle = mix(turn.x, turn.y, random_unit(stream, RANDOM_ROTATION));
    float spin = mix(spread.z, spread.w, random_unit(stream, RANDOM_SPIN));
    bool backwards = random_unit(stream, RANDOM_SPIN + 1u) < 0.5;
    angle += (backwards ? -spin : spin) * age;

    plane facing = plane(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0));
    uint4 form = looks[system].form;
#if SHAPES
    vec3 world_up = vec3(0.0, 1.0, 0.0);
    vec3 axis = form.y == LOOK_AXIAL ? look_at(system, KILN_LOOK_AXIS, life).xyz : world_up;
    facing = facing_plane(form.y, axis, center.xyz);
#endif
    vec3 moving = world_to_view_vector(particle_velocity(record));
    vec2 moving_in_plane = vec2(dot(moving, facing.right), dot(moving, facing.up));
    vec3 upward = point_up(angle, half_size, shape.y, moving_in_plane, form.y);
    float pixels_per_m = view.frustum.w / (2.0 * view.frustum.y * max(depth, 1e-3));
    float opacity = shape.z;
    if (view.clock.w < 1.0 && form.x == 0u)
        opacity *= widen(half_size, upward.z, 0.5 * KILN_COARSE_LEAST / pixels_per_m);
    /* The particles that spin backwards, which are half of all, are also mirrored. */
    vec2 sideways = backwards ? vec2(-upward.y, upward.x) : vec2(upward.y, -upward.x);
    plane turned = plane(facing.right * sideways.x + facing.up * sideways.y,
                         facing.right * upward.x + facing.up * upward.y, facing.normal);
    right = vec4(turned.right * half_size, 0.0);
    up = vec4(turned.up * upward.z, 0.0);

    float near_fade = clamp((depth - view.eye.w) / max(hot.w, 1e-6), 0.0, 1.0);
    particle.color = vec4(cover.rgb, opacity * near_fade);
    particle.hot = vec4(hot.rgb, float(looks[system].flags.x));
    particle.cool = vec4(cool.rgb, shape.w);
    uint4 texture_cells = choose_texture(system, stream);
    vec4 bloom = look_at(system, KILN_LOOK_BLOOM, life);
    particle.bloom = vec4(bloom.rgb, uintBitsToFloat(texture_cells.w));

    particle.cells = choose_cells(texture_cells, life * cool.w, looks[system].flags.y != 0u,
                                  stream, 2.0 * half_size * pixels_per_m);
    particle.depth = vec4(depth, float(texture_cells.z), float(looks[system].flags.z),
                          length(center.xyz));
    light_particle(cover.w, entry & 0xffffffu, position, turned);
    particle.light_x.a = half_size * bloom.a;
#if SHAPES
    if (form.x != 0u)
        make_plain(form, turn.zw * scale * view.clock.w, 2.0 * half_size * pixels_per_m, moving, shape.y);
#endif
}
