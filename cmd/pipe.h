/* Sends frames to standard output, for another program (`--output -`). */
#ifndef KILN_CMD_PIPE_H
#define KILN_CMD_PIPE_H

#include "options.h"

#define PIPE_OPTION                                                                                \
    {                                                                                              \
        .name = "pipe", .kind = OPTION_CHOICE, .placeholder = "y4m|rgb24|rgba|rgbaf32",            \
        .help =                                                                                    \
            "What '--output -' writes to standard output: Y4M as in an MP4; bytes in sRGB, with "  \
            "straight alpha or none; or floats, little-endian, linear, premultiplied.",            \
        .fallback = "y4m"                                                                          \
    }

/* Finds out whether, and what, frames are to go to standard output. Returns 0, or the exit code
 * after reporting what is wrong. */
int pipe_read(struct kiln_stream *stream, const struct arguments *arguments);

/* Takes standard output for the frames of such a stream; from now on everything else that would be
 * printed there goes to standard error. Does nothing for a stream of no format. */
int pipe_open(struct kiln_stream *stream);

#endif
