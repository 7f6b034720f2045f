/* Computes elastic collisions of spheres (UberFlow 2004, 4.4 and 4.5).
 *
 * As in the paper, each particle looks for its closest partner among the particles that it touches.
 * Both are moved back in time to their first contact, exchange momentum there, and fly on for the
 * same time. In the paper, each particle answers for itself, so that one of three particles may
 * take an impulse that no other gave. Here a pair collides only if each is the other's closest, and
 * both compute the same pair, so momentum is always kept. A particle without such a partner
 * collides in the next round of the same step, or in the next step, where it still overlaps. A
 * particle that touches none at the start of a step has no part in the step's rounds. Pairs are
 * ordered without ties, so that in every round at least the closest of all pairs collides.
 *
 * If the scene asks for it (`fastest`), a pair that does not touch yet, but will within the step,
 * collides ahead of time. Each particle is put where its new way, extended backwards, starts. It
 * may overlap others there, so it has no part in further rounds. */
#ifndef KILN_SHARED_INTERACT_COLLIDE_H
#define KILN_SHARED_INTERACT_COLLIDE_H

#include "shared/interact_body.h"
#include "shared/spin.h"

/* Two bodies, as the first sees the second. */
struct contact {
    float3 apart;   /* from the first to the second, m */
    float3 parting; /* velocity of the second minus that of the first */
    float square;   /* square of the distance */
    float reach;    /* sum of the radii */
    float opening;  /* apart times parting: below 0 they approach each other */
};

FN S(contact) contact_of(S(kiln_body) a, S(kiln_body) b)
{
    EXACT float3 from = body_position(a);
    EXACT float3 to = body_position(b);
    EXACT float3 slow = body_velocity(a);
    EXACT float3 fast = body_velocity(b);
    EXACT float3 apart = float3_sub(to, from);
    EXACT float3 parting = float3_sub(fast, slow);
    EXACT S(contact) c;
    c.apart = float3_canon(apart);
    c.parting = float3_canon(parting);
    EXACT float square = float3_dot(c.apart, c.apart);
    EXACT float opening = float3_dot(c.apart, c.parting);
    c.square = exact_canon(square);
    c.opening = exact_canon(opening);
    c.reach = body_radius(a) + body_radius(b);
    return c;
}

/* Returns whether two bodies touch. It computes nothing else, since few bodies touch. */
FN bool contact_is_near(S(kiln_body) a, S(kiln_body) b)
{
    EXACT float3 from = body_position(a);
    EXACT float3 to = body_position(b);
    EXACT float3 apart = float3_sub(to, from);
    EXACT float3 c = float3_canon(apart);
    EXACT float sum = float3_dot(c, c);
    EXACT float square = exact_canon(sum);
    EXACT float reach = body_radius(a) + body_radius(b);
    EXACT float reach_square = reach * reach;
    return body_radius(a) > 0.0f && body_radius(b) > 0.0f && square < reach_square;
}

/* Returns the seconds since two bodies that approach began to touch, or, below 0, until they will:
 * |apart - parting t| = reach. It is the earlier root; bodies that never touch have none. */
FN float contact_root(S(contact) c)
{
    EXACT float speed_square = float3_dot(c.parting, c.parting);
    EXACT float inside = c.reach * c.reach - c.square;
    EXACT float under = c.opening * c.opening + speed_square * inside;
    EXACT float below = exact_sqrt(under) - c.opening;
    EXACT float y = exact_div(inside, below);
    return y;
}

/* Returns whether two bodies that do not touch will meet within the step. */
FN bool contact_comes(CROWD_PARAM S(contact) c)
{
    EXACT float speed_square = float3_dot(c.parting, c.parting);
    EXACT float inside = c.reach * c.reach - c.square;
    EXACT float under = c.opening * c.opening + speed_square * inside;
    EXACT float since = contact_root(c);
    EXACT float soonest = -INTERACT(ahead_s);
    return c.opening < 0.0f && speed_square <= INTERACT(fastest_square) && under > 0.0f &&
           since >= soonest;
}

/* Returns whether two bodies are within the width of a cell and approach each other. Others do not
 * meet within the step. */
FN bool contact_closes(CROWD_PARAM S(kiln_body) a, S(kiln_body) b)
{
    EXACT float3 from = body_position(a);
    EXACT float3 to = body_position(b);
    EXACT float3 apart = float3_sub(to, from);
    EXACT float square = float3_dot(apart, apart);
    EXACT float cells = INTERACT(cells_per_metre);
    EXACT float cells_square = (square * cells) * cells;
    EXACT float3 slow = body_velocity(a);
    EXACT float3 fast = body_velocity(b);
    EXACT float3 parting = float3_sub(fast, slow);
    EXACT float opening = float3_dot(apart, parting);
    return cells_square < 1.0f && opening < 0.0f;
}

/* Returns whether two bodies will meet within the step. */
FN bool contact_is_ahead(CROWD_PARAM S(kiln_body) a, S(kiln_body) b)
{
    if (!(INTERACT(ahead_s) > 0.0f) || !contact_closes(CROWD a, b) || !(body_radius(a) > 0.0f) ||
        !(body_radius(b) > 0.0f))
        return false;
    EXACT S(contact) c = contact_of(a, b);
    bool comes = contact_comes(CROWD c);
    return comes;
}

/* Returns the rank of a pair; lower pairs collide first. First come pairs that approach, before
 * pairs that only overlap, both by their distance. Pairs that will meet come last. */
FN uint contact_rank(S(contact) c, float ahead_s)
{
    EXACT float square = c.reach * c.reach;
    EXACT float nearness = exact_div(c.square, square);
    if (c.square >= square) {
        EXACT float wait = exact_div(-contact_root(c), ahead_s);
        nearness = 1.0f + wait;
    }
    uint later = c.opening < 0.0f ? 0u : EXACT_SIGN_BIT;
    return FLOAT_BITS(nearness) | later;
}

/* The best partner so far. */
struct contact_choice {
    uint rank;
    uint low, high; /* slots of the pair; of equal ranks, the pair with lower slots comes first */
    uint partner;   /* index of a body */
};

FN S(contact_choice) contact_no_choice(void)
{
    S(contact_choice) choice;
    choice.rank = INTERACT_NOBODY;
    choice.low = INTERACT_NOBODY;
    choice.high = INTERACT_NOBODY;
    choice.partner = INTERACT_NOBODY;
    return choice;
}

FN S(contact_choice) contact_choose(CROWD_PARAM S(contact_choice) best, S(kiln_body) a,
                                    S(kiln_body) b, uint at)
{
    uint mine = a.velocity_slot.w;
    uint other = b.velocity_slot.w;
    if (mine == other || (!contact_is_near(a, b) && !contact_is_ahead(CROWD a, b)))
        return best;
    EXACT S(contact) c = contact_of(a, b);
    S(contact_choice) choice;
    choice.rank = contact_rank(c, INTERACT(ahead_s));
    choice.low = mine < other ? mine : other;
    choice.high = mine < other ? other : mine;
    choice.partner = at;
    bool better = choice.rank < best.rank ||
                  (choice.rank == best.rank &&
                   (choice.low < best.low || (choice.low == best.low && choice.high < best.high)));
    if (better)
        return choice;
    return best;
}

FN S(contact_choice) contact_choose_among(CROWD_PARAM S(contact_choice) best, S(kiln_body) a,
                                          uint begin, uint end)
{
    S(contact_choice) choice = best;
    for (uint k = begin; k < end; k++)
        choice = contact_choose(CROWD choice, a, BODY(k), k);
    return choice;
}

/* Finds the closest of all bodies that a body touches: in the 27 cells around it, which are nine
 * rows of three neighbours in the table; a row may wrap around at the table's ends. A cell of the
 * table may hold several cells of space, which only costs time. */
FN uint contact_find(CROWD_PARAM uint self)
{
    S(kiln_body) a = BODY(self);
    EXACT float3 p = body_position(a);
    int x = cell_along(p.x, INTERACT(cells_per_metre));
    int y = cell_along(p.y, INTERACT(cells_per_metre));
    int z = cell_along(p.z, INTERACT(cells_per_metre));
    S(contact_choice) best = contact_no_choice();
    for (int row = 0; row < 9; row++) {
        uint start = cell_row(y + row % 3 - 1, z + row / 3 - 1);
        uint first = cell_in_row(CROWD start, x - 1);
        uint last = cell_in_row(CROWD start, x + 1);
        uint begin = cell_begin(CROWD first);
        uint end = CELL_END(last);
        if (last < first) {
            best = contact_choose_among(CROWD best, a, 0u, end);
            end = CELL_END(INTERACT(cell_mask));
        }
        best = contact_choose_among(CROWD best, a, begin, end);
    }
    return best.partner;
}

/* Returns the result of a search in a later round. */
FN uint contact_later(uint partner)
{
    return partner == INTERACT_NOBODY ? INTERACT_NOBODY_NOW : partner;
}

/* ---- response ------------------------------------------------------------------------------- */

/* Returns the part of a change that the first of two bodies gets: the mass of the second divided by
 * that of both, for balls of one material. */
FN float contact_share(S(kiln_body) a, S(kiln_body) b)
{
    EXACT float mine = body_radius(a);
    EXACT float other = body_radius(b);
    EXACT float mass = (mine * mine) * mine;
    EXACT float other_mass = (other * other) * other;
    EXACT float both = mass + other_mass;
    EXACT float y = mass == other_mass ? 0.5f : exact_div(other_mass, both);
    return y;
}

/* Returns the time since contact, at most a step. */
FN float contact_since(S(contact) c, float dt_s)
{
    EXACT float t = contact_root(c);
    EXACT float soonest = c.square < c.reach * c.reach ? 0.0f : -dt_s;
    EXACT float y = exact_clamp(t, soonest, dt_s);
    return y;
}

/* Returns the direction in which two bodies at one place part. The two bodies of a pair get
 * opposite directions. */
FN float3 contact_any_normal(S(kiln_body) a, S(kiln_body) b)
{
    EXACT float side = a.velocity_slot.w < b.velocity_slot.w ? 1.0f : -1.0f;
    EXACT float3 y = FLOAT3(0.0f, side, 0.0f);
    return y;
}

/* Two bodies at the time when they began to touch, as the first sees the second. */
struct contact_blow {
    float3 apart;  /* from the first to the second, m */
    float3 normal; /* unit vector of `apart` */
    float since_s; /* seconds since then */
    float towards; /* m/s along the normal */
    float bounce;  /* m/s: change of that velocity */
};

FN S(contact_blow) contact_blow_of(S(contact) c, float3 otherwise, float restitution, float dt_s)
{
    EXACT S(contact_blow) blow;
    bool approach = c.opening < 0.0f;
    blow.since_s = approach ? contact_since(c, dt_s) : 0.0f;
    blow.apart = float3_add_scaled(c.apart, c.parting, -blow.since_s);
    blow.normal = float3_normalize(blow.apart, otherwise);
    EXACT float away = float3_dot(c.parting, blow.normal);
    blow.towards = approach && away < 0.0f ? -away : 0.0f;
    blow.bounce = blow.towards + blow.towards * restitution;
    return blow;
}

/* Returns the first of two bodies that touch, after their collision. `restitution` 1 keeps all
 * energy. Of a remaining overlap, the part `apart` is removed. */
FN S(kiln_body) contact_answer(S(kiln_body) a, S(kiln_body) b, float restitution, float apart,
                               float dt_s)
{
    EXACT S(contact) c = contact_of(a, b);
    EXACT float share = contact_share(a, b);
    EXACT float3 otherwise = contact_any_normal(a, b);
    EXACT S(contact_blow) blow = contact_blow_of(c, otherwise, restitution, dt_s);
    EXACT float since_s = blow.since_s;
    EXACT float change = -(blow.bounce * share);
    EXACT float3 position = body_position(a);
    EXACT float3 velocity = body_velocity(a);
    EXACT float3 normal = blow.normal;
    EXACT float3 faster = float3_add_scaled(velocity, normal, change);
    EXACT float moved = change * since_s;
    EXACT float distance = float3_length(blow.apart) + (blow.towards * restitution) * since_s;
    EXACT float overlap = c.reach - distance;
    EXACT float rest = overlap > 0.0f && since_s >= 0.0f ? overlap : 0.0f;
    EXACT float freed = (rest * apart) * share;
    EXACT float shift = moved - freed;
    EXACT float3 farther = float3_add_scaled(position, normal, shift);
    S(kiln_body) after = body_with_motion(a, farther, faster);
    if (since_s < 0.0f)
        return body_done(after);
    return after;
}

/* ---- spin (UberFlow 2004, 4.5) -------------------------------------------------------------- */

/* A body and its spin, rad/s. */
struct contact_turning {
    S(kiln_body) body;
    float3 rate;
};

/* Returns the change of the second body's velocity by friction between two balls with these spins,
 * as if the first had all the mass. The two balls of a pair get opposite changes. */
FN float3 contact_rub(S(contact) c, S(contact_blow) blow, float3 skins, float friction)
{
    EXACT float away = -float3_dot(c.parting, blow.normal);
    EXACT float3 aside = float3_add_scaled(c.parting, blow.normal, away);
    EXACT float3 turning = float3_cross(skins, blow.normal);
    EXACT float3 slip = float3_sub(aside, turning);
    EXACT float most = friction * blow.bounce;
    EXACT float3 y = spin_grip(slip, most);
    return y;
}

/* Returns the first of two bodies that spin, after their collision: contact_answer, and friction at
 * the point of contact. Both are moved back in time to the contact for it, so that angular momentum
 * is kept as well. */
FN S(contact_turning) contact_answer_turning(CROWD_PARAM S(contact_turning) a, S(contact_turning) b)
{
    EXACT S(contact_turning) after;
    EXACT float dt_s = INTERACT(derived.dt_s);
    after.body = contact_answer(a.body, b.body, INTERACT(restitution), INTERACT(apart), dt_s);
    EXACT S(contact) c = contact_of(a.body, b.body);
    EXACT float3 otherwise = contact_any_normal(a.body, b.body);
    EXACT S(contact_blow) blow = contact_blow_of(c, otherwise, INTERACT(restitution), dt_s);
    EXACT float radius = body_radius(a.body);
    EXACT float3 mine = float3_scale(a.rate, radius);
    EXACT float3 other = float3_scale(b.rate, body_radius(b.body));
    /* m/s: sum of the surface velocities about the two centres */
    EXACT float3 skins = float3_add(mine, other);
    EXACT float3 rub = contact_rub(c, blow, skins, INTERACT(friction));
    EXACT float share = contact_share(a.body, b.body);
    EXACT float3 part = float3_scale(rub, share);
    EXACT float3 velocity = body_velocity(after.body);
    EXACT float3 position = body_position(after.body);
    EXACT float3 slower = float3_sub(velocity, part);
    EXACT float3 shifted = float3_add_scaled(position, part, -blow.since_s);
    after.body = body_with_motion(after.body, shifted, slower);
    EXACT float3 spin_change = spin_from(part, blow.normal, radius);
    EXACT float3 rate = float3_add(a.rate, spin_change);
    after.rate = spin_held(rate);
    return after;
}

/* Does contact_after for bodies that spin. */
FN S(contact_turning) contact_after_turning(CROWD_PARAM uint self)
{
    EXACT S(contact_turning) a;
    a.body = BODY(self);
    a.rate = spin_rate(TURNING(self));
    uint partner = PARTNER(self);
    if (partner >= INTERACT_NOBODY_NOW)
        return a;
    if (PARTNER(partner) != self)
        return a;
    EXACT S(contact_turning) b;
    b.body = BODY(partner);
    b.rate = spin_rate(TURNING(partner));
    EXACT S(contact_turning) after = contact_answer_turning(CROWD a, b);
    return after;
}

/* ---- rounds --------------------------------------------------------------------------------- */

/* Returns a body after a round: it changes if it and its partner are each other's closest. */
FN S(kiln_body) contact_after(CROWD_PARAM uint self)
{
    S(kiln_body) a = BODY(self);
    uint partner = PARTNER(self);
    if (partner >= INTERACT_NOBODY_NOW)
        return a;
    if (PARTNER(partner) != self)
        return a;
    S(kiln_body)
    after = contact_answer(a, BODY(partner), INTERACT(restitution), INTERACT(apart),
                           INTERACT(derived.dt_s));
    return after;
}

#endif
