/* Divides groups of tests that take long into parts. CTest runs each part in a process of its own,
 * so that several cores share them. */
#ifndef KILN_TESTS_PARTS_H
#define KILN_TESTS_PARTS_H

#include <glob.h>

#include "support/cmocka.h"

enum { TEST_LIST_SIZE = 256 };

/* The state of a test that runs once for each scene. */
struct test_scene {
    const char *path;
    size_t number; /* index among all scenes, by name */
};

/* A group of tests that is made at run time. */
struct test_list {
    struct CMUnitTest tests[TEST_LIST_SIZE];
    struct test_scene scenes[TEST_LIST_SIZE]; /* at the places of their tests */
    size_t count;
    glob_t files; /* owns the paths */
};

void test_list_add(struct test_list *list, const struct CMUnitTest *tests, size_t count);

/* Adds a test for every stride-th scene of scenes/. The test has the scene's name, and its state is
 * a struct test_scene. Call it once for a list. */
void test_list_add_scenes(struct test_list *list, struct CMUnitTest test, size_t stride);

/* Runs the group and frees the list. The program's argument "2/3" chooses the second of three
 * parts: the second test, the fifth, the eighth and so on, so that each test is in exactly one
 * part. */
int test_list_run(struct test_list *list, const char *name, int argc, char **argv,
                  CMFixtureFunction setup, CMFixtureFunction teardown);

#endif
