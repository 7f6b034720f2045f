/* Computes the state hash (docs/determinism.md, 5): two sums over the living particles of a hash of
 * (system, serial, words). Layout, order and dead particles do not change it. */
#ifndef KILN_SHARED_STATE_HASH_H
#define KILN_SHARED_STATE_HASH_H

#include "shared/particle.h"
#include "shared/random.h"

struct state_hash_lanes {
    uint a, b;
};

FN S(state_hash_lanes) state_hash_word(S(state_hash_lanes) lanes, uint word)
{
    S(state_hash_lanes) mixed;
    mixed.a = random_mix(lanes.a ^ word);
    mixed.b = random_mix(lanes.b + word * 0x9e3779b9u);
    return mixed;
}

/* Returns the words that a particle, or what is left of one, adds to the two sums; zero for an
 * empty slot. */
FN S(state_hash_lanes) state_hash_particle(uint system, S(kiln_particle) p)
{
    S(state_hash_lanes) lanes;
    lanes.a = 0u;
    lanes.b = 0u;
    if (!particle_is_there(p))
        return lanes;
    lanes.a = system + 0x6b696c6eu;
    lanes.b = system + 0x7374617eu;
    lanes = state_hash_word(lanes, p.position_serial.x);
    lanes = state_hash_word(lanes, p.position_serial.y);
    lanes = state_hash_word(lanes, p.position_serial.z);
    lanes = state_hash_word(lanes, p.position_serial.w);
    lanes = state_hash_word(lanes, p.velocity_birth.x);
    lanes = state_hash_word(lanes, p.velocity_birth.y);
    lanes = state_hash_word(lanes, p.velocity_birth.z);
    lanes = state_hash_word(lanes, p.velocity_birth.w);
    return lanes;
}

/* Returns the words that a particle's spin or way adds to the two sums; zero for a dead particle.
 */
FN S(state_hash_lanes) state_hash_spin(uint system, S(kiln_particle) p, S(kiln_spin) s)
{
    S(state_hash_lanes) lanes;
    lanes.a = 0u;
    lanes.b = 0u;
    if (!particle_is_alive(p))
        return lanes;
    lanes.a = system + 0x7370696eu;
    lanes.b = system + 0x726f6c6cu;
    lanes = state_hash_word(lanes, p.position_serial.w);
    lanes = state_hash_word(lanes, s.rate.x);
    lanes = state_hash_word(lanes, s.rate.y);
    lanes = state_hash_word(lanes, s.rate.z);
    lanes = state_hash_word(lanes, s.pose.x);
    lanes = state_hash_word(lanes, s.pose.y);
    lanes = state_hash_word(lanes, s.pose.z);
    lanes = state_hash_word(lanes, s.pose.w);
    return lanes;
}

#endif
