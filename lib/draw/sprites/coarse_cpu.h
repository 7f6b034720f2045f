/* A kiln_coarse_cpu converts between a frame and its smaller picture on the host, in arithmetic
 * that is the same on every machine. */
#ifndef KILN_DRAW_SPRITES_COARSE_CPU_H
#define KILN_DRAW_SPRITES_COARSE_CPU_H

#include "draw/sprites/coarse_images.h"

struct kiln_coarse_cpu;

/* NULL with an error. images and threads must outlive it. */
struct kiln_coarse_cpu *kiln_coarse_cpu_create(struct kiln_coarse_images *images,
                                               struct kiln_threads *threads,
                                               struct kiln_error *error);
void kiln_coarse_cpu_destroy(struct kiln_coarse_cpu **coarse);

/* Fills depth, edges and, if mixed, fine_depth from the frame's depth. */
bool kiln_coarse_cpu_measure(struct kiln_coarse_cpu *coarse, struct kiln_image *depth,
                             struct kiln_error *error);

/* Puts the coarse pictures, and the fine ones near edges, into the frame's, where depth is that of
 * the last kiln_coarse_cpu_measure. */
bool kiln_coarse_cpu_spread(struct kiln_coarse_cpu *coarse, const struct kiln_coarse_blend *blend,
                            struct kiln_image *depth, struct kiln_error *error);

#endif
