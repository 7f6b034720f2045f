/* Splits groups of slow tests into parts, and says whether a test checks all of its cases or a
 * sample. CTest runs each part in its own process, so that the parts run on several cores at once.
 */
#ifndef KILN_TESTS_PARTS_H
#define KILN_TESTS_PARTS_H

#include <glob.h>
#include <stdbool.h>

#include "support/cmocka.h"

enum { TEST_LIST_SIZE = 256 };

/* Returns whether tests check all of their cases: whether the environment variable KILN_TESTS is
 * "all", as `tools/test --all` sets it. If not, slow tests check a sample of their cases, the same
 * in each run. */
bool test_is_full(void);

/* A test that runs once for each scene file finds this struct in *state. */
struct test_scene {
    const char *path;
    size_t number; /* index among all scene files, sorted by name */
};

/* A group of cmocka tests that is put together at run time. */
struct test_list {
    struct CMUnitTest tests[TEST_LIST_SIZE];
    struct test_scene scenes[TEST_LIST_SIZE]; /* scenes[i] is the state of tests[i] */
    size_t count;
    glob_t files; /* owns the paths of the scenes */
};

/* Appends copies of the tests to the list. */
void test_list_add(struct test_list *list, const struct CMUnitTest *tests, size_t count);

/* Appends copies of the tests to the list if test_is_full. */
void test_list_add_full(struct test_list *list, const struct CMUnitTest *tests, size_t count);

/* Appends copies of `test`, one for each scene file of scenes/, or, unless test_is_full, for the
 * first and every stride-th file after it. Each copy has the name of its file, and its *state is a
 * struct test_scene. Call this at most once for a list. */
void test_list_add_scenes(struct test_list *list, struct CMUnitTest test, size_t stride);

/* Runs the group and frees the list. argc, argv: the program's arguments. Without an argument, all
 * tests run. The argument "2/3" chooses the second of three parts, which has the second test, the
 * fifth, the eighth and so on; each test is in exactly one part. Returns the program's exit status.
 */
int test_list_run(struct test_list *list, const char *name, int argc, char **argv,
                  CMFixtureFunction setup, CMFixtureFunction teardown);

#endif
