/* Computes structural similarity (Wang, Bovik, Sheikh, Simoncelli: "Image Quality Assessment: From
 * Error Visibility to Structural Similarity", 2004). */
#ifndef KILN_COMPARE_SSIM_H
#define KILN_COMPARE_SSIM_H

#include "base/thread.h"
#include "kiln.h"

/* Computes the mean over all pixels of the similarity of two planes of luma from 0 to 1. The
 * similarity of equal planes is 1, and the least possible one is -1. Windows are 11x11, Gaussian
 * with sigma 1.5, K1 0.01, K2 0.03. At the border the window is cut off and its remaining weights
 * sum to 1, so a picture of any size is judged to its edge (the authors' program leaves out the
 * outer 5 pixels). False with KILN_DEVICE_FAILED when memory is short. */
bool kiln_ssim(const float *reference, const float *test, uint32_t width, uint32_t height,
               struct kiln_threads *threads, double *similarity, struct kiln_error *error);

#endif
