/* Draws billboards as the shaders of shaders/draw define them, in the simplest way: pixel by pixel,
 * in double precision. It is the reference that every technique of stage `raster` approximates. */
#ifndef KILN_TESTS_TRUE_BILLBOARDS_H
#define KILN_TESTS_TRUE_BILLBOARDS_H

#include "draw/sprites/particles.h"
#include "support/true_sprite.h"

/* A picture and its glow: red, green, blue and alpha, premultiplied. */
struct true_picture {
    uint32_t width, height;
    double (*color)[4], (*glow)[4];
};

void true_picture_init(struct true_picture *picture, uint32_t width, uint32_t height);
void true_picture_finish(struct true_picture *picture);

/* Draws the particles of a job as kiln_particles_run does. The entries are sorted, farthest first.
 */
void true_draw(const struct true_scene *scene, const struct kiln_particles_draw *draw,
               struct true_picture *picture);

#endif
