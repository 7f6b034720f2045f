/* A kiln_volume_gl marches rays through gas in GL (shaders/draw/volume/volume_march.comp), with a
 * ray for each pixel. Its pictures differ from those of the host by the rounding of the device. The
 * host lights the blocks, and gets the planes and the profiles back. */
#ifndef KILN_DRAW_VOLUME_VOLUME_GL_H
#define KILN_DRAW_VOLUME_VOLUME_GL_H

#include "draw/volume/volume_march.h"
#include "draw/volume/volume_tiles.h"
#include "gpu/image.h"

struct kiln_volume_gl;

/* Creates the programs for a picture of width x height pixels; NULL with an error. device must
 * outlive the result. */
struct kiln_volume_gl *kiln_volume_gl_create(struct kiln_device *device, uint32_t width,
                                             uint32_t height, struct kiln_error *error);
void kiln_volume_gl_destroy(struct kiln_volume_gl **gl);

/* Begins an empty picture, without gas that is half opaque. depth: of the scene, m. Fails with
 * KILN_DEVICE_FAILED, and advice in the message, where a storage block of the device is too small;
 * so does kiln_volume_gl_march. */
bool kiln_volume_gl_begin(struct kiln_volume_gl *gl, struct kiln_image *depth,
                          struct kiln_error *error);

/* Draws the gas of a domain over the planes of the picture, for the march's tiles that blocks
 * touch. Of the march's planes and halfway, only whether they are there counts; its grid does not
 * count. Profiles are written to the host, except near_m. same_field: the field is that of the last
 * call. */
bool kiln_volume_gl_march(struct kiln_volume_gl *gl, const struct kiln_volume_march *march,
                          const struct kiln_volume_tiles *tiles, bool same_field,
                          struct kiln_error *error);

/* Copies the planes to the host. halfway_m: gets the depths of half opacity; NULL: not needed. */
bool kiln_volume_gl_end(struct kiln_volume_gl *gl, const struct kiln_volume_planes *planes,
                        float *halfway_m, struct kiln_error *error);

#endif
