/* Reads videos frame by frame, for flipbooks (asset/atlas/cells_in.c) and comparisons
 * (compare/footage.c). A sandboxed process, kiln-decode, decodes them. kiln opens the file and
 * passes its descriptor, so a video cannot make kiln-decode open another file. */
#ifndef KILN_ASSET_IMAGE_VIDEO_IN_H
#define KILN_ASSET_IMAGE_VIDEO_IN_H

#include "asset/image/image.h"

enum { KILN_MAX_VIDEO_FRAMES = 1000000 }; /* reading a frame beyond it fails */

/* Returns whether a file name has the suffix of a video format (.mp4, .mov, .mkv, .webm, .avi,
 * .m4v, .gif, .apng), in upper or lower case. */
bool kiln_video_in_has_suffix(const char *path);

struct kiln_video_in;

/* Opens a video; of several video streams, FFmpeg chooses the best. Returns NULL with KILN_IO when
 * the file cannot be opened, KILN_INVALID_INPUT when it is no video that can be decoded,
 * KILN_OVER_LIMIT when the loader's budget is exceeded, and KILN_DEVICE_FAILED when memory is short
 * or kiln-decode is not installed. The loader gives the asset root, the budget and the processes;
 * it must outlive the video. With NULL, any file may be opened, and nothing is counted. */
struct kiln_video_in *kiln_video_in_open(struct kiln_loader *loader, const char *path,
                                         struct kiln_error *error);
void kiln_video_in_close(struct kiln_video_in **video);

/* Reads the next frame, in the order of display. Returns true with the image, which the caller
 * destroys (kiln_asset_image_destroy), or with NULL after the last frame. kiln-decode decodes the
 * following frames while the caller uses this one. Colours are converted by the matrix and range
 * that the file names, and are taken as encoded with sRGB's transfer function, whatever the file
 * says. Returns false when a frame is broken, the file was cut short, a limit of image.h or
 * KILN_MAX_VIDEO_FRAMES is exceeded, or the loader's budget is. The video can then only be
 * closed. */
bool kiln_video_in_read(struct kiln_video_in *video, struct kiln_asset_image **image,
                        struct kiln_error *error);

#endif
