/* Loads scenes. The public functions are in lib/frame/scene.c, since what a scene is expected to
 * take is known to the rooms that take it. */
#ifndef KILN_SCENE_LOAD_H
#define KILN_SCENE_LOAD_H

#include "base/footprint.h"
#include "scene/scene.h"

/* Adds the memory that a scene is expected to take. Its options have been validated. */
typedef void kiln_scene_estimate(const struct kiln_scene *scene, struct kiln_footprint *footprint);

/* Do what kiln_scene_load and kiln_scene_parse promise; `estimate` says what the limit of memory is
 * compared with; NULL: nothing is. */
struct kiln_scene *kiln_scene_load_with(const char *path, const struct kiln_scene_params *given,
                                        kiln_scene_estimate *estimate, struct kiln_error *error);
struct kiln_scene *kiln_scene_parse_with(const char *text, size_t size, const char *name,
                                         const struct kiln_scene_params *given,
                                         kiln_scene_estimate *estimate, struct kiln_error *error);

#endif
