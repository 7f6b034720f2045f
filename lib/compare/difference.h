/* Pictures of differences: the error map, alone or beside reference and test, as PNG. */
#ifndef KILN_COMPARE_DIFFERENCE_H
#define KILN_COMPARE_DIFFERENCE_H

#include "base/pattern.h"
#include "compare/footage.h"
#include "compare/measure.h"
#include "kiln_program.h"

/* Where they go, and what they show. */
struct kiln_difference_plan {
    const char *path; /* as it was given */
    bool map_alone;   /* the error map; else reference, test and error map side by side */
    bool overwrite;
    bool folder; /* NAME.png of each frame's name in it */
    struct kiln_path_pattern pattern;
    const char *option;
    struct kiln_claims *claims; /* of pictures that have not been declared; else NULL */
};

/* A single picture goes to path; those of a sequence need a pattern with a number, or get one
 * ("_0000"); with a path that is a folder or ends in a slash, each is named after its frame.
 * KILN_USAGE when the path makes no sense or is no PNG, KILN_IO when a single one may not be put
 * there. */
bool kiln_difference_plan_make(struct kiln_difference_plan *plan, const char *path, bool map_alone,
                               bool sequence, bool overwrite, struct kiln_error *error);

/* Declares the pictures of the frames of a reference, which the call writes for `option`: all, but
 * only the first of a video, whose others are declared when they are written. The claims outlive
 * the plan. */
bool kiln_difference_plan_claim(struct kiln_difference_plan *plan, const char *option,
                                const struct kiln_footage *reference, struct kiln_claims *claims,
                                struct kiln_error *error);

/* Writes one picture, which appears whole or not at all. name is the frame's, number that for the
 * pattern. KILN_IO, KILN_DEVICE_FAILED. */
bool kiln_difference_write(const struct kiln_difference_plan *plan, const char *name,
                           uint32_t number, const struct kiln_subject *reference,
                           const struct kiln_subject *test, const float *errors,
                           struct kiln_error *error);

#endif
