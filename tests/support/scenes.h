/* Loads scenes from texts and files, for tests. */
#ifndef KILN_TESTS_SCENES_H
#define KILN_TESTS_SCENES_H

#include "kiln.h"

/* The name of scenes from texts in messages. */
#define SCENE_NAME "test.yaml"

/* Returns the scene of a text, or NULL with the error. `overrides` is a list that ends with NULL,
 * or NULL. */
struct kiln_scene *try_scene(const char *text, const char *const *overrides,
                             struct kiln_error *error);

/* Return the scene of a text or a file; an error fails the test. */
struct kiln_scene *load_scene(const char *text, const char *const *overrides);
struct kiln_scene *load_scene_file(const char *path);

/* Returns the text of kiln_scene_print, which the caller frees. */
char *print_scene(const struct kiln_scene *scene);

#endif
