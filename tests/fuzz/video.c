/* Fuzzes the decoder of videos: for any input each frame must be an image within the size limits,
 * or decoding must end with an error, and nothing may crash. If this fails, a malicious video may
 * take over kiln-decode, the separate process that decodes untrusted files. */
#include <sys/mman.h>
#include <unistd.h>

#include "base/ffmpeg.h"
#include "decode.h"
#include "fuzz.h"
#include "image_check.h"

enum { MOST_FRAMES = 8 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct kiln_error error = {0};
    require(kiln_ffmpeg_open(KILN_FFMPEG_CLIPS, &error), "FFmpeg is missing");
    const int file = memfd_create("fuzz", 0);
    require(file >= 0 && write(file, data, size) == (ssize_t)size, "no memory");
    struct decode_video *video = decode_video_open(file, &error);
    require(video || (error.code != KILN_OK && *error.message), "an error without a message");
    fuzz_taken = false;
    for (int i = 0; video && i < MOST_FRAMES; i++) {
        struct kiln_asset_image *image = NULL;
        if (!decode_video_read(video, &image, &error) || !image)
            break;
        fuzz_taken = check_image(image, &error);
    }
    decode_video_close(&video);
    close(file);
    return 0;
}
