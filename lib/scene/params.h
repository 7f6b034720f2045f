/* Keeps the parameters of a scene for those who ask for them after it was loaded. */
#ifndef KILN_SCENE_PARAMS_H
#define KILN_SCENE_PARAMS_H

#include "scene/options.h"

/* Copies the reader's parameters, which have been checked, into the scene that is read. */
bool kiln_scene_keep_params(struct kiln_reader *reader);

#endif
