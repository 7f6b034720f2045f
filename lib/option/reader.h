/* Reads a tree into the struct that a table describes. Declares the state of one reading, and the
 * helpers that the readers of all types share. */
#ifndef KILN_OPTION_READER_H
#define KILN_OPTION_READER_H

#include "option/option.h"

struct kiln_default; /* holds the text of a default as a tree */

/* The caller sets the members above the blank line; all others are 0 at the start. */
struct kiln_reader {
    const struct kiln_origin *origin; /* where the text that is read came from */
    struct kiln_arena *arena;         /* owns the texts that the target points to */
    struct kiln_arena *scratch;       /* owns trees and keys, and may be destroyed after reading */
    struct kiln_error *error;
    void *target; /* the struct that the whole table fills, for types that need other parts of it */

    char path[512]; /* dotted path of the value that is being read: "systems.smoke.emit.rate" */
    size_t path_length;
    float4 *keys; /* keys of all animated values read so far; NULL before the first */
    uint32_t key_count;
    struct kiln_default *defaults;
};

/* Appends ".name" to the path and returns the length to restore with kiln_reader_leave. */
size_t kiln_reader_enter(struct kiln_reader *reader, const char *name);
size_t kiln_reader_enter_index(struct kiln_reader *reader, uint32_t index);
void kiln_reader_leave(struct kiln_reader *reader, size_t length);

/* Fills the error with "file:line:column: path: message"; returns false. */
bool kiln_reader_error(struct kiln_reader *reader, const struct kiln_node *node, const char *format,
                       ...) __attribute__((format(printf, 3, 4)));

/* Fills the error like kiln_reader_error, for a dotted path below root ("systems.smoke.emit"), or
 * for the nearest part of the path that is in the file. */
bool kiln_reader_error_at(struct kiln_reader *reader, const struct kiln_node *root,
                          const char *path, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Fills the error with "expected <allowed values>, found <the node>"; returns false. */
bool kiln_reader_mismatch(struct kiln_reader *reader, const struct kiln_option *option,
                          const struct kiln_node *node);
bool kiln_reader_expected(struct kiln_reader *reader, const struct kiln_node *node,
                          const char *expected);
bool kiln_reader_out_of_memory(struct kiln_reader *reader);

/* Copies a text into the arena that the target's texts lie in. */
bool kiln_reader_keep_text(struct kiln_reader *reader, const char *text, const char **kept);

/* Returns whether YAML takes a node for a text. Without quotes, some words are numbers, booleans or
 * null. */
bool kiln_reader_is_text(const struct kiln_node *node);

/* Fills one struct from a mapping: all members, defaults for those that are missing. node NULL
 * takes every default. */
bool kiln_read_members(struct kiln_reader *reader, const struct kiln_option *members,
                       const struct kiln_node *node, void *base);

/* Reads a text, which must end in a zero byte that size does not count, and fills the reader's
 * target by a table. */
bool kiln_read_document(struct kiln_reader *reader, const struct kiln_option *rows,
                        const char *text, size_t size);

/* Reads a number with its unit into SI and checks the limits, as a float or as a double. */
bool kiln_read_number(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, double *value);
bool kiln_read_float(struct kiln_reader *reader, const struct kiln_option *option,
                     const struct kiln_node *node, float *value);

/* Reads a whole number. */
bool kiln_read_whole(struct kiln_reader *reader, const struct kiln_option *option,
                     const struct kiln_node *node, uint32_t *value);

#endif
