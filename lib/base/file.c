/* Joins and compares paths, and reads text files whole. */
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"

bool kiln_path_join(char path[KILN_PATH_SIZE], const char *folder, const char *name,
                    struct kiln_error *error)
{
    return snprintf(path, KILN_PATH_SIZE, "%s/%s", folder, name) < KILN_PATH_SIZE ||
           kiln_error_set(error, KILN_IO, "%.200s...: the path is longer than %d bytes", folder,
                          KILN_PATH_SIZE - 1);
}

const char *kiln_path_below(const char *path, const char *folder)
{
    const size_t length = strcmp(folder, "/") == 0 ? 0 : strlen(folder);
    return strncmp(path, folder, length) == 0 && path[length] == '/' ? path + length + 1 : NULL;
}

static bool check_file(int file, const char *path, const char *what, size_t limit,
                       struct stat *status, struct kiln_error *error)
{
    if (fstat(file, status) != 0)
        return kiln_error_set_errno(error, KILN_IO, errno, "%s", path);
    if (S_ISDIR(status->st_mode))
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: the path is a folder, not %s", path,
                              what);
    if (!S_ISREG(status->st_mode))
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: the path is not a regular file",
                              path);
    if ((uint64_t)status->st_size > limit)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the file has %lld bytes; %s has at most %zu", path,
                              (long long)status->st_size, what, limit);
    return true;
}

static bool read_bytes(int file, const char *path, char *text, size_t expected, size_t *size,
                       struct kiln_error *error)
{
    size_t length = 0;
    while (length < expected) {
        ssize_t count = read(file, text + length, expected - length);
        if (count == 0)
            break; /* the file has become shorter */
        if (count < 0 && errno != EINTR)
            return kiln_error_set_errno(error, KILN_IO, errno, "%s", path);
        length += count > 0 ? (size_t)count : 0;
    }
    text[length] = '\0';
    *size = length;
    return true;
}

char *kiln_text_file_take(int file, const char *path, const char *what, size_t limit, size_t *size,
                          struct stat *status, struct kiln_error *error)
{
    struct stat own, *found = status ? status : &own;
    if (!check_file(file, path, what, limit, found, error))
        return NULL;
    const size_t expected = (size_t)found->st_size;
    char *text = malloc(expected + 1);
    if (!text) {
        kiln_error_no_memory(error, "%s", path);
    } else if (!read_bytes(file, path, text, expected, size, error)) {
        free(text);
        text = NULL;
    }
    return text;
}

char *kiln_text_file_read(const char *path, const char *what, size_t limit, size_t *size,
                          struct kiln_error *error)
{
    struct stat status;
    /* Without O_NONBLOCK, opening a pipe would wait for its writer. */
    int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) {
        kiln_error_set_errno(error, KILN_INVALID_INPUT, errno, "%s", path);
        return NULL;
    }
    char *text = kiln_text_file_take(file, path, what, limit, size, &status, error);
    close(file);
    return text;
}
