/* Finds the files that are tests, in folders and among operands. A file that may be a test and
 * cannot be read is an error: a run must not be green because it did not see a test. */
#include "suite/discover.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "option/node.h"
#include "suite/expect.h"
#include "suite/test_file.h"

struct search {
    struct kiln_arena *arena;
    struct kiln_findings *findings;
    struct kiln_error *error;
    const char *operand;
    const char *root;       /* real path of the folder that the goldens lie in; NULL: not known */
    struct stat skipped[2]; /* the folders of goldens and of results */
    size_t skipped_count;
    size_t seen; /* files of tests that were seen, repeated ones included */
};

static bool out_of_memory(struct search *search)
{
    return kiln_error_no_memory(search->error, "finding tests");
}

/* ---- names ---------------------------------------------------------------------------------- */

static const char marker[] = ".kiln-tests";

/* Returns the length of the part of a file's real path that is the folder from which names begin,
 * '/' included: the nearest folder with a marker, or the parent of the goldens' folder, or the
 * file's own folder. So a test has one name, however it is found. */
static size_t root_length(const struct search *search, const char *path)
{
    const size_t own = (size_t)(strrchr(path, '/') - path) + 1;
    char file[KILN_PATH_SIZE];
    for (size_t length = own; length > 0; length--) {
        if (path[length - 1] != '/')
            continue;
        int written = snprintf(file, sizeof file, "%.*s%s", (int)length, path, marker);
        if (written < (int)sizeof file && access(file, F_OK) == 0)
            return length;
    }
    const size_t root = search->root ? strlen(search->root) : 0;
    if (root == 1) /* "/" */
        return root;
    return root > 0 && strncmp(path, search->root, root) == 0 && path[root] == '/' ? root + 1 : own;
}

/* Returns the real path of the folder that a folder lies in. If the folder does not exist yet, its
 * name tells the parent. */
static const char *find_parent(struct kiln_arena *arena, const char *folder)
{
    char *real_folder = realpath(folder, NULL);
    const char *path =
        real_folder ? kiln_arena_text(arena, real_folder, strlen(real_folder)) : folder;
    free(real_folder);
    const char *slash = path ? strrchr(path, '/') : NULL;
    const size_t length = slash ? (size_t)(slash - path) : 0;
    const char *parent = length ? kiln_arena_text(arena, path, length) : slash ? "/" : ".";
    char *real = path && parent ? realpath(parent, NULL) : NULL;
    const char *copy = real ? kiln_arena_text(arena, real, strlen(real)) : NULL;
    free(real);
    return copy;
}

/* ---- one file ------------------------------------------------------------------------------- */

/* Returns a path without its end: "effects/fire.test.yaml" gives "effects/fire". */
static const char *name_of(struct kiln_arena *arena, const char *path)
{
    static const char *const ends[] = {".test.yaml", ".test.yml", ".yaml", ".yml"};
    size_t length = strlen(path);
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        size_t end = strlen(ends[i]);
        if (length >= end && strcmp(path + length - end, ends[i]) == 0)
            return kiln_arena_text(arena, path, length - end);
    }
    return kiln_arena_text(arena, path, length);
}

/* Returns the folder's real path and the file's own name: two links to one file are two tests. */
static const char *identity_of(struct kiln_arena *arena, const char *path)
{
    const char *slash = strrchr(path, '/');
    char folder[KILN_PATH_SIZE];
    size_t length = slash ? (size_t)(slash - path) : 0;
    if (length >= sizeof folder)
        return NULL;
    memcpy(folder, path, length);
    folder[length] = '\0';
    char *real = realpath(!slash ? "." : length ? folder : "/", NULL);
    const char *identity =
        kiln_arena_format(arena, "%s/%s", real ? real : folder, slash ? slash + 1 : path);
    free(real);
    return identity;
}

static bool add_file(struct search *search, const char *path, bool in_folder)
{
    struct kiln_findings *findings = search->findings;
    struct kiln_found found = {
        .path = kiln_arena_text(search->arena, path, strlen(path)),
        .identity = identity_of(search->arena, path),
        .in_folder = in_folder,
    };
    if (found.identity)
        found.name = name_of(search->arena, found.identity + root_length(search, found.identity));
    if (!found.path || !found.name || !found.identity)
        return out_of_memory(search);
    search->seen++;
    for (size_t i = 0; i < findings->count; i++) {
        if (strcmp(findings->items[i].identity, found.identity) == 0) {
            findings->items[i].in_folder &= in_folder;
            return true;
        }
    }
    if (findings->count == findings->capacity) {
        size_t capacity = findings->capacity ? 2 * findings->capacity : 64;
        struct kiln_found *items =
            kiln_arena_alloc(search->arena, capacity, sizeof *findings->items);
        if (!items)
            return out_of_memory(search);
        if (findings->count)
            memcpy(items, findings->items, findings->count * sizeof *items);
        findings->items = items;
        findings->capacity = capacity;
    }
    findings->items[findings->count++] = found;
    return true;
}

/* ---- whether a file is a test ---------------------------------------------------------------- */

/* Returns whether a line of a text has a key. This decides where the text cannot be parsed: a scene
 * with a fault is a test that fails. */
static bool has_line_with_key(const char *text, const char *key)
{
    static const char byte_order_mark[] = "\xef\xbb\xbf";
    size_t mark = sizeof byte_order_mark - 1, length = strlen(key);
    text += strncmp(text, byte_order_mark, mark) == 0 ? mark : 0;
    for (const char *line = text; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        const char *word = line + strspn(line, *line == '{' ? "{ \t\"'" : "\"'");
        if (strncmp(word, key, length) == 0 &&
            word[length + strspn(word + length, " \t\"'")] == ':')
            return true;
    }
    return false;
}

/* Which of the keys a YAML file's top level has. */
struct keys {
    bool scene, test;
};

static bool find_keys(const char *text, size_t size, const char *path, struct keys *keys)
{
    struct kiln_arena *scratch = kiln_arena_create();
    struct kiln_origin origin = {.name = path, .has_lines = true, .kind = "a file"};
    struct kiln_error error = {0};
    const struct kiln_node *root =
        scratch ? kiln_node_parse(scratch, text, size, &origin, &error) : NULL;
    bool ok = scratch && error.code != KILN_DEVICE_FAILED;
    keys->scene = root ? kiln_node_entry(root, "kiln") != NULL : has_line_with_key(text, "kiln");
    keys->test =
        root ? kiln_node_entry(root, "kiln_test") != NULL : has_line_with_key(text, "kiln_test");
    kiln_arena_destroy(&scratch);
    return ok;
}

/* Adds a YAML file of a folder if it is a scene; files of another kind are passed over. */
static bool add_if_scene(struct search *search, const char *path)
{
    struct kiln_error error = {0};
    size_t size = 0;
    if (access(path, R_OK) != 0)
        return kiln_error_set_errno(search->error, KILN_IO, errno, "%s", path);
    char *text = kiln_text_file_read(path, "a scene file", KILN_MAX_SCENE_SIZE, &size, &error);
    struct keys keys = {0};
    bool ok = true;
    if (text)
        ok = find_keys(text, size, path, &keys) || out_of_memory(search);
    else if (error.code != KILN_INVALID_INPUT) {
        *search->error = error;
        ok = false;
    }
    free(text);
    if (ok && keys.test)
        return kiln_error_set(
            search->error, KILN_USAGE,
            "%s: a file with the key kiln_test needs a name that ends in .test.yaml", path);
    return ok && (!keys.scene || add_file(search, path, true));
}

/* ---- folders -------------------------------------------------------------------------------- */

static bool is_skipped(const struct search *search, const struct stat *status)
{
    for (size_t i = 0; i < search->skipped_count; i++) {
        if (search->skipped[i].st_dev == status->st_dev &&
            search->skipped[i].st_ino == status->st_ino)
            return true;
    }
    return false;
}

/* Returns whether the folder has goldens, perhaps of another run. The scene beside goldens is no
 * test. */
static bool has_expect_file(struct dirent *const *entries, int count)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(entries[i]->d_name, "expect.yaml") == 0)
            return true;
    }
    return false;
}

static bool is_accepted_scene(const char *path)
{
    const char *slash = strrchr(path, '/');
    return strcmp(slash ? slash + 1 : path, "scene.yaml") == 0;
}

static bool search_folder(struct search *search, const char *folder);

static bool search_entry(struct search *search, const char *path, bool has_goldens)
{
    struct stat status;
    if (lstat(path, &status) != 0)
        return errno == ENOENT || kiln_error_set_errno(search->error, KILN_IO, errno, "%s", path);
    if (S_ISDIR(status.st_mode))
        return is_skipped(search, &status) || search_folder(search, path);
    if (!kiln_test_file_is_yaml(path) || (has_goldens && is_accepted_scene(path)))
        return true;
    if (stat(path, &status) != 0)
        return kiln_error_set_errno(search->error, KILN_IO, errno, "%s", path);
    if (!S_ISREG(status.st_mode))
        return true;
    return kiln_test_file_is(path) ? add_file(search, path, true) : add_if_scene(search, path);
}

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

static int by_bytes(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

/* Searches a folder; "" is the working directory. */
static bool search_folder(struct search *search, const char *folder)
{
    struct dirent **entries = NULL;
    int count = scandir(*folder ? folder : ".", &entries, is_visible, by_bytes);
    if (count < 0)
        return kiln_error_set_errno(search->error, KILN_IO, errno, "%s: the folder cannot be read",
                                    *folder ? folder : ".");
    bool has_goldens = has_expect_file(entries, count), ok = true;
    for (int i = 0; i < count; i++) {
        struct kiln_text path = {0};
        bool slash = *folder && folder[strlen(folder) - 1] != '/';
        kiln_text_add(&path, "%s%s%s", folder, slash ? "/" : "", entries[i]->d_name);
        if (path.failed)
            ok = ok && out_of_memory(search);
        else if (ok && path.length >= KILN_PATH_SIZE)
            ok = kiln_error_set(search->error, KILN_IO, "%.200s...: the path is too long",
                                path.data);
        else if (ok)
            ok = search_entry(search, path.data, has_goldens);
        kiln_text_free(&path);
        free(entries[i]);
    }
    free(entries);
    return ok;
}

/* ---- operands ------------------------------------------------------------------------------- */

/* Adds the prefix of the names of tests in a folder. Names below a folder with a marker have
 * another. */
static bool add_name_prefix(struct search *search, const char *folder)
{
    struct kiln_findings *findings = search->findings;
    char *real = realpath(*folder ? folder : ".", NULL);
    const char *path = real ? kiln_arena_format(search->arena, "%s/", real) : NULL;
    free(real);
    if (!path)
        return out_of_memory(search);
    findings->name_prefixes[findings->name_prefix_count++] = path + root_length(search, path);
    return true;
}

/* Searches a folder that is an operand; "scenes//" is searched as "scenes", and "." as "". */
static bool search_operand_folder(struct search *search)
{
    const char *operand = search->operand;
    size_t length = strlen(operand), before = search->seen;
    while (length > 1 && operand[length - 1] == '/')
        length--;
    bool here = length == 1 && *operand == '.';
    char *folder = strndup(operand, here ? 0 : length);
    bool ok = folder ? search_folder(search, folder) && add_name_prefix(search, folder)
                     : out_of_memory(search);
    free(folder);
    return ok &&
           (search->seen > before ||
            kiln_error_set(search->error, KILN_USAGE,
                           "%s: the folder has no tests: no *.test.yaml, and no scene", operand));
}

static bool search_operand(struct search *search)
{
    const char *operand = search->operand;
    struct stat status;
    if (strlen(operand) >= KILN_PATH_SIZE)
        return kiln_error_set(search->error, KILN_USAGE, "%.200s...: the path is too long",
                              operand);
    if (stat(operand, &status) != 0)
        return kiln_error_set_errno(search->error, KILN_USAGE, errno, "%s", operand);
    if (S_ISDIR(status.st_mode))
        return search_operand_folder(search);
    if (!kiln_test_file_is_yaml(operand))
        return kiln_error_set(search->error, KILN_USAGE,
                              "%s: not a test; a test is a *.test.yaml or a scene, *.yaml or *.yml",
                              operand);
    return add_file(search, operand, false);
}

bool kiln_discover(struct kiln_arena *arena, const struct kiln_suite_params *params,
                   struct kiln_findings *findings, struct kiln_error *error)
{
    struct search search = {.arena = arena,
                            .findings = findings,
                            .error = error,
                            .root = find_parent(arena, params->golden)};
    const char *const skipped[] = {params->golden, params->results};
    findings->name_prefixes =
        kiln_arena_alloc(arena, params->path_count + 1, sizeof *findings->name_prefixes);
    if (!findings->name_prefixes)
        return out_of_memory(&search);
    for (size_t i = 0; i < 2; i++) {
        if (stat(skipped[i], &search.skipped[search.skipped_count]) == 0)
            search.skipped_count++;
    }
    bool ok = true;
    for (size_t i = 0; ok && i < params->path_count; i++) {
        search.operand = params->paths[i];
        ok = search_operand(&search);
    }
    return ok;
}
