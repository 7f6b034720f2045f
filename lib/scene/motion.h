/* Hashes the parts of a scene; saved states are known by these hashes. */
#ifndef KILN_SCENE_MOTION_H
#define KILN_SCENE_MOTION_H

#include "scene/parts.h"

/* SHA-256, in hex, of what decides a part: its options, the contents of the files behind them, the
 * slots of each system, and the version of the step. Of scenes with the same motion hash, each step
 * leaves the same state in the same slots. Files are read anew: KILN_INVALID_INPUT when one cannot
 * be, KILN_DEVICE_FAILED when memory is short. */
bool kiln_scene_part_hash(const struct kiln_scene *scene, enum kiln_scene_part part, char hex[65],
                          struct kiln_error *error);

#endif
