/* This header declares living particles as the host sees them, for results that sum over all of
 * them: the light of fire, the shadow of smoke. */
#ifndef KILN_DRAW_MOMENT_LIVING_H
#define KILN_DRAW_MOMENT_LIVING_H

#include "draw/moment/moment.h"
#include "shared/instance.h"

/* Holds the data from which the particles of one system are computed. */
struct kiln_living_system {
    struct kiln_derived_params derived;
    const float4 *keys;
    const struct kiln_particle *records; /* of the system */
    const float4 *rows;                  /* of its look */
    uint32_t used;                       /* slots to ask for: 0 .. used - 1 */
    uint32_t step;
    float dt_s;
    const struct kiln_spin *spins; /* of the system; NULL: collisions do not turn its particles */
};

struct kiln_living {
    float3 position; /* m */
    float radius;    /* m: half of the billboard's edge */
    float progress;  /* through its life, 0 to 1 */
    float opacity;   /* at this age, fades included */
};

/* Returns the data from which the particles of one system are computed. The moment was filled with
 * on_host, and must outlive the result. */
struct kiln_living_system kiln_living_system(const struct kiln_moment *moment, uint32_t index);

/* Computes the particle in a slot; returns false when no particle lives there. */
bool kiln_living_at(const struct kiln_living_system *system, uint32_t slot,
                    struct kiln_living *particle);

/* Returns a row of the system's look (KILN_LOOK_*) at a progress through life. */
float4 kiln_living_look(const struct kiln_living_system *system, uint32_t row, float progress);

/* Returns the orientation of a sphere in the world, as collisions or its own spin have turned
 * it. */
float4 kiln_living_pose(const struct kiln_living_system *system, uint32_t slot, float progress);

/* Returns the axes in the world of a mesh whose look has this enum kiln_orient. */
struct instance_axes kiln_living_axes(const struct kiln_living_system *system, uint32_t slot,
                                      float progress, uint32_t orient);

/* Returns the light that a particle emits, the mean of its hot and cool parts. */
float3 kiln_living_glow(const struct kiln_living_system *system, float progress);

#endif
