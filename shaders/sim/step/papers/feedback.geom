/* Technique `feedback` (Heinz 2019, 3.3.3, algorithm 3.1, lines 9 to 13): moves one particle and
 * writes it to the stream; dead particles are left out, but for what children need of their
 * parents. A slot that a particle is born into in this step is skipped, since feedback_emit.geom
 * writes it. With FAMILY, children are born in this shader, since each has a slot of its own. */
// variant:
// variant: FAMILY=1
// variant: GRIDS=1
// variant: GRIDS=1 SOURCES=1
// variant: GRIDS=1 FAMILY=1
// variant: COLLIDE_RUB=1
// variant: GRIDS=1 FAMILY=1 COLLIDE_RUB=1
// variant: COLLIDE_FIELD=1 GRIDS=1
// variant: COLLIDE_DEPTH=1 COLLIDE_FIELD=1 GRIDS=1
// variant: PUSHES=1 COLLIDE_FIELD=1 GRIDS=1 FAMILY=1
// variant: COLLIDE_VOLUME=1
// variant: PUSHES=1 COLLIDE_VOLUME=1 COLLIDE_FIELD=1 GRIDS=1 FAMILY=1
// variant: PUSHES=1
// variant: SPINS=1 PUSHES=1 COLLIDE_RUB=1
// variant: SPINS=1 PUSHES=1 COLLIDE_FIELD=1 GRIDS=1 FAMILY=1 COLLIDE_RUB=1
// variant: PUSHES=1 GRIDS=1 FAMILY=1
// variant: FORCES_ALL=1
// variant: FORCES_ALL=1 FAMILY=1
// variant: FORCES_ALL=1 GRIDS=1
// variant: FORCES_ALL=1 GRIDS=1 FAMILY=1
// variant: SWEEP_ALL=1
// variant: SWEEP_ALL=1 FORCES_ALL=1 GRIDS=1 FAMILY=1 PUSHES=1
layout(points) in;
layout(points, max_vertices = 1) out;

#include "sim/step/papers/feedback.glsl"

void main()
{
    uint slot = vertices[0].number;
    if (step_birth_index(slot) < step_params.birth_count)
        return;
    kiln_particle p;
    p.position_serial = vertices[0].position_serial;
    p.velocity_birth = vertices[0].velocity_birth;
#ifdef FAMILY
    p = slot_after(slot, p);
#else /* without births, whose code would slow down every particle */
    if (particle_is_alive(p))
        p = step_particle(p, push_of(slot));
#endif
    if (particle_is_there(p))
        write_particle(p);
}
