/* What vertex shaders know of a particle: its record, the table of its look, the camera. Drawing call
 * n is of entries[n], which names system and slot. */
layout(std140, binding = KILN_BIND_KEYS) uniform key_block { float4 value_keys[KILN_MAX_VALUE_KEYS]; };
#include "shared/derived.h"
#include "shared/look_layout.h"

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };
layout(std140, binding = KILN_BIND_LOOKS) uniform look_block { kiln_draw_look looks[KILN_MAX_SYSTEMS]; };
layout(std430, binding = KILN_BIND_RECORDS) readonly buffer record_block { kiln_particle records[]; };
layout(std430, binding = KILN_BIND_ENTRIES) readonly buffer entry_block { uint entries[]; };
layout(binding = 0) uniform sampler2D look_table; /* see shared/look_layout.h */

/* A row of the system's table at the particle's progress through life. */
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
