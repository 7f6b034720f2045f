/* One particle thrown at what a test has put there. */
#ifndef KILN_TESTS_THROWN_H
#define KILN_TESTS_THROWN_H

#include "support/scene_fixture.h"

/* The scene of what is thrown; too large for a stack. */
extern struct scene_fixture fixture;

void assert_near(double found, double expected, double allowed);

/* One particle that starts at time 0 with a velocity, and its state some steps later. */
struct kiln_system *one_particle(float3 from, float3 velocity);
struct kiln_particle after(uint32_t steps);
struct kiln_system *throw_one(const double from[3], const double v[3]);

/* At half speed after an impact. */
struct kiln_system *shoot(const double from[3], const double v[3]);

/* Next to nothing is its speed. */
struct kiln_system *rest_at(const double from[3]);

/* The particle after half a second, when it met a surface with this normal at a time. */
void expect_mirror(const double from[3], const double v[3], const double normal[3], double time_s);

/* Falls and flies from above the origin in all directions down. */
void a_crowd_around(uint32_t count, float speed, float gravity);

/* For 20 steps of a crowd of at most 1000: no bounce adds speed, which some take, and nobody comes
 * nearer to the origin than that, m. */
void no_bounce_makes_faster(float nearest);

typedef bool in_object(const struct kiln_scene *scene, const struct kiln_object *object, float3 p,
                       float time_s);

/* At the end of no step of the fixture's scene is anybody in an object who collides by paths; some
 * are who do not. */
void nobody_ends_inside(uint32_t steps, in_object *is_inside);

#endif
