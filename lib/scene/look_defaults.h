/* Settles the keys of a look whose default depends on other keys. */
#ifndef KILN_SCENE_LOOK_DEFAULTS_H
#define KILN_SCENE_LOOK_DEFAULTS_H

#include "scene/scene.h"

/* Returns whether billboards show whole pictures: all textures are files of one cell. Such a
 * picture may have letters, so it is upright by default and never mirrored. */
bool kiln_look_is_picture(const struct kiln_look *look);

/* Gives a value to each key that has its word instead. */
void kiln_look_settle(struct kiln_look *look);

#endif
