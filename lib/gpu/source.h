/* This header declares the functions that join shader files by their includes and map lines of a
 * driver's messages back to the files. */
#ifndef KILN_GPU_SOURCE_H
#define KILN_GPU_SOURCE_H

#include "base/text.h"
#include "kiln.h"

enum { KILN_MAX_SOURCE_FILES = 128, KILN_MAX_SOURCE_PATH = 128, KILN_MAX_SOURCE_BRANCHES = 32 };

/* The number of no branch of #if: what is outside of all. */
#define KILN_SOURCE_WHOLE SIZE_MAX

/* Describes lines of the joined text that come from one file: those from `line` up to the next
 * piece. */
struct kiln_source_piece {
    size_t line;
    size_t file_line;
    size_t file; /* index, or KILN_MAX_SOURCE_FILES for the lines that kiln puts before the file */
};

/* Holds a joined text. A zero-initialised kiln_source is empty; kiln_source_finish frees it. The
 * text has no "#line" directives, because Mesa reports their string number as 0 for most errors.
 * Lines are mapped by the table of pieces instead. */
struct kiln_source {
    struct kiln_text text;
    size_t line_count;
    char files[KILN_MAX_SOURCE_FILES][KILN_MAX_SOURCE_PATH];
    size_t file_count;
    /* Branches of #if have numbers, and a file that is in the text with an include guard has that
     * of its branch, or KILN_SOURCE_WHOLE. */
    size_t branches[KILN_MAX_SOURCE_BRANCHES], branch_count, last_branch;
    size_t inserted_in[KILN_MAX_SOURCE_FILES];
    struct kiln_source_piece *pieces;
    size_t piece_count, piece_capacity;
};

bool kiln_source_load(struct kiln_source *source, const char *file, const char *defines,
                      struct kiln_error *error);
void kiln_source_finish(struct kiln_source *source);

/* Appends one line of a driver's message (length bytes) to out and replaces its "0:12(3)", "0(12)"
 * or "ERROR: 0:12" by "shaders/file:12". A line of another form is appended unchanged. */
void kiln_source_map_line(const struct kiln_source *source, const char *line, size_t length,
                          struct kiln_text *out);

#endif
