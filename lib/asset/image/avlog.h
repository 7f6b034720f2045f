/* What FFmpeg has to say, taken from stderr to where it belongs. */
#ifndef KILN_ASSET_IMAGE_AVLOG_H
#define KILN_ASSET_IMAGE_AVLOG_H

#include "kiln.h"

/* Collects the messages of one stretch of FFmpeg calls. */
struct kiln_avlog {
    const struct kiln_log *log; /* gets warnings and errors as debug lines; NULL: none */
    char first_error[192];      /* the first message of level error, "" if none came */
    struct kiln_avlog *outer;   /* set by begin */
};

/* Between begin and end, FFmpeg's messages from this thread go to avlog; those of other threads
 * and of the time outside go where they always went. Pairs may nest. The first begin installs
 * FFmpeg's log callback, of which a process has one. */
void kiln_avlog_begin(struct kiln_avlog *avlog);
void kiln_avlog_end(struct kiln_avlog *avlog);

#endif
