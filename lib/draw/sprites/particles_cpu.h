/* A kiln_raster_cpu draws particles by technique `cpu`: as sprites into tiles, on threads, with the
 * widest vectors that the machine has. The pixels are the same bytes on every machine and for any
 * number of threads. */
#ifndef KILN_DRAW_SPRITES_PARTICLES_CPU_H
#define KILN_DRAW_SPRITES_PARTICLES_CPU_H

#include "base/footprint.h"
#include "draw/sprites/particles.h"

struct kiln_raster_cpu;

struct kiln_raster_cpu *kiln_raster_cpu_create(const struct kiln_scene *scene,
                                               const struct kiln_atlas *atlas,
                                               struct kiln_threads *threads,
                                               struct kiln_error *error);

/* Adds the memory of drawing a scene whose atlas has so many layers. */
void kiln_raster_cpu_footprint(const struct kiln_scene *scene, uint64_t layers,
                               struct kiln_footprint *footprint);
void kiln_raster_cpu_destroy(struct kiln_raster_cpu **tiles);

/* Returns whether covering particles can be drawn apart, as kiln_particles_splits does: where tiles
 * keep the colour of what glows apart, and of all particles the additive ones glow. */
bool kiln_raster_cpu_splits(const struct kiln_particles_draw *draw, uint64_t systems);

/* Draws the particles of a pass, as kiln_particles_run does. */
bool kiln_raster_cpu_run(struct kiln_raster_cpu *tiles, const struct kiln_particles_draw *draw,
                         struct kiln_error *error);

#endif
