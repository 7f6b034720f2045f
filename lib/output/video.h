/* Clips by FFmpeg: one core for every encoder and container (video.c), told apart by a row of
 * settings each (video_formats.c). */
#ifndef KILN_OUTPUT_VIDEO_H
#define KILN_OUTPUT_VIDEO_H

#include "base/ffmpeg.h"
#include "output/formats.h"

struct kiln_video_settings {
    const char *muxer; /* FFmpeg's names */
    const char *encoder;
    const char *codec;    /* what people call it: "H.264" */
    const char *kind;     /* of file, with its article: "an MP4 video" */
    const char *packages; /* of Debian, that bring the encoder */
    uint32_t bits;        /* of the display pixels that it takes; 0: as params.png_bits says */
    /* By (has alpha, has more than 8 bits); AV_PIX_FMT_NONE where the format holds no such pixels.
     */
    enum AVPixelFormat pixels[2][2];
    bool even_sizes;
    uint32_t max_edge;
    bool intra;                /* every frame stands alone */
    bool parts;                /* a clip is encoded part by part; else as a whole */
    const char *later_packets; /* FFmpeg's bit stream filters for those of all parts but the first;
                                  NULL: none */
    const char *muxer_options; /* "key=value:key=value", or NULL */
    /* Sets what the encoder is told; false when memory is short. NULL: there is nothing to set. */
    bool (*tune)(AVCodecContext *codec, const struct kiln_output_params *params);
    /* Adds options of the muxer that depend on the clip, and warns; FFmpeg's status. NULL: there
     * are none. */
    int (*prepare)(const struct kiln_output_params *params, AVDictionary **options);
};

/* Opens FFmpeg; KILN_IO where it is not installed, or was built without what a format needs. */
bool kiln_video_find(const struct kiln_video_settings *settings, struct kiln_error *error);

/* Reports what went wrong: the disk's answer if it gave one, what FFmpeg said, or its status. */
bool kiln_video_fail(const struct kiln_output_params *params, const struct kiln_temporary *file,
                     const char *said, int status, const char *what, struct kiln_error *error);

/* For clips whose packets are there already, in place of kiln_video_encode: begins a part at a
 * position in the clip, which fails when its encoder's header is another than the clip's; and adds
 * its packets, whose pts count from the start of the part, in the order of decoding. */
bool kiln_video_begin_part(void *opaque, int64_t first, const uint8_t *header, size_t size);
bool kiln_video_add_packet(void *opaque, AVPacket *packet, struct kiln_error *error);

/* The functions of a struct kiln_format whose settings are params->format->video; opaque is what
 * kiln_video_open returned. */
struct kiln_output_needs kiln_video_needs(const struct kiln_output_params *params);
bool kiln_video_check(const struct kiln_output_params *params, struct kiln_error *error);
void *kiln_video_open(const struct kiln_output_params *params, struct kiln_temporary *file,
                      struct kiln_error *error);
bool kiln_video_encode(void *opaque, const struct kiln_picture *picture, struct kiln_error *error);
bool kiln_video_finish(void *opaque, const struct kiln_caller *caller, struct kiln_error *error);
void kiln_video_close(void *opaque);

/* For settings with pixels of AV_PIX_FMT_PAL8, in place of kiln_video_encode: one byte a pixel,
 * rows from the top, and 256 colours as 0xAARRGGBB. number counts from 0 and ascends, but may leave
 * out some: the one before then lasts longer. */
bool kiln_video_encode_indices(void *opaque, const uint8_t *indices, const uint32_t palette[256],
                               int64_t number, struct kiln_error *error);

#endif
