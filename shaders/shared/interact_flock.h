/* Computes flocking (Drone 2007, 7.4.4; Reynolds 1987 and 1999): separation, avoidance of
 * collisions, cohesion and alignment, with the neighbours in view and with the averages of the
 * whole system.
 *
 * The sums over neighbours are sums of integers, so that their order changes no bit. Their units
 * are 1/65536 of the radius, of twice the top speed, or of a direction. The paper takes the
 * averages of all from the last level of mip-maps; here they are sums of integers of 64 bits. */
#ifndef KILN_SHARED_INTERACT_FLOCK_H
#define KILN_SHARED_INTERACT_FLOCK_H

#include "shared/interact_body.h"

/* The most bodies that a body looks at. Rows of cells beyond this number are left out, so that sums
 * stay within 31 bits and loops within the length that every driver runs. */
#define FLOCK_MOST 8000u

/* ---- sums of integers ----------------------------------------------------------------------- */

struct flock_triple {
    int x, y, z;
};

/* Sums over all particles that a particle sees. */
struct flock_sums {
    int count;
    S(flock_triple) apart;   /* in radii: vectors to them */
    S(flock_triple) parting; /* in units of twice the top speed: their velocities minus its own */
    /* directions away from those that are too close, weighted by closeness */
    S(flock_triple) away;
    /* directions away from those that will be too close, weighted likewise */
    S(flock_triple) aside;
};

FN S(flock_triple) flock_no_triple(void)
{
    S(flock_triple) parts;
    parts.x = 0;
    parts.y = 0;
    parts.z = 0;
    return parts;
}

FN S(flock_sums) flock_no_sums(void)
{
    S(flock_sums) sums;
    sums.count = 0;
    sums.apart = flock_no_triple();
    sums.parting = flock_no_triple();
    sums.away = flock_no_triple();
    sums.aside = flock_no_triple();
    return sums;
}

FN int flock_part(float part)
{
    EXACT float held = exact_clamp(part, -1.0f, 1.0f);
    EXACT float at = held * 65536.0f + 0.5f;
    return INT(FLOOR(at));
}

FN S(flock_triple) flock_triple_of(float3 v, float unit)
{
    EXACT float3 part = float3_scale(v, unit);
    S(flock_triple) y;
    y.x = flock_part(part.x);
    y.y = flock_part(part.y);
    y.z = flock_part(part.z);
    return y;
}

FN S(flock_triple) flock_triple_add(S(flock_triple) a, S(flock_triple) b)
{
    S(flock_triple) y;
    y.x = a.x + b.x;
    y.y = a.y + b.y;
    y.z = a.z + b.z;
    return y;
}

FN S(flock_sums) flock_sums_add(S(flock_sums) a, S(flock_sums) b)
{
    S(flock_sums) y;
    y.count = a.count + b.count;
    y.apart = flock_triple_add(a.apart, b.apart);
    y.parting = flock_triple_add(a.parting, b.parting);
    y.away = flock_triple_add(a.away, b.away);
    y.aside = flock_triple_add(a.aside, b.aside);
    return y;
}

/* Converts a sum to a float, rounded alike on all devices; not every integer is a float. */
FN float flock_float(int sum)
{
    EXACT float high = FLOAT(sum >> 12) * 4096.0f;
    EXACT float low = FLOAT(sum & 4095);
    EXACT float y = high + low;
    return y;
}

/* Converts a sum to its unit, of which it counts 65536ths. */
FN float3 flock_total(S(flock_triple) sum, float unit)
{
    EXACT float part = unit * 1.52587890625e-5f;
    EXACT float3 all = FLOAT3(flock_float(sum.x), flock_float(sum.y), flock_float(sum.z));
    EXACT float3 y = float3_scale(all, part);
    return y;
}

/* ---- averages of the whole system ----------------------------------------------------------- */

/* A signed integer of 64 bits. */
struct flock_wide {
    uint low, high;
};

/* Converts a number, clamped to 2^20, to units of 2^-22. */
FN S(flock_wide) flock_wide_of(float x)
{
    EXACT float held = exact_clamp(x, -1048576.0f, 1048576.0f);
    EXACT float whole = FLOOR(held);
    EXACT float rest = (held - whole) * 4194304.0f;
    EXACT float part = exact_min(rest, 4194303.0f); /* a value just below 0 rounds up to 1 */
    int units = INT(whole);
    S(flock_wide) y;
    y.low = (UINT(units) << 22u) | UINT(INT(FLOOR(part)));
    y.high = UINT(units >> 10);
    return y;
}

FN S(flock_wide) flock_wide_add(S(flock_wide) a, S(flock_wide) b)
{
    S(flock_wide) y;
    y.low = a.low + b.low;
    y.high = a.high + b.high + (y.low < a.low ? 1u : 0u);
    return y;
}

/* Returns the mean of `count` numbers with this sum, with a relative error of 2^-21. */
FN float flock_wide_mean(S(flock_wide) sum, uint count)
{
    bool negative = (sum.high & EXACT_SIGN_BIT) != 0u;
    uint low = negative ? ~sum.low + 1u : sum.low;
    uint high = negative ? ~sum.high + (low == 0u ? 1u : 0u) : sum.high;
    EXACT float size = FLOAT(INT(high >> 16u));
    size = size * 65536.0f + FLOAT(INT(high & 0xffffu));
    size = size * 65536.0f + FLOAT(INT(low >> 16u));
    size = size * 65536.0f + FLOAT(INT(low & 0xffffu));
    EXACT float unit = size * 2.384185791015625e-7f;
    EXACT float of_all = FLOAT(INT(count));
    EXACT float mean = exact_div(unit, of_all);
    EXACT float y = negative ? -mean : mean;
    return y;
}

/* Sums over all particles of a system. */
struct flock_all {
    S(flock_wide) x, y, z;          /* sums of positions */
    S(flock_wide) to_x, to_y, to_z; /* sums of velocities */
};

FN S(flock_wide) flock_wide_zero(void)
{
    S(flock_wide) y;
    y.low = 0u;
    y.high = 0u;
    return y;
}

FN S(flock_all) flock_nobody(void)
{
    S(flock_all) all;
    all.x = flock_wide_zero();
    all.y = flock_wide_zero();
    all.z = flock_wide_zero();
    all.to_x = flock_wide_zero();
    all.to_y = flock_wide_zero();
    all.to_z = flock_wide_zero();
    return all;
}

FN S(flock_all) flock_all_add(S(flock_all) a, S(flock_all) b)
{
    S(flock_all) y;
    y.x = flock_wide_add(a.x, b.x);
    y.y = flock_wide_add(a.y, b.y);
    y.z = flock_wide_add(a.z, b.z);
    y.to_x = flock_wide_add(a.to_x, b.to_x);
    y.to_y = flock_wide_add(a.to_y, b.to_y);
    y.to_z = flock_wide_add(a.to_z, b.to_z);
    return y;
}

FN S(flock_all) flock_all_of(S(kiln_body) b)
{
    EXACT float3 position = body_position(b);
    EXACT float3 velocity = body_velocity(b);
    S(flock_all) y;
    y.x = flock_wide_of(position.x);
    y.y = flock_wide_of(position.y);
    y.z = flock_wide_of(position.z);
    y.to_x = flock_wide_of(velocity.x);
    y.to_y = flock_wide_of(velocity.y);
    y.to_z = flock_wide_of(velocity.z);
    return y;
}

struct flock_means {
    float3 position, velocity;
};

/* Returns the means of a sum over at least one particle. */
FN S(flock_means) flock_means_of(S(flock_all) all, uint count)
{
    EXACT S(flock_means) means;
    means.position = FLOAT3(flock_wide_mean(all.x, count), flock_wide_mean(all.y, count),
                            flock_wide_mean(all.z, count));
    means.velocity = FLOAT3(flock_wide_mean(all.to_x, count), flock_wide_mean(all.to_y, count),
                            flock_wide_mean(all.to_z, count));
    return means;
}

/* ---- neighbours ----------------------------------------------------------------------------- */

/* Returns whether a particle with this velocity sees another. `view` is the square of the cosine of
 * half the angle of view, with the cosine's sign, and below -1 for all around. */
FN bool flock_sees(float3 velocity, float3 apart, float square, float view)
{
    EXACT float along = float3_dot(velocity, apart);
    EXACT float ahead = exact_canon(along);
    EXACT float speed_square = float3_dot(velocity, velocity);
    EXACT float whole = (speed_square * square) * exact_abs(view);
    EXACT float limit = exact_canon(whole);
    EXACT float ahead_square = ahead * ahead;
    EXACT float part = exact_canon(ahead_square);
    uint in_front = ahead >= 0.0f ? 1u : 0u;
    uint narrow = part >= limit ? in_front : 0u;
    uint wide = part <= limit ? 1u : in_front;
    return (view >= 0.0f ? narrow : wide) != 0u;
}

/* Returns the closeness: 1 at distance none, 0 from a distance of 1 / per_metre on. */
FN float flock_closeness(float square, float per_metre)
{
    EXACT float part = exact_sqrt(square) * per_metre;
    EXACT float left = 1.0f - part;
    EXACT float y = exact_max(left, 0.0f);
    return y;
}

/* Returns the direction away from a place. Two particles at one place get opposite directions. */
FN float3 flock_away(float3 from, uint mine, uint other)
{
    EXACT float side = mine < other ? 1.0f : -1.0f;
    EXACT float3 up = FLOAT3(0.0f, side, 0.0f);
    EXACT float3 back = FLOAT3(-from.x, -from.y, -from.z);
    EXACT float3 y = float3_normalize(back, up);
    return y;
}

/* Returns the seconds until two particles are closest, if that is in the future and within the
 * horizon; else 0. */
FN float flock_meet_s(float3 apart, float3 parting, float horizon_s)
{
    EXACT float speed_square = float3_dot(parting, parting);
    EXACT float opening = float3_dot(apart, parting);
    EXACT float closing = -opening;
    EXACT float t = exact_div(closing, speed_square);
    EXACT float y = t > 0.0f && t < horizon_s ? t : 0.0f;
    return y;
}

/* A particle in view, as another sees it. */
struct flock_seen {
    float3 apart;     /* vector from the particle that sees to the one in view, m */
    float3 parting;   /* velocity of the one in view minus that of the particle that sees */
    float square;     /* square of the distance */
    uint mine, other; /* slots of the particle that sees, and of the particle in view */
};

/* Returns the terms that a particle in view adds to the sums. */
FN S(flock_sums) flock_parts_of(CROWD_PARAM S(flock_seen) seen)
{
    EXACT float closeness = flock_closeness(seen.square, INTERACT(flock.per_space));
    EXACT float3 away = flock_away(seen.apart, seen.mine, seen.other);
    EXACT float meet_s = flock_meet_s(seen.apart, seen.parting, INTERACT(flock.horizon_s));
    EXACT float sooner = 1.0f - meet_s * INTERACT(flock.per_horizon);
    EXACT float3 passing = float3_add_scaled(seen.apart, seen.parting, meet_s);
    EXACT float3 nearest = float3_canon(passing);
    EXACT float sum = float3_dot(nearest, nearest);
    EXACT float nearest_square = exact_canon(sum);
    EXACT float threat = flock_closeness(nearest_square, INTERACT(flock.per_space)) * sooner;
    EXACT float weight = meet_s > 0.0f ? threat : 0.0f;
    EXACT float3 aside = flock_away(nearest, seen.mine, seen.other);
    S(flock_sums) y;
    y.count = 1;
    y.apart = flock_triple_of(seen.apart, INTERACT(flock.per_radius));
    y.parting = flock_triple_of(seen.parting, INTERACT(flock.per_speed));
    y.away = flock_triple_of(away, closeness);
    y.aside = flock_triple_of(aside, weight);
    return y;
}

/* Returns whether a particle sees another at `to`, which has to be in the row of cells y, z, since
 * a place in the table may belong to several rows around. */
FN bool flock_is_seen(CROWD_PARAM float3 velocity, float3 apart, float square, float3 to, int y,
                      int z)
{
    int its_y = cell_along(to.y, INTERACT(cells_per_metre));
    int its_z = cell_along(to.z, INTERACT(cells_per_metre));
    uint seen = flock_sees(velocity, apart, square, INTERACT(flock.view)) ? 1u : 0u;
    seen = square < INTERACT(flock.radius_square) ? seen : 0u;
    seen = its_y == y ? seen : 0u;
    seen = its_z == z ? seen : 0u;
    return seen != 0u;
}

/* Adds a neighbour to the sums. */
FN S(flock_sums) flock_add(CROWD_PARAM S(flock_sums) sums, S(kiln_body) a, S(kiln_body) b, int y,
                           int z)
{
    EXACT float3 from = body_position(a);
    EXACT float3 to = body_position(b);
    EXACT float3 velocity = body_velocity(a);
    EXACT float3 its_velocity = body_velocity(b);
    EXACT float3 way = float3_sub(to, from);
    EXACT float3 faster = float3_sub(its_velocity, velocity);
    EXACT S(flock_seen) seen;
    seen.apart = float3_canon(way);
    seen.parting = float3_canon(faster);
    EXACT float sum = float3_dot(seen.apart, seen.apart);
    seen.square = exact_canon(sum);
    seen.mine = a.velocity_slot.w;
    seen.other = b.velocity_slot.w;
    if (seen.mine == seen.other ||
        !flock_is_seen(CROWD velocity, seen.apart, seen.square, to, y, z))
        return sums;
    S(flock_sums) parts = flock_parts_of(CROWD seen);
    S(flock_sums) more = flock_sums_add(sums, parts);
    return more;
}

FN S(flock_sums) flock_add_among(CROWD_PARAM S(flock_sums) sums, S(kiln_body) a, uint begin,
                                 uint end, int y, int z)
{
    S(flock_sums) more = sums;
    for (uint k = begin; k < end; k++)
        more = flock_add(CROWD more, a, BODY(k), y, z);
    return more;
}

/* A row of three cells around a particle: bodies from begin to end - 1. */
struct flock_row {
    int y, z;
    uint begin, end;
    uint behind; /* further bodies at the table's start, for a row that wraps around */
};

/* Returns one of nine rows; number 4 is the middle one. */
FN S(flock_row) flock_row_at(CROWD_PARAM int x, int y, int z, int number)
{
    S(flock_row) row;
    row.y = y + number % 3 - 1;
    row.z = z + number / 3 - 1;
    uint start = cell_row(row.y, row.z);
    uint first = cell_in_row(CROWD start, x - 1);
    uint last = cell_in_row(CROWD start, x + 1);
    row.begin = cell_begin(CROWD first);
    row.end = CELL_END(last);
    row.behind = 0u;
    if (last < first) {
        row.behind = row.end;
        row.end = CELL_END(INTERACT(cell_mask));
    }
    return row;
}

FN uint flock_row_size(S(flock_row) row)
{
    return (row.end - row.begin) + row.behind;
}

/* Sums up all particles that a body sees, in the 27 cells around it, its own row of cells first. */
FN S(flock_sums) flock_look(CROWD_PARAM uint self)
{
    S(kiln_body) a = BODY(self);
    EXACT float3 p = body_position(a);
    int x = cell_along(p.x, INTERACT(cells_per_metre));
    int y = cell_along(p.y, INTERACT(cells_per_metre));
    int z = cell_along(p.z, INTERACT(cells_per_metre));
    uint left = FLOCK_MOST;
    S(flock_sums) sums = flock_no_sums();
    for (int number = 4; number < 13; number++) {
        S(flock_row) row = flock_row_at(CROWD x, y, z, number % 9);
        if (flock_row_size(row) > left)
            continue;
        left -= flock_row_size(row);
        sums = flock_add_among(CROWD sums, a, 0u, row.behind, row.y, row.z);
        sums = flock_add_among(CROWD sums, a, row.begin, row.end, row.y, row.z);
    }
    return sums;
}

/* ---- steering ------------------------------------------------------------------------------- */

/* Limits a vector's length to a range; a zero vector becomes one along z. */
FN float3 flock_within(float3 v, float shortest, float longest)
{
    EXACT float3 along_z = FLOAT3(0.0f, 0.0f, 1.0f);
    EXACT float length = float3_length(v);
    EXACT float held = exact_clamp(length, shortest, longest);
    if (held == length)
        return v;
    EXACT float3 direction = float3_normalize(v, along_z);
    EXACT float3 y = float3_scale(direction, held);
    return y;
}

/* Returns the acceleration towards the middle of a group and towards its velocity. */
FN float3 flock_join(float3 apart, float3 parting, float cohesion, float alignment)
{
    EXACT float3 to = float3_scale(apart, cohesion);
    EXACT float3 y = float3_add_scaled(to, parting, alignment);
    return y;
}

FN float3 flock_acceleration(CROWD_PARAM S(kiln_body) a, S(flock_sums) sums, S(flock_means) means)
{
    EXACT float3 position = body_position(a);
    EXACT float3 velocity = body_velocity(a);
    EXACT float3 to_all = float3_sub(means.position, position);
    EXACT float3 with_all = float3_sub(means.velocity, velocity);
    EXACT float3 wish =
        flock_join(to_all, with_all, INTERACT(flock.all_cohesion), INTERACT(flock.all_alignment));
    EXACT float count = FLOAT(sums.count);
    EXACT float share = exact_rcp(count); /* 0 if there are none */
    EXACT float3 apart = flock_total(sums.apart, INTERACT(flock.radius) * share);
    EXACT float3 parting = flock_total(sums.parting, INTERACT(flock.speed) * share);
    EXACT float3 near =
        flock_join(apart, parting, INTERACT(flock.cohesion), INTERACT(flock.alignment));
    EXACT float3 away = flock_total(sums.away, INTERACT(flock.separation));
    EXACT float3 aside = flock_total(sums.aside, INTERACT(flock.avoidance));
    wish = float3_add(wish, near);
    wish = float3_add(wish, away);
    wish = float3_add(wish, aside);
    EXACT float3 y = flock_within(wish, 0.0f, INTERACT(flock.strongest));
    return y;
}

/* Returns a push's velocity plus the effect of flocking in a step. */
FN float4 flock_push(CROWD_PARAM float4 push, S(kiln_body) a, float3 acceleration)
{
    EXACT float3 velocity = body_velocity(a);
    EXACT float3 steered = float3_add_scaled(velocity, acceleration, INTERACT(derived.dt_s));
    EXACT float3 after = flock_within(steered, INTERACT(flock.slowest), INTERACT(flock.fastest));
    EXACT float3 change = float3_sub(after, velocity);
    EXACT float3 c = float3_canon(change);
    EXACT float4 y = FLOAT4(push.x + c.x, push.y + c.y, push.z + c.z, push.w);
    return y;
}

#endif
