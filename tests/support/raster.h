/* Makes the input of the stage `raster`, which draws particles: the scene's atlas, target images of
 * the scene's size, the light of a plain sky, and particle records and draw entries, which the test
 * fills in. Everything is in host memory, for the technique `cpu`, so that tests run without GL,
 * unless the test gives a device. */
#ifndef KILN_TESTS_RASTER_H
#define KILN_TESTS_RASTER_H

#include "draw/sprites/particles.h"
#include "shared/particle.h"

struct raster {
    struct kiln_device *device; /* NULL: the technique is `cpu` */
    enum kiln_raster_technique technique;
    struct kiln_particles_stage *stage; /* of GL: made by the first raster_draw */
    struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_atlas atlas;
    struct kiln_moment moment;
    struct kiln_draw_backdrop light; /* the light on particles */
    /* raster_add_targets makes these: */
    struct kiln_image depth, color, bloom, added; /* added: for additive particles drawn apart */
    struct kiln_framebuffer framebuffer;
    /* raster_add_particles makes these: */
    struct kiln_pool pool;
    struct kiln_buffer entries;
    uint32_t count; /* number of entries */
};

/* Returns a number from `low` to `high`, made from rand(). */
float raster_random(float low, float high);

/* Returns a living particle at (x, y, z), m, with a random velocity of at most 2 m/s along each
 * axis. It was born at the start of a random step from 1 to `steps`, which decides its age. */
struct kiln_particle raster_random_particle(float x, float y, float z, uint32_t serial,
                                            uint32_t steps);

/* Takes ownership of the scene, and makes its atlas, its light, and its camera as at the end of
 * step `step`. columns, rows: number of cells along each axis of builtin flipbooks. */
void raster_open(struct raster *r, struct kiln_scene *scene, uint32_t columns, uint32_t rows,
                 uint32_t step);

/* Does what raster_open does, for a technique on a device. */
void raster_open_on(struct raster *r, struct kiln_device *device,
                    enum kiln_raster_technique technique, struct kiln_scene *scene,
                    uint32_t columns, uint32_t rows, uint32_t step);

/* Adds a sun and a row of `lamps` lamps, 1 m apart, to the light. */
void raster_add_lamps(struct raster *r, uint32_t lamps);

/* Makes the target images. Returns the depth of the scene in each pixel, m, by which particles are
 * hidden. Each depth is 1e9, which stands for the sky; a test may change it. */
float *raster_add_targets(struct raster *r);

/* Makes `capacity` particle slots for each system, and `count` draw entries. Sets *records and
 * *entries to the arrays, which the test then fills in. */
void raster_add_particles(struct raster *r, uint32_t capacity, uint32_t count,
                          struct kiln_particle **records, uint32_t **entries);

/* Returns a job that draws the particles of all draw entries, in the light that raster_open and
 * raster_add_lamps made, without shadows. */
struct kiln_particles_draw raster_job(struct raster *r);

/* Draws a job with the technique, `cpu` on thread_count threads. An error fails the test. */
void raster_draw(struct raster *r, const struct kiln_particles_draw *job, uint32_t thread_count);

void raster_close(struct raster *r);

#endif
