/* Makes pictures whose pixels follow from formulas, so that tests of lib/output, which writes
 * pictures and videos, know what a file must hold. Also makes temporary folders for the files. */
#ifndef KILN_TESTS_PICTURES_H
#define KILN_TESTS_PICTURES_H

#include "output/output.h"

/* The scene hash that test_output_params sets: 64 hexadecimal digits. */
extern const char test_scene_hash[];

/* Returns the level, 0 to 255, of a channel of a pixel of test_picture. It changes smoothly with x,
 * y and the frame, in each channel differently. */
uint32_t test_level(uint32_t frame, uint32_t width, uint32_t x, uint32_t y, int channel);

/* Returns the sample of a channel of test_picture's layer of floats with this index. */
float test_layer_value(uint32_t frame, uint32_t x, uint32_t y, uint32_t layer, uint32_t channel);

/* Returns parameters of an output of one range of frames, with 64 x 36 pixels and 30 frames a
 * second. path and range must outlive the parameters. */
struct kiln_output_params test_output_params(const char *path,
                                             const struct kiln_frame_range *range);

/* Returns a picture of a frame in the form that an output needs, with the samples of test_level and
 * test_layer_value. 16-bit samples are level * 256 + x. Alpha is opaque unless params->alpha is
 * set. The caller owns the picture. */
struct kiln_picture *test_picture(const struct kiln_output *output,
                                  const struct kiln_output_params *params, uint32_t frame);

/* Opens an output, writes every frame of its ranges and finishes it. Returns false with the first
 * error. */
bool test_write_all(const struct kiln_output_params *params, struct kiln_error *error);

/* Makes a temporary folder and writes its path to `folder`. */
void test_make_folder(char folder[32]);

/* Returns the number of entries of a folder, hidden ones included, but not "." and "..". */
int test_count_files(const char *folder);

/* Removes a folder with everything in it. */
void test_remove_folder(const char *folder);

#endif
