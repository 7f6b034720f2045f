/* Finds whether a picture file may have several frames, layers or pages. */
#ifndef KILN_ASSET_IMAGE_ANIMATED_H
#define KILN_ASSET_IMAGE_ANIMATED_H

#include "kiln.h"

/* Returns whether an open file is an animated WebP, PNG or GIF, by its blocks; its name and its
 * pixels are not looked at. */
bool kiln_file_is_animated(int file);

/* Return whether an open file is a WebP, a GIF, an EXR, which may have several layers, or a TIFF,
 * which may have several pages. */
bool kiln_file_is_webp(int file);
bool kiln_file_is_exr(int file);
bool kiln_file_is_gif(int file);
bool kiln_file_is_tiff(int file);

#endif
