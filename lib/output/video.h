/* Declares clips that FFmpeg writes. All encoders and containers share the code of video.c; each
 * has a row of settings in video_formats.c. */
#ifndef KILN_OUTPUT_VIDEO_H
#define KILN_OUTPUT_VIDEO_H

#include "base/ffmpeg.h"
#include "output/formats.h"

struct kiln_video_settings {
    const char *muxer; /* FFmpeg's names */
    const char *encoder;
    const char *codec;    /* the codec's common name: "H.264" */
    const char *kind;     /* name of the kind of file, with its article: "an MP4 video" */
    const char *packages; /* Debian packages that have the encoder */
    /* bits of a channel of the pixels that the encoder is given; 0: as params.png_bits says */
    uint32_t bits;
    /* FFmpeg's pixel formats by [has alpha][bits > 8]; AV_PIX_FMT_NONE where there is none. */
    enum AVPixelFormat pixels[2][2];
    bool even_sizes;
    uint32_t max_edge;
    bool intra; /* every frame is a key frame */
    bool parts; /* a clip is encoded part by part; else at once */
    /* FFmpeg's bit stream filters for all packets of the parts after the first; NULL: none */
    const char *later_parts_filter;
    const char *muxer_options; /* "key=value:key=value", or NULL */
    /* Sets options of the encoder; false when memory is short. NULL: there are none to set. */
    bool (*tune)(AVCodecContext *codec, const struct kiln_output_params *params);
    /* Adds options of the muxer that depend on the clip, and logs warnings. Returns FFmpeg's
     * status. NULL: there are none. */
    int (*prepare)(const struct kiln_output_params *params, AVDictionary **options);
};

/* Opens FFmpeg's libraries; KILN_IO where they are missing, or lack what a format needs. */
bool kiln_video_find(const struct kiln_video_settings *settings, struct kiln_error *error);

/* Fills the error: with the disk's error if there was one, else with FFmpeg's message or its
 * status. */
bool kiln_video_fail(const struct kiln_output_params *params, const struct kiln_temporary *file,
                     const char *said, int status, const char *what, struct kiln_error *error);

/* Write packets that are encoded already, instead of kiln_video_encode. kiln_video_begin_part
 * begins a part at a position in the clip; it fails when the part's encoder has another header than
 * the clip's. Then packets are added in the order of decoding; their pts count from the start of
 * the part. */
bool kiln_video_begin_part(void *opaque, int64_t first, const uint8_t *header, size_t size);
bool kiln_video_add_packet(void *opaque, AVPacket *packet, struct kiln_error *error);

/* The functions of a struct kiln_format whose settings are params->format->video. `opaque` is the
 * result of kiln_video_open. */
struct kiln_output_needs kiln_video_needs(const struct kiln_output_params *params);

/* Returns whether clips of a format may have alpha. */
bool kiln_video_has_alpha(const struct kiln_output_params *params);

bool kiln_video_check(const struct kiln_output_params *params, struct kiln_error *error);
void *kiln_video_open(const struct kiln_output_params *params, struct kiln_temporary *file,
                      struct kiln_error *error);
bool kiln_video_encode(void *opaque, const struct kiln_picture *picture, struct kiln_error *error);
bool kiln_video_finish(void *opaque, const struct kiln_caller *caller, struct kiln_error *error);
void kiln_video_close(void *opaque);

/* Encodes a frame of palette indices, for settings with pixels of AV_PIX_FMT_PAL8, instead of
 * kiln_video_encode: one byte a pixel, rows from the top, and 256 colours as 0xAARRGGBB. number
 * counts from 0 and ascends. Numbers may be left out; then the frame before lasts longer. */
bool kiln_video_encode_indices(void *opaque, const uint8_t *indices, const uint32_t palette[256],
                               int64_t number, struct kiln_error *error);

#endif
