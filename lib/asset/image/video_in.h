/* Videos in, frame by frame, decoded by kiln-decode. The file is opened here and its descriptor
 * handed over; it cannot make anybody open another one. */
#ifndef KILN_ASSET_IMAGE_VIDEO_IN_H
#define KILN_ASSET_IMAGE_VIDEO_IN_H

#include "asset/image/image.h"

enum { KILN_MAX_VIDEO_FRAMES = 1000000 };

/* Whether a file name ends as one of the videos that can be opened does (.mp4, .mov, .mkv, .webm,
 * .avi, .m4v, .gif, .apng), in any case of letters. */
bool kiln_video_in_has_suffix(const char *path);

struct kiln_video_in;

/* Opens the one video stream of a file. NULL with KILN_IO when it cannot be opened,
 * KILN_INVALID_INPUT when it is no such video, KILN_OVER_LIMIT, KILN_DEVICE_FAILED when memory is
 * short. The loader may be NULL, and must outlive it. */
struct kiln_video_in *kiln_video_in_open(struct kiln_loader *loader, const char *path,
                                         struct kiln_error *error);
void kiln_video_in_close(struct kiln_video_in **video);

/* Gets the next frame, in the order of display: true with the image, which the caller destroys, or
 * with NULL after the last one. Frames are decoded ahead, while the caller looks at this one.
 * Colours are converted by the matrix and range that the file names, and taken as encoded with
 * sRGB's transfer function. False when a frame is broken, the file was cut short, or the limits of
 * image.h or the one above are exceeded; nothing can be read after that. */
bool kiln_video_in_read(struct kiln_video_in *video, struct kiln_asset_image **image,
                        struct kiln_error *error);

#endif
