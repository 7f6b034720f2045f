/* Runs a test in a temporary working directory of its own, which is removed afterwards, and writes
 * and reads small files. */
#include "support/folders.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/cmocka.h"
#include "support/pictures.h"

int test_enter_folder(void **state)
{
    struct test_place *place = malloc(sizeof *place);
    assert_non_null(place);
    test_make_folder(place->folder);
    place->before = open(".", O_RDONLY | O_DIRECTORY);
    assert_true(place->before >= 0 && chdir(place->folder) == 0);
    *state = place;
    return 0;
}

int test_leave_folder(void **state)
{
    struct test_place *place = *state;
    assert_int_equal(fchdir(place->before), 0);
    close(place->before);
    test_remove_folder(place->folder);
    free(place);
    return 0;
}

void test_write_file(const char *path, const char *text)
{
    char folder[256];
    assert_true(snprintf(folder, sizeof folder, "%s", path) < (int)sizeof folder);
    for (char *slash = strchr(folder, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        mkdir(folder, 0777);
        *slash = '/';
    }
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fputs(text, file) >= 0, 1);
    assert_int_equal(fclose(file), 0);
}

char *test_read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        fail_msg("%s cannot be opened", path);
    enum { MOST = 1 << 20 };
    char *text = calloc(1, MOST);
    assert_non_null(text);
    assert_true(fread(text, 1, MOST - 1, file) < MOST - 1);
    fclose(file);
    return text;
}
