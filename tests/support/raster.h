/* What `raster=cpu` draws with, all of it on the host: a scene's atlas, targets of its size,
 * records and entries that the test fills in, light that comes from all over. */
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
    /* of raster_add_targets */
    struct kiln_image depth, color, bloom;
    struct kiln_framebuffer framebuffer;
    /* of raster_add_particles */
    struct kiln_pool pool;
    struct kiln_buffer entries;
    uint32_t count;
};

float raster_random(float low, float high);

/* Within 2 m/s in each direction, born in one of so many steps. */
struct kiln_particle raster_random_particle(float x, float y, float z, uint32_t serial,
                                            uint32_t steps);

/* Owns the scene; a builtin atlas has so many cells a system. The camera is where it is at a step.
 */
void raster_open(struct raster *r, struct kiln_scene *scene, uint32_t columns, uint32_t rows,
                 uint32_t step);

/* A sun, and some lamps in a row. */
void raster_add_lamps(struct raster *r, uint32_t lamps);

/* Returns the depth, all of it sky. */
float *raster_add_targets(struct raster *r);

/* Slots for each system, and entries; what lies in these is the test's. */
void raster_add_particles(struct raster *r, uint32_t capacity, uint32_t count,
                          struct kiln_particle **records, uint32_t **entries);

/* What draws all entries. */
struct kiln_particles_draw raster_job(struct raster *r);

/* Draws it on so many threads. */
void raster_draw(struct raster *r, const struct kiln_particles_draw *job, uint32_t thread_count);

void raster_close(struct raster *r);

#endif
