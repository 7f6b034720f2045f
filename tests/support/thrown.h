/* Throws particles at the colliders that a test has put into a scene. */
#ifndef KILN_TESTS_THROWN_H
#define KILN_TESTS_THROWN_H

#include "support/scene_fixture.h"

/* The scene of the particles. It is static, since it is too large for a stack. */
extern struct scene_fixture fixture;

/* Fails if a number differs from the expected one by more than `allowed`. */
void assert_near(double found, double expected, double allowed);

/* Makes a new scene with one particle that starts at time 0 with a velocity, m/s. */
struct kiln_system *one_particle(float3 from, float3 velocity);

/* Runs the scene for some steps and returns its first particle. */
struct kiln_particle after(uint32_t steps);

/* Does what one_particle does. */
struct kiln_system *throw_one(const double from[3], const double v[3]);

/* Does what throw_one does; the particle keeps half of its speed at an impact. */
struct kiln_system *shoot(const double from[3], const double v[3]);

/* Makes a scene with one particle that hardly moves. */
struct kiln_system *rest_at(const double from[3]);

/* Runs the scene of `shoot` for half a second, and fails unless the particle was mirrored at time_s
 * by a surface with this normal. */
void expect_mirror(const double from[3], const double v[3], const double normal[3], double time_s);

/* Makes a scene with `count` particles that start 3 m above the origin and fly downwards, spread
 * over an angle, with up to `speed` m/s and gravity, m/s^2. */
void a_crowd_around(uint32_t count, float speed, float gravity);

/* Runs a crowd of at most 1000 particles for 20 steps. Fails if a particle gets faster, if fewer
 * than about a hundred impacts take speed, or if a particle comes nearer to the origin than
 * `nearest`, m.
 */
void no_bounce_makes_faster(float nearest);

/* Returns whether a place is inside of an object at a time. */
typedef bool in_object(const struct kiln_scene *scene, const struct kiln_object *object, float3 p,
                       float time_s);

/* Runs the scene. Fails if at the end of a step a particle of a system with swept collision is
 * inside of an object, or if hardly any particle of other systems is. */
void nobody_ends_inside(uint32_t steps, in_object *is_inside);

#endif
