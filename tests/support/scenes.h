/* Loads scenes from texts and files for tests, and prints them. */
#ifndef KILN_TESTS_SCENES_H
#define KILN_TESTS_SCENES_H

#include "kiln.h"

/* The file name in messages about a scene that is loaded from a text. */
#define SCENE_NAME "test.yaml"

/* Returns the scene of a text, which the caller destroys, or NULL with an error. overrides: a
 * list of "KEY=VALUE" that ends with NULL, or NULL for none. */
struct kiln_scene *try_scene(const char *text, const char *const *overrides,
                             struct kiln_error *error);

/* Return the scene of a text or of a file, which the caller destroys. An error fails the test. */
struct kiln_scene *load_scene(const char *text, const char *const *overrides);
struct kiln_scene *load_scene_file(const char *path);

/* Returns the scene of a file with the changes of a list that ends with NULL, at most 4, and with
 * gas in coarse cells, so that its steps take no time to speak of. An error fails the test. */
struct kiln_scene *load_coarse_scene(const char *path, const char *const *overrides);

/* Returns the scene of a file of tests/motion, such as "rest", which the caller destroys. override:
 * a "KEY=VALUE", or NULL for none. An error fails the test. */
struct kiln_scene *load_fixture(const char *name, const char *override);

/* Returns the text that kiln_scene_print writes. The caller frees it. */
char *print_scene(const struct kiln_scene *scene);

#endif
