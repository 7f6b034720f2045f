/* Splits groups of slow tests into parts, and says whether a test is to check all of its cases.
 * CTest runs each part in a process of its own, so that the parts run on several cores at once. */
#ifndef KILN_TESTS_PARTS_H
#define KILN_TESTS_PARTS_H

#include <glob.h>
#include <stdbool.h>

#include "support/cmocka.h"

enum { TEST_LIST_SIZE = 256 };

/* Returns whether all cases are to be checked, as by `tools/test --all`: the environment variable
 * KILN_TESTS is "all". Otherwise slow tests check a sample of their cases, always the same ones. */
bool test_is_full(void);

/* The state of a test that runs once for each scene. */
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

/* Appends a test for every scene file of scenes/, or, unless test_is_full, for every stride-th one,
 * from the first on. The test has the file's name, and its *state is a struct test_scene. A list
 * may have scenes from one call only. */
void test_list_add_scenes(struct test_list *list, struct CMUnitTest test, size_t stride);

/* Runs the group and frees the list. The program's argument "2/3" chooses the second of three
 * parts: the second test, the fifth, the eighth and so on, so that each test is in exactly one
 * part. Without an argument all tests run. Returns the program's exit status. */
int test_list_run(struct test_list *list, const char *name, int argc, char **argv,
                  CMFixtureFunction setup, CMFixtureFunction teardown);

#endif
