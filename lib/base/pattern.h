/* Declares the patterns of numbered files, such as "frame_####.png". A pattern says where the
 * number of a frame goes in a file name.
 *
 * The code that writes pictures (lib/output, lib/suite/rendering.c, lib/compare/difference.c) and
 * the code that reads numbered pictures (lib/compare/footage.c) parse a path once and then make the
 * path of each frame. Both sides must make the same file name for a frame, and users type the
 * patterns, so what a pattern means must not change; new forms may be added. */
#ifndef KILN_BASE_PATTERN_H
#define KILN_BASE_PATTERN_H

#include "base/temporary.h"
#include "kiln.h"

/* A parsed path: the text before the number and the text after it. */
struct kiln_path_pattern {
    char before[KILN_PATH_SIZE];
    char after[256];
    bool numbered;   /* false: `before` is the whole path */
    uint32_t digits; /* a number with fewer digits gets leading zeros */
};

/* Says whether file names have a number. */
enum kiln_numbering {
    KILN_NUMBER_NEVER,    /* for one file with all frames: a place for a number is an error */
    KILN_NUMBER_IF_ASKED, /* for a single frame: a number only where the name has a place for it */
    /* For several frames: if the name has no place for a number, "_" and four digits are inserted
     * before its suffix. The caller has checked that the name has a suffix. */
    KILN_NUMBER_ALWAYS,
};

/* Parses a path such as "frame_####.png" or "frame_%04d.png". The file name has at most one place
 * for the number: a run of '#', one for each digit, or %d with an optional width. Both forms give
 * leading zeros; "%4d" means the same as "%04d". In the file name, "%%" stands for a percent sign
 * and "%#" for a hash.
 *
 * Folder names are not parsed: "%%" stays "%%", and a single '#' is a hash. Only a run of two or
 * more '#', or %d with or without a width, is an error in them, since its writer probably meant the
 * number.
 *
 * Returns false with KILN_USAGE if anything else follows a percent sign in the file name, if there
 * are two places for a number, one in a folder name, one that KILN_NUMBER_NEVER forbids, or one of
 * more than 9 digits, or if the path is too long. */
bool kiln_path_pattern_parse(struct kiln_path_pattern *pattern, const char *path,
                             enum kiln_numbering numbering, struct kiln_error *error);

/* Writes the path of a frame; false when it does not fit into size bytes. */
bool kiln_path_pattern_format(const struct kiln_path_pattern *pattern, uint32_t frame, char *path,
                              size_t size);

#endif
