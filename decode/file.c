/* This file chooses the reader of a file by its format: that of one picture, and that of all frames
 * of an animation. It keeps what readers find wrong. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "decode.h"

void decode_warn(struct decode_picture *picture, const char *format, ...)
{
    const size_t length = strlen(picture->warning), room = sizeof picture->warning - length;
    const int divided = snprintf(picture->warning + length, room, "%s", length > 0 ? "; " : "");
    va_list args;
    va_start(args, format);
    if ((size_t)divided < room)
        vsnprintf(picture->warning + length + divided, room - (size_t)divided, format, args);
    va_end(args);
}

static bool take_first(void *user, struct kiln_asset_image *image)
{
    struct kiln_asset_image **first = user;
    *first = image;
    return false;
}

/* Decodes the first frame of a file. */
static struct kiln_asset_image *decode_first(decode_frames *frames, struct decode_picture *picture)
{
    struct kiln_asset_image *image = NULL;
    if (!frames(picture, take_first, &image))
        kiln_asset_image_destroy(&image);
    return image;
}

decode_frames *decode_frames_of(enum kiln_picture_format format)
{
    return format == KILN_PICTURE_WEBP  ? decode_webp_frames
           : format == KILN_PICTURE_GIF ? decode_gif_frames
                                        : NULL;
}

struct kiln_asset_image *decode_file(struct decode_picture *picture)
{
    decode_frames *frames = decode_frames_of(picture->format);
    if (frames)
        return decode_first(frames, picture);
    switch (picture->format) {
    case KILN_PICTURE_JPEG:
        return decode_jpeg(picture);
    case KILN_PICTURE_TIFF:
        return decode_tiff(picture);
    case KILN_PICTURE_BMP:
        return decode_by_ffmpeg(picture);
    case KILN_PICTURE_EXR:
        return decode_exr(picture);
    case KILN_PICTURE_HDR:
        return decode_hdr(picture);
    default:
        return decode_png(picture);
    }
}
