/* Gives a test a working directory of its own, and writes and reads files in it. */
#ifndef KILN_TESTS_FOLDERS_H
#define KILN_TESTS_FOLDERS_H

struct test_place {
    char folder[32]; /* path of the test's folder */
    int before;      /* descriptor of the working directory before the test */
};

/* Set-up and tear-down of a test for cmocka: they make and enter the folder, and leave and remove
 * it. */
int test_enter_folder(void **state);
int test_leave_folder(void **state);

/* Writes a text file and the folders above it. */
void test_write_file(const char *path, const char *text);

/* Returns the text of a whole file, which the caller frees. */
char *test_read_file(const char *path);

#endif
