/* Hashes the parts of a scene. Saved states carry these hashes, so that a scene finds the states of
 * its own motion. */
#ifndef KILN_SCENE_MOTION_H
#define KILN_SCENE_MOTION_H

#include "scene/parts.h"

/* Computes the SHA-256, in hex, of all that decides a part: its options, the contents of its files,
 * the slots of each system, and the version of the step. Two scenes with the same motion hash have
 * the same state in the same slots after each step. Files are read again: KILN_INVALID_INPUT when
 * one cannot be read, KILN_DEVICE_FAILED when memory is short. */
bool kiln_scene_part_hash(const struct kiln_scene *scene, enum kiln_scene_part part, char hex[65],
                          struct kiln_error *error);

#endif
