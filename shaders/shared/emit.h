/* Computes births (Heinz 2019, 2.1.2): the time in the step, the place on the emitter's shape, and
 * the velocity. All values are taken at the particle's own birth time, so that a moving emitter
 * leaves an even trail. */
#ifndef KILN_SHARED_EMIT_H
#define KILN_SHARED_EMIT_H

#include "shared/derived.h"
#include "shared/source.h"

/* The time of a birth of this step. */
struct emit_time {
    uint sixty_fourths; /* the time: 64ths of the step */
    float place;        /* the part of the step at whose end the emitter is where it gives birth */
};

/* Returns the time of birth number `index` of this step. */
FN S(emit_time) emit_birth_time(SIM_PARAM uint index)
{
    uint j = index;
    uint group = 0u;
    while (group + 1u < STEP(group_count) && j >= STEP(groups[group].count)) {
        j -= STEP(groups[group].count);
        group++;
    }
    uint at = STEP(groups[group].first) + j * STEP(groups[group].spacing);
    EXACT S(emit_time) time;
    time.sixty_fourths = at >> 26u;
    uint kept = STEP(groups[group].kind) == BIRTHS_BY_WAY ? at >> 8u : time.sixty_fourths << 18u;
    time.place = FLOAT(INT(kept)) * 5.9604644775390625e-8f;
    return time;
}

/* Returns how far along the shape birth number `index` of this step lies, 0 to 1, or -1 where its
 * place is random. */
FN float emit_order(SIM_PARAM uint index)
{
    EXACT float along = -1.0f;
    if (!USES(USES_EMITTERS, EMIT_ORDERED) || STEP(emit.order) == ORDER_RANDOM)
        return along;
    uint j = index;
    uint group = 0u;
    while (group + 1u < STEP(group_count) && j >= STEP(groups[group].count)) {
        j -= STEP(groups[group].count);
        group++;
    }
    uint parts = STEP(groups[group].count);
    if (STEP(emit.order) == ORDER_OPEN)
        parts = parts > 1u ? parts - 1u : 1u;
    if (STEP(groups[group].kind) == BIRTHS_BURST)
        along = exact_div(FLOAT(j), FLOAT(parts));
    return along;
}

struct emit_place {
    float3 moved;     /* m: of a mesh with an animation, its way in the step where the place is */
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
 * numbers. along: how far around it lies, 0 to 1, unless it is negative. */
FN float3 emit_on_disc(uint stream, uint purpose, float3 axis, float radius, bool rim, float along)
{
    EXACT float part = exact_sqrt(random_unit(stream, purpose));
    EXACT float distance = rim ? radius : radius * part;
    EXACT float around_part = random_unit(stream, purpose + 1u);
    if (along >= 0.0f)
        around_part = along;
    EXACT float turn = around_part * EXACT_TWO_PI;
    EXACT S(exact_angle) around = exact_sincos(turn);
    EXACT S(random_frame) frame = random_frame_about(axis);
    EXACT float along_u = distance * around.cosine;
    EXACT float along_v = distance * around.sine;
    EXACT float3 sideways = float3_scale(frame.u, along_u);
    EXACT float3 y = float3_add_scaled(sideways, frame.v, along_v);
    return y;
}

/* Returns a place on the line: at the nozzle that is next in turn, or anywhere; or the place
 * `order` from its first end, unless that is negative. */
FN float3 emit_on_line(SIM_PARAM S(value_clocks) clocks, uint serial, float order)
{
    uint stream = clocks.stream;
    EXACT float3 span = VALUE3_OF(KEYED_SIZE, SIM_KEYS STEP(emit.size), clocks);
    uint nozzles = STEP(emit.nozzles);
    EXACT float part = random_unit(stream, RANDOM_PLACE);
    if (nozzles != 0u)
        part = exact_div(FLOAT(serial % nozzles) + 0.5f, FLOAT(nozzles));
    if (order >= 0.0f)
        part = order;
    EXACT float along = part - 0.5f;
    EXACT float3 y = float3_scale(span, along);
    return y;
}

#if !defined(GL_core_profile) || defined(SOURCES)

FN float3 emit_source_vector(float4 word)
{
    EXACT float3 y = FLOAT3(word.x, word.y, word.z);
    return y;
}

/* Lets the particle start along a normal, within the angle whose cosine is given, if the emitter
 * says so. */
FN S(emit_place) emit_along_normal(SIM_PARAM S(emit_place) at, uint stream, float3 normal,
                                   float cos_angle)
{
    EXACT S(emit_place) place = at;
    EXACT float3 axis = float3_normalize(normal, place.axis);
    if (STEP(emit.outward) != 0u)
        place.direction = random_direction(stream, RANDOM_DIRECTION, axis, cos_angle);
    return place;
}

/* Finds a place uniform on the triangles of a mesh, each of which has `words` words. u: the part of
 * the step by which a mesh with an animation has moved on. */
FN S(emit_place) emit_on_triangles(SIM_PARAM S(emit_place) at, uint stream, float cos_angle,
                                   uint words, float u)
{
    uint first = STEP(emit.first_word);
    uint turn = source_turn(stream, STEP(emit.cells));
    uint of_turn = first + turn * words;
    uint cell = source_choose(stream, turn, GRID_WORD(of_turn).w, UINT(GRID_WORD(of_turn + 1u).w));
    uint word = first + cell * words;
    EXACT float3 corner = emit_source_vector(GRID_WORD(word));
    EXACT float3 to_second = emit_source_vector(GRID_WORD(word + 1u));
    EXACT float3 to_third = emit_source_vector(GRID_WORD(word + 2u));
    EXACT S(source_spot) spot = source_spot_on_triangle(stream);
    EXACT S(emit_place) place = at;
    if (words == SOURCE_POSED_WORDS) {
        EXACT float3 corner_moved = emit_source_vector(GRID_WORD(word + 3u));
        EXACT float3 second_moved = emit_source_vector(GRID_WORD(word + 4u));
        EXACT float3 third_moved = emit_source_vector(GRID_WORD(word + 5u));
        EXACT float3 moved = float3_add_scaled(corner_moved, second_moved, spot.s);
        place.moved = float3_add_scaled(moved, third_moved, spot.t);
        corner = float3_add_scaled(corner, corner_moved, u);
        to_second = float3_add_scaled(to_second, second_moved, u);
        to_third = float3_add_scaled(to_third, third_moved, u);
    }
    EXACT float3 along = float3_add_scaled(corner, to_second, spot.s);
    EXACT float3 normal = float3_cross(to_second, to_third);
    place.offset = float3_add_scaled(along, to_third, spot.t);
    place = emit_along_normal(SIM place, stream, normal, cos_angle);
    return place;
}

/* Finds one of the vertices of a mesh, all of which are as likely. */
FN S(emit_place) emit_on_vertices(SIM_PARAM S(emit_place) at, uint stream, float cos_angle)
{
    uint word = STEP(emit.first_word) + source_turn(stream, STEP(emit.cells)) * SOURCE_VERTEX_WORDS;
    EXACT float3 normal = emit_source_vector(GRID_WORD(word + 1u));
    EXACT S(emit_place) place = at;
    place.offset = emit_source_vector(GRID_WORD(word));
    place = emit_along_normal(SIM place, stream, normal, cos_angle);
    return place;
}

/* Returns a place in the columns of the inside of a mesh, which are as wide as the size. */
FN float3 emit_in_columns(SIM_PARAM uint stream)
{
    uint first = STEP(emit.first_word);
    uint turn = source_turn(stream, STEP(emit.cells));
    uint of_turn = first + turn * SOURCE_COLUMN_WORDS;
    uint cell = source_choose(stream, turn, GRID_WORD(of_turn).w, UINT(GRID_WORD(of_turn + 1u).y));
    uint word = first + cell * SOURCE_COLUMN_WORDS;
    EXACT float3 low = emit_source_vector(GRID_WORD(word));
    EXACT float edge = STEP(emit.size.x.constant);
    EXACT float height = GRID_WORD(word + 1u).x;
    EXACT float x = random_unit(stream, RANDOM_PLACE + 2u) - 0.5f;
    EXACT float up = random_unit(stream, RANDOM_PLACE + 3u);
    EXACT float z = random_unit(stream, RANDOM_PLACE + 4u) - 0.5f;
    EXACT float3 y = FLOAT3(low.x + x * edge, low.y + up * height, low.z + z * edge);
    return y;
}

/* Returns a place on the pixels of an image, whose edge is the size. */
FN float3 emit_on_image(SIM_PARAM S(value_clocks) clocks)
{
    uint stream = clocks.stream;
    uint first = STEP(emit.first_word);
    uint turn = source_turn(stream, STEP(emit.cells));
    EXACT float4 pixel = GRID_WORD(first + turn);
    uint cell = source_choose(stream, turn, pixel.z, UINT(pixel.w));
    pixel = GRID_WORD(first + cell);
    EXACT float edge = STEP(emit.size.x.constant);
    EXACT S(source_spot) spot = source_spot_on_pixel(stream);
    EXACT float3 y = FLOAT3(pixel.x + spot.s * edge, pixel.y + spot.t * edge, 0.0f);
    return y;
}

/* Returns a place on a path: anywhere, or `order` from its first end, unless that is negative. */
FN float3 emit_on_path(SIM_PARAM uint stream, float order)
{
    EXACT float part = random_unit(stream, RANDOM_PLACE);
    if (order >= 0.0f)
        part = order;
    EXACT float place = part * FLOAT(STEP(emit.cells));
    uint cell = UINT(place);
    uint last = STEP(emit.cells) - 1u;
    cell = cell < last ? cell : last;
    EXACT float rest = place - FLOAT(cell);
    EXACT float3 from = emit_source_vector(GRID_WORD(STEP(emit.first_word) + cell));
    EXACT float3 to = emit_source_vector(GRID_WORD(STEP(emit.first_word) + cell + 1u));
    EXACT float3 way = float3_sub(to, from);
    EXACT float3 y = float3_add_scaled(from, way, rest);
    return y;
}

#endif

/* order: how far along the shape the place is, or -1 (emit_order). u: part of the step. */
FN S(emit_place) emit_place_at(SIM_PARAM S(value_clocks) clocks, uint serial, float order, float u)
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
    place.moved = place.offset;
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
        place.offset = emit_on_disc(stream, RANDOM_PLACE, axis, radius, surface, order);
    } else if (USES(USES_EMITTERS, EMIT_CONE) && shape == EMIT_CONE) {
        /* A nozzle's stream widens by the angle. Place and direction share their random numbers:
         * the farther from the middle a particle starts, the farther from the axis it flies, as if
         * all came from one point behind. */
        place.offset = emit_on_disc(stream, RANDOM_DIRECTION, axis, radius, false, -1.0f);
    } else if (USES(USES_EMITTERS, EMIT_LINE) && shape == EMIT_LINE) {
        place.offset = emit_on_line(SIM clocks, serial, order);
    }
#if !defined(GL_core_profile) || defined(SOURCES)
    if (USES(USES_EMITTERS, EMIT_TRIANGLES) && shape == EMIT_TRIANGLES) {
        place = emit_on_triangles(SIM place, stream, rim.cosine, SOURCE_TRIANGLE_WORDS, u);
    } else if (USES(USES_EMITTERS, EMIT_POSED) && shape == EMIT_POSED) {
        place = emit_on_triangles(SIM place, stream, rim.cosine, SOURCE_POSED_WORDS, u);
    } else if (USES(USES_EMITTERS, EMIT_VERTICES) && shape == EMIT_VERTICES) {
        place = emit_on_vertices(SIM place, stream, rim.cosine);
    } else if (USES(USES_EMITTERS, EMIT_COLUMNS) && shape == EMIT_COLUMNS) {
        place.offset = emit_in_columns(SIM stream);
    } else if (USES(USES_EMITTERS, EMIT_IMAGE) && shape == EMIT_IMAGE) {
        place.offset = emit_on_image(SIM clocks);
    } else if (USES(USES_EMITTERS, EMIT_PATH) && shape == EMIT_PATH) {
        place.offset = emit_on_path(SIM stream, order);
    }
#endif
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
FN S(emit_state) emit_at_rest(SIM_PARAM S(value_clocks) clocks, uint serial, float scale,
                              float order, float u)
{
    EXACT S(emit_place) place = emit_place_at(SIM clocks, serial, order, u);
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
    if (USES(USES_EMITTERS, EMIT_POSED) && STEP(emit.shape) == EMIT_POSED) {
        EXACT float inherit = VALUE_OF(KEYED_INHERIT, SIM_KEYS STEP(emit.inherit), clocks);
        EXACT float metres_per_s = scale * STEP(emit.frame.square.w);
        EXACT float part = inherit * metres_per_s;
        born.velocity = float3_add_scaled(born.velocity, place.moved, part);
    }
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

/* Returns place and velocity of a particle born at a clip time, after the part u of the step.
 * order: that of emit_order. */
FN S(emit_state) emit_particle(SIM_PARAM uint stream, uint serial, float time_s, float u,
                               float order)
{
    EXACT S(value_clocks) clocks =
        value_clocks_of_birth(time_s, STEP(derived.random_key), STEP(derived.scene_key), stream);
    EXACT float scale = emit_scale(SIM u);
    EXACT S(emit_state) born = emit_at_rest(SIM clocks, serial, scale, order, u);
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
    EXACT S(emit_state) own = emit_at_rest(SIM clocks, serial, 1.0f, -1.0f, 0.0f);
    EXACT float inherit = VALUE_OF(KEYED_INHERIT, SIM_KEYS STEP(emit.inherit), clocks);
    EXACT float3 offset = emit_rotate(own.position, axis);
    EXACT float3 thrown = emit_rotate(own.velocity, axis);
    EXACT S(emit_state) born;
    born.position = float3_add(parent.position, offset);
    born.velocity = float3_add_scaled(thrown, parent.velocity, inherit);
    return born;
}

#endif
