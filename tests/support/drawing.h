/* Draws particles that a test places by hand: makes a scene from a text, takes the particles'
 * records from the test, and draws them into images of 32-bit floats. The test also chooses the
 * view depth of a wall, which hides particles behind it. */
#ifndef KILN_TESTS_DRAWING_H
#define KILN_TESTS_DRAWING_H

#include "draw/backdrop/backdrop.h"
#include "draw/sprites/particles.h"
#include "gpu/framebuffer.h"
#include "support/cmocka.h"

/* Settings that drawing_init reads. A test may change them before the call. */
extern enum kiln_raster_technique drawing_technique; /* KILN_RASTER_GEOMETRY at first */
extern uint32_t drawing_most;                        /* slots for particles; 32 at first */
extern uint32_t drawing_threads;                     /* worker threads; 2 at first */
extern const char *drawing_asset_root;               /* folder of assets; NULL: working directory */

struct drawing {
    struct kiln_device *device;
    struct kiln_threads *threads;
    struct kiln_scene *scene;
    struct kiln_atlas atlas;
    struct kiln_image backdrop_color, backdrop_depth; /* targets of the backdrop stage */
    struct kiln_image depth;        /* view depth of the scene, m; hides what is behind */
    struct kiln_image color, bloom; /* the particles are drawn into these */
    struct kiln_framebuffer framebuffer;
    struct kiln_backdrop_stage *backdrop;
    struct kiln_particles_stage *particles;
    struct kiln_pool pool;
    struct kiln_buffer entries;
    struct kiln_moment moment;
    struct kiln_lighting lighting; /* light on particles: all zero unless a test computes it */
};

/* Makes a scene from a text with overrides "KEY=VALUE", and the stages that draw it. One texture
 * replaces all textures: its red is the texture coordinate u and its green is v, 0 to 1, so the
 * colour of a pixel tells which place of the particle it shows. An error fails the test. */
void drawing_init(struct drawing *d, struct kiln_device *device, const char *text,
                  const char *const *overrides, size_t override_count);
void drawing_finish(struct drawing *d);

/* Returns a living particle that was born at the start of step 1. position: m; velocity: m/s. */
struct kiln_particle drawing_particle(uint32_t serial, float3 position, float3 velocity);

/* Puts particles into the pool, and makes draw entries in the same order. Moves the camera to its
 * place at the end of step `step`, and draws the backdrop. */
void drawing_place(struct drawing *d, const struct kiln_particle *particles, uint32_t count,
                   uint32_t step);

/* Draws the first `count` particles of the pool, each over those in lower slots. A wall at the view
 * depth depth_m, m, fills the picture and hides all that is farther away. */
void drawing_run(struct drawing *d, uint32_t count, float depth_m);

/* ---- vectors of the world in double precision ------------------------------------------------ */

typedef struct {
    double x, y, z;
} vec;

vec vec_of(float3 v);
double vec_dot(vec a, vec b);

/* Returns a + b * t. */
vec vec_add(vec a, vec b, double t);

vec vec_cross(vec a, vec b);
vec vec_unit(vec a);

/* Returns a unit axis of the camera in the world: row 0 points right, row 1 up, row 2 backwards. */
vec drawing_axis(const struct drawing *d, int row);

/* Returns the position of the camera, m. */
vec drawing_eye(const struct drawing *d);

/* Returns the direction of the ray from the eye through the place (x, y) of the picture, px from
 * the top left. The point eye + t * direction has the view depth t, m. */
vec drawing_ray(const struct drawing *d, double x, double y);

/* Projects a point of the world, m: returns its place in the picture, x and y, px from the top
 * left, and its view depth z, m. */
vec drawing_project(const struct drawing *d, vec point);

/* Runs a group of tests, which need a device, once for each technique of stage `raster`. Unless
 * test_is_full, runs only the techniques `tiled` and `cpu`; gpu.crowds compares the others with
 * them. Returns the program's exit status. */
int drawing_run_rasters(const struct CMUnitTest *tests, size_t count, char **argv);

#endif
