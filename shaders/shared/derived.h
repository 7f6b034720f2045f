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

#endif
