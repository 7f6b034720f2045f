/* Files as they are given by people: they may be anything. */
#include "base/file_in.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"

int kiln_file_open(const char *path, const char *what, const char *allowed, size_t *size,
                   struct kiln_error *error)
{
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    struct stat status;
    if (file < 0 || fstat(file, &status) != 0) {
        kiln_error_set_errno(error, KILN_IO, errno, "%s: the %s cannot be opened", path, what);
        if (file >= 0)
            close(file);
        return -1;
    }
    if (!S_ISREG(status.st_mode)) {
        kiln_error_set(error, KILN_INVALID_INPUT, "%s: not a file but a %s; allowed are %s files",
                       path, S_ISDIR(status.st_mode) ? "folder" : "device or pipe", allowed);
        close(file);
        return -1;
    }
    *size = (size_t)status.st_size;
    return file;
}

static bool read_all(int file, unsigned char *bytes, size_t size)
{
    for (size_t done = 0; done < size;) {
        ssize_t got = read(file, bytes + done, size - done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        done += (size_t)got;
    }
    return true;
}

unsigned char *kiln_file_read(const char *path, const char *what, const char *allowed, size_t limit,
                              size_t *size, struct kiln_error *error)
{
    int file = kiln_file_open(path, what, allowed, size, error);
    if (file < 0)
        return NULL;
    unsigned char *bytes = NULL;
    if (*size > limit) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: the %s file has %zu bytes; allowed are at most %zu", path, what, *size,
                       limit);
    } else if (!(bytes = malloc(*size + 1))) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory while reading", path);
    } else if (!read_all(file, bytes, *size)) {
        kiln_error_set_errno(error, KILN_IO, errno, "%s: the %s cannot be read", path, what);
        free(bytes);
        bytes = NULL;
    }
    close(file);
    return bytes;
}
