/* Gives the births of a scene's systems to lib/particles. */
#ifndef KILN_SCENE_SCENE_BIRTHS_H
#define KILN_SCENE_SCENE_BIRTHS_H

#include "particles/births.h"
#include "scene/scene.h"

/* Holds the births of a system for lib/particles. source.context points into the struct, which must
 * not be moved after it was filled. */
struct kiln_scene_births {
    struct kiln_births_source source;
    const struct kiln_scene *scene;
    uint32_t system;
    const struct kiln_value *rate;
};
void kiln_scene_births_init(struct kiln_scene_births *births, const struct kiln_scene *scene,
                            uint32_t system);

#endif
