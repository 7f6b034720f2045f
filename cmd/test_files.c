/* Makes and claims the results folder of a test run, and writes and reads the log files of tests.
 */
#include "test_files.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "report.h"

char *join_path(const char *folder, const char *name)
{
    char *path = NULL;
    return asprintf(&path, "%s/%s", folder, name) < 0 ? NULL : path;
}

/* Makes the folders above a path; false with errno. */
static bool make_parents(const char *path)
{
    char *folder = strdup(path);
    if (!folder)
        return false;
    bool ok = true;
    for (char *slash = strchr(folder + 1, '/'); ok && slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        ok = mkdir(folder, 0777) == 0 || errno == EEXIST;
        *slash = '/';
    }
    int failure = errno;
    free(folder);
    errno = failure;
    return ok;
}

int claim_folder(const char *path)
{
    if (!make_parents(path) || (mkdir(path, 0777) != 0 && errno != EEXIST))
        return report(KILN_IO, "%s: cannot create the folder: %s", path, strerror(errno));
    int folder = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0)
        return report(KILN_IO, "%s: cannot open the folder: %s", path, strerror(errno));
    if (flock(folder, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK)
        return 0; /* the open descriptor holds the lock; some file systems have no locks */
    close(folder);
    return report(KILN_USAGE,
                  "%s: another run writes its results there; give this one another "
                  "folder by --results",
                  path);
}

bool remove_file(const char *path)
{
    return unlink(path) == 0 || errno == ENOENT || errno == ENOTDIR;
}

int create_log(const char *path)
{
    if (!make_parents(path) || !remove_file(path))
        return -1;
    return open(path, O_WRONLY | O_APPEND | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

const char *last_log_line(const char *path, char line[LOG_LINE_SIZE])
{
    char tail[4096] = "";
    line[0] = '\0';
    /* The process of a test could have put a pipe, a device or a link in place of its log. */
    const int file = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    struct stat status;
    ssize_t count = 0;
    if (file >= 0 && fstat(file, &status) == 0 && S_ISREG(status.st_mode)) {
        const off_t most = (off_t)sizeof tail - 1;
        count =
            pread(file, tail, sizeof tail - 1, status.st_size > most ? status.st_size - most : 0);
    }
    if (file >= 0)
        close(file);
    size_t length = count > 0 ? (size_t)count : 0;
    while (length > 0 && (unsigned char)tail[length - 1] <= ' ')
        length--;
    size_t start = length;
    while (start > 0 && tail[start - 1] != '\n')
        start--;
    size_t used = 0;
    for (size_t i = start; i < length && used + 1 < LOG_LINE_SIZE; i++) {
        unsigned char c = (unsigned char)tail[i];
        line[used++] = (char)(c < ' ' || c == 127 ? ' ' : c);
    }
    line[used] = '\0';
    return line;
}
