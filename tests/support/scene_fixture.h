/* Builds scenes in memory, for tests of stages that take a loaded scene. Tests set the members of
 * the scene themselves, so they need no scene file and no parser. */
#ifndef KILN_TESTS_SCENE_FIXTURE_H
#define KILN_TESTS_SCENE_FIXTURE_H

#include "scene/scene.h"

struct scene_fixture {
    struct kiln_scene scene;
    float4 keys[KILN_BLOCK_KEYS]; /* scene.keys */
    struct kiln_force baked;      /* the force that fixture_alone bakes */
};

/* Makes an empty scene of 300 frames, 60 a second, with one simulation step a frame. Frees the
 * meshes of the scene that *f had before, so *f must be all zeros before the first call. */
void fixture_init(struct scene_fixture *f);

struct kiln_value fixture_constant(float x);

/* Returns a value with `count` key frames, linear between them. clock: KILN_CLOCK_TIME or
 * KILN_CLOCK_LIFE. points: for each key frame, first its place x on the clock, in seconds or as a
 * fraction of the life, ascending; then the value at x. */
struct kiln_value fixture_keys(struct scene_fixture *f, uint32_t clock, uint32_t count,
                               const float (*points)[2]);

/* Returns a value that changes linearly from y0 at x0 to y1 at x1, and is constant outside. x0, x1:
 * in seconds, or as fractions of the life, as the clock is KILN_CLOCK_TIME or KILN_CLOCK_LIFE. */
struct kiln_value fixture_ramp(struct scene_fixture *f, uint32_t clock, float x0, float y0,
                               float x1, float y1);

struct kiln_value3 fixture_constant3(float x, float y, float z);
struct kiln_range fixture_range(float min, float max);

/* Adds a system that emits `rate` particles a second upwards from the origin. They start with 1 to
 * 2 m/s and live for 1 to 2 s. */
struct kiln_system *fixture_add_system(struct scene_fixture *f, const char *name, float rate);

struct kiln_force *fixture_add_force(struct kiln_system *system, enum kiln_force_kind kind);

/* Adds a box along the axes with its centre at (x, y, z) and edges of width, height and depth, m.
 * Particles collide with the box. Its restitution and friction, factors on those of the particles,
 * are 1, as for all objects that the functions below add. */
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

/* Adds a square terrain of noise, centred on the y axis, with hills about 0.5 m wide. y: the lowest
 * height, m; width: edge of the square, m; height: the largest height of a hill above y, m;
 * samples: number of height samples along x; there are about half as many along z. */
struct kiln_object *fixture_add_terrain(struct scene_fixture *f, float y, float width, float height,
                                        uint32_t samples);

/* Adds the mesh of an OBJ file with its origin at (x, y, z), m, where one unit of the file is 1 m.
 * Particles collide with its distance field. An error fails the test. */
struct kiln_object *fixture_add_mesh(struct scene_fixture *f, const char *file, float x, float y,
                                     float z);

/* Makes particles collide with a mesh by depth maps, one along each of the axes x, y and z.
 * resolution: width and height of each map, in texels. */
void fixture_map_depths(struct kiln_object *mesh, uint32_t resolution);

/* Adds the mesh of a tetrahedron that moves, turns and grows. */
struct kiln_object *fixture_add_moving_mesh(struct scene_fixture *f);

/* Adds two moving meshes with colliders of kind KILN_COLLIDER_VOLUME. The first mesh is solid
 * behind its surface (KILN_SIDES_ONE); particles meet the surface of the second from both sides
 * (KILN_SIDES_TWO). */
void fixture_add_moving_volumes(struct scene_fixture *f);

/* Adds a system as fixture_add_system does, but its particles are born of the particles of system
 * `parent`, an index. event: death, bounce or trail; count: births for each event. For a trail,
 * count is 0, and the test sets emit.parent.rate, births a second. */
struct kiln_system *fixture_add_child(struct scene_fixture *f, const char *name, uint32_t parent,
                                      enum kiln_event event, uint32_t count);

/* Gives every system as many particle slots as it needs for `steps` steps. Call it after all
 * changes of the scene. */
void fixture_finish(struct scene_fixture *f, uint32_t steps);

/* ---- larger scenes --------------------------------------------------------------------------- */

/* Adds a floor, two still boxes that overlap, a box that moves, a box that grows, and a box of 90 m
 * that particles do not collide with. */
void fixture_zoo_backdrop(struct scene_fixture *f);

/* Adds a sphere that moves and a cylinder that grows. */
void fixture_add_round(struct scene_fixture *f);

/* Adds colliders that are not along the axes of the world, most of which move or turn: boxes, a
 * capsule, a cylinder, a cone and planes. Gives every second system friction, and a restitution
 * that falls over the life. */
void fixture_add_oriented(struct scene_fixture *f);

/* Adds the velocity field of whirl.grid to a system: (-2 z, 0.5 + 0.3 y, 2 x), m/s, for x from -1.5
 * to 1.5, y from -0.5 to 1.9 and z from -1.5 to 1.5, m. */
struct kiln_force *fixture_add_field(struct kiln_system *system);

/* Makes the particles of a system collide with each other as balls. radius: m. */
struct kiln_interaction *fixture_add_collisions(struct kiln_system *system, float radius);

/* Makes the particles of a system attract each other. strength: the acceleration that each particle
 * causes at a distance of 1 m, m/s^2. */
struct kiln_interaction *fixture_add_gravity(struct kiln_system *system, float strength);

/* Makes the particles of a system a flock. radius: the distance up to which each particle sees
 * others, m. */
struct kiln_flock *fixture_add_flock(struct kiln_system *system, float radius);

/* Makes a scene with every emitter shape but the line; gravity, drag, wind and curl noise; the
 * colliders of fixture_zoo_backdrop; and values that are constant or vary over time or life. One
 * system is switched off. The systems get slots for `steps` steps. Tests add other forces,
 * colliders and interactions by the functions above. */
void fixture_zoo(struct scene_fixture *f, enum kiln_integration integration, uint32_t steps);

enum { FIXTURE_MAX_FORCE_KINDS = 64 };

/* Writes every kind of force that a scene may have to `kinds`, and returns their number. */
uint32_t fixture_force_kinds(enum kiln_force_kind kinds[FIXTURE_MAX_FORCE_KINDS]);

/* Makes a scene of 1500 particles under one force of a kind, with slots for `steps` steps. No
 * number of the force is 0, so that every number that the kind reads changes the result. Its
 * falloff, profile and mode are the first of their enums. */
void fixture_alone(struct scene_fixture *f, enum kiln_force_kind kind, uint32_t steps);

/* Adds two systems. In the first, points with each falloff attract and later repel, and there are
 * quadratic drag and a limit of the speed. In the second, there are vortices of each profile, and a
 * vortex, curl noise and wind that add their velocity (KILN_WIND_ADD). The caller then calls
 * fixture_finish. */
void fixture_add_whirls(struct scene_fixture *f);

#endif
