/* Builds scenes in memory, for tests of stages that take a loaded scene. Tests set the members of
 * the scene themselves, so they need no scene file and no parser. */
#ifndef KILN_TESTS_SCENE_FIXTURE_H
#define KILN_TESTS_SCENE_FIXTURE_H

#include "scene/scene.h"

struct scene_fixture {
    struct kiln_scene scene;
    float4 keys[KILN_MAX_VALUE_KEYS]; /* scene.keys */
};

/* Makes an empty scene: 300 frames at 60 a second, with one step each. It also frees the meshes
 * that *f had, so *f must be all zeros before the first call. */
void fixture_init(struct scene_fixture *f);

struct kiln_value fixture_constant(float x);

/* Returns a value with `count` key frames over a clock (KILN_CLOCK_*), linear between them. points:
 * x, which is in seconds or parts of the life, ascending; and the value there. */
struct kiln_value fixture_keys(struct scene_fixture *f, uint32_t clock, uint32_t count,
                               const float (*points)[2]);

/* Returns a value that goes linearly from y0 at x0 to y1 at x1. x is as in fixture_keys. */
struct kiln_value fixture_ramp(struct scene_fixture *f, uint32_t clock, float x0, float y0,
                               float x1, float y1);

struct kiln_value3 fixture_constant3(float x, float y, float z);
struct kiln_range fixture_range(float min, float max);

/* Adds a system that emits `rate` particles a second upwards from the origin. They start with 1 to
 * 2 m/s and live for 1 to 2 s. */
struct kiln_system *fixture_add_system(struct scene_fixture *f, const char *name, float rate);

struct kiln_force *fixture_add_force(struct kiln_system *system, enum kiln_force_kind kind);

/* Adds a box along the axes with its centre at (x, y, z) and edges of width, height and depth, m.
 * Particles collide with it and with the objects of the functions below, whose factors of
 * restitution and friction are 1. */
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

/* Adds square terrain of noise about the y axis, with hills 0.5 m wide. y: its lowest height, m;
 * width: of the square, m; height: that hills rise over y at most, m; samples: along x, with about
 * half as many along z. */
struct kiln_object *fixture_add_terrain(struct scene_fixture *f, float y, float width, float height,
                                        uint32_t samples);

/* Adds the mesh of an OBJ file with its origin at (x, y, z), m, where one unit of the file is 1 m.
 * Particles collide with its distance field. An error fails the test. */
struct kiln_object *fixture_add_mesh(struct scene_fixture *f, const char *file, float x, float y,
                                     float z);

/* Makes particles collide with a mesh by depth maps in the directions x, y and z. resolution: of
 * each map. */
void fixture_map_depths(struct kiln_object *mesh, uint32_t resolution);

/* Adds a tetrahedron, as a mesh, that moves, turns and grows. */
struct kiln_object *fixture_add_moving_mesh(struct scene_fixture *f);

/* Adds two moving meshes that particles collide with by volumes of planes (KILN_COLLIDER_VOLUME).
 * The planes of the first mesh are solid on one side, those of the second on both. */
void fixture_add_moving_volumes(struct scene_fixture *f);

/* Adds a system as fixture_add_system does, but its particles are born of the particles of system
 * `parent`. count: births for each event; a trail has emit.parent.rate instead. */
struct kiln_system *fixture_add_child(struct scene_fixture *f, const char *name, uint32_t parent,
                                      enum kiln_event event, uint32_t count);

/* Gives every system the slots that it needs for `steps` steps. Call it after all changes of the
 * scene. */
void fixture_finish(struct scene_fixture *f, uint32_t steps);

/* ---- larger scenes --------------------------------------------------------------------------- */

/* Adds a floor, two still boxes that overlap, a box that moves, a box that grows, and a box of 90 m
 * that particles do not collide with. */
void fixture_zoo_backdrop(struct scene_fixture *f);

/* Adds a sphere that moves and a cylinder that grows. */
void fixture_add_round(struct scene_fixture *f);

/* Adds colliders with frames of their own, most of which move or turn: boxes, a capsule, a cylinder
 * and planes. Gives every second system friction, and a restitution that falls over the life. */
void fixture_add_oriented(struct scene_fixture *f);

/* Adds the velocity field of whirl.grid to a system: (-2 z, 0.5 + 0.3 y, 2 x), m/s, for x from -1.5
 * to 1.5, y from -0.5 to 1.9 and z from -1.5 to 1.5, m. */
struct kiln_force *fixture_add_field(struct kiln_system *system);

/* Makes the particles of a system collide with each other as balls of a radius, m. */
struct kiln_interaction *fixture_add_collisions(struct kiln_system *system, float radius);

/* Makes the particles of a system attract each other. */
struct kiln_interaction *fixture_add_gravity(struct kiln_system *system, float strength);

/* Makes the particles of a system a flock, in which each sees others up to a radius, m. */
struct kiln_flock *fixture_add_flock(struct kiln_system *system, float radius);

/* Makes a scene with every emitter shape but the line; gravity, drag, wind and curl noise; the
 * colliders of fixture_zoo_backdrop; and values that are constant or vary over time or life. One
 * system is switched off. The systems get slots for `steps` steps. Tests add what else there is
 * with the functions of this header. */
void fixture_zoo(struct scene_fixture *f, enum kiln_integration integration, uint32_t steps);

enum { FIXTURE_MAX_FORCE_KINDS = 64 };

/* Writes every kind of force that a scene may have to `kinds`, and returns their number. */
uint32_t fixture_force_kinds(enum kiln_force_kind kinds[FIXTURE_MAX_FORCE_KINDS]);

/* Makes a scene of 1500 particles under one force of a kind. No number of the force is 0, so that
 * every number that the kind reads changes the result. Its falloff, profile and mode are the first
 * of their enums. */
void fixture_alone(struct scene_fixture *f, enum kiln_force_kind kind, uint32_t steps);

/* Adds two systems. In the first, points with each falloff attract and later repel, and there are
 * quadratic drag and a limit of the speed. In the second, there are vortices of each profile, and a
 * vortex, curl noise and wind that add their velocity (KILN_WIND_ADD). The caller then calls
 * fixture_finish. */
void fixture_add_whirls(struct scene_fixture *f);

#endif
