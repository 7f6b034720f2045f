/* Warns of particles whose steps are too small for the positions that they are added to. */
#ifndef KILN_SCENE_SMALL_STEPS_H
#define KILN_SCENE_SMALL_STEPS_H

#include "scene/options.h"

/* Returns the least speed, m/s, that rounding changes by at most 1 %, at a distance from the origin
 * in metres and a rate of steps a second. */
double kiln_small_steps_true_speed(float place, double rate);

/* Logs a warning with its place for each system whose particles are so slow and so far from the
 * origin that rounding their positions changes their speed by more than 1 %. The scene has been
 * validated; root is its tree. */
void kiln_small_steps_warn(struct kiln_reader *reader, const struct kiln_node *root);

#endif
