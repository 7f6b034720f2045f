/* Finds out what red and green of a motion file stand for: by the options of the scene and, where
 * these leave it open, by the layout that kiln writes beside a flipbook (output/flipbook.c). */
#ifndef KILN_SCENE_MOTION_LAYOUT_H
#define KILN_SCENE_MOTION_LAYOUT_H

#include "scene/options.h"

/* The version of layouts, in their member "kiln_flipbook". In version 1, green points down. Since
 * version 2 it points up, unless the layout says down. Both versions name the direction. */
enum { KILN_FLIPBOOK_VERSION = 2 };

/* Fills motion_full and motion_layout of a system's look. NAME.json beside NAME_motion.SUFFIX is
 * read if the scene leaves the scale or the direction of green open, and if it is a layout of
 * kiln's. A layout that cannot be read is an error at look.motion. root: as of kiln_validate. */
bool kiln_motion_layout_settle(struct kiln_reader *reader, const struct kiln_node *root,
                               struct kiln_system *system);

#endif
