/* Billboards as the shaders of shaders/draw define them, drawn the plain way: in double precision,
 * pixel by pixel, each texel where it is. What every technique of stage `raster` is an
 * approximation of.
 */
#ifndef KILN_TESTS_TRUE_BILLBOARDS_H
#define KILN_TESTS_TRUE_BILLBOARDS_H

#include "draw/sprites/particles.h"
#include "support/true_sprite.h"

/* What was drawn, premultiplied: red, green, blue and alpha; and the same of the glow. */
struct true_picture {
    uint32_t width, height;
    double (*color)[4], (*glow)[4];
};

void true_picture_init(struct true_picture *picture, uint32_t width, uint32_t height);
void true_picture_finish(struct true_picture *picture);

/* Draws what kiln_particles_run draws, farthest first. */
void true_draw(const struct true_scene *scene, const struct kiln_particles_draw *draw,
               struct true_picture *picture);

#endif
