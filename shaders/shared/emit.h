/* Computes births (Heinz 2019, 2.1.2): the time in the step, the place on the emitter's shape, and
 * the velocity. All values are taken at the particle's own birth time, so that a moving emitter
 * leaves an even trail. */
#ifndef KILN_SHARED_EMIT_H
#define KILN_SHARED_EMIT_H

#include "shared/derived.h"

/* Returns the 64ths of the step that have passed at birth number `index` of this step. */
FN uint emit_birth_fraction(SIM_PARAM uint index)
{
    uint j = index;
    uint group = 0u;
    while (group + 1u < STEP(group_count) && j >= STEP(groups[group].count)) {
        j -= STEP(groups[group].count);
        group++;
    }
    return (STEP(groups[group].first) + j * STEP(groups[group].spacing)) >> 26u;
}

struct emit_place {
    float3 axis;      /* direction of the shape, unit length */
    float3 offset;    /* place relative to the origin, m */
    float3 direction; /* direction of flight, unit length */
};

/* Returns a place uniform in the box, or on its six faces by their area. */
FN float3 emit_in_box(SIM_PARAM S(value_clocks) clocks)
{
    uint stream = clocks.stream;
    EXACT float3 size = VALUE3_OF(KEYED_SIZE, SIM_KEYS STEP(emit.size), clocks);
    EXACT float3 at = FLOAT3(random_unit(stream, RANDOM_PLACE) - 0.5f,
                             random_unit(stream, RANDOM_PLACE + 1u) - 0.5f,
                             random_unit(stream, RANDOM_PLACE + 2u) - 0.5f);
    if (STEP(emit.surface) != 0u) {
        EXACT float x_area = size.y * size.z;
        EXACT float xy_area = x_area + size.x * size.z;
        EXACT float all_area = xy_area + size.x * size.y;
        EXACT float pick = random_unit(stream, RANDOM_PLACE + 3u) * all_area;
        EXACT float side = random_unit(stream, RANDOM_PLACE + 4u) < 0.5f ? -0.5f : 0.5f;
        at.x = pick < x_area ? side : at.x;
        at.y = pick >= x_area && pick < xy_area ? side : at.y;
        at.z = pick >= xy_area ? side : at.z;
    }
    EXACT float3 y = FLOAT3(at.x * size.x, at.y * size.y, at.z * size.z);
    return y;
}

/* Returns a place uniform on the disc about the unit vector `axis`, or on its rim; takes 2 random
 * numbers. */
FN float3 emit_on_disc(uint stream, uint purpose, float3 axis, float radius, bool rim)
{
    EXACT float part = exact_sqrt(random_unit(stream, purpose));
    EXACT float distance = rim ? radius : radius * part;
    EXACT float turn = random_unit(stream, purpose + 1u) * EXACT_TWO_PI;
    EXACT S(exact_angle) around = exact_sincos(turn);
    EXACT S(random_frame) frame = random_frame_about(axis);
    EXACT float along_u = distance * around.cosine;
    EXACT float along_v = distance * around.sine;
    EXACT float3 sideways = float3_scale(frame.u, along_u);
    EXACT float3 y = float3_add_scaled(sideways, frame.v, along_v);
    return y;
}

/* Returns a place on the line: at the nozzle that is next in turn, or anywhere. */
FN float3 emit_on_line(SIM_PARAM S(value_clocks) clocks, uint serial)
{
    uint stream = clocks.stream;
    EXACT float3 span = VALUE3_OF(KEYED_SIZE, SIM_KEYS STEP(emit.size), clocks);
    uint nozzles = STEP(emit.nozzles);
    EXACT float part = random_unit(stream, RANDOM_PLACE);
    if (nozzles != 0u)
        part = exact_div(FLOAT(serial % nozzles) + 0.5f, FLOAT(nozzles));
    EXACT float along = part - 0.5f;
    EXACT float3 y = float3_scale(span, along);
    return y;
}

FN S(emit_place) emit_place_at(SIM_PARAM S(value_clocks) clocks, uint serial)
{
    uint stream = clocks.stream;
    EXACT float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    EXACT float3 towards = VALUE3_OF(KEYED_DIRECTION, SIM_KEYS STEP(emit.direction), clocks);
    EXACT float3 axis = float3_normalize(towards, up);
    EXACT float angle = VALUE_OF(KEYED_ANGLE, SIM_KEYS STEP(emit.angle), clocks);
    EXACT S(exact_angle) rim = exact_sincos(angle);
    EXACT float radius = VALUE_OF(KEYED_RADIUS, SIM_KEYS STEP(emit.radius), clocks);
    EXACT S(emit_place) place;
    place.axis = axis;
    place.direction = random_direction(stream, RANDOM_DIRECTION, axis, rim.cosine);
    place.offset = FLOAT3(0.0f, 0.0f, 0.0f);
    uint shape = STEP(emit.shape);
    bool surface = STEP(emit.surface) != 0u;
    if (USES(USES_EMITTERS, EMIT_SPHERE) && shape == EMIT_SPHERE) {
        EXACT float3 unit = random_in_ball(stream, RANDOM_PLACE, surface);
        place.offset = float3_scale(unit, radius);
        if (STEP(emit.outward) != 0u)
            place.direction = float3_normalize(unit, axis);
    } else if (USES(USES_EMITTERS, EMIT_BOX) && shape == EMIT_BOX) {
        place.offset = emit_in_box(SIM clocks);
    } else if (USES(USES_EMITTERS, EMIT_DISC) && shape == EMIT_DISC) {
        place.offset = emit_on_disc(stream, RANDOM_PLACE, axis, radius, surface);
    } else if (USES(USES_EMITTERS, EMIT_CONE) && shape == EMIT_CONE) {
        /* A nozzle's stream widens by the angle. Place and direction share their random numbers:
         * the farther from the middle a particle starts, the farther from the axis it flies, as if
         * all came from one point behind. */
        place.offset = emit_on_disc(stream, RANDOM_DIRECTION, axis, radius, false);
    } else if (USES(USES_EMITTERS, EMIT_LINE) && shape == EMIT_LINE) {
        place.offset = emit_on_line(SIM clocks, serial);
    }
    return place;
}

struct emit_state {
    float3 position; /* m */
    float3 velocity; /* m/s */
};

/* Returns the metres in one unit of the shape's frame, after the part u of the step. */
FN float emit_scale(SIM_PARAM float u)
{
    if (!(USES(USES_EMITTERS, EMIT_ATTACHED) && STEP(emit.attached) != 0u))
        return 1.0f;
    EXACT float scale = STEP(emit.frame.start.w) + u * STEP(emit.frame.linear.w);
    return scale;
}

/* Returns a birth at a clip time as the shape says, from an emitter at rest. The place is in the
 * shape's frame, the velocity in m/s. */
FN S(emit_state) emit_at_rest(SIM_PARAM S(value_clocks) clocks, uint serial, float scale)
{
    EXACT S(emit_place) place = emit_place_at(SIM clocks, serial);
    EXACT float slowest = VALUE_OF(KEYED_SPEED, SIM_KEYS STEP(emit.speed.min), clocks);
    EXACT float fastest = VALUE_OF(KEYED_SPEED, SIM_KEYS STEP(emit.speed.max), clocks);
    EXACT float speed = random_between(clocks.stream, RANDOM_SPEED, slowest, fastest);
    EXACT float3 origin = VALUE3_OF(KEYED_ORIGIN, SIM_KEYS STEP(emit.origin), clocks);
    EXACT S(emit_state) born;
    born.position = float3_add(origin, place.offset);
    EXACT float turn = VALUE_OF(KEYED_TURN, SIM_KEYS STEP(emit.turn), clocks) * scale;
    EXACT float3 around = float3_cross(place.axis, place.offset);
    EXACT float3 thrown = float3_scale(place.direction, speed);
    born.velocity = float3_add_scaled(thrown, around, turn);
    return born;
}

/* Returns the place of a frame after the part u of the step. */
FN float3 emit_frame_place(S(kiln_emit_frame) frame, float u)
{
    EXACT float3 start = FLOAT3(frame.start.x, frame.start.y, frame.start.z);
    EXACT float3 linear = FLOAT3(frame.linear.x, frame.linear.y, frame.linear.z);
    EXACT float3 square = FLOAT3(frame.square.x, frame.square.y, frame.square.z);
    EXACT float3 cube = FLOAT3(frame.cube.x, frame.cube.y, frame.cube.z);
    EXACT float3 inner = float3_add_scaled(square, cube, u);
    EXACT float3 middle = float3_add_scaled(linear, inner, u);
    EXACT float3 place = float3_add_scaled(start, middle, u);
    return place;
}

/* Returns the rotation of a frame in the part u of the step: a unit quaternion. */
FN float4 emit_frame_turn(S(kiln_emit_frame) frame, float u)
{
    EXACT S(exact_angle) half_turn = exact_sincos(0.5f * (u * frame.spin.w));
    EXACT float3 axis = FLOAT3(frame.spin.x, frame.spin.y, frame.spin.z);
    EXACT float3 sines = float3_scale(axis, half_turn.sine);
    EXACT float4 turn = FLOAT4(sines.x, sines.y, sines.z, half_turn.cosine);
    return turn;
}

/* Takes a birth from the frame of the emitter's node to the world, after the part u of the step.
 * inherit: the part of the frame's velocity at that place which the particle gets. */
FN S(emit_state) emit_from_node(SIM_PARAM S(emit_state) own, float inherit, float u, float scale)
{
    EXACT S(kiln_emit_frame) frame = STEP(emit.frame);
    EXACT float3 linear = FLOAT3(frame.linear.x, frame.linear.y, frame.linear.z);
    EXACT float3 square = FLOAT3(frame.square.x, frame.square.y, frame.square.z);
    EXACT float3 cube = FLOAT3(frame.cube.x, frame.cube.y, frame.cube.z);
    EXACT float3 origin = emit_frame_place(frame, u);
    EXACT float3 cubes = float3_scale(cube, 3.0f);
    EXACT float3 squares = float3_add(square, square);
    EXACT float3 rates = float3_add_scaled(squares, cubes, u);
    EXACT float3 moved = float3_add_scaled(linear, rates, u);

    EXACT float3 axis = FLOAT3(frame.spin.x, frame.spin.y, frame.spin.z);
    EXACT float4 turn = emit_frame_turn(frame, u);
    EXACT float3 at_start = float3_turn(frame.pose, own.position);
    EXACT float3 outwards = float3_turn(turn, at_start);
    EXACT float3 offset = float3_scale(outwards, scale);
    EXACT float3 thrown_at_start = float3_turn(frame.pose, own.velocity);
    EXACT float3 thrown = float3_turn(turn, thrown_at_start);

    EXACT float3 across = float3_cross(axis, offset);
    moved = float3_add_scaled(moved, across, frame.spin.w);
    moved = float3_add_scaled(moved, outwards, frame.linear.w);
    EXACT float part = inherit * frame.square.w;
    EXACT S(emit_state) born;
    born.position = float3_add(origin, offset);
    born.velocity = float3_add_scaled(thrown, moved, part);
    return born;
}

/* Returns place and velocity of a particle born at a clip time, after the part u of the step. */
FN S(emit_state) emit_particle(SIM_PARAM uint stream, uint serial, float time_s, float u)
{
    EXACT S(value_clocks) clocks =
        value_clocks_of_birth(time_s, STEP(derived.random_key), STEP(derived.scene_key), stream);
    EXACT float scale = emit_scale(SIM u);
    EXACT S(emit_state) born = emit_at_rest(SIM clocks, serial, scale);
    EXACT float3 origin_rate =
        FLOAT3(VALUE_RATE_OF(KEYED_ORIGIN, SIM_KEYS STEP(emit.origin.x), clocks),
               VALUE_RATE_OF(KEYED_ORIGIN, SIM_KEYS STEP(emit.origin.y), clocks),
               VALUE_RATE_OF(KEYED_ORIGIN, SIM_KEYS STEP(emit.origin.z), clocks));
    EXACT float inherit = VALUE_OF(KEYED_INHERIT, SIM_KEYS STEP(emit.inherit), clocks);
    EXACT float of_origin = inherit * scale;
    born.velocity = float3_add_scaled(born.velocity, origin_rate, of_origin);
    if (USES(USES_EMITTERS, EMIT_ATTACHED) && STEP(emit.attached) != 0u)
        born = emit_from_node(SIM born, inherit, u, scale);
    return born;
}

/* Rotates v from a space whose y axis is y to one whose y axis is the unit vector `axis`. */
FN float3 emit_rotate(float3 v, float3 axis)
{
    EXACT S(random_frame) frame = random_frame_about(axis);
    EXACT float3 across = float3_scale(frame.u, v.x);
    EXACT float3 upwards = float3_add_scaled(across, axis, v.y);
    EXACT float3 y = float3_add_scaled(upwards, frame.v, -v.z);
    return y;
}

/* Returns place and velocity of a particle that is born of another: `parent` at that moment is the
 * origin of the shape's space, and `axis` its y axis. */
FN S(emit_state) emit_child(SIM_PARAM uint stream, uint serial, float time_s, S(emit_state) parent,
                            float3 axis)
{
    EXACT S(value_clocks) clocks =
        value_clocks_of_birth(time_s, STEP(derived.random_key), STEP(derived.scene_key), stream);
    EXACT S(emit_state) own = emit_at_rest(SIM clocks, serial, 1.0f);
    EXACT float inherit = VALUE_OF(KEYED_INHERIT, SIM_KEYS STEP(emit.inherit), clocks);
    EXACT float3 offset = emit_rotate(own.position, axis);
    EXACT float3 thrown = emit_rotate(own.velocity, axis);
    EXACT S(emit_state) born;
    born.position = float3_add(parent.position, offset);
    born.velocity = float3_add_scaled(thrown, parent.velocity, inherit);
    return born;
}

#endif
