/* Opens the file of a scene, once, so that nothing but the file that was opened is read. */
#ifndef KILN_SCENE_PLACE_H
#define KILN_SCENE_PLACE_H

#include "kiln.h"

/* Opens a scene file for reading. If its path enters the asset root (NULL: there is none), it is
 * opened below the root, whatever links are there; otherwise the path is the operator's, and links
 * in it are followed. Returns the descriptor, which the caller closes, or -1 with
 * KILN_INVALID_INPUT. */
int kiln_scene_open(const char *path, const char *asset_root, struct kiln_error *error);

#endif
