/* The container of a clip: packets in, a file out. Functions return one of FFmpeg's statuses, below
 * 0 for an error; what the disk says is in the file's `failure`. */
#ifndef KILN_OUTPUT_MUXER_H
#define KILN_OUTPUT_MUXER_H

#include "output/video.h"

struct kiln_muxer {
    const struct kiln_output_params *params;
    struct kiln_temporary *file;
    AVFormatContext *container;
    AVIOContext *io;
    AVStream *stream;     /* the container's */
    AVRational time_base; /* of the packets: a frame */
    bool begun;           /* the container waits for its end */
};

/* Writes the header of a stream. What codec and time_base say is copied. Zero-initialised is
 * closed, and closing frees what there is after a failure, too. */
int kiln_muxer_open(struct kiln_muxer *muxer, const struct kiln_output_params *params,
                    const AVCodecParameters *codec, AVRational time_base,
                    struct kiln_temporary *file);
void kiln_muxer_close(struct kiln_muxer *muxer);

/* Adds a packet, whose times count frames from the start of the clip; it is empty afterwards. */
int kiln_muxer_add(struct kiln_muxer *muxer, AVPacket *packet);

/* Ends the file. */
int kiln_muxer_finish(struct kiln_muxer *muxer);

#endif
