/* Finds whether a picture file has several frames. */
#ifndef KILN_ASSET_IMAGE_ANIMATED_H
#define KILN_ASSET_IMAGE_ANIMATED_H

#include "kiln.h"

/* Returns whether an open file is an animated WebP, PNG or GIF, by its blocks; its name and its
 * pixels are not looked at. */
bool kiln_file_is_animated(int file);

/* Return whether an open file is a WebP, a GIF, or a TIFF, which may have several pages. */
bool kiln_file_is_webp(int file);
bool kiln_file_is_gif(int file);
bool kiln_file_is_tiff(int file);

#endif
