/* Converts FFmpeg's frames to pictures. */
#ifndef KILN_DECODE_AVFRAME_H
#define KILN_DECODE_AVFRAME_H

#include "asset/image/image.h"
#include "base/ffmpeg.h"

/* Makes a picture of a decoded frame; the caller destroys it. With a code other than KILN_OK,
 * *problem is the fault as static text: KILN_INVALID_INPUT, or KILN_DEVICE_FAILED when memory is
 * short. */
enum kiln_code decode_avframe(const AVFrame *frame, struct kiln_asset_image **image,
                              const char **problem);

/* Sets up a decoder, before it is opened, so that its pixels are the same on every machine. */
void decode_same_everywhere(AVCodecContext *decoder);

#endif
