/* Makes the cells of a source out of a path. */
#ifndef KILN_SCENE_SOURCE_PATH_H
#define KILN_SCENE_SOURCE_PATH_H

#include "scene/source.h"

/* Fills a source with places at equal distances along a path. False when memory is short. */
bool kiln_source_fill_path(struct kiln_arena *arena, struct kiln_path *path,
                           struct kiln_source *source);

#endif
