/* Computes FLIP: how different two pictures look when one flips between them (Andersson et al.,
 * "FLIP: A Difference Evaluator for Alternating Images", HPG 2020; "Visualizing Errors in Rendered
 * High Dynamic Range Images", EG 2021). Pictures are linear Rec. 709, three floats a pixel, rows
 * from the top. */
#ifndef KILN_COMPARE_FLIP_H
#define KILN_COMPARE_FLIP_H

#include "base/thread.h"
#include "kiln.h"

struct kiln_flip_params {
    float pixels_per_degree; /* of the viewer's field of view; 4 to 400 */
};

/* A 3840 pixel wide, 0.7 m wide screen seen from 0.7 m. */
#define KILN_FLIP_DEFAULTS ((struct kiln_flip_params){.pixels_per_degree = 67.0206f})

struct kiln_flip_pair {
    const float *reference, *test;
    uint32_t width, height; /* both at least 1 */
};

/* Checks that picture, one of the pair, has finite values only. Returns false with
 * KILN_INVALID_INPUT and the place of another value. */
bool kiln_flip_check_finite(const float *picture, const struct kiln_flip_pair *pair,
                            struct kiln_error *error);

/* Computes the LDR error of each pixel, 0 (none) to 1; values are clamped to 0..1 first. errors has
 * room for width * height. False with KILN_INVALID_INPUT when a value is not finite (the message
 * says where), with KILN_DEVICE_FAILED when memory is short. */
bool kiln_flip_ldr(const struct kiln_flip_pair *pair, const struct kiln_flip_params *params,
                   struct kiln_threads *threads, float *errors, struct kiln_error *error);

/* The exposures at which HDR pictures are compared, in stops. */
struct kiln_flip_exposures {
    float start, stop;
    uint32_t count; /* at least 2, at most KILN_FLIP_MAX_EXPOSURES */
};
enum { KILN_FLIP_MAX_EXPOSURES = 64 };

/* Chooses the exposures from the reference alone. At the first one, its brightest pixel is
 * tone-mapped to 0.85; at the last one, its median is. A reference whose median is black (fire on
 * black) counts as one with a median of 2^-16 of its brightest pixel: the range is never empty,
 * since any two pictures would be equal in an empty range. The test picture may be NULL. False with
 * KILN_INVALID_INPUT when a value of the reference is not finite, with KILN_DEVICE_FAILED when
 * memory is short. */
bool kiln_flip_choose_exposures(const struct kiln_flip_pair *pair,
                                struct kiln_flip_exposures *exposures, struct kiln_error *error);

/* Computes the largest LDR error of each pixel over the exposures, tone-mapped with ACES. Negative
 * values count as 0. Fails as kiln_flip_ldr does. */
bool kiln_flip_hdr(const struct kiln_flip_pair *pair, const struct kiln_flip_params *params,
                   const struct kiln_flip_exposures *exposures, struct kiln_threads *threads,
                   float *errors, struct kiln_error *error);

#endif
