/* Evaluates the values of looks that vary over other clocks than life, for one particle, as
 * lib/draw/moment/look_values.c does on the host. record.glsl includes it, and declares look_table;
 * shared/look_layout.h says where the values lie in it. */

/* Returns a texel of a system's values, whose rows follow one another. */
vec4 look_texel(int first_row, int texel)
{
    ivec2 at = ivec2(texel % KILN_LOOK_SAMPLES, first_row + texel / KILN_LOOK_SAMPLES);
    return texelFetch(look_table, at, 0);
}

#ifdef LOOK_SOURCES

#include "shared/source.h"

layout(binding = KILN_UNIT_SOURCES) uniform usampler2D source_texels;

uvec4 source_texel(int number)
{
    return texelFetch(source_texels, ivec2(number % SOURCE_ROW, number / SOURCE_ROW), 0);
}

/* Returns the colour of the place where a particle was born, as kiln_source_color does on the host.
 * first: texel of the first of the source's cells. */
vec3 source_color(int first, int cells, uint stream)
{
    uint turn = source_turn(stream, uint(cells));
    uvec4 cell = source_texel(first + int(turn));
    uint chosen = source_choose(stream, turn, uintBitsToFloat(cell.x), cell.y);
    cell = source_texel(first + int(chosen));
    uint number = cell.z;
    if (cell.w > 1u)
        number += source_color_of(source_spot_on_triangle(stream), cell.w);
    uint color = source_texel(first + cells + int(number / 4u))[number % 4u];
    return vec3(source_component(color, 0u), source_component(color, 1u),
                source_component(color, 2u));
}

#endif

/* A part of a value: its own curve, what multiplies it, or what is added to it. */
struct look_part {
    uint clock, flags, draw;
    int row, count; /* number of steps, or octaves of a noise */
    float from, per_x, span, period_s;
};

look_part look_part_of(int first_row, int value, int part)
{
    int texel = LOOK_VALUE_TEXEL(value) + 2 + 2 * part;
    vec4 a = look_texel(first_row, texel);
    vec4 b = look_texel(first_row, texel + 1);
    uint what = uint(a.x);
    return look_part(what & 15u, what >> LOOK_PART_FLAG_SHIFT, RANDOM_VALUES + uint(a.y),
                     int(a.z), int(a.w), b.x, b.y, b.z, b.w);
}

/* Returns what a part's clock shows. */
float look_clock(look_part part, value_clocks clocks)
{
    bool parent = (part.flags & LOOK_PART_PARENT) != 0u;
    switch (part.clock) {
    case KILN_CLOCK_LIFE:
        return parent ? clocks.parent_life : clocks.life;
    case KILN_CLOCK_AGE:
        return parent ? clocks.parent_age_s : clocks.age_s;
    case KILN_CLOCK_SPEED:
        return length(clocks.velocity);
    case KILN_CLOCK_HEIGHT:
        return clocks.height;
    case KILN_CLOCK_DISTANCE:
        return clocks.distance;
    case KILN_CLOCK_RANDOM:
        return random_unit(parent ? clocks.parent_stream : clocks.stream, part.draw);
    case KILN_CLOCK_NOISE:
        return value_noise_at(value_noise(random_bits(clocks.stream, part.draw), uint(part.count),
                                          exact_div(clocks.time_s, part.period_s)));
    default:
        return part.from;
    }
}

/* Returns x within the keys of a part that repeats. */
float look_repeat(look_part part, float x)
{
    float since = x - part.from;
    float turns = floor(exact_div(since, part.span));
    float rest = clamp(since - turns * part.span, 0.0, part.span);
    bool back = (part.flags & LOOK_PART_MIRRORS) != 0u && mod(turns, 2.0) != 0.0;
    return part.from + (back ? part.span - rest : rest);
}

/* Returns a part's components, or the same number for all. */
vec4 look_part_at(look_part part, value_clocks clocks)
{
#ifdef LOOK_SOURCES
    if (part.clock == LOOK_CLOCK_SOURCE) {
        bool parent = (part.flags & LOOK_PART_PARENT) != 0u;
        vec3 color =
            source_color(part.row, part.count, parent ? clocks.parent_stream : clocks.stream);
        return vec4(color, color.x);
    }
#endif
    float x = look_clock(part, clocks);
    if ((part.flags & (LOOK_PART_LOOPS | LOOK_PART_MIRRORS)) != 0u)
        x = look_repeat(part, x);
    if ((part.flags & LOOK_PART_STEPS) == 0u) {
        float place = clamp((x - part.from) * part.per_x, 0.0, float(KILN_LOOK_SAMPLES - 1));
        return look_row_at(part.row, place);
    }
    vec4 texel = look_texel(part.row, 0);
    for (int k = 1; k < part.count && x >= texel.w; k++)
        texel = look_texel(part.row, k);
    return vec4(texel.xyz, texel.x);
}

/* Returns what a row of a look is multiplied by. */
vec4 look_factor(int first_row, int row, value_clocks clocks)
{
    vec4 factor = vec4(1.0);
    vec4 own = look_texel(first_row, row);
    for (int i = 0; i < int(own.y); i++) {
        int value = int(own.x) + i;
        vec4 what = look_texel(first_row, LOOK_VALUE_TEXEL(value));
        vec4 limits = look_texel(first_row, LOOK_VALUE_TEXEL(value) + 1);
        uint lanes = uint(what.x);
        uint parts = uint(what.y);
        vec4 y = vec4(0.0);
        for (int p = 0; p < 3; p++) {
            if ((parts & (1u << p)) == 0u)
                continue;
            vec4 one = look_part_at(look_part_of(first_row, value, p), clocks);
            y = p == 1 ? y * one : y + one;
        }
        y = clamp(vec4(y.xyz, y.x), limits.x, limits.y);
        if (what.z > 0.0) {
            float place = (y.x - limits.z) * limits.w;
            y = look_row_at(int(what.z), clamp(place, 0.0, float(KILN_LOOK_SAMPLES - 1)));
        }
        factor *= mix(vec4(1.0), y, vec4(bvec4(uvec4(lanes) & uvec4(1u, 2u, 4u, 8u))));
    }
    return factor;
}
