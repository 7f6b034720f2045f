/* The encoder of one part of a clip: pictures in, packets out. It starts with a key frame and knows
 * of no other part. Functions return one of FFmpeg's statuses, below 0 for an error. */
#ifndef KILN_OUTPUT_CODER_H
#define KILN_OUTPUT_CODER_H

#include "output/scaler.h"
#include "output/video.h"

struct kiln_coder {
    const struct kiln_video_settings *settings;
    AVCodecContext *codec;
    AVFrame *frame;            /* to be filled, with nothing else known of it */
    struct SwsContext *scaler; /* NULL for palettes */
    AVBSFContext *filter;      /* of packets; NULL: they stay as they are */
};

enum AVPixelFormat kiln_coder_pixels(const struct kiln_output_params *params);

/* first: of a clip's parts, the one that says what made it. Zero-initialised is closed, and closing
 * frees what there is after a failure, too. */
int kiln_coder_open(struct kiln_coder *coder, const struct kiln_output_params *params, bool first);
void kiln_coder_close(struct kiln_coder *coder);

/* Converts a picture into coder->frame. */
int kiln_coder_convert(struct kiln_coder *coder, const struct kiln_picture *picture);

/* Takes coder->frame as frame `number` of the part; numbers ascend. kiln_coder_end tells that no
 * more come. */
int kiln_coder_send(struct kiln_coder *coder, int64_t number);
int kiln_coder_end(struct kiln_coder *coder);

/* A packet that is ready, whose pts is the number of its frame, in the order of decoding.
 * AVERROR(EAGAIN) when more frames are needed, AVERROR_EOF behind the last. */
int kiln_coder_receive(struct kiln_coder *coder, AVPacket *packet);

#endif
