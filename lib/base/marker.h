/* Finds the markers by which servers of continuous integration take commands from the output of a
 * program and from reports. Texts of scenes, results and file names reach such outputs, so every
 * writer of an output breaks the markers in them: a scene of a stranger must not set a variable of
 * the job that renders it, nor upload a file of the machine. */
#ifndef KILN_BASE_MARKER_H
#define KILN_BASE_MARKER_H

#include "kiln.h"

/* Returns how many bytes of a marker that starts here stand before the place where another sign
 * breaks it: 1 for "##vso[", which "# #vso[" is not. Returns 0 where no marker starts.
 * `starts_line` says that only white space stands before the text in its line. */
size_t kiln_marker_break(const char *text, bool starts_line);

/* Returns whether a text starts a line, if the text before `c` does so, after the character at c.
 * White space, whether or not it ends a line, keeps a start; a line end makes one. */
bool kiln_marker_starts_line(char c, bool starts_line);

/* Writes a text with a blank in each marker, which breaks it. `put` writes the character at the
 * start of a text as the output needs it, and returns the character's bytes, 1 or more. */
void kiln_marker_write(FILE *out, const char *text,
                       size_t (*put)(FILE *out, const char *text, const void *how),
                       const void *how);

#endif
