/* Hand-made particles before the drawing stages: a scene's text and its records, drawn into float
 * images over a depth that the test chooses. */
#ifndef KILN_TESTS_DRAWING_H
#define KILN_TESTS_DRAWING_H

#include "draw/backdrop/backdrop.h"
#include "draw/sprites/particles.h"
#include "gpu/framebuffer.h"

/* What drawing_init takes, for tests to set before it. */
extern enum kiln_raster_technique drawing_technique; /* KILN_RASTER_GEOMETRY at first */
extern uint32_t drawing_most;                        /* particles: 32 */
extern uint32_t drawing_threads;                     /* 2 */
extern const char *drawing_asset_root;               /* NULL: the working directory */

struct drawing {
    struct kiln_device *device;
    struct kiln_threads *threads;
    struct kiln_scene *scene;
    struct kiln_atlas atlas;
    struct kiln_image backdrop_color, backdrop_depth; /* as the backdrop drew them */
    struct kiln_image depth;                          /* what particles are compared with */
    struct kiln_image color, bloom;
    struct kiln_framebuffer framebuffer;
    struct kiln_backdrop_stage *backdrop;
    struct kiln_particles_stage *particles;
    struct kiln_pool pool;
    struct kiln_buffer entries;
    struct kiln_moment moment;
    struct kiln_lighting lighting; /* of the particles: none, unless a test runs it */
};

/* The text of a scene with one system, and overrides for it. */
void drawing_init(struct drawing *d, struct kiln_device *device, const char *text,
                  const char *const *overrides, size_t override_count);
void drawing_finish(struct drawing *d);

/* A particle that was born at the start of step 1. */
struct kiln_particle drawing_particle(uint32_t serial, float3 position, float3 velocity);

/* Puts particles into the pool and the entries, in order, and the camera at a step. */
void drawing_place(struct drawing *d, const struct kiln_particle *particles, uint32_t count,
                   uint32_t step);

/* Makes the scene a wall at a depth, and draws the particles before it, each over those before. */
void drawing_run(struct drawing *d, uint32_t count, float depth_m);

/* ---- vectors of the world in double ---------------------------------------------------------- */

typedef struct {
    double x, y, z;
} vec;

vec vec_of(float3 v);
double vec_dot(vec a, vec b);

/* a + b * t */
vec vec_add(vec a, vec b, double t);

vec vec_cross(vec a, vec b);
vec vec_unit(vec a);

/* Row of the camera: 0 its right, 1 its up, 2 backwards. */
vec drawing_axis(const struct drawing *d, int row);

vec drawing_eye(const struct drawing *d);

/* The ray through a position in the picture; its t is view depth. */
vec drawing_ray(const struct drawing *d, double x, double y);

/* The inverse: where in the picture a point of the world is, and its depth. */
vec drawing_project(const struct drawing *d, vec point);

#endif
