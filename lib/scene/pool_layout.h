/* Says what the pool of a scene holds: slots, spins and canvases all follow from the scene. */
#ifndef KILN_SCENE_POOL_LAYOUT_H
#define KILN_SCENE_POOL_LAYOUT_H

#include "particles/pool.h"
#include "scene/scene.h"

/* Returns the layout of the pool of a run of the scene. */
struct kiln_pool_layout kiln_scene_pool_layout(const struct kiln_scene *scene);

/* Returns the number of slots of all systems that paint. */
uint32_t kiln_scene_paint_slots(const struct kiln_scene *scene);

#endif
