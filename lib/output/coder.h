/* Declares the encoder of one part of a clip, which makes packets from pictures. The first packet
 * is a key frame, and no packet depends on another part. Functions return one of FFmpeg's statuses,
 * below 0 for an error. */
#ifndef KILN_OUTPUT_CODER_H
#define KILN_OUTPUT_CODER_H

#include "output/scaler.h"
#include "output/video.h"

struct kiln_coder {
    const struct kiln_video_settings *settings;
    AVCodecContext *codec;
    AVFrame *frame;            /* the frame to fill before kiln_coder_send */
    struct SwsContext *scaler; /* converts pixels; NULL for palettes */
    AVBSFContext *filter;      /* changes packets; NULL: packets stay as they are */
};

enum AVPixelFormat kiln_coder_pixels(const struct kiln_output_params *params);

/* Opens the encoder of a part. first: the part is the first of the clip, whose packets name the
 * encoder. A zero-initialised coder counts as closed. kiln_coder_close frees everything, also after
 * a failure. */
int kiln_coder_open(struct kiln_coder *coder, const struct kiln_output_params *params, bool first);
void kiln_coder_close(struct kiln_coder *coder);

/* Converts a picture into coder->frame. */
int kiln_coder_convert(struct kiln_coder *coder, const struct kiln_picture *picture);

/* Encodes coder->frame as frame `number` of the part; numbers ascend. kiln_coder_end says that no
 * more frames come. */
int kiln_coder_send(struct kiln_coder *coder, int64_t number);
int kiln_coder_end(struct kiln_coder *coder);

/* Returns a packet that is ready. Packets come in the order of decoding, and a packet's pts is the
 * number of its frame. AVERROR(EAGAIN) when more frames are needed, AVERROR_EOF behind the last
 * packet. */
int kiln_coder_receive(struct kiln_coder *coder, AVPacket *packet);

#endif
