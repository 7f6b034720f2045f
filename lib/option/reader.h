/* From the tree to the scene: the state of one load, and what the types' readers share. */
#ifndef KILN_SCENE_READER_H
#define KILN_SCENE_READER_H

#include "option/option.h"

struct kiln_default; /* a default's text as a tree */

struct kiln_reader {
    struct kiln_arena *arena;   /* of the scene */
    struct kiln_arena *scratch; /* of the load: trees */
    struct kiln_error *error;
    struct kiln_scene *scene;
    char path[512]; /* "systems.smoke.emit.rate": where the reader is */
    size_t path_length;
    float4 keys[KILN_MAX_VALUE_KEYS]; /* becomes scene->keys */
    uint32_t key_count;
    struct kiln_default *defaults;
};

/* Appends ".name" to the path and returns the length to restore with kiln_reader_leave. */
size_t kiln_reader_enter(struct kiln_reader *reader, const char *name);
size_t kiln_reader_enter_index(struct kiln_reader *reader, uint32_t index);
void kiln_reader_leave(struct kiln_reader *reader, size_t length);

/* "file:line:column: path: message"; returns false. */
bool kiln_reader_error(struct kiln_reader *reader, const struct kiln_node *node, const char *format,
                       ...) __attribute__((format(printf, 3, 4)));

/* "expected <what the option allows>, found <the node>"; returns false. */
bool kiln_reader_mismatch(struct kiln_reader *reader, const struct kiln_option *option,
                          const struct kiln_node *node);
bool kiln_reader_expected(struct kiln_reader *reader, const struct kiln_node *node,
                          const char *expected);
bool kiln_reader_out_of_memory(struct kiln_reader *reader);

/* Is this a text for YAML? Without quotes, some words are numbers and such. */
bool kiln_reader_is_text(const struct kiln_node *node);

/* Fills one struct from a mapping: all members, defaults for those that are missing. node NULL
 * takes every default. */
bool kiln_read_members(struct kiln_reader *reader, const struct kiln_option *members,
                       const struct kiln_node *node, void *base);

/* Reads a number with its unit into SI and checks the limits, as a float or as a double. */
bool kiln_read_number(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, double *value);
bool kiln_read_float(struct kiln_reader *reader, const struct kiln_option *option,
                     const struct kiln_node *node, float *value);

/* Reads a whole number. */
bool kiln_read_whole(struct kiln_reader *reader, const struct kiln_option *option,
                     const struct kiln_node *node, uint32_t *value);

#endif
