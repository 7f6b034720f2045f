/* Computes one opaque sphere from its record, its look and the clock, for solids_spheres.geom. A
 * sphere cannot fade; its opacity scales it instead. */
#include "shared/draw_layout.h"

// variant:
// variant: PATTERN=1
// variant: PATTERN=1 SPINS=1
// variant: PATTERN=1 LOOK_VALUES=1
// variant: PATTERN=1 LOOK_VALUES=1 LOOK_SOURCES=1
// variant: PATTERN=1 LOOK_VALUES=1 LOOK_PARENTS=1
#include "draw/moment/record.glsl"
#include "draw/solids/pose.glsl"

layout(location = 0) out vec4 center;        /* in view space; w: radius, m */
layout(location = 1) out vec4 reflected;     /* albedo; a: 1 if lit, 0 if unlit, or between */
layout(location = 2) out vec4 emitted;       /* radiance; a: part of what it fills that it covers */
layout(location = 3) out vec4 bloom_weights; /* weights of equation 3.2 */
#ifdef PATTERN
layout(location = 4) out vec4 second_albedo; /* of the pattern; a: segments of each colour;
                                              * 0: none, below 0: a stripe */
layout(location = 5) out vec4 ball_pose;     /* turns vectors from the ball to the world */
#endif

void main()
{
    uint entry = entries[gl_VertexID];
    uint system = KILN_ENTRY_SYSTEM(entry);
    kiln_particle record = records[KILN_ENTRY_SLOT(entry)];
    uint stream = particle_stream(looks[system].derived, record);
    float age = particle_age_before(record, view.clock_step.x, view.within.x, view.clock.y);
    float life = particle_progress(age, particle_life_s(looks[system].derived, record));
    LOOK_OF(system, record, stream, age, life)
    vec4 shape = look_at(system, KILN_LOOK_SHAPE, life);
    vec4 spread = look_at(system, KILN_LOOK_SPREAD, life);

    center.xyz = world_to_view_point(particle_position(record));
    float scale = mix(spread.x, spread.y, random_unit(stream, RANDOM_SCALE));
    float radius = looks[system].form.x == LOOK_MESH ? 0.0 : 0.5 * shape.x * scale * shape.z;
    /* A sphere is at least as wide as a pixel. A smaller one would flicker between the samples; it
     * covers only a part of what it fills. */
    float pixel_m = 2.0 * view.frustum.y * max(-center.z, 1e-3) / view.frustum.w;
    center.w = radius > 0.0 ? max(radius, 0.5 * pixel_m) : 0.0;
    reflected = look_at(system, KILN_LOOK_COVER, life);
    emitted.rgb = look_at(system, KILN_LOOK_HOT, life).rgb;
    emitted.a = radius * radius / max(center.w * center.w, 1e-30);
    bloom_weights = look_at(system, KILN_LOOK_BLOOM, life);
#ifdef PATTERN
    uvec4 turn = looks[system].turn;
    second_albedo = look_at(system, KILN_LOOK_OTHER, life);
    second_albedo.a = turn.z == LOOK_STRIPE ? -1.0 : float(int(turn.z) - int(LOOK_SEGMENTS));
    second_albedo.a = turn.z == LOOK_PLAIN ? 0.0 : second_albedo.a;
    float angle = instance_angle(stream, look_at(system, KILN_LOOK_TURN, life), spread,
                                 particle_turned_s(record, age, view.clock.y));
    ball_pose = instance_pose(stream, angle);
#ifdef SPINS
    if (turn.x != 0u)
        ball_pose = pose_of_slot(system, KILN_ENTRY_SLOT(entry));
#endif
#endif
}
