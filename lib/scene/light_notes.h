/* Warns of fire that sheds far more light than it shows. */
#ifndef KILN_SCENE_LIGHT_NOTES_H
#define KILN_SCENE_LIGHT_NOTES_H

#include "scene/options.h"

/* Logs a warning for each system whose look.light is over a hundred times what its billboards
 * show. root: the scene as it was parsed. */
void kiln_light_notes_warn(struct kiln_reader *reader, const struct kiln_node *root);

/* Returns how many times as much light as billboards of an atlas show is shed where look.light is
 * 1; 1 for an atlas that is a file, of which it is not known. */
float kiln_light_times(const char *atlas);

#endif
