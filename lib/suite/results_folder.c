/* Keeps the list of a folder of results, .kiln-results, and removes files that an earlier run left.
 * For example:
 *
 *     # kiln results 1
 *     # writing effects/fire
 *     60303ae22b998861bce3b28f33eec1be758a213c86c93c076dbe9f558c11c752  run.json
 *     fd61a03af4f77d870fc21e05e7e80678095c92d808cfb3b5c279ee04c74aca13  effects/smoke/result.json
 *
 * "writing" names the tests of a run that has not ended or was killed. Unlisted files in the
 * folders of these tests are removed, too, since it is not known beforehand which files a run
 * writes. */
#include "suite/results_folder.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/temporary.h"

#define HEAD    "# kiln results 1\n"
#define WRITING "# writing "

enum { MAX_LIST_SIZE = 256 << 20, HASH_SIZE = 64 };

struct entry {
    const char *path; /* path below the folder of results; in `writing`, a test's full name */
    char hash[HASH_SIZE + 1]; /* SHA-256; "" in `writing` and `removed` */
};

struct entries {
    struct entry *items;
    size_t count, capacity;
};

struct folder {
    const struct kiln_suite *suite;
    struct kiln_arena *arena;
    struct entries listed;  /* ordered by path */
    struct entries writing; /* tests; ordered */
    struct entries removed; /* to be removed, or replaced in the list; ordered once complete */
    struct entries added;   /* new entries of the list */
    struct kiln_error *error;
};

static bool no_memory(const struct folder *f)
{
    return kiln_error_no_memory(f->error, "%s", f->suite->results_folder);
}

/* ---- The list -------------------------------------------------------------------------------- */

static bool add(const struct folder *f, struct entries *entries, const char *path, size_t length,
                const char *hash)
{
    if (entries->count == entries->capacity) {
        size_t capacity = entries->capacity ? 2 * entries->capacity : 64;
        struct entry *items = realloc(entries->items, capacity * sizeof *items);
        if (!items)
            return no_memory(f);
        entries->items = items;
        entries->capacity = capacity;
    }
    struct entry *entry = &entries->items[entries->count];
    *entry = (struct entry){.path = kiln_arena_text(f->arena, path, length)};
    snprintf(entry->hash, sizeof entry->hash, "%s", hash);
    entries->count += entry->path != NULL;
    return entry->path || no_memory(f);
}

static int by_path(const void *a, const void *b)
{
    return strcmp(((const struct entry *)a)->path, ((const struct entry *)b)->path);
}

static void sort(struct entries *entries)
{
    if (entries->count > 0)
        qsort(entries->items, entries->count, sizeof *entries->items, by_path);
}

static const struct entry *find(const struct entries *entries, const char *path)
{
    const struct entry wanted = {.path = path};
    return entries->count == 0
               ? NULL
               : bsearch(&wanted, entries->items, entries->count, sizeof wanted, by_path);
}

/* Adds a path as sha256sum escapes it. A line with an escaped path begins with a backslash. */
static void add_escaped(struct kiln_text *text, const char *path)
{
    for (; *path; path++) {
        if (*path == '\\' || *path == '\n' || *path == '\r')
            kiln_text_add(text, "\\%c", *path == '\n' ? 'n' : *path == '\r' ? 'r' : '\\');
        else
            kiln_text_add(text, "%c", *path);
    }
}

/* Adds an entry whose path is escaped as add_escaped does. */
static bool add_unescaped(const struct folder *f, struct entries *entries, const char *escaped,
                          size_t length, const char *hash)
{
    char path[KILN_PATH_SIZE];
    size_t used = 0;
    for (size_t i = 0; i < length && used + 1 < sizeof path; i++) {
        char c = escaped[i];
        if (c == '\\' && i + 1 < length) {
            c = escaped[++i];
            if (c == 'n')
                c = '\n';
            else if (c == 'r')
                c = '\r';
        }
        path[used++] = c;
    }
    return add(f, entries, path, used, hash);
}

/* Reads one line of the list, without its newline. Comments other than "# writing" are skipped. */
static bool take_line(struct folder *f, const char *line, size_t length)
{
    static const char digits[] = "0123456789abcdef";
    const size_t writing = strlen(WRITING);
    if (length > writing && strncmp(line, WRITING, writing) == 0)
        return add_unescaped(f, &f->writing, line + writing, length - writing, "");
    if (length == 0 || *line == '#')
        return true;
    const bool escaped = *line == '\\';
    const char *start = line + escaped, *path = start + HASH_SIZE + 2;
    char hash[HASH_SIZE + 1];
    snprintf(hash, sizeof hash, "%.*s", HASH_SIZE, start);
    if (strspn(hash, digits) != HASH_SIZE || strncmp(start + HASH_SIZE, "  ", 2) != 0 ||
        path >= line + length)
        return kiln_error_set(f->error, KILN_USAGE,
                              "%s/" KILN_RESULTS_LIST ": '%.*s' is not a line of a list of results",
                              f->suite->results_folder, length < 40 ? (int)length : 40, line);
    size_t left = length - (size_t)(path - line);
    return escaped ? add_unescaped(f, &f->listed, path, left, hash)
                   : add(f, &f->listed, path, left, hash);
}

static bool read_list(struct folder *f, const char *path)
{
    size_t size = 0;
    char *text = kiln_text_file_read(path, "a list of results", MAX_LIST_SIZE, &size, f->error);
    if (!text)
        return false;
    bool ok =
        strncmp(text, HEAD, strlen(HEAD)) == 0 ||
        kiln_error_set(
            f->error, KILN_USAGE,
            "%s: not a list of results by this version of kiln; name another folder by --results",
            path);
    for (const char *line = text; ok && *line;) {
        size_t length = strcspn(line, "\n");
        ok = take_line(f, line, length);
        line += length + (line[length] == '\n');
    }
    free(text);
    sort(&f->listed);
    sort(&f->writing);
    return ok;
}

static void add_line(struct kiln_text *text, const struct entry *entry)
{
    bool escaped = strpbrk(entry->path, "\\\n\r") != NULL;
    kiln_text_add(text, "%s%s  ", escaped ? "\\" : "", entry->hash);
    add_escaped(text, entry->path);
    kiln_text_add(text, "\n");
}

/* Writes the list: the listed entries that are not in `removed`, and the entries in `added`. */
static bool write_list(struct folder *f)
{
    char path[KILN_PATH_SIZE];
    if (!kiln_path_join(path, f->suite->results_folder, KILN_RESULTS_LIST, f->error))
        return false;
    struct kiln_text text = {0};
    kiln_text_add(&text, HEAD);
    for (size_t i = 0; i < f->writing.count; i++) {
        kiln_text_add(&text, WRITING);
        add_escaped(&text, f->writing.items[i].path);
        kiln_text_add(&text, "\n");
    }
    for (size_t i = 0; i < f->listed.count; i++) {
        if (!find(&f->removed, f->listed.items[i].path))
            add_line(&text, &f->listed.items[i]);
    }
    for (size_t i = 0; i < f->added.count; i++)
        add_line(&text, &f->added.items[i]);
    bool ok = !text.failed ? kiln_temporary_write_file(path, text.data, text.length, f->error)
                           : no_memory(f);
    kiln_text_free(&text);
    return ok;
}

/* Returns whether an entry of a folder is neither "." nor "..". */
static int is_contents(const struct dirent *entry)
{
    return strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
}

/* Returns the number of entries of a folder, or a value below 0 with errno. free_entries frees
 * them. */
static int list_entries(const char *folder, struct dirent ***entries)
{
    *entries = NULL;
    return scandir(folder, entries, is_contents, alphasort);
}

static void free_entries(struct dirent **entries, int count)
{
    for (int i = 0; i < count; i++)
        free(entries[i]);
    free(entries);
}

static bool is_empty(const char *folder)
{
    struct dirent **entries;
    int count = list_entries(folder, &entries);
    free_entries(entries, count);
    return count == 0;
}

/* Reads the list, or makes the folder where there is none. A folder with contents but no list is
 * refused. */
static bool open_list(struct folder *f)
{
    char path[KILN_PATH_SIZE];
    if (!kiln_path_join(path, f->suite->results_folder, KILN_RESULTS_LIST, f->error) ||
        !kiln_make_parent_folders(path, f->error))
        return false;
    if (access(path, F_OK) == 0)
        return read_list(f, path);
    return is_empty(f->suite->results_folder) ||
           kiln_error_set(f->error, KILN_USAGE,
                          "%s: the folder is not empty, but has no " KILN_RESULTS_LIST
                          ", so its files may not be kiln's; name another folder by --results, or "
                          "empty this one",
                          f->suite->results_folder);
}

/* ---- Files of a test ------------------------------------------------------------------------- */

static bool ends_in(const char *name, const char *suffix)
{
    size_t length = strlen(name), end = strlen(suffix);
    return length > end && strcmp(name + length - end, suffix) == 0;
}

/* Returns whether a run gives this name to a file in the folder of a test. */
static bool is_written_by_tests(const char *name)
{
    if (strncmp(name, "frame_", 6) == 0)
        return ends_in(name, ".png") || ends_in(name, ".exr");
    if (strncmp(name, ".frame_", 7) == 0)
        return ends_in(name, ".tmp"); /* left by a process that was killed */
    return strcmp(name, "log.txt") == 0 || strcmp(name, "against.txt") == 0 ||
           strcmp(name, "result.json") == 0;
}

typedef bool visit_file(struct folder *f, const char *path, const char *from_root, bool writing);

/* Visits the files in a test's folder whose names are those that a run gives. The folder may be
 * missing. */
static bool visit_test(struct folder *f, const struct kiln_test *test, visit_file *visit)
{
    char folder[KILN_PATH_SIZE];
    if (!kiln_path_join(folder, f->suite->results_folder, test->full_name, f->error))
        return false;
    struct dirent **entries;
    int count = list_entries(folder, &entries);
    bool ok =
        count >= 0 || errno == ENOENT ||
        kiln_error_set_errno(f->error, KILN_IO, errno, "%s: the folder cannot be read", folder);
    const bool writing = find(&f->writing, test->full_name) != NULL;
    for (int i = 0; ok && i < count; i++) {
        char path[KILN_PATH_SIZE], from_root[KILN_PATH_SIZE];
        const char *name = entries[i]->d_name;
        if (is_written_by_tests(name))
            ok = kiln_path_join(path, folder, name, f->error) &&
                 kiln_path_join(from_root, test->full_name, name, f->error) &&
                 visit(f, path, from_root, writing);
    }
    free_entries(entries, count);
    return ok;
}

/* Visits the files of all tests, and run.json. */
static bool visit_all(struct folder *f, visit_file *visit)
{
    char path[KILN_PATH_SIZE];
    if (!kiln_path_join(path, f->suite->results_folder, "run.json", f->error))
        return false;
    bool ok = access(path, F_OK) != 0 || visit(f, path, "run.json", f->writing.count > 0);
    for (size_t i = 0; ok && i < f->suite->count; i++)
        ok = visit_test(f, &f->suite->tests[i], visit);
    return ok;
}

/* Adds a file to `removed`. It is an error if no earlier run wrote the file, or if it changed
 * since. */
static bool choose_removed(struct folder *f, const char *path, const char *from_root, bool writing)
{
    const struct entry *listed = find(&f->listed, from_root);
    char hash[HASH_SIZE + 1];
    if (!listed && !writing)
        return kiln_error_set(f->error, KILN_USAGE,
                              "%s: kiln did not write this file; move it away, or name another "
                              "folder by --results",
                              path);
    if (listed && !kiln_hash_sha256_file(path, hash))
        return kiln_error_set_errno(f->error, KILN_IO, errno, "%s: the file cannot be read", path);
    if (listed && !writing && strcmp(hash, listed->hash) != 0)
        return kiln_error_set(f->error, KILN_USAGE,
                              "%s: changed since kiln wrote this file; move it away, or name "
                              "another folder by --results",
                              path);
    return add(f, &f->removed, from_root, strlen(from_root), "");
}

static bool remove_chosen(const struct folder *f)
{
    for (size_t i = 0; i < f->removed.count; i++) {
        char path[KILN_PATH_SIZE];
        if (!kiln_path_join(path, f->suite->results_folder, f->removed.items[i].path, f->error))
            return false;
        if (unlink(path) != 0 && errno != ENOENT)
            return kiln_error_set_errno(f->error, KILN_IO, errno,
                                        "%s: the file of an earlier run cannot be removed", path);
    }
    return true;
}

static bool list_file(struct folder *f, const char *path, const char *from_root, bool writing)
{
    (void)writing;
    char hash[HASH_SIZE + 1];
    if (!kiln_hash_sha256_file(path, hash))
        return kiln_error_set_errno(f->error, KILN_IO, errno, "%s: the file cannot be read", path);
    return add(f, &f->removed, from_root, strlen(from_root), "") && /* replaces the earlier entry */
           add(f, &f->added, from_root, strlen(from_root), hash);
}

/* ---- A run ----------------------------------------------------------------------------------- */

/* Checks that results do not go into a folder of goldens, whose pictures have the same names, nor
 * by a link into another folder. */
static bool check_folders(const struct folder *f)
{
    for (size_t i = 0; i < f->suite->count; i++) {
        const struct kiln_result_place place = {f->suite->results_folder,
                                                f->suite->tests[i].full_name};
        if (!kiln_result_folder_check(&place, f->error))
            return false;
        char folder[KILN_PATH_SIZE], path[KILN_PATH_SIZE];
        if (!kiln_path_join(folder, f->suite->results_folder, f->suite->tests[i].full_name,
                            f->error) ||
            !kiln_path_join(path, folder, "expect.yaml", f->error))
            return false;
        if (access(path, F_OK) == 0)
            return kiln_error_set(
                f->error, KILN_USAGE,
                "%s: the folder holds goldens; results need a folder of their own", folder);
    }
    return true;
}

/* Lists the tests of this run as being written, beside those of a run that was killed. */
static bool list_writing(struct folder *f)
{
    size_t before = f->writing.count;
    for (size_t i = 0; i < f->suite->count; i++) {
        const char *name = f->suite->tests[i].full_name;
        struct entries earlier = f->writing;
        earlier.count = before;
        if (!find(&earlier, name) && !add(f, &f->writing, name, strlen(name), ""))
            return false;
    }
    return true;
}

static bool begin(struct folder *f)
{
    if (!check_folders(f) || !open_list(f) || !visit_all(f, choose_removed))
        return false;
    sort(&f->removed);
    return list_writing(f) && write_list(f) && remove_chosen(f);
}

/* Removes the tests of this run from `writing`. */
static void end_writing(struct folder *f)
{
    size_t count = 0;
    for (size_t i = 0; i < f->writing.count; i++) {
        bool ended = false;
        for (size_t j = 0; j < f->suite->count && !ended; j++)
            ended = strcmp(f->writing.items[i].path, f->suite->tests[j].full_name) == 0;
        if (!ended)
            f->writing.items[count++] = f->writing.items[i];
    }
    f->writing.count = count;
}

static bool end(struct folder *f)
{
    if (!open_list(f))
        return false;
    end_writing(f);
    if (!visit_all(f, list_file))
        return false;
    sort(&f->removed);
    return write_list(f);
}

static bool with_folder(const struct kiln_suite *suite, bool (*work)(struct folder *f),
                        struct kiln_error *error)
{
    struct folder f = {.suite = suite, .arena = kiln_arena_create(), .error = error};
    bool ok = f.arena ? work(&f) : no_memory(&f);
    free(f.listed.items);
    free(f.writing.items);
    free(f.removed.items);
    free(f.added.items);
    kiln_arena_destroy(&f.arena);
    return ok;
}

bool kiln_suite_begin(const struct kiln_suite *suite, struct kiln_error *error)
{
    return with_folder(suite, begin, error);
}

bool kiln_results_folder_end(const struct kiln_suite *suite, struct kiln_error *error)
{
    return with_folder(suite, end, error);
}
