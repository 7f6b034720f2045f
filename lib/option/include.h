/* Resolves the key `include` of a file: the files that it lists are read, and their mappings lie
 * under those of the file. */
#ifndef KILN_OPTION_INCLUDE_H
#define KILN_OPTION_INCLUDE_H

#include "option/reader.h"

enum {
    KILN_INCLUDE_MAX_DEPTH = 8,  /* files within files */
    KILN_INCLUDE_MAX_FILES = 64, /* of one scene */
};

/* A file that is open, or was. */
struct kiln_included {
    const char *text; /* with a zero byte behind it; lives as long as the reader's scratch arena */
    size_t size;
    const struct kiln_origin *origin; /* lives as long */
    uint64_t device, inode;           /* which file it is, whatever its path */
};

/* Opens the files that are included. The room of the options knows no folders. */
struct kiln_include_loader {
    /* Reads the file that a scalar names. The path starts at the folder of the scalar's origin, and
     * the new origin has its `via` set to the link. False with an error at the scalar. */
    bool (*read)(void *user, const struct kiln_node *path, const struct kiln_node_link *link,
                 struct kiln_included *file);
    /* Returns whether the mapping of a file may be included; false with an error. NULL: always. */
    bool (*check)(void *user, const struct kiln_node *root);
    void *user;
};

/* Takes `include` out of a mapping that the rows describe, and lays the files under it. Each file
 * is included once. `own` is the mapping's file; all zero if it has none. */
bool kiln_include(struct kiln_reader *reader, const struct kiln_option *rows,
                  struct kiln_node *root, const struct kiln_included *own,
                  const struct kiln_include_loader *loader);

/* Takes the entry of a key out of a mapping and returns it; NULL if there is none. */
struct kiln_node *kiln_node_take(struct kiln_node *map, const char *key);

#endif
