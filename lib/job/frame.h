/* Declares frames that a program keeps (kiln_rendering_take_frame). */
#ifndef KILN_JOB_FRAME_H
#define KILN_JOB_FRAME_H

#include "output/output.h"

/* Makes a frame and takes ownership of the picture, also on failure: NULL with KILN_DEVICE_FAILED
 * when memory is short. */
struct kiln_frame *kiln_frame_create(struct kiln_picture *picture, struct kiln_error *error);

#endif
