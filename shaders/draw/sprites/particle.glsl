/* Makes the billboard of one particle: make_billboard computes it from the particle's record, the
 * look of its system and the clock.
 *
 * Shaders that turn particles into billboards include this file: particles_geometry.vert and
 * particles_instanced.vert for quads that GL draws, and particles_tiled_make.comp for the technique
 * `tiled`, which draws with compute shaders. They first include draw/moment/record.glsl and
 * billboard.glsl, and declare the variables that make_billboard fills in:
 *
 *    vec4 center;        the particle's place in view space, m; w: LOOK_POINT, LOOK_LINE, or 0 for
 *                        a billboard
 *    vec4 right;         half an edge of the billboard in view space, m; w: half the width of a
 *                        point or line, px
 *    vec4 up;            half of the other edge, m; for a line, the whole vector from its head to
 *                        its tail
 *    billboard particle; what the shading reads (billboard.glsl)
 *
 * shared/look_layout.h describes the rows of a look and the members of `looks`, and
 * shared/draw_layout.h the members of `view`.
 *
 * The host defines SHAPES as 1 for a scene with points, lines or billboards that are not parallel
 * to the picture, else as 0. It defines SUN_SHADE and LAMP_SHADE only for a scene whose backdrop
 * shades particles from the sun, or from lamps (kiln_geometry_defines in
 * lib/draw/sprites/particles_geometry.c), and RIBBONS for one with ribbons (ribbon.glsl). Other scenes
 * get a faster shader without that code. It
 * defines HAZE for a scene that has haze; then the shader declares the uniform additive_alpha of
 * shade.glsl. It defines NO_SMOKE for a scene without smoke that throws shadows, and NO_LAMPS for one without
 * lamps and light of fire.
 *
 * tests/support/true_sprite.h is the reference implementation: tests compare every technique with
 * it. */
#include "shared/billboard.h"
#include "shared/billboard_light.h"
#include "shared/billboard_place.h"
#include "shared/heading.h"

layout(std140, binding = KILN_BIND_BACKDROP) uniform backdrop_block { kiln_draw_backdrop backdrop; };

#ifdef HAZE
#include "draw/light/haze.glsl"
#endif

#include "draw/light/smoke_shadow.glsl"

#ifdef SUN_SHADE
layout(binding = KILN_UNIT_SUN_SHADE) uniform sampler2D sun_shade;
#endif

#ifdef LAMP_SHADE
layout(binding = KILN_UNIT_LAMP_SHADE) uniform usampler2DArray lamp_shade;
#endif

vec3 world_to_view_vector(vec3 v)
{
    return vec3(dot(view.world_to_view[0].xyz, v), dot(view.world_to_view[1].xyz, v),
                dot(view.world_to_view[2].xyz, v));
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

/* Returns the part of lamp i, 0 to 1, that objects of the backdrop do not hide from a particle. */
float lamplight_past_backdrop(int i, uint slot)
{
#ifdef LAMP_SHADE
    ivec3 at = ivec3(slot % uint(KILN_SUN_SHADE_ROW), slot / uint(KILN_SUN_SHADE_ROW), i / 4);
    if ((backdrop.lights[i].casters.w & 2u) != 0u)
        return float(bitfieldExtract(texelFetch(lamp_shade, at, 0).r, 8 * (i % 4), 8)) / 255.0;
#endif
    return 1.0;
}

/* Computes the light on a particle. `lit` mixes two lights: with 0, light of strength 1 comes from
 * all sides; with 1, the particle is lit by the sky, the sun and the lamps of the backdrop. color:
 * what thick smoke of such particles reflects. */
void light_particle(float lit, vec3 color, uint slot, vec3 position, billboard_plane plane)
{
    particle.light_0 = vec4(1.0 - lit);
    particle.light_x = particle.light_y = particle.light_z = vec4(0.0);
    if (lit <= 0.0)
        return;
    float diffusion = smoke_diffusion(dot(color, vec3(1.0 / 3.0)));
    light_sum sum = light_sum_of_sky(backdrop.sky_horizon, backdrop.sky_top, lit,
                                     smoke_depth_to_sky(position), diffusion);
    light_parts sun = light_parts_through(smoke_depth_to_sun(position), diffusion,
                                          sunlight_past_backdrop(slot));
    sum = light_sum_add_sun(sum, backdrop.sun_color, backdrop.sun_direction, lit, sun);
#ifndef NO_LAMPS
    for (int i = 0; i < int(backdrop.counts.y); i++) {
        light_parts parts = light_parts_through(smoke_depth_to_lamp(i, position), diffusion,
                                                lamplight_past_backdrop(i, slot));
        sum = light_sum_add_lamp(sum, backdrop.lights[i], lit, position, parts);
    }
#endif
    sum = light_sum_along_plane(sum, 1.0 - lit, view.world_to_view[0], view.world_to_view[1],
                                view.world_to_view[2], plane);
    particle.light_0.rgb = vec3(sum.red.all, sum.green.all, sum.blue.all);
    particle.light_x.rgb = vec3(sum.red.along.x, sum.green.along.x, sum.blue.along.x);
    particle.light_y.rgb = vec3(sum.red.along.y, sum.green.along.y, sum.blue.along.y);
    particle.light_z.rgb = vec3(sum.red.along.z, sum.green.along.z, sum.blue.along.z);
}

/* Chooses one of the system's textures at random; a particle always gets the same one. */
uint4 choose_texture(uint system, uint stream)
{
    uint count = looks[system].flags.w;
    uint chosen = uint(random_unit(stream, RANDOM_TEXTURE) * float(count));
    return looks[system].textures[min(chosen, count - 1u)];
}

/* Chooses two adjacent cells of the atlas and the mix between them (Heinz 2019, equation 3.2).
 * `cell_cycles` is how often the particle has gone through its cells until now, and need not be
 * whole. The result is both layers of the atlas, the mix, and the level of detail. size: px. */
vec4 choose_cells(uint4 atlas, float cell_cycles, bool random_start, uint stream, vec2 size)
{
    float cells = float(atlas.y);
    float position = cell_cycles * (cells - 1.0);
    if (random_start)
        position += random_unit(stream, RANDOM_CELL) * cells;
    float first = floor(position);
    float base = float(atlas.x);
    float level = floor(log2(max(float(KILN_ATLAS_CELL) / max(min(size.x, size.y), 1.0), 1.0)));
    if (billboard_shows_strip(size.x, size.y))
        level = float(KILN_STRIP_LEVEL);
    return vec4(base + mod(first, cells), base + mod(first + 1.0, cells), position - first, level);
}

#ifdef HAZE

/* Puts haze before the particle, all of which is as far away as its middle: dims what it emits and
 * reflects, and adds the haze itself, which is as opaque as each place on the particle. For cells
 * of colour, that is in particle.cool, which they do not need. */
void veil_particle(vec3 position, bool is_colored)
{
    vec3 way = position - view.eye.xyz;
    float clear = haze_clear(backdrop.floor_params.z, 1.0, length(way));
    bool covers = particle.hot.a <= 0.0 || additive_alpha > 0.0;
    vec3 added = covers ? haze_toward(haze_level(way)) * (1.0 - clear) : vec3(0.0);
    particle.color.rgb *= clear;
    particle.hot.rgb = particle.hot.rgb * clear + (is_colored ? vec3(0.0) : added);
    particle.cool.rgb = is_colored ? added : particle.cool.rgb * clear + added;
}

#endif

#if SHAPES

/* Turns the particle into a point or a line, which has no texture. */
void make_plain(uint4 form, vec2 widths_px, float size_px, vec3 moving, float stretch)
{
    bool is_line = form.x == LOOK_LINE;
    float width = is_line ? widths_px.y : widths_px.x > 0.0 ? widths_px.x : size_px;
    stroke_width stroke = stroke_width_of(is_line, width);
    center.w = float(form.x);
    right.w = stroke.half_width;
    up.xyz = is_line ? moving * -(form.w != 0u ? view.clock.z : stretch) : vec3(0.0);
    particle.color.a *= stroke.opacity;
    particle.depth.y = float(!is_line && form.z != 0u ? KILN_CELL_DISC : KILN_CELL_PLAIN);
}

#endif

/* Makes the billboard, point or line of a draw entry, which is a KILN_ENTRY. */
void make_billboard(uint entry)
{
    uint system = KILN_ENTRY_SYSTEM(entry);
    kiln_particle record = records[KILN_ENTRY_SLOT(entry)];
    uint stream = particle_stream(looks[system].derived, record);
    float age = particle_age_before(record, view.clock_step.x, view.within.x, view.clock.y);
    float life = particle_progress(age, particle_life_s(looks[system].derived, record));
    LOOK_OF(system, record, stream, age, life)
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
    float side = billboard_side(random_unit(stream, RANDOM_SPIN + 1u));
    angle += spin * side * particle_turned_s(record, age, view.clock.y);

    billboard_plane plane = billboard_plane_of_picture();
    uint4 form = looks[system].form;
#if SHAPES
    vec3 world_up = vec3(0.0, 1.0, 0.0);
    vec3 axis = form.y == LOOK_AXIAL || form.y == LOOK_NORMAL ? look_at(system, KILN_LOOK_AXIS, life).xyz : world_up;
    bool lies = form.x == 0u && billboard_is_aligned(form.y) &&
                (form.y == LOOK_NORMAL || particle_has_stopped(record));
    if (lies)
        plane = billboard_plane_across(form.y == LOOK_NORMAL ? axis : particle_heading(record), center.xyz,
                                       view.world_to_view[0], view.world_to_view[1], view.world_to_view[2]);
    else if (!billboard_is_flat(form.y) && !billboard_is_aligned(form.y))
        plane = billboard_plane_facing(form.y, world_to_view_vector(axis), center.xyz);
#endif
    vec3 moving = world_to_view_vector(particle_heading(record));
    float stretch = particle_has_stopped(record) ? 0.0 : shape.y;
    float half_length = half_size;
    if ((looks[system].flags.y & LOOK_FORMED) != 0u) {
        vec4 formed = look_at(system, KILN_LOOK_FORM, life);
        half_length *= formed.y;
        half_size *= formed.x;
    }
    billboard_edge edge = billboard_edge(-sin(angle), cos(angle), half_length);
    edge = billboard_stretched(form.y, edge, stretch, dot(moving, plane.right),
                               dot(moving, plane.up));
    float pixels_per_m = view.frustum.w / (2.0 * view.frustum.y * max(depth, 1e-3));
    float opacity = shape.z;
    if (form.x == 0u && form.w != 0u)
        opacity *= billboard_dimming(half_length, edge.half_length);
    billboard_size size = billboard_size(half_size, edge.half_length, 1.0);
    if (view.clock.w < 1.0 && form.x == 0u) /* a billboard in a picture smaller than the frame */
        size = billboard_widened(size.half_width, size.half_length, pixels_per_m);
    bool mirrors = (looks[system].flags.y & LOOK_UNMIRRORED) == 0u;
    plane = billboard_rotated(plane, edge, mirrors ? side : 1.0);
    right = vec4(plane.right * size.half_width, 0.0);
    up = vec4(plane.up * size.half_length, 0.0);
    half_size = size.half_width;
    opacity *= size.opacity;

    float near_fade = clamp((depth - view.eye.w) / max(hot.w, 1e-6), 0.0, 1.0);
    particle.color = vec4(cover.rgb, opacity * near_fade);
    particle.hot = vec4(hot.rgb, float(looks[system].flags.x));
    particle.cool = vec4(cool.rgb, shape.w);
    uint4 texture_cells = choose_texture(system, stream);
    vec4 bloom = look_at(system, KILN_LOOK_BLOOM, life);
    particle.bloom = vec4(bloom.rgb, uintBitsToFloat(texture_cells.w));

    float shown = 2.0 * pixels_per_m;
#if SHAPES
    if (lies)
        shown *= billboard_slant(plane, center.xyz);
#endif
    particle.cells = choose_cells(texture_cells, life * cool.w, (looks[system].flags.y & LOOK_RANDOM_START) != 0u,
                                  stream, shown * vec2(half_size, size.half_length));
    particle.depth = vec4(depth, float(texture_cells.z), float(looks[system].flags.z),
                          length(center.xyz));
#if SHAPES
    if (lies && looks[system].flags.z == 0u) {
        billboard_lying lying = billboard_lying_of(plane, center.xyz, shape.w, half_size);
        particle.cool.a = lying.soft;
        particle.depth.w = lying.near;
    }
#endif
    light_particle(cover.w, cover.rgb, KILN_ENTRY_SLOT(entry), position, plane);
    particle.light_x.a = half_size * bloom.a; /* half the thickness, m */
    particle.light_0.a = particle.light_z.a = 0.0; /* outline.glsl finds the rim */
#if SHAPES
    if (form.x != 0u)
        make_plain(form, turn.zw * scale * view.clock.w, 2.0 * half_size * pixels_per_m, moving, shape.y);
#endif
#ifdef HAZE
    veil_particle(position, form.x == 0u && texture_cells.z == KILN_CELL_COLOR);
#endif
}

#ifdef RIBBONS

#include "draw/sprites/ribbon.glsl"

/* Makes what item i of a drawing shows: a draw entry, or a part of one that is a ribbon. Each entry
 * has RIBBONS items; those that it does not need are not seen. */
void make_item(uint i)
{
    uint entry = entries[i / uint(RIBBONS)], part = i % uint(RIBBONS);
    uint system = KILN_ENTRY_SYSTEM(entry);
    if (looks[system].form.x == LOOK_RIBBON) {
#ifdef NEAREST_FIRST
        part = LOOK_RIBBON_PARTS(looks[system].ribbon.x) - 1u - part; /* or beyond all of them */
#endif
        make_ribbon(entry, part);
    } else if (part == 0u) {
        make_billboard(entry);
    } else {
        center = vec4(0.0);
        particle.color = vec4(0.0);
    }
}

#else

/* Makes the billboard, point or line of draw entry i. */
void make_item(uint i)
{
    make_billboard(entries[i]);
}

#endif
