/* Declares the buffers that a shader reads to draw a particle: its record, the table of its look,
 * and the camera. Vertex shaders and compute shaders that make particles for drawing include it,
 * after shared/draw_layout.h. kiln_moment_bind (lib/draw/moment/moment_gl.c) binds the buffers, and
 * kiln_draw_blocks_bind binds view_block.
 *
 * The n-th particle that is drawn is entries[n], which names its system and its slot in
 * records (KILN_ENTRY). shared/derived.h reads value_keys as a global, so that block
 * must stand before it. */
layout(std140, binding = KILN_BIND_KEYS) uniform key_block { float4 value_keys[KILN_BLOCK_KEYS]; };
#include "shared/derived.h"
#include "shared/look_layout.h"

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };
layout(std140, binding = KILN_BIND_LOOKS) uniform look_block { kiln_draw_look looks[KILN_MAX_SYSTEMS]; };
layout(std430, binding = KILN_BIND_RECORDS) readonly buffer record_block { kiln_particle records[]; };
layout(std430, binding = KILN_BIND_ENTRIES) readonly buffer entry_block { uint entries[]; };
/* rows KILN_LOOK_* of each system */
layout(binding = KILN_UNIT_LOOK_TABLE) uniform sampler2D look_table;

/* Returns a row of the system's table (KILN_LOOK_*) at a part of life, 0 at birth and 1 at death.
 * It interpolates between two samples as the host does (kiln_look_place_at); a sampler's filter may
 * be less precise. */
vec4 look_at(uint system, int row, float life)
{
    float x = life * float(KILN_LOOK_SAMPLES - 1);
    ivec2 texel = ivec2(min(int(x), KILN_LOOK_SAMPLES - 2), int(system) * KILN_LOOK_ROWS + row);
    return mix(texelFetch(look_table, texel, 0), texelFetch(look_table, texel + ivec2(1, 0), 0),
               x - float(texel.x));
}

vec3 world_to_view_point(vec3 position)
{
    vec4 p = vec4(position, 1.0);
    return vec3(dot(view.world_to_view[0], p), dot(view.world_to_view[1], p),
                dot(view.world_to_view[2], p));
}
