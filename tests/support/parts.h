/* Groups of tests that take long: CTest runs such a program in parts, each a process of its own, so
 * that several cores share them. */
#ifndef KILN_TESTS_PARTS_H
#define KILN_TESTS_PARTS_H

#include <glob.h>

#include "support/cmocka.h"

enum { TEST_LIST_SIZE = 256 };

/* The state of a test that runs once for each scene. */
struct test_scene {
    const char *path;
    size_t number; /* how many scenes come before it */
};

/* A group that is put together at run time. */
struct test_list {
    struct CMUnitTest tests[TEST_LIST_SIZE];
    struct test_scene scenes[TEST_LIST_SIZE]; /* at the places of their tests */
    size_t count;
    glob_t files; /* owns the paths */
};

void test_list_add(struct test_list *list, const struct CMUnitTest *tests, size_t count);

/* Adds a test of every scene of scenes/, or of every STRIDEth: it has the scene's name, and its
 * state is a struct test_scene. Once a list. */
void test_list_add_scenes(struct test_list *list, struct CMUnitTest test, size_t stride);

/* Runs the group and frees the list. The argument "2/3" chooses its second part of three: the
 * second test, the fifth, the eighth and so on, so that each test is in one part, however many
 * there are. */
int test_list_run(struct test_list *list, const char *name, int argc, char **argv,
                  CMFixtureFunction setup, CMFixtureFunction teardown);

#endif
