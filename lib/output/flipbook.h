/* Writes flipbooks: frames in cells of one picture, as game engines play them. */
#ifndef KILN_OUTPUT_FLIPBOOK_H
#define KILN_OUTPUT_FLIPBOOK_H

#include "output/formats.h"

/* Takes the place of the PNG format where params.flipbook has cells. It writes the atlas, and
 * beside it the layout (NAME.json) and, on request, the motion (NAME_motion.png). */
extern const struct kiln_format kiln_format_flipbook;

#endif
