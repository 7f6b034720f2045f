/* Gives each test a temporary working directory of its own, so that tests cannot disturb each
 * other. Also writes and reads text files. */
#ifndef KILN_TESTS_FOLDERS_H
#define KILN_TESTS_FOLDERS_H

struct test_place {
    char folder[32]; /* path of the temporary folder */
    int before;      /* file descriptor of the working directory before the test */
};

/* Set-up and tear-down of a test for cmocka. test_enter_folder makes the temporary folder and
 * changes to it. test_leave_folder changes back and removes the folder with all its files. */
int test_enter_folder(void **state);
int test_leave_folder(void **state);

/* Writes a text file, and makes the folders of its path that are missing. */
void test_write_file(const char *path, const char *text);

/* Returns the whole text of a file of less than 1 MiB, which the caller frees. */
char *test_read_file(const char *path);

#endif
