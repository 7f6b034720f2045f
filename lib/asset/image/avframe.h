/* From FFmpeg's frames to pictures. */
#ifndef KILN_ASSET_IMAGE_AVFRAME_H
#define KILN_ASSET_IMAGE_AVFRAME_H

#include <libavcodec/avcodec.h>

#include "asset/image/image.h"

/* Makes a picture of a decoded frame; the caller destroys it. Another code than KILN_OK comes with
 * what went wrong, as static text without a place: KILN_INVALID_INPUT or KILN_DEVICE_FAILED. */
enum kiln_code kiln_avframe_convert(const AVFrame *frame, struct kiln_asset_image **image,
                                    const char **problem);

/* Before a decoder is opened: makes its pixels the same on every machine. */
void kiln_avframe_same_everywhere(AVCodecContext *decoder);

#endif
