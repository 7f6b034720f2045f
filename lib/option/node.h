/* Parses a YAML file into a tree of nodes, without regard to what its keys mean. Every node has its
 * position in the file, for error messages.
 *
 * The dialect is YAML 1.2 without tags and further documents, and its keys are plain words.
 * Anchors, aliases and the merge key << are read where the origin counts nodes
 * (option/node_copy.h), which limits them; without them, a tree cannot be larger than its text. */
#ifndef KILN_OPTION_NODE_H
#define KILN_OPTION_NODE_H

#include "base/arena.h"
#include "kiln.h"

enum {
    KILN_NODE_MAX_DEPTH = 64,
    KILN_NODE_MAX_ENTRIES = 1024,  /* entries of one list or mapping */
    KILN_NODE_MAX_TOTAL = 1 << 18, /* nodes of one text; a key takes two */
};

struct kiln_node;

/* Counts the nodes of all texts that become one tree. */
struct kiln_node_counts {
    uint32_t parsed; /* at most KILN_NODE_MAX_TOTAL */
    uint32_t copied; /* at most KILN_NODE_MAX_COPIES (option/node_copy.h) */
};

/* Says how a node came to its place in a tree from another one: "; included from scene.yaml:2:11".
 * Errors print the chain of links behind their message. */
struct kiln_node_link {
    const char *words;                 /* "included from" */
    const struct kiln_node *at;        /* where that is written */
    const struct kiln_node_link *next; /* how `at` came to its place; NULL: it was always there */
};

/* Describes where a text comes from: a file, or "--set key". */
struct kiln_origin {
    const char *name;
    bool has_lines;        /* whether messages give line and column; false for --set */
    uint32_t lines_before; /* lines of the file before the text, if it is a part of a file */
    const char *kind;      /* for messages: "a scene" */
    const char *version;   /* the first line of such a file, for messages: "kiln: 1"; or NULL */
    const char *syntax;    /* for messages: "JSON" for a text of one line; NULL: "YAML" */
    uint32_t most_entries; /* of one list or mapping; 0: KILN_NODE_MAX_ENTRIES */
    struct kiln_node_counts *counts; /* of all texts together; NULL: aliases are refused */
    const char *folder; /* folder below the asset root that paths in the text start at; NULL: it */
    const struct kiln_node_link *via; /* how the file was included; NULL: it was not */
};

enum kiln_node_kind { KILN_NODE_SCALAR, KILN_NODE_LIST, KILN_NODE_MAP };

struct kiln_node {
    enum kiln_node_kind kind;
    bool quoted;                      /* whether a scalar is in quotes or in block style */
    bool literal;                     /* whether '$' and '=' mean nothing in a scalar's text */
    uint32_t line, column;            /* from 1 */
    const struct kiln_origin *origin; /* must outlive the node */
    const char *text;                 /* text of a scalar; valid UTF-8 */
    /* the key of an entry of a mapping, the scalar before the colon; otherwise NULL */
    struct kiln_node *key;
    struct kiln_node *first, *last; /* entries of a list or mapping, in order */
    struct kiln_node *next;
    uint32_t count;
    const struct kiln_node_link *via; /* how it was copied to this place; NULL: it was not */
};

/* Parses a text of `size` bytes, which a zero byte must follow. The arena owns the tree. On failure
 * returns NULL with KILN_INVALID_INPUT and the position of the error. */
struct kiln_node *kiln_node_parse(struct kiln_arena *arena, const char *text, size_t size,
                                  const struct kiln_origin *origin, struct kiln_error *error);

/* Returns the value of a key, or NULL if the node has no such key or is no mapping. */
struct kiln_node *kiln_node_entry(const struct kiln_node *node, const char *key);

/* Returns whether a node is a scalar with this text, in quotes or not. */
bool kiln_node_is(const struct kiln_node *node, const char *text);

/* Appends a child to a list or, with its key set, to a mapping. */
void kiln_node_append(struct kiln_node *node, struct kiln_node *child);

/* Creates an empty mapping with this origin. Returns NULL when memory is short. */
struct kiln_node *kiln_node_create_map(struct kiln_arena *arena, const struct kiln_origin *origin);

/* Fills the error with "file:line:column: ", the formatted message and the chain of links; returns
 * false. */
bool kiln_node_error(const struct kiln_node *node, struct kiln_error *error, const char *format,
                     ...) __attribute__((format(printf, 3, 4)));

/* Writes the place of a node: "file:line:column", or the origin's name alone if it has no lines. */
void kiln_node_place(const struct kiln_node *node, char *out, size_t size);

/* Writes a short form of a text that is safe on a terminal: replaces control characters by '?' and
 * cuts off the end of a long text. */
void kiln_node_quote(char out[64], const char *text);

#endif
