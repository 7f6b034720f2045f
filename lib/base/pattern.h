/* Says where the number of a frame goes in a file name. */
#ifndef KILN_BASE_PATTERN_H
#define KILN_BASE_PATTERN_H

#include "base/temporary.h"
#include "kiln.h"

struct kiln_path_pattern {
    char before[KILN_PATH_SIZE];
    char after[256];
    bool numbered;
    uint32_t digits; /* at least so many are written; a larger number takes more */
};

/* Whether the names of an output's files have a number. */
enum kiln_numbering {
    KILN_NUMBER_NEVER,    /* one file for all frames: a number in the name is an error */
    KILN_NUMBER_IF_ASKED, /* a single frame: with a number only if the name has one */
    KILN_NUMBER_ALWAYS,   /* several frames: "_0000" is added when the name has no number */
};

/* Reads "frame_####.png" or "frame_%04d.png": in the file name, once, a run of # as wide as the
 * number or %d with an optional width, padded with zeros either way; %% is a percent sign and %# a
 * hash. Anything else after a percent sign is KILN_USAGE, as is a number in the folder, whose name
 * is otherwise taken as it stands. */
bool kiln_path_pattern_parse(struct kiln_path_pattern *pattern, const char *path,
                             enum kiln_numbering numbering, struct kiln_error *error);

/* The path of a frame; false when it does not fit. */
bool kiln_path_pattern_format(const struct kiln_path_pattern *pattern, uint32_t frame, char *path,
                              size_t size);

#endif
