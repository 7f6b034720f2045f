/* A kiln_coarse_cpu converts between a frame and its coarse picture on the host, in arithmetic that
 * gives the same bits on every machine. */
#ifndef KILN_DRAW_SPRITES_COARSE_CPU_H
#define KILN_DRAW_SPRITES_COARSE_CPU_H

#include "draw/sprites/coarse_images.h"

struct kiln_coarse_cpu;

/* Returns NULL with an error. images and threads must outlive the result. */
struct kiln_coarse_cpu *kiln_coarse_cpu_create(struct kiln_coarse_images *images,
                                               struct kiln_threads *threads,
                                               struct kiln_error *error);
void kiln_coarse_cpu_destroy(struct kiln_coarse_cpu **coarse);

/* Computes the images `depth`, `edges` and, if mixed, `fine_depth` from the frame's depth. */
bool kiln_coarse_cpu_measure(struct kiln_coarse_cpu *coarse, struct kiln_image *depth,
                             struct kiln_error *error);

/* Writes the coarse pictures, enlarged, and near edges the fine pictures into the frame's. depth is
 * the image that was given to the last kiln_coarse_cpu_measure. */
bool kiln_coarse_cpu_enlarge(struct kiln_coarse_cpu *coarse, const struct kiln_coarse_blend *blend,
                             struct kiln_image *depth, struct kiln_error *error);

#endif
