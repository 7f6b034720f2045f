/* Recomputes the values of a particle that its record does not have from its serial and its birth
 * (docs/determinism.md, 4). Simulation and drawing share it. */
#ifndef KILN_SHARED_DERIVED_H
#define KILN_SHARED_DERIVED_H

#include "shared/layout.h"
#include "shared/particle.h"
#include "shared/random.h"
#include "shared/uses.h"

/* Returns the particle's stream of random numbers. */
FN uint particle_stream(S(kiln_derived_params) d, S(kiln_particle) p)
{
    return random_stream(d.random_key, p.position_serial.w);
}

/* Returns the clip time after a part of the step of a particle's birth, s. */
FN float particle_birth_time_at(S(kiln_derived_params) d, S(kiln_particle) p, float part)
{
    EXACT float before = FLOAT(particle_birth_step(p) - 1u) - FLOAT(d.warmup_steps);
    EXACT float steps = before + part;
    EXACT float time_s = steps * d.dt_s;
    return time_s;
}

/* Returns the clip time of a particle's birth, s. */
FN float particle_birth_time(S(kiln_derived_params) d, S(kiln_particle) p)
{
    return particle_birth_time_at(d, p, particle_birth_fraction(p));
}

/* Returns the length of a particle's life, s. */
FN float particle_life_s(VALUE_KEYS_PARAM S(kiln_derived_params) d, S(kiln_particle) p)
{
    EXACT float born_s = particle_birth_time(d, p);
    uint stream = particle_stream(d, p);
    EXACT S(value_clocks) clocks = value_clocks_of_birth(born_s, d.random_key, d.scene_key, stream);
    EXACT float low = VALUE_OF(KEYED_LIFE, VALUE_KEYS d.life.min, clocks);
    EXACT float high = VALUE_OF(KEYED_LIFE, VALUE_KEYS d.life.max, clocks);
    EXACT float life_s = random_between(stream, RANDOM_LIFE, low, high);
    return life_s;
}

/* Returns the part of a particle's life that has passed at an age: 0 at birth, 1 at death. */
FN float particle_progress(float age_s, float life_s)
{
    EXACT float part = exact_div(age_s, life_s);
    EXACT float progress = exact_clamp(part, 0.0f, 1.0f);
    return progress;
}

/* Returns the clocks of a particle with those of its parent at its birth, which its look may
 * inherit. of_parent: the parameters of the parent's system; parent: the parent, or what is left of
 * it. */
FN S(value_clocks) particle_clocks_of_child(VALUE_KEYS_PARAM S(value_clocks) clocks,
                                            S(kiln_derived_params) of_parent,
                                            S(kiln_particle) parent, S(kiln_particle) child)
{
    EXACT S(value_clocks) y = clocks;
    EXACT float life_s = particle_life_s(VALUE_KEYS of_parent, parent);
    EXACT float whole = FLOAT(particle_birth_step(child) - particle_birth_step(parent));
    EXACT float part = particle_birth_fraction(child) - particle_birth_fraction(parent);
    EXACT float steps = whole + part;
    EXACT float age_s = steps * of_parent.dt_s;
    y.parent_age_s = exact_max(age_s, 0.0f);
    y.parent_life = particle_progress(y.parent_age_s, life_s);
    y.parent_stream = particle_stream(of_parent, parent);
    return y;
}

#endif
