/* Adds a source to the cells of the bricks that it reaches. The host says how far each cell lies in
 * the source, and the velocity that the source blows with there. */
// variant:
// variant: GAS_COLORED=1
#define GAS_USES_CENTRES readonly
#define GAS_USES_CHANGES
#define GAS_USES_NOW
#ifdef GAS_COLORED
#define GAS_USES_NEXT 1
#endif
#include "sim/gas/gas.glsl"

layout(std430, binding = GAS_BIND_SENT) readonly buffer sent_block
{
    vec4 sent[]; /* velocity, m/s, and how far the cell lies in the source, 0 to 1 */
};

layout(location = GAS_AT_SOURCE) uniform vec4 source[2];

float raised(float now, float wanted, float part)
{
    precise float more = now + (wanted - now) * part;
    return now < wanted ? more : now;
}

void main()
{
    uint i = invocation();
    if (i >= list_count)
        return;
    listed l = listed_at(i / uint(GAS_BRICK_CELLS));
    uint number = i % uint(GAS_BRICK_CELLS);
    vec4 own = sent[l.number + number];
    float within = own.w;
    if (!(within > 0.0f))
        return;
    uint at = l.brick * uint(GAS_BRICK_CELLS) + number;
    vec4 q = now_words[at];
    float part = source[0].w;
    precise vec3 wanted = source[0].xyz * within;
    vec4 y = vec4(raised(q.x, wanted.z, part), raised(q.y, wanted.y, part),
                  raised(q.z, wanted.x, part), q.w);
    now_words[at] = y;
#ifdef GAS_COLORED
    uint color_at = l.brick * gas.groups * uint(GAS_BRICK_CELLS) + number;
    precise float more = y.x - q.x;
    precise vec4 color = next_extras[color_at] + vec4(more * source[1].xyz, more);
    next_extras[color_at] = color;
#endif
    if (source[1].w == 0.0f)
        return;
    vec4 change = changes[at];
    precise float taken = part * within;
    precise vec3 blown = change.xyz + (own.xyz - (centres[at].xyz + change.xyz)) * taken;
    changes[at] = vec4(blown, change.w);
}
