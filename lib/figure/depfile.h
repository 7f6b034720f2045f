/* Makes the makefile of a figure's dependencies, which --depfile asks for. */
#ifndef KILN_FIGURE_DEPFILE_H
#define KILN_FIGURE_DEPFILE_H

#include "base/text.h"
#include "kiln_program.h"

/* Makes the text of a makefile in which the target depends on every file that the claims declare as
 * read, sorted by path. Files below the working directory have their path from there. Each of these
 * files is also a target without a rule, so that make does not fail when one is gone. The caller
 * frees the text. KILN_USAGE for a name that make cannot read. */
bool kiln_depfile_make(const char *target, const struct kiln_claims *claims, struct kiln_text *text,
                       struct kiln_error *error);

/* Returns whether the file `path` exists and its first rule is the target's. */
bool kiln_depfile_is_of(const char *path, const char *target);

#endif
