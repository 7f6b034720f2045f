/* One particle: all that its billboard needs, from the record, the look and the clock. */
#include "shared/draw_layout.h"

layout(std140, binding = KILN_BIND_KEYS) uniform key_block { float4 value_keys[KILN_MAX_VALUE_KEYS]; };
#include "shared/derived.h"
#include "shared/look_layout.h"

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };
layout(std140, binding = KILN_BIND_LOOKS) uniform look_block { kiln_draw_look looks[KILN_MAX_SYSTEMS]; };
layout(std140, binding = KILN_BIND_BACKDROP) uniform backdrop_block { kiln_draw_backdrop backdrop; };
layout(std430, binding = KILN_BIND_RECORDS) readonly buffer record_block { kiln_particle records[]; };
layout(std430, binding = KILN_BIND_ENTRIES) readonly buffer entry_block { uint entries[]; };
layout(binding = 0) uniform sampler2D look_table; /* see shared/look_layout.h */

#include "draw/billboard.glsl"
#include "draw/smoke_shadow.glsl"

layout(location = 0) out vec4 center; /* in view space; w: unused */
layout(location = 1) out vec4 axes;   /* half of the billboard's edges in view space: right, up */
layout(location = 2) out billboard particle;

const float PI = 3.14159265;
/* A row of the system's table at the particle's progress through life. */
vec4 look_at(uint system, int row, float life)
{
    float x = life * float(KILN_LOOK_SAMPLES - 1);
    ivec2 texel = ivec2(min(int(x), KILN_LOOK_SAMPLES - 2), int(system) * KILN_LOOK_ROWS + row);
    return mix(texelFetch(look_table, texel, 0), texelFetch(look_table, texel + ivec2(1, 0), 0),
               x - float(texel.x));
}

vec3 world_to_view_vector(vec3 v)
{
    return vec3(dot(view.world_to_view[0].xyz, v), dot(view.world_to_view[1].xyz, v),
                dot(view.world_to_view[2].xyz, v));
}

/* Smoke scatters: a sprite's far side is dimmer, not black. Light from a direction is half ambient,
 * half along the normal. */
void add_light(vec3 radiance, vec3 direction, vec2 right, vec2 up)
{
    vec3 v = world_to_view_vector(direction);
    particle.light_0.rgb += 0.5 * radiance;
    particle.light_x.rgb += 0.5 * radiance * dot(v.xy, right);
    particle.light_y.rgb += 0.5 * radiance * dot(v.xy, up);
    particle.light_z.rgb += 0.5 * radiance * v.z;
}

void light_particle(float lit, vec3 position, vec2 right, vec2 up)
{
    particle.light_0 = vec4(1.0 - lit);
    particle.light_x = particle.light_y = particle.light_z = vec4(0.0);
    if (lit <= 0.0)
        return;
    /* The horizon's light comes from all sides and crosses less of the smoke than that from above. */
    float sky = skylight_through_smoke(position);
    float sun = sunlight_through_smoke(position);
    particle.light_0.rgb += backdrop.sky_horizon.rgb * lit * sqrt(sky);
    add_light(backdrop.sky_top.rgb * lit * sky, vec3(0.0, 1.0, 0.0), right, up);
    add_light(backdrop.sun_color.rgb * lit * sun / PI, backdrop.sun_direction.xyz, right, up);
    for (int i = 0; i < int(backdrop.counts.y); i++) {
        vec3 towards = backdrop.lights[i].position_radius2.xyz - position;
        float d2 = dot(towards, towards);
        float falloff = 1.0 / (d2 + backdrop.lights[i].position_radius2.w);
        add_light(backdrop.lights[i].color.rgb * lit * falloff,
                  towards * inversesqrt(max(d2, 1e-9)), right, up);
    }
}

/* Which of the system's textures a particle has. */
uint4 choose_texture(uint system, uint stream)
{
    uint count = looks[system].flags.w;
    uint chosen = uint(random_unit(stream, RANDOM_TEXTURE) * float(count));
    return looks[system].textures[min(chosen, count - 1u)];
}

/* Equation 3.2: two adjacent cells and the mix between them, by the progress through life. */
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

/* The billboard's upward direction in view space, and its half length: a stretched particle lies
 * along its velocity. */
vec3 point_up(float angle, float half_size, float stretch, vec3 velocity)
{
    vec3 up = vec3(-sin(angle), cos(angle), half_size);
    if (stretch > 0.0) {
        vec2 moving = world_to_view_vector(velocity).xy;
        float speed = length(moving);
        vec2 turned = mix(up.xy, moving / max(speed, 1e-4), smoothstep(0.05, 0.2, speed));
        up.xy = normalize(turned + vec2(0.0, 1e-5));
        up.z += 0.5 * speed * stretch;
    }
    return up;
}

void main()
{
    uint entry = entries[gl_VertexID];
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
    vec4 p = vec4(position, 1.0);
    center = vec4(dot(view.world_to_view[0], p), dot(view.world_to_view[1], p),
                  dot(view.world_to_view[2], p), 1.0);
    float depth = -center.z;

    float half_size =
        0.5 * shape.x * mix(spread.x, spread.y, random_unit(stream, RANDOM_SCALE));
    float angle = mix(turn.x, turn.y, random_unit(stream, RANDOM_ROTATION));
    float spin = mix(spread.z, spread.w, random_unit(stream, RANDOM_SPIN));
    bool backwards = random_unit(stream, RANDOM_SPIN + 1u) < 0.5;
    angle += (backwards ? -spin : spin) * age;
    vec3 up = point_up(angle, half_size, shape.y, particle_velocity(record));
    vec2 right = backwards ? vec2(-up.y, up.x) : vec2(up.y, -up.x); /* half are mirrored */
    axes = vec4(right * half_size, up.xy * up.z);

    float near_fade = clamp((depth - view.eye.w) / max(hot.w, 1e-6), 0.0, 1.0);
    particle.color = vec4(cover.rgb, shape.z * near_fade);
    particle.hot = vec4(hot.rgb, float(looks[system].flags.x));
    particle.cool = vec4(cool.rgb, shape.w);
    uint4 texture_cells = choose_texture(system, stream);
    particle.bloom = vec4(look_at(system, KILN_LOOK_BLOOM, life).rgb, uintBitsToFloat(texture_cells.w));

    float pixels_per_m = view.frustum.w / (2.0 * view.frustum.y * max(depth, 1e-3));
    particle.cells = choose_cells(texture_cells, life * cool.w, looks[system].flags.y != 0u,
                                  stream, 2.0 * half_size * pixels_per_m);
    particle.depth = vec4(depth, float(texture_cells.z), float(looks[system].flags.z),
                          length(center.xyz));
    light_particle(cover.w, position, right, up.xy);
}
