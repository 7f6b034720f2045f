/* This header declares the two blurs of the glow in GL, the Gaussian and the pyramid, and the
 * functions that they share. */
#ifndef KILN_POST_BLOOM_BLUR_H
#define KILN_POST_BLOOM_BLUR_H

#include "gpu/framebuffer.h"
#include "post/bloom_plan.h"

/* Holds an image with its framebuffer. A zero-initialised target may be finished. */
struct kiln_bloom_target {
    struct kiln_image image;
    struct kiln_framebuffer framebuffer;
};
bool kiln_bloom_target_init(struct kiln_bloom_target *target, struct kiln_device *device,
                            uint32_t width, uint32_t height, GLenum format,
                            struct kiln_error *error);
void kiln_bloom_target_finish(struct kiln_bloom_target *target);

/* Fills the target with the current program; `first` and `second` are bound to texture units 0 and
 * 1. second may be NULL. */
bool kiln_bloom_pass(struct kiln_framebuffer *target, struct kiln_image *first,
                     struct kiln_image *second, GLuint vertex_array, struct kiln_error *error);

/* Creates a full-screen program with a fragment shader. Returns 0 with an error on failure. */
GLuint kiln_bloom_program(struct kiln_device *device, const char *fragment,
                          struct kiln_error *error);

/* Blurs sources with a Gaussian, that of the scene or that of the thesis. Blurring does not change
 * the sum of the light. The plan must outlive the result. */
struct kiln_bloom_gaussian;
struct kiln_bloom_gaussian *kiln_bloom_gaussian_create(struct kiln_device *device,
                                                       const struct kiln_bloom_plan *plan,
                                                       GLenum format, struct kiln_error *error);
void kiln_bloom_gaussian_destroy(struct kiln_bloom_gaussian **gaussian);

/* Blurs the source; the result has the size of the plan's last level. */
struct kiln_image *kiln_bloom_gaussian_run(struct kiln_bloom_gaussian *gaussian,
                                           struct kiln_image *source, GLuint vertex_array,
                                           struct kiln_error *error);

struct kiln_bloom_pyramid;
struct kiln_bloom_pyramid *kiln_bloom_pyramid_create(struct kiln_device *device,
                                                     const struct kiln_bloom_plan *plan,
                                                     GLenum format, struct kiln_error *error);
void kiln_bloom_pyramid_destroy(struct kiln_bloom_pyramid **pyramid);

/* Blurs the source; the result has the size of the plan's first level. radius: 0 (a glow of a pixel
 * or two) to 1 (a glow over the whole picture). */
struct kiln_image *kiln_bloom_pyramid_run(struct kiln_bloom_pyramid *pyramid,
                                          struct kiln_image *source, float radius,
                                          GLuint vertex_array, struct kiln_error *error);

#endif
