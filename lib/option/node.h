/* Parses a YAML file into a tree of nodes, without regard to what its keys mean. Every node has the
 * place where it was written, for error messages.
 *
 * The dialect is YAML 1.2 without anchors, aliases, merge keys, tags and further documents, and
 * with keys that are plain words: nothing in it can grow beyond the size of the file. */
#ifndef KILN_OPTION_NODE_H
#define KILN_OPTION_NODE_H

#include "base/arena.h"
#include "kiln.h"

enum {
    KILN_NODE_MAX_DEPTH = 64,
    KILN_NODE_MAX_ENTRIES = 1024,  /* entries of one list or mapping */
    KILN_NODE_MAX_TOTAL = 1 << 17, /* bytes of one text */
};

/* Says where a text came from: a file, or "--set key". */
struct kiln_origin {
    const char *name;
    bool has_lines;        /* false: positions inside it mean nothing to the reader */
    uint32_t lines_before; /* of the file, where the text is a part of it */
    const char *kind;      /* for messages: "a scene" */
    const char *version;   /* what such a file starts with: "kiln: 1"; NULL: not told */
    const char *syntax;    /* "JSON", of a text of one line; NULL: YAML */
};

enum kiln_node_kind { KILN_NODE_SCALAR, KILN_NODE_LIST, KILN_NODE_MAP };

struct kiln_node {
    enum kiln_node_kind kind;
    bool quoted;                      /* of a scalar: it is written in quotes, or as a block */
    uint32_t line, column;            /* from 1 */
    const struct kiln_origin *origin; /* outlives the node */
    const char *text;                 /* text of a scalar; valid UTF-8 */
    /* of an entry of a mapping: its key, the scalar before the colon */
    struct kiln_node *key;
    struct kiln_node *first, *last; /* entries of a list or mapping, in order */
    struct kiln_node *next;
    uint32_t count;
};

/* Parses a text, which must end in a zero byte that size does not count. The tree lies in the
 * arena. Returns NULL with KILN_INVALID_INPUT and the place of the fault. */
struct kiln_node *kiln_node_parse(struct kiln_arena *arena, const char *text, size_t size,
                                  const struct kiln_origin *origin, struct kiln_error *error);

/* Returns the value of a key; NULL when there is none, or node is no mapping. */
struct kiln_node *kiln_node_entry(const struct kiln_node *node, const char *key);

/* Returns whether a node is a scalar with this text, in quotes or not. */
bool kiln_node_is(const struct kiln_node *node, const char *text);

/* Appends a child to a list or, with its key set, to a mapping. */
void kiln_node_append(struct kiln_node *node, struct kiln_node *child);

/* Creates an empty mapping written at origin; NULL when memory is short. */
struct kiln_node *kiln_node_create_map(struct kiln_arena *arena, const struct kiln_origin *origin);

/* Fills the error with "file:line:column: " and the formatted message; returns false. */
bool kiln_node_error(const struct kiln_node *node, struct kiln_error *error, const char *format,
                     ...) __attribute__((format(printf, 3, 4)));

/* Writes a short form of a text that is safe on a terminal: control characters replaced, the end
 * left out when it is long. */
void kiln_node_quote(char out[64], const char *text);

#endif
