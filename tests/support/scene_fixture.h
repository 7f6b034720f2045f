/* Scenes built by hand, for tests of the stages behind the loader. */
#ifndef KILN_TESTS_SCENE_FIXTURE_H
#define KILN_TESTS_SCENE_FIXTURE_H

#include "scene/scene.h"

struct scene_fixture {
    struct kiln_scene scene;
    float4 keys[KILN_MAX_VALUE_KEYS];
};

/* An empty scene: 300 frames at 60 a second, one step each. Before the first time, all of it is
 * zeros. */
void fixture_init(struct scene_fixture *f);

struct kiln_value fixture_constant(float x);

/* A value through (x, y) pairs. */
struct kiln_value fixture_keys(struct scene_fixture *f, uint32_t clock, uint32_t count,
                               const float (*points)[2]);

/* From y0 at x0 to y1 at x1, in seconds or parts of the life. */
struct kiln_value fixture_ramp(struct scene_fixture *f, uint32_t clock, float x0, float y0,
                               float x1, float y1);

struct kiln_value3 fixture_constant3(float x, float y, float z);
struct kiln_range fixture_range(float min, float max);

/* A system that emits upwards from the origin, `rate` particles a second that live for 1 to 2 s. */
struct kiln_system *fixture_add_system(struct scene_fixture *f, const char *name, float rate);

struct kiln_force *fixture_add_force(struct kiln_system *system, enum kiln_force_kind kind);
struct kiln_object *fixture_add_box(struct scene_fixture *f, float x, float y, float z, float width,
                                    float height, float depth);
struct kiln_object *fixture_add_sphere(struct scene_fixture *f, float x, float y, float z,
                                       float radius);

/* Upright, until its axis is changed. */
struct kiln_object *fixture_add_cylinder(struct scene_fixture *f, float x, float y, float z,
                                         float radius, float height);

/* Upright, as cylinders. */
struct kiln_object *fixture_add_capsule(struct scene_fixture *f, float x, float y, float z,
                                        float radius, float height);

/* Its normal is up. */
struct kiln_object *fixture_add_plane(struct scene_fixture *f, float x, float y, float z);

/* Noise around the origin, of hills half a metre wide. */
struct kiln_object *fixture_add_terrain(struct scene_fixture *f, float y, float width, float height,
                                        uint32_t samples);

/* A mesh that particles bounce off: an OBJ file, as large as it says. */
struct kiln_object *fixture_add_mesh(struct scene_fixture *f, const char *file, float x, float y,
                                     float z);

/* A mesh by its depth maps along x, y and z. */
void fixture_map_depths(struct kiln_object *mesh, uint32_t resolution);

/* One that moves, turns and grows. */
struct kiln_object *fixture_add_moving_mesh(struct scene_fixture *f);

/* Such a mesh as a volume of planes, and one that has two sides. */
void fixture_add_moving_volumes(struct scene_fixture *f);

/* A system like fixture_add_system's, whose particles are born of system `parent`'s. */
struct kiln_system *fixture_add_child(struct scene_fixture *f, const char *name, uint32_t parent,
                                      enum kiln_event event, uint32_t count);

/* Gives every system the slots that it needs for so many steps. */
void fixture_finish(struct scene_fixture *f, uint32_t steps);

/* ---- one scene with everything in it -------------------------------------------------------- */

void fixture_zoo_backdrop(struct scene_fixture *f);

/* A sphere that moves and a cylinder that grows, beside what there is. */
void fixture_add_round(struct scene_fixture *f);

/* What turns, beside what there is, and surfaces that rub. */
void fixture_add_turned(struct scene_fixture *f);

/* The wind of a file for the first system, beside what there is: velocity (-2 z, 0.5 + 0.3 y, 2 x),
 * at x from -1.5 to 1.5, y from -0.5 to 1.9 and z from -1.5 to 1.5. */
struct kiln_force *fixture_add_field(struct kiln_system *system);

/* Balls of a system bounce off each other. */
struct kiln_interaction *fixture_add_collisions(struct kiln_system *system, float radius);

/* Particles of a system attract each other. */
struct kiln_interaction *fixture_add_gravity(struct kiln_system *system, float strength);

/* Particles of a system fly like birds. */
struct kiln_flock *fixture_add_flock(struct kiln_system *system, float radius);

/* Every emitter, force, collider and kind of value, for so many steps. */
void fixture_zoo(struct scene_fixture *f, enum kiln_integration integration, uint32_t steps);

/* A point that is sought and one that is fled, both by turns softened, in drag by the square of the
 * speed; and a vortex of each profile, one of which adds its velocity. For the zoo's own systems
 * and two more; fixture_finish comes after it. */
void fixture_add_whirls(struct scene_fixture *f);

#endif
