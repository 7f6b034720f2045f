/* Places one corner of a triangle of a particle that is drawn as a mesh (Drone 2007, 7.4.4). The
 * particle's position, size and rotation follow from its record, its look and the clock.
 * lib/draw/solids/instances_gl.c makes one instanced draw call for each system with a mesh. An
 * instance is an entry of the drawing order, which has the particles of all systems, so instances
 * of other systems are moved out of view. A mesh is opaque and cannot fade; its opacity scales it
 * instead.
 *
 * Every corner computes the whole triangle, since the fragment shader needs all three corners. The
 * outputs must be the inputs of instances.frag. The processor places particles by the same
 * functions of shared/instance.h. */
#include "shared/draw_layout.h"

// variant:
// variant: SPINS=1
// variant: LOOK_VALUES=1
// variant: LOOK_VALUES=1 LOOK_SOURCES=1
// variant: LOOK_VALUES=1 LOOK_PARENTS=1
#include "draw/moment/record.glsl"
#include "draw/solids/pose.glsl"

/* Corners of the meshes of all systems, three for each triangle; a corner is a position and a
 * normal. */
layout(std430, binding = KILN_BIND_CORNERS) readonly buffer corner_block { vec4 corners[]; };

uniform uint drawn_system; /* the system whose particles this draw call draws */
uniform uint first_corner; /* number of the first corner of the system's mesh in `corners` */
uniform uint orient; /* ORIENT_* */
/* x: distance from the mesh's middle to its farthest corner; y: radius of the sphere that throws
 * its shadow. Both are in sizes of the particle. */
uniform vec2 extent;

layout(location = 0) flat out vec4 a; /* corners in view space, m */
layout(location = 1) flat out vec4 b;
layout(location = 2) flat out vec4 c;
layout(location = 3) flat out vec4 normal_a;
layout(location = 4) flat out vec4 normal_b;
layout(location = 5) flat out vec4 normal_c;
layout(location = 6) flat out vec4 middle;        /* of the particle, in view space; w: radius of
                                                   * the sphere that throws its shadow, m */
layout(location = 7) flat out vec4 reflected;     /* albedo; a: from 1, which is lit, to 0, which
                                                   * shows the albedo as it is */
layout(location = 8) flat out vec4 emitted;       /* radiance; a: part of what it fills that it
                                                   * covers */
layout(location = 9) flat out vec4 bloom_weights; /* rgb: weights of the light in the bloom target */

vec3 world_to_view_vector(vec3 v)
{
    return vec3(dot(view.world_to_view[0].xyz, v), dot(view.world_to_view[1].xyz, v),
                dot(view.world_to_view[2].xyz, v));
}

/* Returns whether a triangle is seen from its front or its back. A triangle that is seen edge on
 * covers no pixel, and its depth cannot be computed. */
bool is_seen(vec3 p, vec3 q, vec3 r)
{
    vec3 face = cross(q - p, r - p);
    float volume = dot(p, face);
    return volume * volume > 1e-10 * dot(face, face) * dot(p, p);
}

void main()
{
    uint entry = entries[gl_InstanceID];
    uint system = KILN_ENTRY_SYSTEM(entry);
    kiln_particle record = records[KILN_ENTRY_SLOT(entry)];
    uint stream = particle_stream(looks[system].derived, record);
    float age = particle_age_before(record, view.clock_step.x, view.within.x, view.clock.y);
    float life = particle_progress(age, particle_life_s(looks[system].derived, record));
    LOOK_OF(system, record, stream, age, life)
    vec4 shape = look_at(system, KILN_LOOK_SHAPE, life);
    vec4 spread = look_at(system, KILN_LOOK_SPREAD, life);

    vec3 center = world_to_view_point(particle_position(record));
    float size = shape.x * mix(spread.x, spread.y, random_unit(stream, RANDOM_SCALE)) * shape.z;
    /* A mesh is at least as wide as a pixel. A smaller one would flicker, since it would lie
     * between the samples of some frames. */
    float pixel_m = 2.0 * view.frustum.y * max(-center.z, 1e-3) / view.frustum.w;
    float scale = max(size * extent.x, 0.5 * pixel_m) / extent.x;
    float angle = instance_angle(stream, look_at(system, KILN_LOOK_TURN, life), spread,
                                 particle_turned_s(record, age, view.clock.y));
    instance_axes axes = instance_axes_of(orient, particle_heading(record), angle, stream);
#ifdef SPINS
    if (looks[system].turn.w != 0u)
        axes = instance_posed(pose_of_slot(system, KILN_ENTRY_SLOT(entry)));
#endif
    mat3 turn = mat3(world_to_view_vector(axes.x), world_to_view_vector(axes.y),
                     world_to_view_vector(axes.z));

    uint corner = 2u * (first_corner + 3u * (uint(gl_VertexID) / 3u));
    a = vec4(turn * corners[corner].xyz * scale + center, 1.0);
    b = vec4(turn * corners[corner + 2u].xyz * scale + center, 1.0);
    c = vec4(turn * corners[corner + 4u].xyz * scale + center, 1.0);
    normal_a = vec4(turn * corners[corner + 1u].xyz, 0.0);
    normal_b = vec4(turn * corners[corner + 3u].xyz, 0.0);
    normal_c = vec4(turn * corners[corner + 5u].xyz, 0.0);
    middle = vec4(center, size * extent.y);
    reflected = look_at(system, KILN_LOOK_COVER, life);
    emitted.rgb = look_at(system, KILN_LOOK_HOT, life).rgb;
    emitted.a = size * size / (scale * scale);
    bloom_weights = look_at(system, KILN_LOOK_BLOOM, life);

    int k = gl_VertexID % 3;
    vec3 place = k == 0 ? a.xyz : k == 1 ? b.xyz : c.xyz;
    /* The near plane clips the triangle; the far plane is at infinity. */
    place.xy -= view.principal.zw * place.z;
    gl_Position = vec4(place.x / view.frustum.x, -place.y / view.frustum.y,
                       -place.z - 2.0 * view.eye.w, -place.z);
    /* This position is before the near plane, so that nothing is drawn. */
    if (system != drawn_system || !(size > 0.0) || !is_seen(a.xyz, b.xyz, c.xyz))
        gl_Position = vec4(0.0, 0.0, -2.0, 1.0);
}
