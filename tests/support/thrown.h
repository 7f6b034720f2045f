/* Throws particles at colliders that a test has put into a scene, and checks where the particles
 * bounce, and that no particle gets faster or passes through. */
#ifndef KILN_TESTS_THROWN_H
#define KILN_TESTS_THROWN_H

#include "support/scene_fixture.h"

/* The scene that all functions below use. It is global, since it is too large for a stack. */
extern struct scene_fixture fixture;

/* Fails if a number differs from the expected one by more than `allowed`, or is a NaN. */
void assert_near(double found, double expected, double allowed);

/* Makes a new scene in `fixture` with one particle, which starts at time 0 at `from`, m, with a
 * velocity, m/s. The particle lives for 10 s, and collides. Returns the particle's system, so that
 * the test can change it. Afterwards the test adds colliders. */
struct kiln_system *one_particle(float3 from, float3 velocity);

/* Runs the scene for some steps of 1/60 s and returns its first particle, which must be alive. */
struct kiln_particle after(uint32_t steps);

/* Does what one_particle does, for arrays of doubles. from: m; v: velocity, m/s. */
struct kiln_system *throw_one(const double from[3], const double v[3]);

/* Does what throw_one does, with a particle that keeps half of its speed at an impact. */
struct kiln_system *shoot(const double from[3], const double v[3]);

/* Makes a scene with one particle at `from`, m, that hardly moves: it starts with 0.1 mm/s. */
struct kiln_system *rest_at(const double from[3]);

/* Runs the scene of `shoot`, with the same from and v, for half a second. Fails unless the particle
 * was reflected once, at the time time_s, s, by a surface with the unit vector `normal`. */
void expect_mirror(const double from[3], const double v[3], const double normal[3], double time_s);

/* Makes a scene with `count` particles that start about 3 m above the origin. They fly downwards
 * within a cone of 0.7 rad, at random speeds from 0.1 * speed to speed, m/s, and fall with the
 * acceleration `gravity`, m/s^2. */
void a_crowd_around(uint32_t count, float speed, float gravity);

/* Runs the scene of a_crowd_around, of at most 1000 particles without gravity, for 21 steps. Fails
 * if a particle gets faster or comes within `nearest`, m, of the origin. Also fails unless more
 * than 100 impacts take a tenth of a particle's speed or more, which shows that particles do hit
 * something. */
void no_bounce_makes_faster(float nearest);

/* A function that returns whether the point p, m, is inside of an object at a time, s. */
typedef bool in_object(const struct kiln_scene *scene, const struct kiln_object *object, float3 p,
                       float time_s);

/* Runs `steps` steps of the scene. Fails if a particle of a system with swept collision is inside
 * of an object at the end of a step. Particles of other systems show that there are objects in the
 * way: they must be found inside more than 100 times. */
void nobody_ends_inside(uint32_t steps, in_object *is_inside);

#endif
