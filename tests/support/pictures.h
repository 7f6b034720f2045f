/* Pictures with known pixels and folders that go away, for the tests of lib/output. */
#ifndef KILN_TESTS_PICTURES_H
#define KILN_TESTS_PICTURES_H

#include "output/output.h"

/* That of the scene in test_output_params. */
extern const char test_scene_hash[];

/* Smooth in x, y and time, another in each channel: 0..255. */
uint32_t test_level(uint32_t frame, uint32_t width, uint32_t x, uint32_t y, int channel);

float test_layer_value(uint32_t frame, uint32_t x, uint32_t y, uint32_t layer, uint32_t channel);
struct kiln_output_params test_output_params(const char *path,
                                             const struct kiln_frame_range *range);

/* A picture as the output wants it. */
struct kiln_picture *test_picture(const struct kiln_output *output,
                                  const struct kiln_output_params *params, uint32_t frame);

/* Opens, writes every frame of the ranges and finishes; false with the first error. */
bool test_write_all(const struct kiln_output_params *params, struct kiln_error *error);

void test_make_folder(char folder[32]);

/* Entries of a folder, hidden ones too. */
int test_count_files(const char *folder);

void test_remove_folder(const char *folder);

#endif
