/* Makes lists of cmocka tests, and runs the part of a list that the command line chooses
 * (NUMBER/COUNT), so that CTest can run slow groups as several processes at once. The environment
 * variable KILN_TESTS decides whether the list has all cases or a sample. */
#include "support/parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void test_list_add(struct test_list *list, const struct CMUnitTest *tests, size_t count)
{
    if (count > TEST_LIST_SIZE - list->count)
        abort();
    memcpy(list->tests + list->count, tests, count * sizeof *tests);
    list->count += count;
}

bool test_is_full(void)
{
    const char *tests = getenv("KILN_TESTS");
    return tests && strcmp(tests, "all") == 0;
}

void test_list_add_full(struct test_list *list, const struct CMUnitTest *tests, size_t count)
{
    if (test_is_full())
        test_list_add(list, tests, count);
}

void test_list_add_scenes(struct test_list *list, struct CMUnitTest test, size_t stride)
{
    glob_t *files = &list->files;
    if (files->gl_pathv || glob(KILN_SOURCE_DIR "/scenes/*.yaml", 0, NULL, files) != 0)
        abort();
    for (size_t i = 0; i < files->gl_pathc; i += test_is_full() ? 1 : stride) {
        list->scenes[list->count] = (struct test_scene){files->gl_pathv[i], i};
        test.name = strrchr(files->gl_pathv[i], '/') + 1;
        test.initial_state = &list->scenes[list->count];
        test_list_add(list, &test, 1);
    }
}

int test_list_run(struct test_list *list, const char *name, int argc, char **argv,
                  CMFixtureFunction setup, CMFixtureFunction teardown)
{
    unsigned long number = 1, count = 1;
    if (argc == 2) {
        char *end = argv[1];
        number = strtoul(argv[1], &end, 10);
        count = *end == '/' ? strtoul(end + 1, &end, 10) : 0;
        count = *end ? 0 : count;
    }
    if (argc > 2 || number < 1 || number > count) {
        fprintf(stderr, "usage: %s [NUMBER/COUNT]\n", argv[0]);
        return 2;
    }
    struct CMUnitTest part[TEST_LIST_SIZE];
    size_t length = 0;
    for (size_t i = number - 1; i < list->count; i += count)
        part[length++] = list->tests[i];
    int failed = _cmocka_run_group_tests(name, part, length, setup, teardown);
    globfree(&list->files);
    return failed;
}
