/* Declares the state of reading a tree into the struct that a table describes, and the helpers that
 * the readers of all types share. */
#ifndef KILN_OPTION_READER_H
#define KILN_OPTION_READER_H

#include "option/option.h"

struct kiln_default; /* holds the tree of a default */
struct kiln_params;

/* The caller sets the members above the blank line; all others are 0 at the start. */
struct kiln_reader {
    const struct kiln_origin *origin; /* where the text comes from */
    struct kiln_arena *arena;         /* owns the texts that the target points to */
    struct kiln_arena *scratch;       /* owns trees and keys, and may be destroyed after reading */
    struct kiln_error *error;
    const struct kiln_log *log; /* gets warnings; NULL: nobody does */
    void *target; /* the struct that the whole table fills, for types that need other parts of it */
    struct kiln_node_counts *counts; /* of the nodes of the tree; NULL: nothing is copied */
    struct kiln_params *params;      /* that expressions may name; NULL: none */
    double clip_s;                   /* length of the clip, for times in "%"; 0: it is not known */

    uint32_t item;  /* number of the entry of a list that is being read, of the innermost list */
    char path[512]; /* dotted path of the value that is being read: "systems.smoke.emit.rate" */
    size_t path_length;
    float4 *keys; /* keys of all animated values read so far; NULL before the first */
    uint32_t key_count, key_room;
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

/* Logs a warning with the place that kiln_reader_error_at finds. */
void kiln_reader_warn_at(struct kiln_reader *reader, const struct kiln_node *root, const char *path,
                         const char *format, ...) __attribute__((format(printf, 4, 5)));

/* Fills the error with "expected <allowed values>, found <the node>"; returns false. */
bool kiln_reader_mismatch(struct kiln_reader *reader, const struct kiln_option *option,
                          const struct kiln_node *node);
bool kiln_reader_expected(struct kiln_reader *reader, const struct kiln_node *node,
                          const char *expected);
bool kiln_reader_out_of_memory(struct kiln_reader *reader);

/* Copies a text into the reader's arena, which owns the target's texts. */
bool kiln_reader_copy_text(struct kiln_reader *reader, const char *text, const char **copy);

/* Returns whether a node is a text in YAML. Words without quotes may be numbers, booleans or null
 * instead. */
bool kiln_reader_is_text(const struct kiln_node *node);

/* Fills one struct from a mapping, with defaults for missing keys. If node is NULL, all members get
 * their defaults. */
bool kiln_read_members(struct kiln_reader *reader, const struct kiln_option *members,
                       const struct kiln_node *node, void *base);

/* Parses a text of `size` bytes, which a zero byte must follow, and fills the reader's target as
 * the table describes. */
bool kiln_read_document(struct kiln_reader *reader, const struct kiln_option *rows,
                        const char *text, size_t size);

/* Read a number, convert it to SI by its unit and check its limits, as a double or as a float. */
bool kiln_read_number(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, double *value);
bool kiln_read_float(struct kiln_reader *reader, const struct kiln_option *option,
                     const struct kiln_node *node, float *value);

/* Reads a whole number and checks its limits. */
bool kiln_read_whole(struct kiln_reader *reader, const struct kiln_option *option,
                     const struct kiln_node *node, uint32_t *value);

#endif
