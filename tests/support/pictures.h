/* Makes pictures with known pixels, and temporary folders, for tests of lib/output. */
#ifndef KILN_TESTS_PICTURES_H
#define KILN_TESTS_PICTURES_H

#include "output/output.h"

/* The scene's hash in test_output_params. */
extern const char test_scene_hash[];

/* Returns a sample of a picture, 0 to 255. It is smooth in x, y and time, and differs in each
 * channel. */
uint32_t test_level(uint32_t frame, uint32_t width, uint32_t x, uint32_t y, int channel);

/* Returns a sample of a layer of floats. */
float test_layer_value(uint32_t frame, uint32_t x, uint32_t y, uint32_t layer, uint32_t channel);
/* Returns parameters of an output of one range, 64 x 36 pixels, 30 frames a second. */
struct kiln_output_params test_output_params(const char *path,
                                             const struct kiln_frame_range *range);

/* Returns a picture with the samples that an output needs. */
struct kiln_picture *test_picture(const struct kiln_output *output,
                                  const struct kiln_output_params *params, uint32_t frame);

/* Opens an output, writes every frame of the ranges and finishes; false with the first error. */
bool test_write_all(const struct kiln_output_params *params, struct kiln_error *error);

/* Makes a temporary folder, and fills in its path. */
void test_make_folder(char folder[32]);

/* Returns the number of entries of a folder, hidden ones included. */
int test_count_files(const char *folder);

/* Removes a folder and all in it. */
void test_remove_folder(const char *folder);

#endif
