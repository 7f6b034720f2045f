/* Sends frames to standard output, for another program (`--output -`). */
#ifndef KILN_CMD_PIPE_H
#define KILN_CMD_PIPE_H

#include "options.h"

#define PIPE_OPTION                                                                                \
    {                                                                                              \
        .name = "pipe", .kind = OPTION_CHOICE, .placeholder = "y4m|rgb24|rgba|rgbaf32",            \
        .help = "What '--output -' writes to standard output: Y4M as in an MP4; bytes in sRGB, "   \
                "with straight alpha or none; or floats, little-endian, linear, premultiplied.",   \
        .fallback = "y4m"                                                                          \
    }

/* Sets the format of the stream if `--output -` is given. Returns 0, or the exit code after
 * reporting what is wrong. */
int pipe_read(struct kiln_stream *stream, const struct arguments *arguments);

/* Reserves standard output for the frames of the stream. From then on everything else that is
 * printed there goes to standard error. Does nothing for KILN_STREAM_NONE. Returns 0, or the exit
 * code after reporting. */
int pipe_open(struct kiln_stream *stream);

#endif
