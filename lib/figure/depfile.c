/* Writes the dependencies of a figure in the syntax of make, as compilers do. */
#include "figure/depfile.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file_in.h"

struct files {
    const char **paths;
    size_t count, capacity;
    const char *here; /* the working directory, with a slash at its end */
    bool failed;
};

static void add_file(void *user, const char *path)
{
    struct files *files = user;
    size_t length = strlen(files->here);
    if (files->count == files->capacity) {
        size_t capacity = files->capacity ? 2 * files->capacity : 64;
        const char **grown = realloc(files->paths, capacity * sizeof *grown);
        if (!grown) {
            files->failed = true;
            return;
        }
        files->paths = grown;
        files->capacity = capacity;
    }
    files->paths[files->count++] = strncmp(path, files->here, length) == 0 ? path + length : path;
}

static int compare_paths(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Adds a file name, escaped so that make reads it as one name. Backslashes are doubled only before
 * an escaped character; '%' is escaped in targets alone, where it would be a pattern. */
static bool add_name(struct kiln_text *text, const char *name, bool target,
                     struct kiln_error *error)
{
    const char *odd = strpbrk(name, "\n=;|");
    if (odd && *odd == '\n')
        return kiln_error_set(error, KILN_USAGE,
                              "--depfile: %s: make cannot read a name with a line feed", name);
    if (odd)
        return kiln_error_set(error, KILN_USAGE, "--depfile: %s: make cannot read a name with '%c'",
                              name, *odd);
    if (*name == '~')
        kiln_text_add(text, "./"); /* a leading '~' would mean a home folder */
    size_t backslashes = 0;
    for (const char *c = name; *c; c++) {
        bool escaped = strchr(" \t#:[]*?", *c) || (*c == '%' && target);
        if (escaped) {
            for (size_t i = 0; i < backslashes; i++)
                kiln_text_add(text, "\\");
        }
        kiln_text_add(text, "%s%c", escaped ? "\\" : *c == '$' ? "$" : "", *c);
        backslashes = *c == '\\' ? backslashes + 1 : 0;
    }
    return true;
}

static bool write_rules(const char *target, const struct files *files, struct kiln_text *text,
                        struct kiln_error *error)
{
    bool ok = add_name(text, target, true, error);
    kiln_text_add(text, ":");
    for (size_t i = 0; ok && i < files->count; i++) {
        kiln_text_add(text, " \\\n  ");
        ok = add_name(text, files->paths[i], false, error);
    }
    kiln_text_add(text, "\n");
    for (size_t i = 0; ok && i < files->count; i++) {
        kiln_text_add(text, "\n");
        ok = add_name(text, files->paths[i], true, error);
        kiln_text_add(text, ":\n");
    }
    return ok;
}

bool kiln_depfile_make(const char *target, const struct kiln_claims *claims, struct kiln_text *text,
                       struct kiln_error *error)
{
    struct files files = {0};
    char *here = realpath(".", NULL);
    struct kiln_text folder = {0};
    if (here)
        kiln_text_add(&folder, "%s%s", here, strcmp(here, "/") == 0 ? "" : "/");
    free(here);
    files.here = folder.failed ? NULL : folder.data;
    bool ok = files.here != NULL;
    if (ok)
        kiln_claims_visit_read(claims, add_file, &files);
    ok = ok && !files.failed;
    if (ok && files.count > 0)
        qsort(files.paths, files.count, sizeof *files.paths, compare_paths);
    bool written = ok && write_rules(target, &files, text, error);
    free(files.paths);
    kiln_text_free(&folder);
    if (ok && (!written || !text->failed))
        return written;
    return kiln_error_no_memory(error, "the dependencies of a figure");
}

bool kiln_depfile_is_of(const char *path, const char *target)
{
    struct kiln_text rule = {0};
    struct kiln_error ignored = {0};
    bool ok = add_name(&rule, target, true, &ignored);
    kiln_text_add(&rule, ":");
    ok = ok && !rule.failed;
    /* The path may be that of a stranger's sidecar, so it may lead to a pipe or a device. */
    const int file = ok && !rule.failed ? open(path, KILN_FILE_FLAGS | O_NOFOLLOW) : -1;
    char *start = file >= 0 ? malloc(rule.length) : NULL;
    struct stat status;
    ok = start && fstat(file, &status) == 0 && S_ISREG(status.st_mode) &&
         pread(file, start, rule.length, 0) == (ssize_t)rule.length &&
         memcmp(start, rule.data, rule.length) == 0;
    free(start);
    if (file >= 0)
        close(file);
    kiln_text_free(&rule);
    return ok;
}
