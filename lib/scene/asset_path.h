/* Names of textures in a scene: built-in ones, and files that stay below the asset root. */
#ifndef KILN_SCENE_ASSET_PATH_H
#define KILN_SCENE_ASSET_PATH_H

#include "scene/options.h"

/* The absolute folder that a scene's paths start from: root, or without one the folder of the
 * file, or without that the working directory. NULL with an error when there is no such folder. */
const char *kiln_asset_root(struct kiln_arena *arena, const char *root, const char *file,
                            struct kiln_error *error);

/* Reads "builtin:name", or the path of an image or video file, which becomes absolute. */
bool kiln_read_asset(struct kiln_reader *reader, const struct kiln_node *node, const char **asset);

/* Whether a file, an absolute path, is what it should be. */
typedef bool kiln_check_file(struct kiln_loader *loader, const char *path,
                             struct kiln_error *error);

/* Reads the path of a file that check (or NULL) accepts; it becomes absolute. */
bool kiln_read_file_asset(struct kiln_reader *reader, const struct kiln_node *node,
                          kiln_check_file *check, const char **asset);

/* What went wrong with a file, an absolute path, as an error at a place in the scene: "file" or
 * another key of it, by its path from the root (kiln_reader_error_at). Returns false. */
bool kiln_asset_fail(struct kiln_reader *reader, const struct kiln_node *root, const char *path,
                     const char *file, const struct kiln_error *error);

/* Notes that the scene was read from this file, too. `what`: static text, for messages. False when
 * memory is short. */
bool kiln_scene_add_file(struct kiln_scene *scene, const char *path, const char *what);

/* Adds a line with the hash of an asset's bytes to a text; nothing for a built-in one. */
bool kiln_asset_add_hash(const struct kiln_scene *scene, const char *asset, struct kiln_text *text,
                         struct kiln_error *error);

/* The asset as a scene names it: relative to the asset root. */
const char *kiln_asset_name(const struct kiln_scene *scene, const char *asset);

#endif
