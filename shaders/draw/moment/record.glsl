/* Declares the buffers that a shader reads to draw a particle: its record, the table of its look,
 * and the camera. Vertex shaders and compute shaders that make particles for drawing include it,
 * after shared/draw_layout.h. kiln_moment_bind (lib/draw/moment/moment_gl.c) binds the buffers, and
 * kiln_draw_blocks_bind binds view_block.
 *
 * The host defines LOOK_VALUES for a scene whose looks have values over other clocks than life,
 * LOOK_SOURCES for one whose particles have the colours of what they were born on, LOOK_PARENTS for
 * one whose looks inherit some values from parents, and USES_CLOCKS (shared/value.h) for one whose
 * lives are more than curves over time (kiln_moment_gl_defines). Other scenes get a shader that compiles faster.
 *
 * The n-th particle that is drawn is entries[n], which names its system and its slot in
 * records (KILN_ENTRY). shared/derived.h reads value_keys as a global, so that block
 * must stand before it. */
#ifndef USES_CLOCKS
#define USES_CLOCKS (1u << KILN_CLOCK_TIME)
#endif
layout(std140, binding = KILN_BIND_KEYS) uniform key_block { float4 value_keys[KILN_BLOCK_KEYS]; };
#include "shared/derived.h"
#include "shared/look_layout.h"

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };
layout(std140, binding = KILN_BIND_LOOKS) uniform look_block { kiln_draw_look looks[KILN_MAX_SYSTEMS]; };
layout(std430, binding = KILN_BIND_RECORDS) readonly buffer record_block { kiln_particle records[]; };
layout(std430, binding = KILN_BIND_ENTRIES) readonly buffer entry_block { uint entries[]; };
/* rows KILN_LOOK_* of each system */
layout(binding = KILN_UNIT_LOOK_TABLE) uniform sampler2D look_table;

/* Returns a row of the table at a place, in samples. It interpolates between two samples as the
 * host does (kiln_look_place_at); a sampler's filter may be less precise. */
vec4 look_row_at(int row, float x)
{
    ivec2 texel = ivec2(min(int(x), KILN_LOOK_SAMPLES - 2), row);
    return mix(texelFetch(look_table, texel, 0), texelFetch(look_table, texel + ivec2(1, 0), 0),
               x - float(texel.x));
}

/* Returns a row of the system's table (KILN_LOOK_*) at a part of life, 0 at birth and 1 at death,
 * without values over other clocks. */
vec4 look_over_life(uint system, int row, float life)
{
    return look_row_at(int(system) * KILN_LOOK_ROWS + row, life * float(KILN_LOOK_SAMPLES - 1));
}

#ifdef LOOK_VALUES

#include "draw/moment/look_values.glsl"

vec4 look_rows[KILN_LOOK_ROWS]; /* of the particle, by LOOK_OF */

/* Returns a row of the look (KILN_LOOK_*) of the particle that LOOK_OF was called for. */
vec4 look_at(uint system, int row, float life)
{
    return look_rows[row];
}

/* Finds the look of a particle at the moment. All rows are found in one loop, since compilers would
 * otherwise make a copy of it for each row. */
void look_find(uint system, kiln_particle record, uint stream, float age, float life)
{
    vec3 position = particle_position(record);
    value_clocks clocks = value_clocks_at(view.clock.x, looks[system].derived.random_key,
                                          looks[system].derived.scene_key);
    clocks.life = life;
    clocks.age_s = age;
    clocks.height = position.y;
    clocks.distance = length(position - view.eye.xyz);
    clocks.velocity = particle_velocity(record);
    clocks.stream = stream;
#ifdef LOOK_PARENTS
    uint4 values = looks[system].values;
    if (LOOK_PARENT_SLOTS(values.w) != 0u)
        clocks = particle_clocks_of_child(clocks, looks[LOOK_PARENT_SYSTEM(values.w)].derived,
                                          records[LOOK_PARENT_RECORD(values, record.position_serial.w)],
                                          record);
#endif
    for (int row = 0; row < KILN_LOOK_ROWS; row++) {
        look_rows[row] = look_over_life(system, row, life);
        if (looks[system].values.x != 0u)
            look_rows[row] *= look_factor(int(looks[system].values.x), row, clocks);
    }
}

#define LOOK_OF(system, record, stream, age, life) look_find(system, record, stream, age, life);

#else

/* Returns a row of the system's look (KILN_LOOK_*) at a part of life. */
vec4 look_at(uint system, int row, float life)
{
    return look_over_life(system, row, life);
}

#define LOOK_OF(system, record, stream, age, life)

#endif

vec3 world_to_view_point(vec3 position)
{
    vec4 p = vec4(position, 1.0);
    return vec3(dot(view.world_to_view[0], p), dot(view.world_to_view[1], p),
                dot(view.world_to_view[2], p));
}
