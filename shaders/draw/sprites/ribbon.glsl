/* Makes a part of a ribbon (shared/ribbon.h) for the rasterisers of GL. particle.glsl includes it
 * where the host defines RIBBONS, the most parts that a segment of the scene is drawn as. Each draw
 * entry then has RIBBONS items, one for each part. lib/draw/sprites/sprite_ribbon.h does the same on the CPU.
 *
 * A part needs no right and up edges, nor light, whose places hold other data. ribbon_pixel.glsl
 * reads them:
 *
 *    center.w          LOOK_RIBBON
 *    right, up         the lines at which the part begins and ends; w: half widths there, px
 *    particle.color    -1, by which it is known; opacity where it begins and where it ends; 1
 *    particle.cells    layer of the atlas; RIBBON_* bits; unused; level of detail
 *    particle.light_0  1 / depth where it begins and where it ends, 1/m; places in the texture
 *    particle.light_x  its middle line, xyz
 *    particle.light_y  `hot` where it ends, rgb
 *    particle.light_z  `cool` where it ends, rgb */
#include "shared/ribbon.h"
#include "shared/ribbon_layout.h"

/* Returns the slot `by` after or before one of a system, in the order of serials. */
uint slot_beside(uint4 ribbon, uint slot, int by)
{
    int first = int(LOOK_RIBBON_SLOT(ribbon.x)), capacity = int(LOOK_RIBBON_SLOT(ribbon.y));
    int beside = int(slot) + by;
    beside += beside < first ? capacity : 0;
    return uint(beside - (beside >= first + capacity ? capacity : 0));
}

bool is_there(kiln_particle p, uint serial)
{
    return particle_is_alive(p) && p.position_serial.w == serial;
}

/* Finds the living parent of a particle whose later siblings are not born yet. */
bool find_parent(uint system, uint slot, uint serial, out vec3 place)
{
    uint run = looks[system].ribbon.z, number = serial % run;
    kiln_particle parent = records[LOOK_PARENT_RECORD(looks[system].values, serial)];
    place = particle_position(parent);
    if (number == run - 1u || !is_there(parent, serial / run))
        return false;
    for (uint i = 1u; i < run - number; i++)
        if (is_there(records[slot + i], serial + i))
            return false;
    return true;
}

bool is_near(vec3 a, vec3 b, float gap)
{
    return gap <= 0.0 || dot(a - b, a - b) <= gap * gap;
}

/* Holds what a ribbon is at one of its particles. */
struct ribbon_end {
    float half_width, along, opacity;
    vec3 hot, cool, bloom;
};

/* Computes an end of a segment. number: of its particle in the ribbon. */
ribbon_end find_ribbon_end(uint system, kiln_particle record, uint slot, float age, vec3 position,
                           uint number)
{
    uint4 form = looks[system].ribbon;
    uint stream = particle_stream(looks[system].derived, record);
    float life = particle_progress(age, particle_life_s(looks[system].derived, record));
    LOOK_OF(system, record, stream, age, life)
    vec4 shape = look_at(system, KILN_LOOK_SHAPE, life);
    vec4 spread = look_at(system, KILN_LOOK_SPREAD, life);
    vec4 turn = look_at(system, KILN_LOOK_TURN, life);
    vec4 hot = look_at(system, KILN_LOOK_HOT, life);
    vec4 cool = look_at(system, KILN_LOOK_COOL, life);
    vec4 cover = look_at(system, KILN_LOOK_COVER, life);
    ribbon_end end;
    end.bloom = look_at(system, KILN_LOOK_BLOOM, life).rgb;
    vec3 at = world_to_view_point(position);
    end.along = life;
    if ((form.y & LOOK_RIBBON_COUNTED) != 0u)
        end.along = float(number) / float(max(form.z, 2u) - 1u);
    float scale = mix(spread.x, spread.y, random_unit(stream, RANDOM_SCALE));
    end.half_width = 0.5 * shape.x * scale * mix(turn.y, turn.x, end.along);
    end.opacity = shape.z * clamp((-at.z - view.eye.w) / max(hot.w, 1e-6), 0.0, 1.0);
    particle.color = vec4(cover.rgb, 1.0);
    particle.hot = vec4(hot.rgb, float(looks[system].flags.x));
    particle.cool = vec4(cool.rgb, shape.w);
    bool is_colored = looks[system].textures[0].z == KILN_CELL_COLOR;
    billboard_plane plane =
        billboard_plane_facing(LOOK_VIEWPOINT, world_to_view_vector(vec3(0.0, 1.0, 0.0)), at);
    light_particle(cover.w, cover.rgb, slot, position, plane);
    vec3 light = max(particle.light_0.rgb + particle.light_z.rgb, 0.0);
    particle.hot.rgb += cover.rgb * light;
    particle.cool.rgb += is_colored ? vec3(0.0) : cover.rgb * light;
#ifdef HAZE
    veil_particle(position, is_colored);
#endif
    end.hot = particle.hot.rgb;
    end.cool = particle.cool.rgb;
    return end;
}

/* Makes part `part` of the segment of a draw entry, of those in drawing order, in which the first
 * is that at the farther end. */
void make_ribbon(uint entry, uint part)
{
    uint system = KILN_ENTRY_SYSTEM(entry), slot = KILN_ENTRY_SLOT(entry);
    uint4 form = looks[system].ribbon;
    uint parts = LOOK_RIBBON_PARTS(form.x);
    particle.color = vec4(0.0);
    center = right = up = vec4(0.0, 0.0, 0.0, float(LOOK_RIBBON));
    if (part >= parts)
        return;
    kiln_particle record = records[slot];
    uint serial = record.position_serial.w;
    uint number = form.z > 0u ? serial % form.z : 0u;
    bool is_last = form.z > 0u && number == form.z - 1u;
    float gap = look_over_life(system, KILN_LOOK_SHAPE, 0.0).y;
    uint to_slot = slot_beside(form, slot, 1);
    kiln_particle to = records[to_slot], after = records[slot_beside(form, to_slot, 1)];
    kiln_particle before = records[slot_beside(form, slot, -1)];
    vec3 from_place = particle_position(record), to_place = particle_position(to);
    vec3 before_place = particle_position(before), after_place = particle_position(after);
    bool goes_on = is_there(to, serial + 1u) && !is_last, joined = false;
    if (!goes_on && !is_last && (form.y & LOOK_RIBBON_JOINS) != 0u)
        joined = find_parent(system, slot, serial, to_place);
    if (!(goes_on || joined) || !is_near(from_place, to_place, gap))
        return;
    bool next_is_last = form.z > 0u && number + 2u >= form.z;
    ribbon_points points;
    points.has_before = (form.z == 0u || number > 0u) && is_there(before, serial - 1u) &&
                        is_near(before_place, from_place, gap);
    points.has_after = goes_on && !next_is_last && is_there(after, serial + 2u);
    if (goes_on && !next_is_last && !points.has_after && (form.y & LOOK_RIBBON_JOINS) != 0u)
        points.has_after = find_parent(system, to_slot, serial + 1u, after_place);
    points.has_after = points.has_after && is_near(to_place, after_place, gap);
    points.before = world_to_view_point(before_place);
    points.from = world_to_view_point(from_place);
    points.to = world_to_view_point(to_place);
    points.after = world_to_view_point(after_place);
    points.has_before = points.has_before && ribbon_bends(points.before, points.from, points.to);
    points.has_after = points.has_after && ribbon_bends(points.from, points.to, points.after);

    float age = particle_age_before(record, view.clock_step.x, view.within.x, view.clock.y);
    float to_age = particle_age_before(to, view.clock_step.x, view.within.x, view.clock.y);
    if (joined) {
        to = record;
        to.position_serial.w = serial + 1u;
        to_slot = slot;
        to_age = 0.0;
    }
    ribbon_end ends[2];
    ends[0] = find_ribbon_end(system, record, slot, age, from_place, number);
    ends[1] = find_ribbon_end(system, to, to_slot, to_age, to_place, number + 1u);
    if (ends[0].opacity <= 0.0 && ends[1].opacity <= 0.0)
        return;
    float textures_a_metre = look_over_life(system, KILN_LOOK_TURN, 0.0).z;
    if (textures_a_metre > 0.0) {
        uint counted = form.z > 0u ? number : serial;
        ends[0].along = float(counted * form.w >> 8) / 16777216.0;
        ends[1].along = ends[0].along + (joined ? distance(from_place, to_place) * textures_a_metre
                                                : float(form.w) / 4294967296.0);
    }

    uint k = points.from.z <= points.to.z ? part : parts - 1u - part;
    bool straight = parts < 2u;
    float at[2] = float[2](float(k) / float(parts), k == parts - 1u ? 1.0 : float(k + 1u) / float(parts));
    ribbon_joint joints[2];
    bool seen = true;
    for (int i = 0; i < 2; i++) {
        ribbon_place place = ribbon_place_at(points, at[i], straight);
        vec3 face = place.at;
        if ((form.y & LOOK_RIBBON_NORMAL) != 0u)
            face = world_to_view_vector(look_over_life(system, KILN_LOOK_AXIS, 0.0).xyz);
        joints[i] = ribbon_joint_at(view.frustum, view.principal, place,
                                    mix(ends[0].half_width, ends[1].half_width, at[i]), face);
        seen = seen && -place.at.z > view.eye.w;
    }
    ribbon_part made = ribbon_part_between(joints[0], joints[1], straight);
    if (!seen || !made.seen)
        return;
    float depth = 0.5 * (1.0 / joints[0].near + 1.0 / joints[1].near);
    center.xyz = vec3(0.0, 0.0, -depth);
    right = vec4(made.begins.x, made.begins.y, made.begins.at, made.half_begins);
    up = vec4(made.ends.x, made.ends.y, made.ends.at, made.half_ends);
    vec2 opacity = vec2(mix(ends[0].opacity, ends[1].opacity, at[0]) * made.thin_begins,
                        mix(ends[0].opacity, ends[1].opacity, at[1]) * made.thin_ends);
    particle.color = vec4(-1.0, opacity, 1.0);
    particle.hot.rgb = mix(ends[0].hot, ends[1].hot, at[0]);
    particle.cool.rgb = mix(ends[0].cool, ends[1].cool, at[0]);
    particle.light_0 = vec4(joints[0].near, joints[1].near, mix(ends[0].along, ends[1].along, at[0]),
                            mix(ends[0].along, ends[1].along, at[1]));
    particle.light_x = vec4(made.middle.x, made.middle.y, made.middle.at, 0.0);
    particle.light_y.rgb = mix(ends[0].hot, ends[1].hot, at[1]);
    particle.light_z = vec4(mix(ends[0].cool, ends[1].cool, at[1]), 0.0);
    uint flags = k == 0u && !points.has_before ? RIBBON_BEGINS : 0u;
    flags |= k == parts - 1u && !points.has_after ? RIBBON_ENDS : 0u;
    flags |= textures_a_metre > 0.0 ? RIBBON_REPEATS : 0u;
    uint4 atlas = looks[system].textures[0];
    float width = 2.0 * max(made.half_begins, made.half_ends);
    float level = floor(log2(max(float(KILN_ATLAS_CELL) / max(width, 1.0), 1.0)));
    particle.cells = vec4(float(atlas.x), float(flags), 0.0, level);
    particle.depth = vec4(depth, float(atlas.z), 0.0, depth);
    particle.bloom = vec4(ends[0].bloom, 0.0);
}
