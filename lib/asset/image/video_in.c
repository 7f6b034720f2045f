/* This file reads a video frame by frame from a kiln-decode process of its own. The socket holds
 * the process back while no frame is taken. What FFmpeg passes over silently (a file that ends too
 * early, a damaged frame) is an error, since a comparison must not pass on missing frames. */
#include "asset/image/video_in.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "asset/image/animated.h"
#include "asset/image/received.h"
#include "base/error.h"

#define ALLOWED "MP4, MOV, Matroska, WebM, AVI, GIF, APNG or animated WebP"

struct kiln_video_in {
    char *path;
    struct kiln_received received;
    uint32_t frames; /* number of frames read */
    bool has_ended;
};

bool kiln_video_in_has_suffix(const char *path)
{
    static const char *const suffixes[] = {".mp4",  ".m4v", ".mov", ".mkv",
                                           ".webm", ".avi", ".gif", ".apng"};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof suffixes / sizeof *suffixes; i++) {
        if (strcasecmp(dot, suffixes[i]) == 0)
            return true;
    }
    return false;
}

/* Hands the file over and takes the first answer, which describes the video. */
static bool begin(struct kiln_video_in *video, int file, struct kiln_error *error)
{
    struct kiln_received *received = &video->received;
    const bool webp = kiln_file_is_webp(file), gif = kiln_file_is_gif(file);
    const struct kiln_decode_request request = {
        .format = gif ? KILN_PICTURE_GIF : KILN_PICTURE_WEBP,
        .frames = true,
        .most_bytes = webp || gif ? KILN_MAX_IMAGE_BYTES : UINT64_MAX,
        .most_pixels = KILN_MAX_IMAGE_PIXELS,
    };
    const enum kiln_decode_kind kind = webp  ? KILN_DECODE_WEBP
                                       : gif ? KILN_DECODE_PICTURE
                                             : KILN_DECODE_VIDEO;
    received->helper = kiln_loader_take(received->loader, kind, error);
    if (!received->helper)
        return false;
    struct kiln_error reason = {0};
    struct kiln_decode_answer answer;
    return (kiln_helper_send(received->helper, &request, sizeof request, file, &reason) &&
            kiln_helper_answer(received->helper, kiln_loader_caller(received->loader),
                               1u << KILN_DECODE_READY, &answer, &reason)) ||
           kiln_received_fail(received, &reason, error);
}

struct kiln_video_in *kiln_video_in_open(struct kiln_loader *loader, const char *path,
                                         struct kiln_error *error)
{
    const struct kiln_loader_file named = {path, "video", ALLOWED, SIZE_MAX};
    size_t size = 0;
    const int file = kiln_loader_open(loader, &named, &size, error);
    if (file < 0)
        return NULL;
    struct kiln_video_in *video = calloc(1, sizeof *video);
    char *copy = video ? strdup(path) : NULL;
    if (copy) {
        video->path = copy;
        video->received = (struct kiln_received){.loader = loader, .name = copy};
        if (!begin(video, file, error))
            kiln_video_in_close(&video);
    } else {
        kiln_error_no_memory(error, "opening the video of %s", path);
        free(video);
        video = NULL;
    }
    close(file);
    return video;
}

void kiln_video_in_close(struct kiln_video_in **video)
{
    if (!*video)
        return;
    kiln_helper_end(&(*video)->received.helper);
    free((*video)->path);
    free(*video);
    *video = NULL;
}

bool kiln_video_in_read(struct kiln_video_in *video, struct kiln_asset_image **image,
                        struct kiln_error *error)
{
    struct kiln_error reason = {0};
    *image = NULL;
    if (video->has_ended)
        return true;
    kiln_helper_begin(video->received.helper);
    *image = kiln_received_image(&video->received, 1u << KILN_DECODE_PIXELS | 1u << KILN_DECODE_END,
                                 &reason);
    if (reason.code == KILN_OK && *image && ++video->frames > KILN_MAX_VIDEO_FRAMES) {
        kiln_asset_image_destroy(image);
        kiln_error_set(&reason, KILN_INVALID_INPUT, "the video has more than %d frames",
                       KILN_MAX_VIDEO_FRAMES);
    }
    video->has_ended = !*image && reason.code == KILN_OK;
    return reason.code == KILN_OK || kiln_received_fail(&video->received, &reason, error);
}
