/* Makes the input of `raster=cpu` on the host: the atlas of a scene, targets of its size, records
 * and entries that the test fills in, and the light of a sky. */
#ifndef KILN_TESTS_RASTER_H
#define KILN_TESTS_RASTER_H

#include "draw/sprites/particles.h"
#include "shared/particle.h"

struct raster {
    struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_atlas atlas;
    struct kiln_moment moment;
    struct kiln_draw_backdrop light;
    /* made by raster_add_targets */
    struct kiln_image depth, color, bloom, added;
    struct kiln_framebuffer framebuffer;
    /* made by raster_add_particles */
    struct kiln_pool pool;
    struct kiln_buffer entries;
    uint32_t count;
};

float raster_random(float low, float high);

/* Returns a living particle with a random velocity of up to 2 m/s along each axis, born in a random
 * step from 1 to `steps`. */
struct kiln_particle raster_random_particle(float x, float y, float z, uint32_t serial,
                                            uint32_t steps);

/* Takes over the scene, and makes its atlas. A builtin flipbook gets columns x rows cells. The
 * camera is at its place at `step`. */
void raster_open(struct raster *r, struct kiln_scene *scene, uint32_t columns, uint32_t rows,
                 uint32_t step);

/* Adds a sun and a row of lamps to the light. */
void raster_add_lamps(struct raster *r, uint32_t lamps);

/* Makes the targets. Returns the scene's depths, which are all those of the sky. */
float *raster_add_targets(struct raster *r);

/* Makes `capacity` slots for each system, and `count` entries. The test fills in *records and
 * *entries. */
void raster_add_particles(struct raster *r, uint32_t capacity, uint32_t count,
                          struct kiln_particle **records, uint32_t **entries);

/* Returns a job that draws all entries. */
struct kiln_particles_draw raster_job(struct raster *r);

/* Draws a job with `raster=cpu` on thread_count threads. */
void raster_draw(struct raster *r, const struct kiln_particles_draw *job, uint32_t thread_count);

void raster_close(struct raster *r);

#endif
