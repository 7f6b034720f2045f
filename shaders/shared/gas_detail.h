/* Declares how detailed gas is drawn, for the host (lib/draw/volume/volume_detail.h) and for GL
 * (shaders/draw/volume/volume_sample.glsl). Thickness is the amount of gas by its slope, cells. */
#ifndef KILN_SHARED_GAS_DETAIL_H
#define KILN_SHARED_GAS_DETAIL_H

/* Cells of a domain along an edge of a cell of the noise's lattice: about the smallest eddies that
 * the gas itself has. */
#define GAS_NOISE_CELL 3.0f

/* The second group of ways has the noise of places so far away, cells of the lattice. */
#define GAS_NOISE_APART 511.5f

/* Brings the root of the mean square of the noise to 1. */
#define GAS_NOISE_UNIT 1.32f

/* The size of an octave of noise by that of the one before, and the mean square of two. */
#define GAS_OCTAVE      0.6f
#define GAS_TWO_OCTAVES 1.36f

/* How much noise changes the amount of smoke: the deviation of its logarithm, of one octave. That
 * of flames is half of it. */
#define GAS_DETAIL 0.4f

/* Thickness at which half of the gas is drawn. */
#define GAS_SMOKE_EDGE 1.8f
#define GAS_FLAME_EDGE 1.5f

/* Thickness from where no gas is drawn to where all of it is. */
#define GAS_EDGE_WIDTH 1.0f

/* How far noise moves edges: the root of the mean square of one octave, thickness. */
#define GAS_SMOKE_TORN 1.0f
#define GAS_FLAME_TORN 0.8f

/* A step of a ray that adds less light and opacity than this is drawn as it is. */
#define GAS_DETAIL_SEEN (1.0f / 2048.0f)

#endif
