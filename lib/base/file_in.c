/* This file opens regular files and reads them into memory as a whole. A path may come from a user
 * and lead to anything (a folder, a FIFO, a device), so each file is checked after it is opened.
 * KILN_FILE_FLAGS keep opening from waiting. Below a folder, files are opened by openat2, which the
 * kernel resolves there even if links are swapped meanwhile. */
#include "base/file_in.h"

#include <errno.h>
#include <inttypes.h>
#include <linux/openat2.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "base/error.h"

bool kiln_file_is_lfs_pointer(int file)
{
    static const char start[] = "version https://git-lfs.github.com/spec/v";
    char found[sizeof start - 1];
    return pread(file, found, sizeof found, 0) == (ssize_t)sizeof found &&
           memcmp(found, start, sizeof found) == 0;
}

bool kiln_path_is_lfs_pointer(const char *path)
{
    const int file = open(path, KILN_FILE_FLAGS);
    const bool is = file >= 0 && kiln_file_is_lfs_pointer(file);
    if (file >= 0)
        close(file);
    return is;
}

bool kiln_file_check(int file, const char *path, const char *what, const char *allowed,
                     size_t *size, struct kiln_error *error)
{
    struct stat status;
    if (fstat(file, &status) != 0)
        return kiln_error_set_errno(error, KILN_IO, errno, "%s: the %s cannot be examined", path,
                                    what);
    *size = (size_t)status.st_size;
    if (!S_ISREG(status.st_mode))
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the path is not a file but a %s; allowed are %s files", path,
                              S_ISDIR(status.st_mode) ? "folder" : "device or pipe", allowed);
    return !kiln_file_is_lfs_pointer(file) ||
           kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: the %s is a Git LFS pointer: run git lfs pull", path, what);
}

int kiln_file_open(const char *path, const char *what, const char *allowed, size_t *size,
                   struct kiln_error *error)
{
    int file = open(path, KILN_FILE_FLAGS);
    if (file < 0)
        kiln_error_set_errno(error, KILN_IO, errno, "%s: the %s cannot be opened", path, what);
    if (file >= 0 && !kiln_file_check(file, path, what, allowed, size, error)) {
        close(file);
        file = -1;
    }
    return file;
}

/* ---- Below a folder -------------------------------------------------------------------------- */

/* Opens one name in a folder and follows no link. A link before the last name counts as a way out,
 * since this function cannot tell where it leads. */
static int open_step(int folder, const char *name, bool is_last, int flags)
{
    struct stat status;
    if (strcmp(name, "..") == 0) {
        errno = EXDEV;
        return -1;
    }
    const int step_flags = is_last ? flags : O_PATH | O_DIRECTORY | O_CLOEXEC;
    const int opened = openat(folder, name, step_flags | O_NOFOLLOW);
    const int reason = errno;
    const bool is_link = opened < 0 && (reason == ELOOP || reason == ENOTDIR) &&
                         fstatat(folder, name, &status, AT_SYMLINK_NOFOLLOW) == 0 &&
                         S_ISLNK(status.st_mode);
    errno = !is_link ? reason : is_last && (flags & O_NOFOLLOW) ? ELOOP : EXDEV;
    return opened;
}

/* Opens a path component by component and follows no link. It replaces openat2 on an older kernel,
 * or in a container that forbids the call. */
static int open_steps(int folder, const char *relative, int flags)
{
    char path[KILN_PATH_SIZE];
    int at = dup(folder);
    if (snprintf(path, sizeof path, "%s", relative) >= (int)sizeof path)
        path[0] = '\0';
    char *rest = path;
    for (const char *step; at >= 0 && (step = strsep(&rest, "/"));) {
        const int next = *step ? open_step(at, step, !rest, flags) : dup(at);
        const int reason = errno;
        close(at);
        errno = reason;
        at = next;
    }
    return at;
}

int kiln_file_open_below(const char *folder, const char *path, int flags)
{
    if (*path == '/') {
        errno = EXDEV;
        return -1;
    }
    const int root = open(folder, O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (root < 0)
        return -1;
    const struct open_how how = {.flags = (unsigned)flags,
                                 .resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS};
    int file, tries = 0;
    do { /* EAGAIN: something was renamed meanwhile, and the kernel cannot be sure */
        file = (int)syscall(SYS_openat2, root, path, &how, sizeof how);
    } while (file < 0 && (errno == EAGAIN || errno == EINTR) && tries++ < 100);
    if (file < 0 && (errno == ENOSYS || errno == EPERM))
        file = open_steps(root, path, flags);
    const int reason = errno;
    close(root);
    errno = reason;
    return file;
}

/* ---- Reading --------------------------------------------------------------------------------- */

static bool read_all(int file, unsigned char *bytes, size_t size)
{
    for (size_t done = 0; done < size;) {
        const ssize_t got = read(file, bytes + done, size - done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got == 0)
            errno = ENODATA; /* the file has become shorter since its size was found */
        if (got <= 0)
            return false;
        done += (size_t)got;
    }
    return true;
}

bool kiln_file_check_size(const char *path, const char *what, size_t size, size_t limit,
                          struct kiln_error *error)
{
    return size <= limit || kiln_error_set(error, KILN_INVALID_INPUT,
                                           "%s: the %s file has %zu bytes; allowed are at most %zu",
                                           path, what, size, limit);
}

unsigned char *kiln_file_read_bytes(int file, const char *path, const char *what, size_t size,
                                    struct kiln_error *error)
{
    unsigned char *bytes = malloc(size + 1); /* not malloc(0), which may return NULL */
    if (!bytes) {
        kiln_error_no_memory(error, "reading %s", path);
    } else if (!read_all(file, bytes, size)) {
        kiln_error_set_errno(error, KILN_IO, errno, "%s: the %s cannot be read", path, what);
        free(bytes);
        bytes = NULL;
    }
    return bytes;
}

unsigned char *kiln_file_read(const char *path, const char *what, const char *allowed, size_t limit,
                              size_t *size, struct kiln_error *error)
{
    const int file = kiln_file_open(path, what, allowed, size, error);
    if (file < 0)
        return NULL;
    unsigned char *bytes = kiln_file_check_size(path, what, *size, limit, error)
                               ? kiln_file_read_bytes(file, path, what, *size, error)
                               : NULL;
    close(file);
    return bytes;
}
