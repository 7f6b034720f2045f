/* Writes pictures of differences as PNG: the error map, alone or beside reference and test. */
#ifndef KILN_COMPARE_DIFFERENCE_H
#define KILN_COMPARE_DIFFERENCE_H

#include "base/pattern.h"
#include "compare/footage.h"
#include "compare/measure.h"
#include "kiln_program.h"

/* The files that pictures of differences go to, and the panels of these pictures. */
struct kiln_difference_plan {
    const char *path; /* the path as it was given */
    bool map_alone;   /* the error map; else reference, test and error map side by side */
    bool overwrite;
    bool folder; /* path is a folder, which gets NAME.png for each frame of that name */
    struct kiln_path_pattern pattern;
    const char *option;
    struct kiln_claims *claims; /* for pictures that are declared as they are written; else NULL */
};

/* Plans the files of pictures of differences. A single picture goes to path. The pictures of a
 * sequence go to a pattern with a number; a path without one gets "_0000". With a path that is a
 * folder or ends in a slash, each picture is named after its frame. KILN_USAGE when the path is
 * invalid or no PNG, KILN_IO when a single picture may not be put there. */
bool kiln_difference_plan_make(struct kiln_difference_plan *plan, const char *path, bool map_alone,
                               bool sequence, bool overwrite, struct kiln_error *error);

/* Declares the pictures that are written for `option`, one for each frame of the reference. For a
 * video, only the first picture is declared here; the others are declared when they are written.
 * The claims must outlive the plan. */
bool kiln_difference_plan_claim(struct kiln_difference_plan *plan, const char *option,
                                const struct kiln_footage *reference, struct kiln_claims *claims,
                                struct kiln_error *error);

/* Writes one picture, which appears whole or not at all. name is the frame's name, and number goes
 * into the pattern. Fails with KILN_IO or KILN_DEVICE_FAILED. */
bool kiln_difference_write(const struct kiln_difference_plan *plan, const char *name,
                           uint32_t number, const struct kiln_compare_picture *reference,
                           const struct kiln_compare_picture *test, const float *errors,
                           struct kiln_error *error);

#endif
