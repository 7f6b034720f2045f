/* Scenes from texts, and the errors of bad ones. */
#ifndef KILN_TESTS_SCENES_H
#define KILN_TESTS_SCENES_H

#include "kiln.h"

/* The name that scenes of texts have in messages. */
#define SCENE_NAME "test.yaml"

/* overrides ends in NULL, or is NULL. A NULL with an error is the caller's to judge. */
struct kiln_scene *try_scene(const char *text, const char *const *overrides,
                             struct kiln_error *error);

struct kiln_scene *load_scene(const char *text, const char *const *overrides);
struct kiln_scene *load_scene_file(const char *path);

/* The caller frees it. */
char *print_scene(const struct kiln_scene *scene);

#endif
