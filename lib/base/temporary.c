/* Writes files under temporary names and renames them when they are complete.
 *
 * The table of temporary names has static storage and a fixed size: kiln_abandon_outputs must find
 * the names from a signal handler, which can take no lock and has no pointer to an owner. A slot is
 * claimed and released by an atomic, its path is written before it is marked as armed, and a file
 * exists only while its slot is armed. */
#include "base/temporary.h"

#include <assert.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/budget.h"
#include "base/error.h"

enum { SLOT_COUNT = 256, MAX_ATTEMPTS = 64, MAX_TOGETHER = 8 };

enum slot_state { SLOT_FREE, SLOT_CLAIMED, SLOT_ARMED };

static struct slot {
    atomic_int state;
    char path[KILN_PATH_SIZE];
} slots[SLOT_COUNT];

static atomic_bool ending; /* set when the process is about to end: then no new file is opened */

static int claim_slot(void)
{
    for (int i = 0; i < SLOT_COUNT; i++) {
        int expected = SLOT_FREE;
        if (atomic_compare_exchange_strong(&slots[i].state, &expected, SLOT_CLAIMED))
            return i;
    }
    return -1;
}

static void release_slot(int slot)
{
    atomic_store(&slots[slot].state, SLOT_FREE);
}

void kiln_abandon_outputs(void)
{
    atomic_store(&ending, true);
    for (int i = 0; i < SLOT_COUNT; i++) {
        if (atomic_load(&slots[i].state) == SLOT_ARMED)
            unlink(slots[i].path);
    }
}

bool kiln_target_check(const char *path, bool overwrite, struct kiln_error *error)
{
    struct stat status;
    if (lstat(path, &status) != 0) {
        if (errno == ENOENT || errno == ENOTDIR)
            return true;
        return kiln_error_set_errno(error, KILN_IO, errno, "%s: the path cannot be used", path);
    }
    if (S_ISDIR(status.st_mode))
        return kiln_error_set(error, KILN_USAGE, "%s: a folder has this name", path);
    if (!S_ISREG(status.st_mode) && !S_ISLNK(status.st_mode))
        return kiln_error_set(error, KILN_USAGE, "%s: a device, pipe or socket has this name",
                              path);
    return overwrite ||
           kiln_error_set(error, KILN_USAGE, "%s: the file exists (--force replaces it)", path);
}

bool kiln_make_parent_folders(const char *path, struct kiln_error *error)
{
    char folder[KILN_PATH_SIZE];
    size_t length = strlen(path);
    if (length >= sizeof folder)
        return kiln_error_set(error, KILN_USAGE, "%.200s...: the path is longer than %d bytes",
                              path, KILN_PATH_SIZE - 1);
    memcpy(folder, path, length + 1);
    for (char *slash = strchr(folder + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        struct stat status;
        if ((mkdir(folder, 0777) != 0 && errno != EEXIST) || stat(folder, &status) != 0)
            return kiln_error_set_errno(error, KILN_IO, errno, "%s: the folder cannot be made",
                                        folder);
        if (!S_ISDIR(status.st_mode))
            return kiln_error_set(error, KILN_USAGE,
                                  "%s: the path is not a folder, but %s needs a folder here",
                                  folder, path);
        *slash = '/';
    }
    return true;
}

/* Writes the path ".NAME.kiln-PID-N.tmp" in the target's folder. A long NAME is cut, since file
 * names have a limit. */
static bool write_temporary_name(char path[KILN_PATH_SIZE], const char *target, int number)
{
    const char *slash = strrchr(target, '/');
    const char *name = slash ? slash + 1 : target;
    int length = snprintf(path, KILN_PATH_SIZE, "%.*s.%.100s.kiln-%ld-%d.tmp", (int)(name - target),
                          target, name, (long)getpid(), number);
    return length < KILN_PATH_SIZE;
}

/* Creates a file and locks it until it is closed. Returns -1 with errno on failure. Between the
 * creation and the lock, another process may take the file for a left-over one and lock or remove
 * it; then errno is EEXIST. */
static int open_locked(const char *path)
{
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0)
        return -1;
    struct stat status;
    bool locked_by_other = flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!locked_by_other && fstat(file, &status) == 0 && status.st_nlink > 0)
        return file;
    close(file);
    errno = EEXIST;
    return -1;
}

/* Removes a left-over file: one that no process locks, since its writer was killed. If such files
 * stayed, a job that is killed and tried again under the same process number, as in a container,
 * would use up its MAX_ATTEMPTS names. */
static bool remove_leftover(const char *path)
{
    /* Without O_NONBLOCK, opening a pipe would wait for its reader. */
    int file = open(path, O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0)
        return false;
    struct stat status;
    bool removed = fstat(file, &status) == 0 && S_ISREG(status.st_mode) &&
                   flock(file, LOCK_EX | LOCK_NB) == 0 && unlink(path) == 0;
    close(file);
    return removed;
}

/* Writes the folder of a target. Returns false if its name is too long. */
static bool folder_of(const char *target, char folder[KILN_PATH_SIZE])
{
    const char *slash = strrchr(target, '/');
    const int length = slash && slash != target ? (int)(slash - target) : 1;
    return snprintf(folder, KILN_PATH_SIZE, "%.*s", length, slash ? target : ".") < KILN_PATH_SIZE;
}

/* Returns whether a name is of the form ".NAME.kiln-PID-N.tmp". */
static bool is_temporary_name(const char *name)
{
    static const char mark[] = ".kiln-", suffix[] = ".tmp", digits[] = "0123456789";
    const size_t length = strlen(name), suffix_length = sizeof suffix - 1;
    if (name[0] != '.' || length <= suffix_length ||
        strcmp(name + length - suffix_length, suffix) != 0)
        return false;
    const char *last = NULL;
    for (const char *at = name; (at = strstr(at, mark)); at++)
        last = at + sizeof mark - 1;
    const size_t pid = last ? strspn(last, digits) : 0;
    if (pid == 0 || last[pid] != '-')
        return false;
    const char *number = last + pid + 1;
    const size_t count = strspn(number, digits);
    return count > 0 && number + count == name + length - suffix_length;
}

void kiln_temporary_sweep(const char *target)
{
    char folder[KILN_PATH_SIZE], path[KILN_PATH_SIZE];
    struct dirent **entries = NULL;
    if (!folder_of(target, folder))
        return;
    const int count = scandir(folder, &entries, NULL, NULL);
    for (int i = 0; i < count; i++) {
        const char *name = entries[i]->d_name;
        if (is_temporary_name(name) &&
            snprintf(path, sizeof path, "%s/%s", folder, name) < KILN_PATH_SIZE)
            remove_leftover(path);
        free(entries[i]);
    }
    free(entries);
}

/* Creates a file in an armed slot. Returns -1 with errno on failure. */
static int create_file(int slot, const char *target)
{
    int number = slot;
    for (int attempt = 0; attempt < MAX_ATTEMPTS; attempt++) {
        if (!write_temporary_name(slots[slot].path, target, number)) {
            errno = ENAMETOOLONG;
            return -1;
        }
        atomic_store(&slots[slot].state, SLOT_ARMED);
        int file = atomic_load(&ending) ? -1 : open_locked(slots[slot].path);
        if (file >= 0 && atomic_load(&ending)) {
            unlink(slots[slot].path);
            close(file);
            file = -1;
        }
        if (atomic_load(&ending))
            errno = ECANCELED;
        if (file >= 0 || errno != EEXIST)
            return file;
        atomic_store(&slots[slot].state, SLOT_CLAIMED); /* the file with this name is not ours */
        if (!remove_leftover(slots[slot].path))
            number += SLOT_COUNT;
    }
    return -1;
}

bool kiln_temporary_open(struct kiln_temporary *temporary, const char *target,
                         struct kiln_error *error)
{
    int slot = claim_slot();
    if (slot < 0) {
        kiln_error_set(error, KILN_IO, "%s: more than %d files are being written at once", target,
                       SLOT_COUNT);
        return false;
    }
    char *copy = strdup(target);
    int file = copy ? create_file(slot, target) : -1;
    if (file >= 0) {
        *temporary = (struct kiln_temporary){.target = copy, .file = file, .slot = slot};
        return true;
    }
    kiln_error_set_errno(error, KILN_IO, errno, "%s: the file cannot be created", target);
    release_slot(slot);
    free(copy);
    return false;
}

const char *kiln_temporary_path(const struct kiln_temporary *temporary)
{
    return slots[temporary->slot].path;
}

bool kiln_temporary_write(struct kiln_temporary *temporary, const void *bytes, size_t size)
{
    const char *rest = bytes;
    struct kiln_error ignored = {0};
    if (!kiln_budget_take(temporary->budget, KILN_LIMIT_output, size, "", &ignored))
        temporary->failure = EDQUOT;
    while (size > 0 && temporary->failure == 0) {
        ssize_t written = write(temporary->file, rest, size);
        if (written > 0) {
            rest += written;
            size -= (size_t)written;
        } else if (written == 0 || errno != EINTR) {
            temporary->failure = written == 0 ? EIO : errno;
        }
    }
    return temporary->failure == 0;
}

/* Reports why a file cannot be written, and returns false. If the output is over its limit, that is
 * the reason, whatever errno says: taking 0 bytes fails only then. */
static bool report_failure(const struct kiln_temporary *temporary, int failure,
                           struct kiln_error *error)
{
    return kiln_budget_take(temporary->budget, KILN_LIMIT_output, 0, temporary->target, error) &&
           kiln_error_set_errno(error, KILN_IO, failure, "%s: the file cannot be written",
                                temporary->target);
}

bool kiln_temporary_fail(const struct kiln_temporary *temporary, struct kiln_error *error)
{
    return report_failure(temporary, temporary->failure, error);
}

bool kiln_temporary_seek(struct kiln_temporary *temporary, int64_t offset)
{
    if (temporary->failure == 0 && lseek(temporary->file, offset, SEEK_SET) != offset)
        temporary->failure = errno;
    return temporary->failure == 0;
}

static void release(struct kiln_temporary *temporary)
{
    release_slot(temporary->slot);
    free(temporary->target);
    *temporary = (struct kiln_temporary){.file = -1, .slot = -1, .failure = EBADF};
}

/* Renames a file. Without overwrite, it fails where a file has appeared meanwhile. A file system
 * without RENAME_NOREPLACE gets a plain rename: close_all has just found the name free. */
static bool move_into_place(const char *path, const char *target, bool overwrite)
{
    if (!overwrite) {
        if (renameat2(AT_FDCWD, path, AT_FDCWD, target, RENAME_NOREPLACE) == 0)
            return true;
        if (errno != EINVAL && errno != ENOSYS)
            return false;
    }
    return rename(path, target) == 0;
}

/* Closes a file that still has its temporary name. Returns the errno of the first failure since it
 * was opened, or 0. `lock` receives a second descriptor, which the caller closes after the rename.
 * It keeps the file locked, so that no process takes the file for a left-over one. */
static int close_file(struct kiln_temporary *temporary, int *lock)
{
    *lock = fcntl(temporary->file, F_DUPFD_CLOEXEC, 0);
    if (temporary->durable && temporary->failure == 0 && fsync(temporary->file) != 0)
        temporary->failure = errno;
    if (close(temporary->file) != 0 && temporary->failure == 0)
        temporary->failure = errno;
    return temporary->failure;
}

/* Synchronises a target's folder, so that the names in it outlast a crash. Failures are ignored,
 * since the file is complete without this. */
static void sync_folder(const char *target)
{
    char folder[KILN_PATH_SIZE];
    if (!folder_of(target, folder))
        return;
    const int opened = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (opened < 0)
        return;
    fsync(opened);
    close(opened);
}

bool kiln_temporary_commit(struct kiln_temporary *temporary, bool overwrite,
                           struct kiln_error *error)
{
    return kiln_temporary_commit_all(&temporary, 1, overwrite, error);
}

/* Closes all files, and checks that each is whole and may get its name. */
static bool close_all(struct kiln_temporary *const *files, size_t count, bool overwrite, int *locks,
                      struct kiln_error *error)
{
    bool whole = true;
    for (size_t i = 0; i < count; i++) {
        int failure = close_file(files[i], &locks[i]);
        if (whole && failure != 0)
            whole = report_failure(files[i], failure, error);
    }
    for (size_t i = 0; i < count && whole; i++)
        whole = kiln_target_check(files[i]->target, overwrite, error);
    return whole;
}

/* Renames the files in their order. Returns how many got their names, which is fewer than `count`
 * only with an error. The last file marks a complete set, so an old one with its name is removed
 * before the first rename. */
static size_t rename_all(struct kiln_temporary *const *files, size_t count, bool overwrite,
                         struct kiln_error *error)
{
    const char *last = files[count - 1]->target;
    if (overwrite && count > 1 && unlink(last) != 0 && errno != ENOENT) {
        report_failure(files[count - 1], errno, error);
        return 0;
    }
    for (size_t i = 0; i < count; i++) {
        if (!move_into_place(slots[files[i]->slot].path, files[i]->target, overwrite)) {
            report_failure(files[i], errno, error);
            return i;
        }
    }
    return count;
}

bool kiln_temporary_commit_all(struct kiln_temporary *const *files, size_t count, bool overwrite,
                               struct kiln_error *error)
{
    int locks[MAX_TOGETHER];
    assert(count <= MAX_TOGETHER);
    size_t renamed = close_all(files, count, overwrite, locks, error)
                         ? rename_all(files, count, overwrite, error)
                         : 0;
    for (size_t i = 0; i < count; i++) {
        if (renamed < count)
            unlink(i < renamed ? files[i]->target : slots[files[i]->slot].path);
        else if (files[i]->durable)
            sync_folder(files[i]->target);
        if (locks[i] >= 0)
            close(locks[i]);
        release(files[i]);
    }
    return renamed == count;
}

void kiln_temporary_discard(struct kiln_temporary *temporary)
{
    if (!temporary->target)
        return;
    close(temporary->file);
    unlink(slots[temporary->slot].path);
    release(temporary);
}

bool kiln_temporary_write_file(const char *path, const void *bytes, size_t size,
                               struct kiln_error *error)
{
    struct kiln_temporary file = {0};
    if (!kiln_target_check(path, true, error) || !kiln_make_parent_folders(path, error) ||
        !kiln_temporary_open(&file, path, error))
        return false;
    kiln_temporary_write(&file, bytes, size); /* kiln_temporary_commit reports a failure */
    return kiln_temporary_commit(&file, true, error);
}
