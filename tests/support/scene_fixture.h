/* Builds scenes in C, for tests of stages that take a loaded scene. */
#ifndef KILN_TESTS_SCENE_FIXTURE_H
#define KILN_TESTS_SCENE_FIXTURE_H

#include "scene/scene.h"

struct scene_fixture {
    struct kiln_scene scene;
    float4 keys[KILN_MAX_VALUE_KEYS];
};

/* Makes an empty scene: 300 frames at 60 a second, with one step each. Before the first call, *f
 * must be all zeros. */
void fixture_init(struct scene_fixture *f);

struct kiln_value fixture_constant(float x);

/* Returns a value with keys (x, y) over a clock (KILN_CLOCK_*). */
struct kiln_value fixture_keys(struct scene_fixture *f, uint32_t clock, uint32_t count,
                               const float (*points)[2]);

/* Returns a value that goes from y0 at x0 to y1 at x1; x is in seconds or parts of the life. */
struct kiln_value fixture_ramp(struct scene_fixture *f, uint32_t clock, float x0, float y0,
                               float x1, float y1);

struct kiln_value3 fixture_constant3(float x, float y, float z);
struct kiln_range fixture_range(float min, float max);

/* Adds a system that emits `rate` particles a second upwards from the origin; they live for 1 to 2
 * s.
 */
struct kiln_system *fixture_add_system(struct scene_fixture *f, const char *name, float rate);

struct kiln_force *fixture_add_force(struct kiln_system *system, enum kiln_force_kind kind);
struct kiln_object *fixture_add_box(struct scene_fixture *f, float x, float y, float z, float width,
                                    float height, float depth);
struct kiln_object *fixture_add_sphere(struct scene_fixture *f, float x, float y, float z,
                                       float radius);

/* Adds an upright cylinder; a test may change its axis. */
struct kiln_object *fixture_add_cylinder(struct scene_fixture *f, float x, float y, float z,
                                         float radius, float height);

/* Adds an upright capsule; a test may change its axis. */
struct kiln_object *fixture_add_capsule(struct scene_fixture *f, float x, float y, float z,
                                        float radius, float height);

/* Adds a plane whose normal is up; a test may change its axis. */
struct kiln_object *fixture_add_plane(struct scene_fixture *f, float x, float y, float z);

/* Adds terrain of noise around the origin, with hills half a metre wide. */
struct kiln_object *fixture_add_terrain(struct scene_fixture *f, float y, float width, float height,
                                        uint32_t samples);

/* Adds a mesh that particles collide with: an OBJ file, not scaled. */
struct kiln_object *fixture_add_mesh(struct scene_fixture *f, const char *file, float x, float y,
                                     float z);

/* Makes particles collide with a mesh by its depth maps along x, y and z. */
void fixture_map_depths(struct kiln_object *mesh, uint32_t resolution);

/* Adds a mesh that moves, turns and grows. */
struct kiln_object *fixture_add_moving_mesh(struct scene_fixture *f);

/* Adds two moving meshes whose colliders are volumes of planes, with one side and with two. */
void fixture_add_moving_volumes(struct scene_fixture *f);

/* Adds a system as fixture_add_system does, but its particles are born of those of system `parent`.
 */
struct kiln_system *fixture_add_child(struct scene_fixture *f, const char *name, uint32_t parent,
                                      enum kiln_event event, uint32_t count);

/* Gives every system the slots that it needs for `steps` steps. */
void fixture_finish(struct scene_fixture *f, uint32_t steps);

/* ---- one scene with everything in it -------------------------------------------------------- */

void fixture_zoo_backdrop(struct scene_fixture *f);

/* Adds a sphere that moves and a cylinder that grows. */
void fixture_add_round(struct scene_fixture *f);

/* What turns, beside what there is, and surfaces that rub. */
void fixture_add_oriented(struct scene_fixture *f);

/* Adds the wind of a file to a system: velocity (-2 z, 0.5 + 0.3 y, 2 x), for x from -1.5 to 1.5, y
 * from -0.5 to 1.9 and z from -1.5 to 1.5. */
struct kiln_force *fixture_add_field(struct kiln_system *system);

/* Makes the particles of a system collide with each other as balls. */
struct kiln_interaction *fixture_add_collisions(struct kiln_system *system, float radius);

/* Makes the particles of a system attract each other. */
struct kiln_interaction *fixture_add_gravity(struct kiln_system *system, float strength);

/* Makes the particles of a system a flock. */
struct kiln_flock *fixture_add_flock(struct kiln_system *system, float radius);

/* Makes a scene with every emitter, force, collider and kind of value, with slots for `steps`
 * steps.
 */
void fixture_zoo(struct scene_fixture *f, enum kiln_integration integration, uint32_t steps);

enum { FIXTURE_MAX_FORCE_KINDS = 64 };

/* Writes every kind of force that a scene may have, each once, and returns how many there are. */
uint32_t fixture_force_kinds(enum kiln_force_kind kinds[FIXTURE_MAX_FORCE_KINDS]);

/* Makes a scene of 1500 particles under one force of a kind. No option of the force is 0, so that
 * each counts that the kind has; words are the first of their lists. */
void fixture_alone(struct scene_fixture *f, enum kiln_force_kind kind, uint32_t steps);

/* Adds two systems: one with points that attract and repel by every falloff, with quadratic drag;
 * and one with vortices of each profile, one of which adds its velocity. Call fixture_finish after
 * it. */
void fixture_add_whirls(struct scene_fixture *f);

#endif
