/* Declares the check of a scene's sizes against its techniques. Not every technique takes a scene
 * of the greatest size. */
#ifndef KILN_FRAME_SIZES_H
#define KILN_FRAME_SIZES_H

#include "frame/technique.h"

/* Returns whether the techniques take a scene of this size. Otherwise fills the error with
 * KILN_USAGE: what there is too much of, how much of it, how much is allowed, and what takes more.
 */
bool kiln_sizes_check(const struct kiln_scene *scene, const struct kiln_techniques *techniques,
                      struct kiln_error *error);

#endif
