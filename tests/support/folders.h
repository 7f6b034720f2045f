/* A working directory of a test's own, and files in it. */
#ifndef KILN_TESTS_FOLDERS_H
#define KILN_TESTS_FOLDERS_H

struct test_place {
    char folder[32];
    int before;
};

/* cmocka's setup and teardown. */
int test_enter_folder(void **state);
int test_leave_folder(void **state);

/* Writes a text file and the folders above it. */
void test_write_file(const char *path, const char *text);

/* The whole file, to be freed. */
char *test_read_file(const char *path);

#endif
