/* Declares the patterns of numbered files, such as "frame_####.png": where the number of a frame
 * goes in a file name.
 *
 * The code that writes pictures (lib/output, lib/suite/rendering.c, lib/compare/difference.c) and
 * the code that reads numbered pictures (lib/compare/footage.c) parse a path once and then make the
 * path of each frame. Both sides must make the same name of a frame, and users type the patterns,
 * so what a pattern means must not change; new forms may be added. */
#ifndef KILN_BASE_PATTERN_H
#define KILN_BASE_PATTERN_H

#include "base/temporary.h"
#include "kiln.h"

/* A parsed path: the text before the number and the text after it. */
struct kiln_path_pattern {
    char before[KILN_PATH_SIZE];
    char after[256];
    bool numbered;   /* false: `before` is the whole path */
    uint32_t digits; /* least digits of the number, which zeros fill up */
};

/* Whether the names of files have a number. */
enum kiln_numbering {
    KILN_NUMBER_NEVER,    /* one file for all frames: a number in the name is an error */
    KILN_NUMBER_IF_ASKED, /* a single frame: a number only where the name has a place for it */
    /* Several frames: where the name has no place for a number, "_0000" goes before its suffix,
     * which the name must have. */
    KILN_NUMBER_ALWAYS,
};

/* Parses a path such as "frame_####.png" or "frame_%04d.png". The number may stand once, in the
 * file name: as a run of '#', one for each digit, or as %d with an optional width. Zeros fill up
 * the width in both forms. "%%" is a percent sign and "%#" a hash. Returns false with KILN_USAGE
 * where anything else follows a percent sign, the path is too long, or the folder's name has a
 * number; that name is otherwise taken as it stands. */
bool kiln_path_pattern_parse(struct kiln_path_pattern *pattern, const char *path,
                             enum kiln_numbering numbering, struct kiln_error *error);

/* Writes the path of a frame; false when it does not fit into size bytes. */
bool kiln_path_pattern_format(const struct kiln_path_pattern *pattern, uint32_t frame, char *path,
                              size_t size);

#endif
