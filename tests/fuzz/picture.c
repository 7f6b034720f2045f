/* Fuzzes the decoding of pictures by FFmpeg, libjpeg-turbo, libtiff, libwebp and kiln's own reader
 * of HDR files: for any input the decoder must return an image within the size limits or an error,
 * and never crash. If this fails, a malicious picture may take over kiln-decode, the separate
 * process that decodes untrusted files. The first two bytes of an input choose the file format. */
#include <string.h>

#include "base/ffmpeg.h"
#include "decode.h"
#include "fuzz.h"
#include "image_check.h"

static enum kiln_picture_format format_of(const uint8_t *data, size_t size)
{
    if (size >= 2 && memcmp(data, "BM", 2) == 0)
        return KILN_PICTURE_BMP;
    if (size >= 2 && (memcmp(data, "II", 2) == 0 || memcmp(data, "MM", 2) == 0))
        return KILN_PICTURE_TIFF;
    if (size >= 2 && memcmp(data, "RI", 2) == 0)
        return KILN_PICTURE_WEBP;
    if (size >= 2 && memcmp(data, "GI", 2) == 0)
        return KILN_PICTURE_GIF;
    if (size >= 2 && memcmp(data, "#?", 2) == 0)
        return KILN_PICTURE_HDR;
    return KILN_PICTURE_JPEG;
}

static bool keep_last(void *user, struct kiln_asset_image *image)
{
    struct kiln_asset_image **last = user;
    kiln_asset_image_destroy(last);
    *last = image;
    return true;
}

static struct kiln_asset_image *drop(struct kiln_asset_image *image)
{
    kiln_asset_image_destroy(&image);
    return NULL;
}

/* Decodes all frames of a file and returns the last, or its one picture. */
static struct kiln_asset_image *decode(struct decode_picture *picture)
{
    struct kiln_asset_image *last = NULL;
    decode_frames *frames = decode_frames_of(picture->format);
    if (!frames)
        return decode_file(picture);
    return frames(picture, keep_last, &last) ? last : drop(last);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct kiln_error error = {0};
    require(kiln_ffmpeg_open(KILN_FFMPEG_PICTURES, &error), "FFmpeg is missing");
    require(decode_jpeg_begin(&error) && decode_tiff_begin(&error) && decode_webp_begin(&error) &&
                decode_profile_begin(&error),
            "a library is missing");
    struct decode_picture picture = {.bytes = data,
                                     .size = size,
                                     .format = format_of(data, size),
                                     .pages = 1,
                                     .most_pixels = KILN_MAX_IMAGE_PIXELS,
                                     .error = &error};
    fuzz_taken = check_image(decode(&picture), &error);
    return 0;
}
