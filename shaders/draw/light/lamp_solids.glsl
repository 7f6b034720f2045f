/* Finds the part of a lamp that solid particles hide from a point. Their maps are made on the host
 * (lib/draw/light/lamp_solids.c). */
#include "shared/lamp_map.h"

layout(binding = KILN_UNIT_LAMP_SOLIDS) uniform sampler2DArray lamp_solids;

/* The middle of the solid particle that is lit; w: 0 where a surface of the backdrop is lit. */
vec4 lit_middle = vec4(0.0);

/* Returns the part of lamp i that solids cover, by fetches as in mesh_sun_cover. way: from the
 * point to the lamp. */
float solid_lamp_cover(int i, vec3 normal, light_way way)
{
    float radius = backdrop.lights[i].color.w, far = max(backdrop.lights[i].maps.w, 1e-4);
    int number = int(backdrop.lights[i].casters.y >> KILN_LAMP_SOLID_SHIFT);
    bool on_solid = lit_middle.w > 0.0;
    float middle = length(backdrop.lights[i].position_radius2.xyz - lit_middle.xyz);
    lamp_solid_place to =
        lamp_solid_place_of(-way.direction * way.reach, normal, far, on_solid, middle);
    float layer = to.place.face + 6.0 * float(number - 1);
    int taps = number != 0 ? 5 : 0;
    float level = lamp_level(lamp_widest(to.place, radius, 0.0)) + 1.0;
    float stride = 0.0, cover = 0.0, found = 0.0, distance = 0.0, narrow = 0.0;
    for (int k = 0; k < taps; k++) {
        vec2 aside = vec2(k & 1, k >> 1 & 1) * 2.0 * stride - stride;
        vec4 shadow = textureLod(lamp_solids, vec3(vec2(to.at.u, to.at.v) + aside, layer), level);
        if (k == 0) {
            taps = shadow.r > 0.0 ? taps : 1;
            found = shadow.r;
            narrow = shadow.a;
            distance = on_solid ? lamp_other_distance(to.at, shadow.r, shadow.g, shadow.b)
                                : shadow.g;
            float width = lamp_solid_width(to, radius, 0.0, far, found, distance);
            level = lamp_level(width);
            stride = 0.5 * width;
        } else {
            cover += on_solid ? lamp_solid_tap(to.at, shadow.r, shadow.g, shadow.b)
                              : shadow_tap(to.at, aside.x, aside.y, shadow.r, shadow.g,
                                           1.0 / to.at.slack);
        }
    }
    return lamp_thin_cover(to, radius, 0.0, far, found, distance, narrow, cover);
}
