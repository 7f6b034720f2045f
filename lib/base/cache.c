/* This file reads and writes the cache of flipbooks, of the distance fields of meshes and of
 * programs of GL. Each file of the cache is a line with a checksum, followed by the data. The
 * checksum finds accidental damage only: a user who may write into the folder can forge any file.
 * So it is Adler-32 and not SHA-256, which took a sixth of the time of a small frame. */
#include "base/cache.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "base/file.h"
#include "base/file_in.h"
#include "base/temporary.h"
#include "kiln_program.h"

#define MAGIC "kiln-cache 2 "

enum { HEADER = sizeof MAGIC - 1 + 8 + 1 };

/* Writes the path of a folder of the cache. */
static bool find_folder(char folder[KILN_PATH_SIZE], const char *name)
{
    const char *cache = kiln_environment("XDG_CACHE_HOME");
    const char *home = kiln_environment("HOME");
    int length = -1;
    if (cache && cache[0] == '/')
        length = snprintf(folder, KILN_PATH_SIZE, "%s/%s", cache, name);
    else if (home && home[0] == '/')
        length = snprintf(folder, KILN_PATH_SIZE, "%s/.cache/%s", home, name);
    return length > 0 && length < KILN_PATH_SIZE - 80; /* 80: a slash and a file's name */
}

bool kiln_cache_folder(char folder[KILN_PATH_SIZE])
{
    return find_folder(folder, "kiln");
}

/* Makes a folder with rights for this user alone if it is missing. */
static bool make_own_folder(const char *path)
{
    return mkdir(path, 0700) == 0 || errno == EEXIST;
}

/* Returns whether nobody but this user and root may put another file in the place of one that lies
 * in a folder. */
static bool keeps_files(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && (status.st_uid == geteuid() || status.st_uid == 0) &&
           ((status.st_mode & (S_IWGRP | S_IWOTH)) == 0 || (status.st_mode & S_ISVTX) != 0);
}

bool kiln_cache_private_folder(char folder[KILN_PATH_SIZE])
{
    struct kiln_error ignored = {0};
    struct stat status;
    char parent[KILN_PATH_SIZE];
    if (!find_folder(folder, "kiln-programs"))
        return false;
    snprintf(parent, sizeof parent, "%.*s", (int)(strrchr(folder, '/') - folder), folder);
    if (!kiln_make_parent_folders(parent, &ignored) || !make_own_folder(parent) ||
        !keeps_files(parent) || !make_own_folder(folder))
        return false;
    return lstat(folder, &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == geteuid() &&
           (status.st_mode & (S_IRWXG | S_IRWXO)) == 0;
}

static void compose_header(char header[HEADER + 1], const void *bytes, size_t size)
{
    const unsigned long sum = adler32_z(adler32_z(0, NULL, 0), bytes, size);
    snprintf(header, HEADER + 1, MAGIC "%08lx\n", sum);
}

/* ---- reading --------------------------------------------------------------------------------- */

static bool read_bytes(FILE *in, void *bytes, size_t size)
{
    char found[HEADER], expected[HEADER + 1];
    if (fread(found, sizeof found, 1, in) != 1 || fread(bytes, 1, size, in) != size ||
        fgetc(in) != EOF)
        return false;
    compose_header(expected, bytes, size);
    return memcmp(found, expected, sizeof found) == 0;
}

/* Opens the file of a name, and finds how many bytes follow its header. */
static FILE *open_file(const char *folder, const char *name, size_t *size)
{
    char path[KILN_PATH_SIZE];
    struct kiln_error ignored = {0};
    size_t file_size = 0;
    const int file = kiln_path_join(path, folder, name, &ignored)
                         ? kiln_file_open(path, "cache", "", &file_size, &ignored)
                         : -1;
    FILE *in = file >= 0 && file_size >= HEADER ? fdopen(file, "rb") : NULL;
    if (!in && file >= 0)
        close(file);
    *size = in ? file_size - HEADER : 0;
    return in;
}

bool kiln_cache_read_into(const char *folder, const char *name, void *bytes, size_t size)
{
    size_t found;
    FILE *in = open_file(folder, name, &found);
    const bool is_undamaged = in && found == size && read_bytes(in, bytes, size);
    if (in)
        fclose(in);
    return is_undamaged;
}

void *kiln_cache_read_any(const char *folder, const char *name, size_t most, size_t *size)
{
    FILE *in = open_file(folder, name, size);
    void *bytes = in && *size <= most ? malloc(*size > 0 ? *size : 1) : NULL;
    if (bytes && !read_bytes(in, bytes, *size)) {
        free(bytes);
        bytes = NULL;
    }
    if (in)
        fclose(in);
    return bytes;
}

void *kiln_cache_read(const char *folder, const char *name, size_t size)
{
    void *bytes = malloc(size > 0 ? size : 1);
    if (bytes && kiln_cache_read_into(folder, name, bytes, size))
        return bytes;
    free(bytes);
    return NULL;
}

/* ---- making room ----------------------------------------------------------------------------- */

struct entry {
    char name[256];
    off_t size;
    int64_t used_ns; /* when it was last read or written; where the system keeps no times of
                      * reading, when it was written */
};

static int64_t used_ns(const struct stat *status)
{
    const struct timespec *read = &status->st_atim, *written = &status->st_mtim;
    const int64_t read_ns = read->tv_sec * INT64_C(1000000000) + read->tv_nsec;
    const int64_t written_ns = written->tv_sec * INT64_C(1000000000) + written->tv_nsec;
    return read_ns > written_ns ? read_ns : written_ns;
}

static int by_use(const void *a, const void *b)
{
    const struct entry *x = a, *y = b;
    return (x->used_ns > y->used_ns) - (x->used_ns < y->used_ns);
}

/* Returns whether a file's name has the form of the cache's names, which begin with a SHA-256 hash
 * and a dot. Files with other names are not the cache's and are not touched. */
static bool is_ours(const char *name)
{
    const size_t digits = strspn(name, "0123456789abcdef");
    return digits == 64 && name[digits] == '.';
}

/* Lists the files of the cache except `name`, which is about to be written. The caller frees the
 * list. When memory is short or the folder cannot be read, it returns NULL with a count of 0. */
static struct entry *list_others(int folder, const char *name, size_t *count)
{
    struct dirent **found = NULL;
    const int all = scandirat(folder, ".", &found, NULL, NULL);
    struct entry *entries = all > 0 ? calloc((size_t)all, sizeof *entries) : NULL;
    *count = 0;
    for (int i = 0; i < all; i++) {
        struct stat status;
        if (entries && is_ours(found[i]->d_name) && strcmp(found[i]->d_name, name) != 0 &&
            fstatat(folder, found[i]->d_name, &status, AT_SYMLINK_NOFOLLOW) == 0 &&
            S_ISREG(status.st_mode)) {
            struct entry *entry = &entries[(*count)++];
            *entry = (struct entry){.size = status.st_size, .used_ns = used_ns(&status)};
            snprintf(entry->name, sizeof entry->name, "%s", found[i]->d_name);
        }
        free(found[i]);
    }
    free(found);
    return entries;
}

/* Removes the least recently used files until one more of `size` bytes fits into KILN_CACHE_BYTES.
 */
static void make_room(const char *path, const char *name, size_t size)
{
    const int folder = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0)
        return;
    size_t count;
    struct entry *entries = list_others(folder, name, &count);
    off_t total = (off_t)size;
    if (entries)
        qsort(entries, count, sizeof *entries, by_use);
    for (size_t i = 0; i < count; i++)
        total += entries[i].size;
    for (size_t i = 0; i < count && total > KILN_CACHE_BYTES; i++) {
        if (unlinkat(folder, entries[i].name, 0) == 0)
            total -= entries[i].size;
    }
    free(entries);
    close(folder);
}

/* ---- writing --------------------------------------------------------------------------------- */

void kiln_cache_write(const char *folder, const char *name, const void *bytes, size_t size)
{
    char path[KILN_PATH_SIZE], header[HEADER + 1];
    struct kiln_error ignored = {0};
    struct kiln_temporary file = {.target = NULL};
    if (size > KILN_CACHE_BYTES - HEADER || !kiln_path_join(path, folder, name, &ignored) ||
        !kiln_make_parent_folders(path, &ignored))
        return;
    kiln_temporary_sweep(path);
    make_room(folder, name, HEADER + size);
    compose_header(header, bytes, size);
    if (kiln_temporary_open(&file, path, &ignored) && kiln_temporary_write(&file, header, HEADER) &&
        kiln_temporary_write(&file, bytes, size))
        kiln_temporary_commit(&file, true, &ignored);
    else
        kiln_temporary_discard(&file);
}
