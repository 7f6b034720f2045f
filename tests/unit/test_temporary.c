/* lib/output/temporary.c: what others left under the same names. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "output/temporary.h"

enum { KILLED_JOBS = 100 };

static int make_file(const char *path)
{
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    assert_true(file >= 0);
    assert_int_equal(write(file, "old", 3), 3);
    return file;
}

/* However often a job with this process number was killed, its next try finds a name, and nothing
 * of the old ones is left. */
static void files_of_killed_jobs_make_room(void **state)
{
    (void)state;
    const char *target = "test_temporary_killed.png";
    struct kiln_error error = {0};
    struct kiln_temporary file = {0};
    char path[KILN_PATH_SIZE], other[KILN_PATH_SIZE + 16];
    for (int i = 0; i < KILLED_JOBS; i++) {
        if (!kiln_temporary_open(&file, target, &error))
            fail_msg("%s", error.message);
        snprintf(path, sizeof path, "%s", kiln_temporary_path(&file));
        snprintf(other, sizeof other, "%s.kept", path);
        assert_int_equal(link(path, other), 0); /* outlives the discard, as a killed job's file */
        kiln_temporary_discard(&file);
        assert_int_equal(rename(other, path), 0);
    }
    assert_true(kiln_temporary_open(&file, target, &error));
    assert_string_equal(kiln_temporary_path(&file), path);
    kiln_temporary_discard(&file);
    assert_int_equal(access(path, F_OK), -1);
}

/* A file that is being written belongs to its writer, even under our process number. */
static void files_of_living_jobs_stay(void **state)
{
    (void)state;
    const char *target = "test_temporary_living.png";
    struct kiln_error error = {0};
    struct kiln_temporary file = {0};
    char path[KILN_PATH_SIZE];
    assert_true(kiln_temporary_open(&file, target, &error));
    snprintf(path, sizeof path, "%s", kiln_temporary_path(&file));
    kiln_temporary_discard(&file);
    int living = make_file(path);
    assert_int_equal(flock(living, LOCK_EX | LOCK_NB), 0);
    assert_true(kiln_temporary_open(&file, target, &error));
    assert_string_not_equal(kiln_temporary_path(&file), path);
    kiln_temporary_discard(&file);
    assert_int_equal(access(path, F_OK), 0);
    close(living);
    unlink(path);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_of_killed_jobs_make_room),
        cmocka_unit_test(files_of_living_jobs_stay),
    };
    return cmocka_run_group_tests_name("temporary", tests, NULL, NULL);
}
