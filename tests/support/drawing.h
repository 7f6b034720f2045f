/* Draws hand-made particles: makes a scene from a text, takes records from the test, and draws them
 * into float images over a depth that the test chooses. */
#ifndef KILN_TESTS_DRAWING_H
#define KILN_TESTS_DRAWING_H

#include "draw/backdrop/backdrop.h"
#include "draw/sprites/particles.h"
#include "gpu/framebuffer.h"

/* Settings of drawing_init, which tests may set before it. */
extern enum kiln_raster_technique drawing_technique; /* KILN_RASTER_GEOMETRY at first */
extern uint32_t drawing_most;                        /* the most particles, 32 at first */
extern uint32_t drawing_threads;                     /* 2 at first */
extern const char *drawing_asset_root;               /* NULL: the working directory */

struct drawing {
    struct kiln_device *device;
    struct kiln_threads *threads;
    struct kiln_scene *scene;
    struct kiln_atlas atlas;
    struct kiln_image backdrop_color, backdrop_depth; /* targets of the backdrop */
    struct kiln_image depth; /* depth of the scene, which hides particles */
    struct kiln_image color, bloom;
    struct kiln_framebuffer framebuffer;
    struct kiln_backdrop_stage *backdrop;
    struct kiln_particles_stage *particles;
    struct kiln_pool pool;
    struct kiln_buffer entries;
    struct kiln_moment moment;
    struct kiln_lighting lighting; /* of particles: all zero, unless a test computes it */
};

/* Makes the scene of a text, which has one system, and the stages that draw it. Its textures are
 * replaced by one whose colour depends on the place. */
void drawing_init(struct drawing *d, struct kiln_device *device, const char *text,
                  const char *const *overrides, size_t override_count);
void drawing_finish(struct drawing *d);

/* Returns a living particle that was born at the start of step 1. */
struct kiln_particle drawing_particle(uint32_t serial, float3 position, float3 velocity);

/* Puts particles into the pool and the entries, in order, moves the camera to its place at a step,
 * and draws the backdrop. */
void drawing_place(struct drawing *d, const struct kiln_particle *particles, uint32_t count,
                   uint32_t step);

/* Fills the depth with a wall at depth_m, and draws the first `count` particles before it, each
 * over the earlier ones. */
void drawing_run(struct drawing *d, uint32_t count, float depth_m);

/* ---- vectors of the world in double ---------------------------------------------------------- */

typedef struct {
    double x, y, z;
} vec;

vec vec_of(float3 v);
double vec_dot(vec a, vec b);

/* Returns a + b * t. */
vec vec_add(vec a, vec b, double t);

vec vec_cross(vec a, vec b);
vec vec_unit(vec a);

/* Returns an axis of the camera: 0 its right, 1 its up, 2 backwards. */
vec drawing_axis(const struct drawing *d, int row);

vec drawing_eye(const struct drawing *d);

/* Returns the direction of the ray through a place of the picture, px; t along it is view depth. */
vec drawing_ray(const struct drawing *d, double x, double y);

/* Returns the place of a point of the world in the picture, px, and its view depth, m. */
vec drawing_project(const struct drawing *d, vec point);

#endif
