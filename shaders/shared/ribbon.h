/* Computes the strips that ribbons consist of (look.shape: ribbon). A ribbon goes through particles
 * in the order of their births. A segment lies between a particle and the next one; it is drawn as
 * a number of parts, each of them a quad in the picture that shares its ends with its neighbours.
 * The device `cpu` computes a vector of parts (lib/draw/sprites/sprite_ribbon.h), GL one part
 * (shaders/draw/sprites/ribbon.glsl).
 *
 * Positions and directions are in view space, m. */
#ifndef KILN_SHARED_RIBBON_H
#define KILN_SHARED_RIBBON_H

#include "shared/billboard_place.h"
#include "shared/look_layout.h"

/* ---- the curve ------------------------------------------------------------------------------- */

/* The particles around a segment: the one before it, its two ends, and the one after it. */
struct ribbon_points {
    real3 before, from, to, after;
    truth has_before, has_after; /* the ribbon goes on there */
};

/* Returns the direction of a ribbon at the point p between a and b, of which one may be missing. A
 * curve bends as the parabola through the three points does, as Catmull and Rom's does; a ribbon of
 * straight segments has the direction half way between both. The result has no unit length: where
 * the parabola runs through the points in the length of its chords, it is the change a metre. */
REAL_FN real3 ribbon_direction(real3 a, real3 p, real3 b, truth has_a, truth has_b, bool straight)
{
    real3 way_in = real3_sub(p, a), way_out = real3_sub(b, p);
    real length_in = real_sqrt(real3_dot(way_in, way_in));
    real length_out = real_sqrt(real3_dot(way_out, way_out));
    real3 unit_in = real3_scale(way_in, 1.0f / real_max(length_in, real_all(1e-9f)));
    real3 unit_out = real3_scale(way_out, 1.0f / real_max(length_out, real_all(1e-9f)));
    real sum = real_max(length_in + length_out, real_all(1e-9f));
    real part = straight ? real_all(0.5f) : length_out / sum;
    real3 both = real3_add_scaled(unit_out, real3_sub(unit_in, unit_out), part);
    truth only_out = truth_or(truth_not(has_a), length_in < 1e-6f);
    truth only_in = truth_or(truth_not(has_b), length_out < 1e-6f);
    return real3_select(only_out, unit_out, real3_select(only_in, unit_in, both));
}

/* Returns whether a ribbon bends at the point p between a and b by less than 120 degrees. One that
 * bends more ends there and begins again, since the strips of both sides would cover each other. */
REAL_FN truth ribbon_bends(real3 a, real3 p, real3 b)
{
    real3 way_in = real3_sub(p, a), way_out = real3_sub(b, p);
    real both = real3_dot(way_in, way_out);
    real squares = real3_dot(way_in, way_in) * real3_dot(way_out, way_out);
    return truth_or(both >= 0.0f, 4.0f * both * both <= squares);
}

/* A place on a ribbon and its direction there. */
struct ribbon_place {
    real3 at, direction;
};

/* Returns the place at a part of the way along a segment, 0 to 1: on the line between its ends, or
 * on the cubic curve that has the ribbon's directions at both. */
REAL_FN S(ribbon_place) ribbon_place_at(S(ribbon_points) p, real part, bool straight)
{
    real3 way = real3_sub(p.to, p.from);
    real length = real_sqrt(real3_dot(way, way));
    truth always = length >= 0.0f;
    real3 begins = ribbon_direction(p.before, p.from, p.to, p.has_before, always, straight);
    real3 ends = ribbon_direction(p.from, p.to, p.after, always, p.has_after, straight);
    S(ribbon_place) place;
    truth first = part <= 0.0f, last = part >= 1.0f;
    if (straight) {
        place.at = real3_add_scaled(p.from, way, part);
        place.direction = way;
    } else {
        real3 from = real3_scale(begins, length), to = real3_scale(ends, length);
        real square = part * part, cube = square * part;
        real3 at = real3_add_scaled(p.from, way, 3.0f * square - 2.0f * cube);
        at = real3_add_scaled(at, from, cube - 2.0f * square + part);
        place.at = real3_add_scaled(at, to, cube - square);
        place.direction = real3_scale(way, 6.0f * (part - square));
        place.direction =
            real3_add_scaled(place.direction, from, 3.0f * square - 4.0f * part + 1.0f);
        place.direction = real3_add_scaled(place.direction, to, 3.0f * square - 2.0f * part);
    }
    place.at = real3_select(first, p.from, real3_select(last, p.to, place.at));
    place.direction = real3_select(first, begins, real3_select(last, ends, place.direction));
    return place;
}

/* ---- the picture ----------------------------------------------------------------------------- */

/* A line in the picture: x * pixel.x + y * pixel.y + at is the distance of a pixel from it, px. */
struct ribbon_line {
    real x, y, at;
};

REAL_FN S(ribbon_line) ribbon_line_through(S(picture_point) p, real x, real y)
{
    S(ribbon_line) line;
    line.x = x;
    line.y = y;
    line.at = -(x * p.x + y * p.y);
    return line;
}

/* The place where two parts of a ribbon meet, with the same bits for both of them. */
struct ribbon_joint {
    S(picture_point) middle;
    S(ribbon_line) line; /* the joint; the ribbon goes on where distances from it are positive */
    real half_px;        /* half of the ribbon's width along the joint, px */
    real near;           /* 1 / depth, 1/m */
};

/* Returns a unit vector across the ribbon: at right angles to its direction and to a vector that it
 * shows its face to, the view at the place or its normal. */
REAL_FN real3 ribbon_side(real3 direction, real3 face)
{
    real3 side = real3_cross(direction, face);
    real square = real3_dot(side, side);
    truth small = square < 1e-20f;
    real3 unit = real3_scale(side, real_rsqrt(real_select(small, real_all(1.0f), square)));
    return real3_select(small, REAL3(real_all(1.0f), real_all(0.0f), real_all(0.0f)), unit);
}

/* Finds the joint at a place. half_width: m; face: a vector that the ribbon turns its face to. */
REAL_FN S(ribbon_joint) ribbon_joint_at(float4 frustum, float4 principal, S(ribbon_place) place,
                                        real half_width, real3 face)
{
    /* of both faces, that which is turned to the eye: so a line's ends are never exchanged */
    real towards = real3_dot(face, place.at);
    face = real3_select(towards < 0.0f, real3_scale(face, real_all(-1.0f)), face);
    real3 side = ribbon_side(place.direction, face);
    real reach =
        -0.01f * place.at.z; /* of a line whose picture is long enough to have a direction */
    S(picture_point) one =
        picture_point_of(frustum, principal, real3_add_scaled(place.at, side, reach));
    S(picture_point) other =
        picture_point_of(frustum, principal, real3_add_scaled(place.at, side, -reach));
    real x = other.x - one.x, y = other.y - one.y;
    real length = real_sqrt(x * x + y * y);
    real unit = 1.0f / real_max(length, real_all(1e-6f));
    S(ribbon_joint) joint;
    joint.middle = picture_point_of(frustum, principal, place.at);
    joint.line = ribbon_line_through(joint.middle, y * unit, -x * unit);
    joint.half_px = 0.5f * length * half_width / reach;
    joint.near = -1.0f / place.at.z;
    return joint;
}

/* A part of a ribbon in the picture: the strip about its middle line between two joints. */
struct ribbon_part {
    S(ribbon_line) begins, ends, middle;
    real half_begins, half_ends; /* half of its width at right angles to the middle line, px */
    real thin_begins, thin_ends; /* factors of opacity where it is thinner than a pixel */
    S(picture_point) low, high;  /* a box around it */
    truth seen;
};

/* Returns half of a pixel's width in a direction: the square's, up to its diagonal. Edges that are
 * filtered over this width cover as much wherever they lie between the pixels. */
REAL_FN real ribbon_half_pixel(real x, real y)
{
    return 0.5f * (real_abs(x) + real_abs(y));
}

/* A part that meets a joint at a smaller angle than about 10 degrees, as in a hairpin, ends at a
 * right angle instead. */
#define RIBBON_LEAST_TURN 0.17f

/* Returns the line of a joint or, where it is too much aslant, that at a right angle to a
 * direction. */
REAL_FN S(ribbon_line) ribbon_line_or(truth aslant, S(ribbon_joint) joint, real x, real y)
{
    S(ribbon_line) line = ribbon_line_through(joint.middle, x, y);
    line.x = real_select(aslant, line.x, joint.line.x);
    line.y = real_select(aslant, line.y, joint.line.y);
    line.at = real_select(aslant, line.at, joint.line.at);
    return line;
}

/* Finds the part between two joints. mitred: the segments are straight, so that joints must be
 * longer than the ribbon is wide where it bends, up to twice as long. */
REAL_FN S(ribbon_part) ribbon_part_between(S(ribbon_joint) from, S(ribbon_joint) to, bool mitred)
{
    real x = to.middle.x - from.middle.x, y = to.middle.y - from.middle.y;
    real length = real_sqrt(x * x + y * y), unit = 1.0f / real_max(length, real_all(1e-6f));
    real along_x = x * unit, along_y = y * unit;
    S(ribbon_part) part;
    part.middle = ribbon_line_through(from.middle, -along_y, along_x);
    /* the cosines of the angles by which the joints are off a right angle */
    real turn_from = from.line.x * along_x + from.line.y * along_y;
    real turn_to = to.line.x * along_x + to.line.y * along_y;
    truth begins_aslant = turn_from < RIBBON_LEAST_TURN, ends_aslant = turn_to < RIBBON_LEAST_TURN;
    part.begins = ribbon_line_or(begins_aslant, from, along_x, along_y);
    part.ends = ribbon_line_or(ends_aslant, to, along_x, along_y);
    turn_from = real_select(begins_aslant, real_all(1.0f), turn_from);
    turn_to = real_select(ends_aslant, real_all(1.0f), turn_to);
    part.half_begins = from.half_px;
    part.half_ends = to.half_px;
    if (!mitred) {
        part.half_begins = from.half_px * turn_from;
        part.half_ends = to.half_px * turn_to;
    }
    real least = ribbon_half_pixel(along_x, along_y);
    part.thin_begins = real_min(part.half_begins / least, real_all(1.0f));
    part.thin_ends = real_min(part.half_ends / least, real_all(1.0f));
    part.half_begins = real_max(part.half_begins, least);
    part.half_ends = real_max(part.half_ends, least);
    real reach_from = 2.0f * part.half_begins + 1.5f, reach_to = 2.0f * part.half_ends + 1.5f;
    part.low.x = real_min(from.middle.x - reach_from, to.middle.x - reach_to);
    part.low.y = real_min(from.middle.y - reach_from, to.middle.y - reach_to);
    part.high.x = real_max(from.middle.x + reach_from, to.middle.x + reach_to);
    part.high.y = real_max(from.middle.y + reach_from, to.middle.y + reach_to);
    part.seen = length > 1e-4f;
    return part;
}

#endif
