/* Declares the reference rasteriser. It draws particles as the shaders of shaders/draw/sprites do,
 * but in the simplest way: pixel by pixel, in double precision. Tests compare every technique of
 * the stage `raster` with its pictures. */
#ifndef KILN_TESTS_TRUE_BILLBOARDS_H
#define KILN_TESTS_TRUE_BILLBOARDS_H

#include "draw/sprites/particles.h"
#include "support/true_sprite.h"

/* A picture, and the light that the bloom blurs (`glow`). Both are linear RGBA, premultiplied, row
 * by row. */
struct true_picture {
    uint32_t width, height;
    double (*color)[4], (*glow)[4];
};

void true_picture_init(struct true_picture *picture, uint32_t width, uint32_t height);
void true_picture_finish(struct true_picture *picture);

/* Draws the particles of a job over a picture, as kiln_particles_run does. The job's draw entries
 * must be sorted from the farthest particle to the nearest. */
void true_draw(const struct true_scene *scene, const struct kiln_particles_draw *draw,
               struct true_picture *picture);

#endif
