/* Writes the container of a clip, a file of packets. Functions return one of FFmpeg's statuses,
 * below 0 for an error. The file's `failure` has errors of the disk. */
#ifndef KILN_OUTPUT_MUXER_H
#define KILN_OUTPUT_MUXER_H

#include "output/video.h"

struct kiln_muxer {
    const struct kiln_output_params *params;
    struct kiln_temporary *file;
    AVFormatContext *container;
    AVIOContext *io;
    AVStream *stream;     /* owned by the container */
    AVRational time_base; /* unit of the packets' times: a frame */
    bool begun;           /* the header is written, the end is not */
};

/* Opens the file and writes the header of a stream. Codec and time_base are copied. A
 * zero-initialised muxer counts as closed. kiln_muxer_close frees everything, also after a
 * failure. */
int kiln_muxer_open(struct kiln_muxer *muxer, const struct kiln_output_params *params,
                    const AVCodecParameters *codec, AVRational time_base,
                    struct kiln_temporary *file);
void kiln_muxer_close(struct kiln_muxer *muxer);

/* Adds a packet, whose times count frames from the start of the clip; it is empty afterwards. */
int kiln_muxer_add(struct kiln_muxer *muxer, AVPacket *packet);

/* Writes the end of the file. */
int kiln_muxer_finish(struct kiln_muxer *muxer);

#endif
