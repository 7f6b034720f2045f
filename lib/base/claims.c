/* Finds out whether a call would write one file twice or write a file that it reads. Two paths lead
 * to the same file when they end in the same name in the same real folder, whether that file exists
 * or not. They do so, too, when both files exist and have the same device and inode (links). */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/arena.h"
#include "base/error.h"
#include "kiln_program.h"

enum { FIRST_CAPACITY = 64 };

struct claim {
    const char *path; /* absolute, in its real folder */
    const char *what; /* for messages */
    bool written, exists;
    dev_t device;
    ino_t inode;
};

/* A hash table with open addressing. Each claim is in one of them by its path and, if its file
 * exists, in the other by its device and inode. */
struct table {
    struct claim **claims;
    size_t capacity, count; /* capacity: a power of two */
};

struct kiln_claims {
    struct kiln_arena *arena;
    struct table by_path, by_inode;
    /* The last folder and its real path: the next path is often in the same folder. */
    char folder[KILN_PATH_SIZE], real_folder[KILN_PATH_SIZE];
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
    if (!*claims)
        return;
    struct kiln_arena *arena = (*claims)->arena;
    free((*claims)->by_path.claims);
    free((*claims)->by_inode.claims);
    *claims = NULL;
    kiln_arena_destroy(&arena);
}

/* ---- Where a path leads --------------------------------------------------------------------- */

/* Copies a text that is shorter than KILN_PATH_SIZE. */
static void copy_text(char *to, const char *text)
{
    memcpy(to, text, strlen(text) + 1);
}

/* Appends "/NAME" to an absolute path whose "." and ".." are gone; "" is the root. */
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

/* Finds the real path of a folder that may not exist: the part that exists is resolved, the rest is
 * appended by its text. */
static bool real_folder(const char *folder, char real[KILN_PATH_SIZE])
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
        return false;
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
    return ok;
}

/* Finds the real path of a file. False when it is too long, or the working folder is gone. */
static bool lead(struct kiln_claims *claims, const char *path, char real[KILN_PATH_SIZE])
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    size_t length = (size_t)(name - path);
    char folder[KILN_PATH_SIZE];
    if (length >= sizeof folder)
        return false;
    memcpy(folder, path, length);
    folder[length] = '\0';
    if (length == 0)
        copy_text(folder, ".");
    if (strcmp(folder, claims->folder) != 0) {
        claims->folder[0] = '\0';
        if (!real_folder(folder, claims->real_folder))
            return false;
        copy_text(claims->folder, folder);
    }
    copy_text(real, claims->real_folder);
    return append_name(real, name, strlen(name));
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

static bool is_path(const struct claim *a, const struct claim *b)
{
    return strcmp(a->path, b->path) == 0;
}

static bool is_inode(const struct claim *a, const struct claim *b)
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
    while (table->claims[at] && !equal(table->claims[at], claim))
        at = (at + 1) & (table->capacity - 1);
    return &table->claims[at];
}

/* Makes room for one more claim. */
static bool grow(struct table *table, hash_claim *hash, equal_claims *equal)
{
    if (2 * (table->count + 1) <= table->capacity)
        return true;
    struct table larger = {.capacity = table->capacity ? 2 * table->capacity : FIRST_CAPACITY,
                           .count = table->count};
    larger.claims = calloc(larger.capacity, sizeof *larger.claims);
    if (!larger.claims)
        return false;
    for (size_t i = 0; i < table->capacity; i++) {
        if (table->claims[i])
            *find(&larger, table->claims[i], hash, equal) = table->claims[i];
    }
    free(table->claims);
    *table = larger;
    return true;
}

/* ---- Claims --------------------------------------------------------------------------------- */

static bool out_of_memory(const char *path, struct kiln_error *error)
{
    return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory", path);
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
    const struct claim *reads = earlier->written ? now : earlier;
    const struct claim *writes = earlier->written ? earlier : now;
    return kiln_error_set(error, KILN_USAGE, "%s: %s would replace %s, which this command reads",
                          path, writes->what, reads->what);
}

static bool add(struct kiln_claims *claims, struct claim *claim, const char *path,
                struct kiln_error *error)
{
    if (!grow(&claims->by_path, hash_path, is_path) ||
        !grow(&claims->by_inode, hash_inode, is_inode))
        return out_of_memory(path, error);
    struct claim **place = find(&claims->by_path, claim, hash_path, is_path);
    struct claim **of_inode =
        claim->exists ? find(&claims->by_inode, claim, hash_inode, is_inode) : NULL;
    if ((*place && !check(*place, claim, path, error)) ||
        (of_inode && *of_inode && !check(*of_inode, claim, path, error)))
        return false;
    if (!*place) {
        *place = claim;
        claims->by_path.count++;
    }
    if (of_inode && !*of_inode) {
        *of_inode = claim;
        claims->by_inode.count++;
    }
    return true;
}

static bool declare(struct kiln_claims *claims, const char *path, const char *what, bool written,
                    struct kiln_error *error)
{
    char real[KILN_PATH_SIZE];
    if (!lead(claims, path, real)) {
        /* No file can be there. Opening it will fail with the reason; only a path to write that is
         * too long is refused here. */
        return !written || strlen(path) < KILN_PATH_SIZE ||
               kiln_error_set(error, KILN_USAGE, "%.200s...: the path is longer than %d bytes",
                              path, KILN_PATH_SIZE - 1);
    }
    struct claim *claim = kiln_arena_alloc(claims->arena, 1, sizeof *claim);
    if (!claim)
        return out_of_memory(path, error);
    struct stat status;
    claim->path = kiln_arena_text(claims->arena, real, strlen(real));
    claim->what = kiln_arena_text(claims->arena, what, strlen(what));
    claim->written = written;
    claim->exists = stat(path, &status) == 0 && S_ISREG(status.st_mode);
    if (claim->exists) {
        claim->device = status.st_dev;
        claim->inode = status.st_ino;
    }
    if (!claim->path || !claim->what)
        return out_of_memory(path, error);
    return add(claims, claim, path, error);
}

bool kiln_claims_read(struct kiln_claims *claims, const char *path, const char *what,
                      struct kiln_error *error)
{
    return declare(claims, path, what, false, error);
}

bool kiln_claims_write(struct kiln_claims *claims, const char *path, const char *what,
                       struct kiln_error *error)
{
    return declare(claims, path, what, true, error);
}

void kiln_claims_visit_read(const struct kiln_claims *claims,
                            void (*visit)(void *user, const char *path), void *user)
{
    for (size_t i = 0; i < claims->by_path.capacity; i++) {
        const struct claim *claim = claims->by_path.claims[i];
        if (claim && claim->exists && !claim->written)
            visit(user, claim->path);
    }
}
