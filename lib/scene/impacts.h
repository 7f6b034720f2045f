/* Declares the check of what a scene says of impacts. */
#ifndef KILN_SCENE_IMPACTS_H
#define KILN_SCENE_IMPACTS_H

#include "scene/options.h"

/* Checks that the keys of `collide` that a file has for what impacts do agree: `dies`, `then` and
 * `chance`. Call it before the one key is set from the other. */
bool kiln_impacts_agree(struct kiln_reader *reader, const struct kiln_node *root,
                        const struct kiln_system *system);

#endif
