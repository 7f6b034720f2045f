/* lib/base/temporary.c: what others left under the same names. */
#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/temporary.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

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

/* What killed processes left goes; what is locked, is something else than a file, or has another
 * name stays, and a pipe keeps nobody waiting. */
static void what_was_left_is_swept(void **state)
{
    static const char *const gone[] = {".a.png.kiln-1-0.tmp", ".b.kiln-4194304-255.tmp",
                                       ".x.kiln-y.kiln-7-1.tmp"};
    static const char *const kept[] = {".locked.kiln-1-0.tmp",
                                       ".pipe.kiln-1-0.tmp",
                                       ".link.kiln-1-0.tmp",
                                       ".folder.kiln-1-0.tmp",
                                       "a.png",
                                       "a.kiln-1-0.tmp",
                                       ".a.kiln-1-.tmp",
                                       ".a.kiln--0.tmp",
                                       ".a.kiln-1-0.tmp.png",
                                       ".a.kiln-1-0x.tmp"};
    (void)state;
    char folder[32], path[96], target[96];
    test_make_folder(folder);
    snprintf(target, sizeof target, "%s/clip.mp4", folder);
    for (size_t i = 0; i < sizeof gone / sizeof *gone; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, gone[i]);
        close(make_file(path));
    }
    int locked = -1;
    for (size_t i = 0; i < sizeof kept / sizeof *kept; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, kept[i]);
        if (i == 0) {
            locked = make_file(path);
            assert_int_equal(flock(locked, LOCK_EX), 0);
        } else if (i == 1) {
            assert_int_equal(mkfifo(path, 0666), 0);
        } else if (i == 2) {
            assert_int_equal(symlink("a.png", path), 0);
        } else if (i == 3) {
            assert_int_equal(mkdir(path, 0777), 0);
        } else {
            close(make_file(path));
        }
    }
    kiln_temporary_sweep(target);
    for (size_t i = 0; i < sizeof gone / sizeof *gone; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, gone[i]);
        assert_int_equal(access(path, F_OK), -1);
    }
    for (size_t i = 0; i < sizeof kept / sizeof *kept; i++) {
        struct stat status;
        snprintf(path, sizeof path, "%s/%s", folder, kept[i]);
        if (lstat(path, &status) != 0)
            fail_msg("%s is gone", kept[i]);
    }
    close(locked);
    snprintf(path, sizeof path, "%s/%s", folder, kept[3]);
    rmdir(path);
    kiln_temporary_sweep("/nowhere/at/all.png");
    test_remove_folder(folder);
}

/* Nobody takes a file for abandoned while it gets its name, and a durable one has it in the end. */
static void files_keep_their_lock_until_they_have_their_name(void **state)
{
    (void)state;
    char folder[32], target[96];
    struct kiln_error error = {0};
    struct kiln_temporary file = {0};
    test_make_folder(folder);
    snprintf(target, sizeof target, "%s/a.png", folder);
    assert_true(kiln_temporary_open(&file, target, &error));
    file.durable = true;
    assert_true(kiln_temporary_write(&file, "abc", 3));
    kiln_temporary_sweep(target);
    assert_true(kiln_temporary_commit(&file, false, &error));
    assert_int_equal(access(target, F_OK), 0);
    test_remove_folder(folder);
}

/* ---- Files that belong together ------------------------------------------------------------ */

enum { SET = 3 };
static const char *const set_names[SET] = {"set.png", "set_motion.png", "set.json"};

/* Opens a temporary file for each name, as `folder`/NAME, and writes `text` into it. */
static void open_set(const char *folder, const char *text, struct kiln_temporary files[SET])
{
    struct kiln_error error = {0};
    for (int i = 0; i < SET; i++) {
        char path[64];
        snprintf(path, sizeof path, "%s/%s", folder, set_names[i]);
        files[i] = (struct kiln_temporary){0};
        assert_true(kiln_temporary_open(&files[i], path, &error));
        assert_true(kiln_temporary_write(&files[i], text, strlen(text)));
    }
}

static bool commit_set(struct kiln_temporary files[SET], bool overwrite, struct kiln_error *error)
{
    struct kiln_temporary *const set[SET] = {&files[0], &files[1], &files[2]};
    bool good = kiln_temporary_commit_all(set, SET, overwrite, error);
    for (int i = 0; i < SET; i++)
        assert_null(files[i].target); /* closed in any case */
    return good;
}

static void check_set(const char *folder, const char *text)
{
    assert_int_equal(test_count_files(folder), SET);
    for (int i = 0; i < SET; i++) {
        char path[64], found[16] = "";
        snprintf(path, sizeof path, "%s/%s", folder, set_names[i]);
        FILE *file = fopen(path, "r");
        assert_non_null(file);
        assert_non_null(fgets(found, sizeof found, file));
        fclose(file);
        assert_string_equal(found, text);
    }
}

static void sets_come_whole(void **state)
{
    (void)state;
    char folder[32];
    struct kiln_temporary files[SET];
    struct kiln_error error = {0};
    test_make_folder(folder);
    open_set(folder, "old", files);
    assert_true(commit_set(files, false, &error));
    check_set(folder, "old");
    open_set(folder, "new", files);
    assert_false(commit_set(files, false, &error));
    expect_error(&error, KILN_USAGE, "%s/set.png: the file exists (--force replaces it)", folder);
    check_set(folder, "old");
    open_set(folder, "new", files);
    assert_true(commit_set(files, true, &error));
    check_set(folder, "new");
    test_remove_folder(folder);
}

/* Whichever file cannot be completed or moved, none gets its name, and an old set stays. */
static void sets_come_whole_or_not_at_all(void **state)
{
    (void)state;
    for (int bad = 0; bad < SET; bad++) {
        for (int old = 0; old < 2; old++) {
            char folder[32];
            struct kiln_temporary files[SET];
            struct kiln_error error = {0};
            test_make_folder(folder);
            if (old) {
                open_set(folder, "old", files);
                assert_true(commit_set(files, false, &error));
            }
            open_set(folder, "new", files);
            files[bad].failure = ENOSPC;
            assert_false(commit_set(files, true, &error));
            expect_error(&error, KILN_IO,
                         "%s/%s: the file cannot be written: No space left on device", folder,
                         set_names[bad]);
            if (old)
                check_set(folder, "old");
            else
                assert_int_equal(test_count_files(folder), 0);
            test_remove_folder(folder);
        }
    }
}

/* A rename that fails after others takes these back. */
static void sets_are_taken_back(void **state)
{
    (void)state;
    for (int bad = 0; bad < SET; bad++) {
        char folder[32];
        struct kiln_temporary files[SET];
        struct kiln_error error = {0};
        test_make_folder(folder);
        open_set(folder, "new", files);
        assert_int_equal(unlink(kiln_temporary_path(&files[bad])), 0); /* what shall be moved */
        assert_false(commit_set(files, true, &error));
        expect_error(&error, KILN_IO,
                     "%s/%s: the file cannot be written: No such file or directory", folder,
                     set_names[bad]);
        assert_int_equal(test_count_files(folder), 0);
        test_remove_folder(folder);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_of_killed_jobs_make_room),
        cmocka_unit_test(what_was_left_is_swept),
        cmocka_unit_test(files_keep_their_lock_until_they_have_their_name),
        cmocka_unit_test(files_of_living_jobs_stay),
        cmocka_unit_test(sets_come_whole),
        cmocka_unit_test(sets_come_whole_or_not_at_all),
        cmocka_unit_test(sets_are_taken_back),
    };
    return cmocka_run_group_tests_name("temporary", tests, NULL, NULL);
}
