/* Converts FFmpeg's frames to pictures. */
#ifndef KILN_DECODE_AVFRAME_H
#define KILN_DECODE_AVFRAME_H

#include "asset/image/image.h"
#include "base/ffmpeg.h"

/* Makes a picture of a decoded frame; the caller destroys it. Another code than KILN_OK comes with
 * what went wrong, as static text: KILN_INVALID_INPUT or, when memory is short, KILN_DEVICE_FAILED.
 */
enum kiln_code decode_avframe(const AVFrame *frame, struct kiln_asset_image **image,
                              const char **problem);

/* Before a decoder is opened: makes its pixels the same on every machine. */
void decode_same_everywhere(AVCodecContext *decoder);

#endif
