/* Finds out whether a command or a call of the library would write one file twice, or write a file
 * that it reads. Two paths lead to the same file when they end in the same name in the same real
 * folder, whether that file exists or not. Two paths of existing files also lead to the same file
 * when device and inode are the same (links). */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/arena.h"
#include "base/error.h"
#include "kiln_program.h"

enum { FIRST_CAPACITY = 64 };

struct claim {
    const char *path; /* absolute; the folder is resolved, the last name is not */
    const char *what; /* name of the file in messages: "a texture", "--output" */
    bool written;     /* false: read */
    bool exists;      /* as a regular file, with the device and inode below */
    dev_t device;
    ino_t inode;
};

/* A hash table with open addressing. */
struct table {
    struct claim **slots;   /* NULL: free */
    size_t capacity, count; /* capacity: a power of two */
};

struct kiln_claims {
    struct kiln_arena *arena;
    /* The first claim of each path, and of each device and inode. */
    struct table by_path, by_inode;
    /* The last folder that was resolved: the next path is often in the same folder. */
    char folder[KILN_PATH_SIZE], resolved_folder[KILN_PATH_SIZE];
};

struct kiln_claims *kiln_claims_create(void)
{
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_claims *claims = arena ? kiln_arena_alloc(arena, 1, sizeof *claims) : NULL;
    if (!claims)
        kiln_arena_destroy(&arena);
    else
        claims->arena = arena;
    return claims;
}

void kiln_claims_destroy(struct kiln_claims **claims)
{
    if (!claims || !*claims)
        return;
    struct kiln_arena *arena = (*claims)->arena;
    free((*claims)->by_path.slots);
    free((*claims)->by_inode.slots);
    *claims = NULL;
    kiln_arena_destroy(&arena);
}

/* ---- Where a path leads --------------------------------------------------------------------- */

/* Copies a text, which must be shorter than KILN_PATH_SIZE. */
static void copy_text(char *to, const char *text)
{
    memcpy(to, text, strlen(text) + 1);
}

/* Appends a name to an absolute path without "." and ".."; "" is the root. The name "." changes
 * nothing, and ".." removes the last name. False when the path becomes too long. */
static bool append_name(char path[KILN_PATH_SIZE], const char *name, size_t length)
{
    size_t end = strlen(path);
    if (length == 0 || (length == 1 && name[0] == '.'))
        return true;
    if (length == 2 && name[0] == '.' && name[1] == '.') {
        char *slash = strrchr(path, '/');
        if (slash)
            *slash = '\0';
        return true;
    }
    if (end + 1 + length >= KILN_PATH_SIZE)
        return false;
    path[end] = '/';
    memcpy(path + end + 1, name, length);
    path[end + 1 + length] = '\0';
    return true;
}

enum resolution {
    RESOLVED,
    TOO_LONG,  /* the real path does not fit into KILN_PATH_SIZE */
    NO_FOLDER, /* the working folder is gone */
};

/* Finds the real path of a folder that may not exist: the part that exists is resolved, the rest is
 * appended by its text. */
static enum resolution resolve_folder(const char *folder, char real[KILN_PATH_SIZE])
{
    char part[KILN_PATH_SIZE];
    size_t length = strlen(folder);
    memcpy(part, folder, length + 1);
    char *found = realpath(part, NULL);
    while (!found && length > 0) {
        while (length > 0 && part[length - 1] == '/')
            length--;
        while (length > 0 && part[length - 1] != '/')
            length--;
        part[length] = '\0';
        found = realpath(length > 0 ? part : ".", NULL);
    }
    if (!found)
        return errno == ENAMETOOLONG ? TOO_LONG : NO_FOLDER;
    bool ok = strlen(found) < KILN_PATH_SIZE;
    if (ok)
        copy_text(real, strcmp(found, "/") == 0 ? "" : found);
    free(found);
    const char *rest = folder + length;
    while (ok && *rest) {
        size_t name = strcspn(rest, "/");
        ok = append_name(real, rest, name);
        rest += name + (rest[name] == '/');
    }
    return ok ? RESOLVED : TOO_LONG;
}

/* Finds the path of a file in its real folder. The file itself may be a link, which stays. */
static enum resolution resolve(struct kiln_claims *claims, const char *path,
                               char real[KILN_PATH_SIZE])
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    size_t length = (size_t)(name - path);
    char folder[KILN_PATH_SIZE];
    if (length >= sizeof folder)
        return TOO_LONG;
    memcpy(folder, path, length);
    folder[length] = '\0';
    if (length == 0)
        copy_text(folder, ".");
    if (strcmp(folder, claims->folder) != 0) {
        claims->folder[0] = '\0';
        const enum resolution resolution = resolve_folder(folder, claims->resolved_folder);
        if (resolution != RESOLVED)
            return resolution;
        copy_text(claims->folder, folder);
    }
    copy_text(real, claims->resolved_folder);
    return append_name(real, name, strlen(name)) ? RESOLVED : TOO_LONG;
}

/* ---- Tables --------------------------------------------------------------------------------- */

/* Adds bytes to a hash, by FNV-1a. */
static size_t mix(size_t hash, const void *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++)
        hash = (hash ^ ((const unsigned char *)bytes)[i]) * 1099511628211u;
    return hash;
}

static size_t hash_path(const struct claim *claim)
{
    return mix(14695981039346656037u, claim->path, strlen(claim->path));
}

static size_t hash_inode(const struct claim *claim)
{
    size_t hash = mix(14695981039346656037u, &claim->device, sizeof claim->device);
    return mix(hash, &claim->inode, sizeof claim->inode);
}

static bool same_path(const struct claim *a, const struct claim *b)
{
    return strcmp(a->path, b->path) == 0;
}

static bool same_inode(const struct claim *a, const struct claim *b)
{
    return a->device == b->device && a->inode == b->inode;
}

typedef size_t hash_claim(const struct claim *claim);
typedef bool equal_claims(const struct claim *a, const struct claim *b);

/* Finds the place of an equal claim, or else a free place: a table is at most half full. */
static struct claim **find(const struct table *table, const struct claim *claim, hash_claim *hash,
                           equal_claims *equal)
{
    size_t at = hash(claim) & (table->capacity - 1);
    while (table->slots[at] && !equal(table->slots[at], claim))
        at = (at + 1) & (table->capacity - 1);
    return &table->slots[at];
}

/* Makes room for one more claim. */
static bool grow(struct table *table, hash_claim *hash, equal_claims *equal)
{
    if (2 * (table->count + 1) <= table->capacity)
        return true;
    struct table larger = {.capacity = table->capacity ? 2 * table->capacity : FIRST_CAPACITY,
                           .count = table->count};
    larger.slots = calloc(larger.capacity, sizeof *larger.slots);
    if (!larger.slots)
        return false;
    for (size_t i = 0; i < table->capacity; i++) {
        if (table->slots[i])
            *find(&larger, table->slots[i], hash, equal) = table->slots[i];
    }
    free(table->slots);
    *table = larger;
    return true;
}

/* ---- Claims --------------------------------------------------------------------------------- */

static bool out_of_memory(const char *path, struct kiln_error *error)
{
    return kiln_error_no_memory(error, "%s", path);
}

/* Fails when two claims of one file conflict; two claims that only read do not. */
static bool check(const struct claim *earlier, const struct claim *now, const char *path,
                  struct kiln_error *error)
{
    if (earlier->written && now->written)
        return kiln_error_set(error, KILN_USAGE, "%s: %s and %s would both write this file", path,
                              earlier->what, now->what);
    if (!earlier->written && !now->written)
        return true;
    const struct claim *reader = earlier->written ? now : earlier;
    const struct claim *writer = earlier->written ? earlier : now;
    return kiln_error_set(error, KILN_USAGE, "%s: %s would replace %s, which this command reads",
                          path, writer->what, reader->what);
}

static bool add(struct kiln_claims *claims, struct claim *claim, const char *path,
                struct kiln_error *error)
{
    if (!grow(&claims->by_path, hash_path, same_path) ||
        !grow(&claims->by_inode, hash_inode, same_inode))
        return out_of_memory(path, error);
    struct claim **path_place = find(&claims->by_path, claim, hash_path, same_path);
    struct claim **inode_place =
        claim->exists ? find(&claims->by_inode, claim, hash_inode, same_inode) : NULL;
    if ((*path_place && !check(*path_place, claim, path, error)) ||
        (inode_place && *inode_place && !check(*inode_place, claim, path, error)))
        return false;
    if (!*path_place) {
        *path_place = claim;
        claims->by_path.count++;
    }
    if (inode_place && !*inode_place) {
        *inode_place = claim;
        claims->by_inode.count++;
    }
    return true;
}

/* known: what fstat says of the file, which is open; NULL: the file is looked up by its path. */
static bool declare(struct kiln_claims *claims, const char *path, const char *what, bool written,
                    const struct stat *known, struct kiln_error *error)
{
    char real[KILN_PATH_SIZE];
    const enum resolution resolution = resolve(claims, path, real);
    if (resolution != RESOLVED) {
        /* There is no path to compare. A file to read is left out: no file is written by a path
         * that is too long, and if this one cannot be opened, that error says why. Nothing can be
         * opened when the working folder is gone. */
        return !written || resolution == NO_FOLDER ||
               kiln_error_set(error, KILN_USAGE, "%.200s%s: the %spath is longer than %d bytes",
                              path, strlen(path) > 200 ? "..." : "",
                              strlen(path) < KILN_PATH_SIZE ? "absolute " : "", KILN_PATH_SIZE - 1);
    }
    struct claim *claim = kiln_arena_alloc(claims->arena, 1, sizeof *claim);
    if (!claim)
        return out_of_memory(path, error);
    struct stat found;
    const struct stat *status = known ? known : &found;
    claim->path = kiln_arena_text(claims->arena, real, strlen(real));
    claim->what = kiln_arena_text(claims->arena, what, strlen(what));
    claim->written = written;
    claim->exists = (known || stat(path, &found) == 0) && S_ISREG(status->st_mode);
    if (claim->exists) {
        claim->device = status->st_dev;
        claim->inode = status->st_ino;
    }
    if (!claim->path || !claim->what)
        return out_of_memory(path, error);
    return add(claims, claim, path, error);
}

bool kiln_claims_read(struct kiln_claims *claims, const char *path, const char *what,
                      struct kiln_error *error)
{
    return declare(claims, path, what, false, NULL, error);
}

bool kiln_claims_read_open(struct kiln_claims *claims, const char *path, const char *what,
                           const struct stat *status, struct kiln_error *error)
{
    return declare(claims, path, what, false, status, error);
}

bool kiln_claims_write(struct kiln_claims *claims, const char *path, const char *what,
                       struct kiln_error *error)
{
    return declare(claims, path, what, true, NULL, error);
}

void kiln_claims_visit_read(const struct kiln_claims *claims,
                            void (*visit)(void *user, const char *path), void *user)
{
    for (size_t i = 0; i < claims->by_path.capacity; i++) {
        const struct claim *claim = claims->by_path.slots[i];
        if (claim && claim->exists && !claim->written)
            visit(user, claim->path);
    }
}
