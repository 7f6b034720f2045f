/* Converts the pixels of a picture to those of a video codec, by FFmpeg's scaler. */
#ifndef KILN_OUTPUT_SCALER_H
#define KILN_OUTPUT_SCALER_H

#include "base/ffmpeg.h"

/* Returns whether pixels are red, green and blue, or indices of such colours. */
bool kiln_pixels_are_rgb(enum AVPixelFormat format);

/* Opens a scaler from RGBA of 8 or 16 bits a channel to pixels of the format. The caller frees it
 * by sws_freeContext, also after a failure. Luma and chroma are BT.709's in limited range; chroma
 * of half the size is sited left, as H.264 has it. The result is the same on every machine. Returns
 * one of FFmpeg's statuses, below 0 for an error. */
int kiln_scaler_open(struct SwsContext **scaler, uint32_t width, uint32_t height, uint32_t bits,
                     enum AVPixelFormat format);

#endif
