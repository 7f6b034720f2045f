/* lib/base/cache: what is written is read again, what is spoiled is not, and there is an end to it.
 */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/cache.h"
#include "support/cmocka.h"
#include "support/folders.h"

static void the_environment_says_where_it_is(void **state)
{
    (void)state;
    char folder[KILN_PATH_SIZE];
    setenv("XDG_CACHE_HOME", "/x/cache", 1);
    setenv("HOME", "/home/me", 1);
    assert_true(kiln_cache_folder(folder));
    assert_string_equal(folder, "/x/cache/kiln");
    setenv("XDG_CACHE_HOME", "relative", 1);
    assert_true(kiln_cache_folder(folder));
    assert_string_equal(folder, "/home/me/.cache/kiln");
    unsetenv("HOME");
    assert_false(kiln_cache_folder(folder));
}

/* The folder of what a driver trusts is made for this user alone, and refused otherwise. */
static void one_folder_is_private(void **state)
{
    (void)state;
    char folder[KILN_PATH_SIZE], here[256], cache[300];
    struct stat status;
    assert_non_null(getcwd(here, sizeof here));
    snprintf(cache, sizeof cache, "%s/cache", here);
    setenv("XDG_CACHE_HOME", cache, 1);
    const mode_t before = umask(0002);
    assert_true(kiln_cache_private_folder(folder));
    umask(before);
    assert_int_equal(stat("cache/kiln-programs", &status), 0);
    assert_int_equal(status.st_mode & 0777, 0700);
    assert_true(kiln_cache_private_folder(folder));
    assert_string_equal(strrchr(folder, '/'), "/kiln-programs");
    for (int i = 0; i < 6; i++) {
        assert_int_equal(chmod("cache/kiln-programs", (mode_t)(0700 | 1 << i)), 0);
        assert_false(kiln_cache_private_folder(folder));
    }
    assert_int_equal(chmod("cache/kiln-programs", 0700), 0);

    /* Others who may rename the folder could put theirs in its place. */
    static const mode_t kept[] = {0700, 0755, 01777, 01770};
    static const mode_t open_to_others[] = {0777, 0775, 0702, 0720};
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(chmod("cache", kept[i]), 0);
        assert_true(kiln_cache_private_folder(folder));
        assert_int_equal(chmod("cache", open_to_others[i]), 0);
        assert_false(kiln_cache_private_folder(folder));
    }
    assert_int_equal(chmod("cache", 0700), 0);
    assert_int_equal(rmdir("cache/kiln-programs"), 0);
    test_write_file("cache/kiln-programs", "");
    assert_false(kiln_cache_private_folder(folder));
    setenv("XDG_CACHE_HOME", "/dev/null", 1);
    assert_false(kiln_cache_private_folder(folder));
}

static const char bytes[] = "what took long to make";

static bool is_there(const char *folder, const char *name)
{
    char *read = kiln_cache_read(folder, name, sizeof bytes);
    const bool found = read && memcmp(read, bytes, sizeof bytes) == 0;
    assert_true(found || !read);
    free(read);
    return found;
}

static void spoil(const char *path, long at)
{
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    assert_int_equal(fseek(file, at, at < 0 ? SEEK_END : SEEK_SET), 0);
    assert_int_equal(fputc('!', file), '!');
    fclose(file);
}

static void what_is_spoiled_counts_for_nothing(void **state)
{
    (void)state;
    struct stat whole;
    kiln_cache_write("a/b", "x", bytes, sizeof bytes);
    assert_true(is_there("a/b", "x"));
    assert_false(is_there("a/b", "y"));
    assert_null(kiln_cache_read("a/b", "x", sizeof bytes - 1));
    assert_int_equal(stat("a/b/x", &whole), 0);
    for (int i = 0; i < 5; i++) {
        if (i < 3)
            spoil("a/b/x", (long[]){0, 30, -5}[i]);
        else
            assert_int_equal(truncate("a/b/x", whole.st_size + (i == 3 ? -1 : 1)), 0);
        assert_false(is_there("a/b", "x"));
        kiln_cache_write("a/b", "x", bytes, sizeof bytes);
        assert_true(is_there("a/b", "x"));
    }
    size_t size = 0;
    char *any = kiln_cache_read_any("a/b", "x", sizeof bytes, &size);
    assert_true(any && size == sizeof bytes && memcmp(any, bytes, size) == 0);
    free(any);
    assert_null(kiln_cache_read_any("a/b", "x", sizeof bytes - 1, &size));
    assert_null(kiln_cache_read_any("a/b", "y", sizeof bytes, &size));
    spoil("a/b/x", 30);
    assert_null(kiln_cache_read_any("a/b", "x", sizeof bytes, &size));
    assert_int_equal(truncate("a/b/x", 3), 0);
    assert_null(kiln_cache_read_any("a/b", "x", sizeof bytes, &size));
    assert_int_equal(mkfifo("a/b/fifo", 0600), 0);
    assert_false(is_there("a/b", "fifo"));
}

static void where_nothing_can_be_written_nothing_happens(void **state)
{
    (void)state;
    test_write_file("file", "");
    kiln_cache_write("file/below", "x", bytes, sizeof bytes);
    kiln_cache_write("a", "a/b/c", NULL, (size_t)KILN_CACHE_BYTES + 1);
    assert_int_equal(access("a", F_OK), -1);
}

/* A file of a size on no disk, last used so many seconds ago. */
static void add_old(const char *path, off_t size, time_t age_s)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    now.tv_sec -= age_s;
    test_write_file(path, "");
    assert_int_equal(truncate(path, size), 0);
    assert_int_equal(utimensat(AT_FDCWD, path, (struct timespec[]){now, now}, 0), 0);
}

/* A name as the cache has them, which begins with a digit. */
#define HASH(digit)                                                                                \
    "c/" digit "23456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef0.field"

static void the_oldest_make_room(void **state)
{
    (void)state;
    add_old("c/clip.mp4", 2 * (off_t)KILN_CACHE_BYTES, 5000);
    const off_t third = KILN_CACHE_BYTES / 3;
    add_old(HASH("2"), third, 2000);
    add_old(HASH("3"), third, 3000);
    add_old(HASH("1"), third, 1000);

    kiln_cache_write("c", "x", bytes, sizeof bytes);
    assert_true(is_there("c", "x"));
    assert_int_equal(access(HASH("3"), F_OK), -1);
    assert_int_equal(access(HASH("2"), F_OK), 0);
    assert_int_equal(access(HASH("1"), F_OK), 0);

    add_old(HASH("4"), 2 * third, 100);
    kiln_cache_write("c", "y", bytes, sizeof bytes);
    assert_int_equal(access(HASH("2"), F_OK), -1);
    assert_int_equal(access(HASH("1"), F_OK), -1);
    assert_int_equal(access(HASH("4"), F_OK), 0);
    assert_true(is_there("c", "x") && is_there("c", "y"));
    assert_int_equal(access("c/clip.mp4", F_OK), 0); /* not the cache's */
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_environment_says_where_it_is),
        IN_FOLDER(one_folder_is_private),
        IN_FOLDER(what_is_spoiled_counts_for_nothing),
        IN_FOLDER(where_nothing_can_be_written_nothing_happens),
        IN_FOLDER(the_oldest_make_room),
    };
    return cmocka_run_group_tests_name("cache", tests, NULL, NULL);
}
