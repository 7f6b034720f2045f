/* Resolves what a scene says by means of other texts: includes, parameters, uses and overrides.
 * What is left is a tree that the rows of the options read. */
#ifndef KILN_SCENE_RESOLVE_H
#define KILN_SCENE_RESOLVE_H

#include "scene/options.h"

/* Where a scene's text comes from. */
struct kiln_scene_source {
    const char *path;          /* as it was given; NULL for a scene that is no file */
    const struct stat *status; /* of the file */
    size_t size;               /* bytes of the text */
    const struct kiln_scene_params *params;
};

/* Resolves a tree in this order: includes, files of parameters, overrides of parameters, uses,
 * other overrides, then the names of parameters. The scene that is read has its asset root. */
bool kiln_scene_resolve(struct kiln_reader *reader, struct kiln_node *root,
                        const struct kiln_scene_source *source);

/* Does only the first step. */
bool kiln_scene_include(struct kiln_reader *reader, struct kiln_node *root,
                        const struct kiln_scene_source *source);

#endif
