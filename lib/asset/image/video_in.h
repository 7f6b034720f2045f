/* Reads videos frame by frame, decoded by kiln-decode. kiln opens the file and passes its
 * descriptor, so a video cannot make kiln-decode open another file. */
#ifndef KILN_ASSET_IMAGE_VIDEO_IN_H
#define KILN_ASSET_IMAGE_VIDEO_IN_H

#include "asset/image/image.h"

enum { KILN_MAX_VIDEO_FRAMES = 1000000 };

/* Returns whether a file name has the suffix of a video format (.mp4, .mov, .mkv, .webm, .avi,
 * .m4v, .gif, .apng), in upper or lower case. */
bool kiln_video_in_has_suffix(const char *path);

struct kiln_video_in;

/* Opens a file that has one video stream. NULL with KILN_IO when it cannot be opened,
 * KILN_INVALID_INPUT when it is no such video, KILN_OVER_LIMIT, KILN_DEVICE_FAILED when memory is
 * short. The loader may be NULL, and must outlive the video. */
struct kiln_video_in *kiln_video_in_open(struct kiln_loader *loader, const char *path,
                                         struct kiln_error *error);
void kiln_video_in_close(struct kiln_video_in **video);

/* Reads the next frame, in the order of display: true with the image, which the caller destroys, or
 * with NULL after the last one. The process decodes ahead meanwhile. Colours are converted by the
 * matrix and range that the file names; they count as encoded with sRGB's transfer function. False
 * when a frame is broken, the file was cut short, or a limit of image.h or of this header is
 * exceeded. Nothing can be read after that. */
bool kiln_video_in_read(struct kiln_video_in *video, struct kiln_asset_image **image,
                        struct kiln_error *error);

#endif
