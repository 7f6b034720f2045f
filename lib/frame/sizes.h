/* Declares the check of a scene's sizes against its techniques. Not every technique takes a scene
 * of the greatest size. */
#ifndef KILN_FRAME_SIZES_H
#define KILN_FRAME_SIZES_H

#include "frame/technique.h"

/* Returns whether the techniques take a scene with so many systems, forces and keys. Otherwise
 * fills the error with KILN_USAGE: the technique, the size and the technique's limit. */
bool kiln_sizes_check(const struct kiln_scene *scene, const struct kiln_techniques *techniques,
                      struct kiln_error *error);

#endif
