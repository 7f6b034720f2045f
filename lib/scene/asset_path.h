/* Reads and prints the names of textures and files in a scene. A name is that of a built-in
 * texture, or a path below the asset root. */
#ifndef KILN_SCENE_ASSET_PATH_H
#define KILN_SCENE_ASSET_PATH_H

#include "scene/options.h"

/* Returns the absolute folder that a scene's paths start from: root; without one, the folder of the
 * file; without that, the working directory. NULL with an error when there is no such folder. */
const char *kiln_asset_root(struct kiln_arena *arena, const char *root, const char *file,
                            struct kiln_error *error);

/* Reads "builtin:name", or the path of an image or video file, which is made absolute. */
bool kiln_read_asset(struct kiln_reader *reader, const struct kiln_node *node, const char **asset);

/* Makes the path of a file that a scalar names relative to the asset root: it starts at the folder
 * of the scalar's file. False with an error where the path is absolute or leaves the root by "..".
 */
bool kiln_asset_join(struct kiln_reader *reader, const struct kiln_node *node,
                     char path[KILN_PATH_SIZE]);

/* Returns the words that say why a path could not be opened below the asset root, by errno. */
const char *kiln_asset_reason(int reason, char room[256]);

/* Checks the content of a file; path is absolute. */
typedef bool kiln_check_file(struct kiln_loader *loader, const char *path,
                             struct kiln_error *error);

/* Reads the path of a file that `check` accepts (NULL: any file), and makes it absolute. */
bool kiln_read_file_asset(struct kiln_reader *reader, const struct kiln_node *node,
                          kiln_check_file *check, const char **asset);

/* Reports the error of a file as an error at a place in the scene. path is absolute. key is "file"
 * or another key of the node, by its path from the root (kiln_reader_error_at). Returns false. */
bool kiln_asset_fail(struct kiln_reader *reader, const struct kiln_node *root, const char *path,
                     const char *file, const struct kiln_error *error);

/* Adds a file to the list of files that the scene was read from. `what`: static text, for messages.
 * False when memory is short. */
bool kiln_scene_add_file(struct kiln_scene *scene, const char *path, const char *what);

/* Appends a line with the hash of an asset's bytes to a text; nothing for a built-in asset. */
bool kiln_asset_add_hash(const struct kiln_scene *scene, const char *asset, struct kiln_text *text,
                         struct kiln_error *error);

/* Returns the name of an asset as a scene writes it: relative to the asset root. */
const char *kiln_asset_name(const struct kiln_scene *scene, const char *asset);

#endif
