/* kiln_file_open_below: a path stays below its folder, with openat2 and where the kernel refuses
 * it. If this fails, a scene or a folder of results makes kiln read files elsewhere, or kiln tells
 * whether a file elsewhere exists. */
#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/file_in.h"
#include "support/cmocka.h"
#include "support/folders.h"

enum { PLAIN = KILN_FILE_FLAGS, NO_LINK = KILN_FILE_FLAGS | O_NOFOLLOW };

/* A path, how it is opened, and errno; 0: it is opened. */
static const struct {
    const char *path;
    int flags, expected;
    int old_kernel; /* without openat2, where it differs; -1 */
} rows[] = {
    {"a/in", PLAIN, 0, -1},
    {"a/in", NO_LINK, 0, -1},
    {"./a//in", PLAIN, 0, -1},
    {"a/fifo", PLAIN, 0, -1}, /* it does not wait */
    {"a/missing", PLAIN, ENOENT, -1},
    {"missing/in", PLAIN, ENOENT, -1},
    {"a/in/x", PLAIN, ENOTDIR, -1},
    {"../out", PLAIN, EXDEV, -1},
    {"../missing", PLAIN, EXDEV, -1},
    {"/etc/passwd", PLAIN, EXDEV, -1},
    {"/missing", PLAIN, EXDEV, -1},
    {"link_out", PLAIN, EXDEV, -1},
    {"link_to_nothing", PLAIN, EXDEV, -1},
    {"link_absolute", PLAIN, EXDEV, -1},
    {"link_to_zero", PLAIN, EXDEV, -1},
    {"folder_out/out", PLAIN, EXDEV, -1},
    {"folder_out/missing", PLAIN, EXDEV, -1},
    {"link_out", NO_LINK, ELOOP, -1},
    {"link_in", NO_LINK, ELOOP, -1},
    {"link_in", PLAIN, 0, EXDEV},
    {"folder_in/in", NO_LINK, 0, EXDEV},
};

static void make_tree(void)
{
    test_write_file("out", "outside");
    test_write_file("root/a/in", "inside");
    assert_int_equal(mkfifo("root/a/fifo", 0600), 0);
    assert_int_equal(symlink("../out", "root/link_out"), 0);
    assert_int_equal(symlink("../nothing", "root/link_to_nothing"), 0);
    assert_int_equal(symlink("/etc/passwd", "root/link_absolute"), 0);
    assert_int_equal(symlink("/dev/zero", "root/link_to_zero"), 0);
    assert_int_equal(symlink("..", "root/folder_out"), 0);
    assert_int_equal(symlink("a/in", "root/link_in"), 0);
    assert_int_equal(symlink("a", "root/folder_in"), 0);
}

/* Returns the number of rows that are not as they should be. */
static int count_wrong(bool is_old)
{
    int wrong = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const int file = kiln_file_open_below("root", rows[i].path, rows[i].flags);
        const int found = file >= 0 ? 0 : errno;
        const int expected =
            is_old && rows[i].old_kernel >= 0 ? rows[i].old_kernel : rows[i].expected;
        if (file >= 0)
            close(file);
        if (found != expected)
            print_error("%s: %s, not %s\n", rows[i].path, strerror(found), strerror(expected));
        wrong += found != expected;
    }
    return wrong;
}

static void paths_stay_below(void **state)
{
    (void)state;
    make_tree();
    assert_int_equal(count_wrong(false), 0);
}

/* Lets the calling process find no openat2, as on Linux before 5.6. */
static bool hide_openat2(void)
{
    struct sock_filter filter[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_openat2, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOSYS),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    };
    const struct sock_fprog program = {sizeof filter / sizeof *filter, filter};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

static void paths_stay_below_without_openat2(void **state)
{
    (void)state;
    make_tree();
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        _exit(hide_openat2() ? count_wrong(true) : 100);
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)

int main(void)
{
    static const struct CMUnitTest tests[] = {
        IN_FOLDER(paths_stay_below),
        IN_FOLDER(paths_stay_below_without_openat2),
    };
    return cmocka_run_group_tests_name("below", tests, NULL, NULL);
}
