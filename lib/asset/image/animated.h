/* Finds whether a picture file has several frames. */
#ifndef KILN_ASSET_IMAGE_ANIMATED_H
#define KILN_ASSET_IMAGE_ANIMATED_H

#include "kiln.h"

/* Returns whether an open file is an animated WebP, PNG or GIF, by its blocks; its name and its
 * pixels are not looked at. */
bool kiln_file_is_animated(int file);

/* Returns whether an open file is a WebP. */
bool kiln_file_is_webp(int file);

#endif
