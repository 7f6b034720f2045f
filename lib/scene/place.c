/* This file opens the file of a scene. The folder of an asset root may belong to a stranger, who
 * may put links in it and change them at any time. So the path of a scene is followed only up to
 * the root, through folders of the operator; the rest is opened below the root by the kernel's own
 * rule (kiln_file_open_below), and once. */
#include "scene/place.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/file_in.h"
#include "kiln_program.h"

enum { MOST_LINKS = 40 }; /* as in the kernel */

/* A path that is followed. */
struct walk {
    char at[KILN_PATH_SIZE];   /* the real path of the folder that it has reached */
    char text[KILN_PATH_SIZE]; /* holds the rest of the path */
    const char *rest;
    int links; /* number of links that were followed */
};

/* Returns whether a path is in a folder or is the folder; both as realpath gives them. */
static bool is_in(const char *path, const char *folder)
{
    return strcmp(path, folder) == 0 || kiln_path_below(path, folder);
}

/* Starts at the working folder, or at "/" for an absolute path. Returns 0 or an errno value. */
static int begin(struct walk *walk, const char *path)
{
    *walk = (struct walk){.rest = walk->text};
    char *here = realpath(*path == '/' ? "/" : ".", NULL);
    if (!here)
        return errno;
    const bool fits = snprintf(walk->at, sizeof walk->at, "%s", here) < (int)sizeof walk->at &&
                      snprintf(walk->text, sizeof walk->text, "%s", path) < (int)sizeof walk->text;
    free(here);
    return fits ? 0 : ENAMETOOLONG;
}

/* Finds the next name of the rest, past slashes and ".". Returns its length, 0 at the end. */
static size_t find_name(struct walk *walk)
{
    const char *rest = walk->rest;
    while (rest[0] == '/' || (rest[0] == '.' && (rest[1] == '/' || rest[1] == '\0')))
        rest++;
    walk->rest = rest;
    return strcspn(rest, "/");
}

static void leave_folder(struct walk *walk)
{
    char *slash = strrchr(walk->at, '/');
    slash[slash == walk->at] = '\0'; /* the parent of "/" is "/" */
}

/* Goes to the target of a link, whose name has a length. Returns 0 or an errno value. */
static int follow_link(struct walk *walk, const char *target, size_t name)
{
    char text[KILN_PATH_SIZE];
    if (++walk->links > MOST_LINKS)
        return ELOOP;
    if (snprintf(text, sizeof text, "%s%s", target, walk->rest + name) >= (int)sizeof text)
        return ENAMETOOLONG;
    if (*target == '/')
        memcpy(walk->at, "/", 2);
    memcpy(walk->text, text, sizeof text);
    walk->rest = walk->text;
    return 0;
}

/* Enters the folder of the next name, or follows the link of that name. Returns 0 or an errno
 * value. */
static int enter(struct walk *walk, size_t name)
{
    char path[KILN_PATH_SIZE], target[KILN_PATH_SIZE];
    const char *slash = strcmp(walk->at, "/") == 0 ? "" : "/";
    if (snprintf(path, sizeof path, "%s%s%.*s", walk->at, slash, (int)name, walk->rest) >=
        (int)sizeof path)
        return ENAMETOOLONG;
    const ssize_t length = readlink(path, target, sizeof target - 1);
    if (length >= 0) {
        target[length] = '\0';
        return follow_link(walk, target, name);
    }
    if (errno != EINVAL) /* that is what is no link */
        return errno;
    memcpy(walk->at, path, sizeof path);
    walk->rest += name;
    return 0;
}

/* Follows a path, name by name, until it is in the root and does not leave it at once by "..".
 * Every folder that it comes through is looked at, so a link of the operator cannot lead through
 * the root by links of a stranger. Returns the path from the root, which the caller frees. NULL if
 * the path does not enter the root, or, with *reason an errno value, if it cannot be followed.
 * root: as realpath gives it. */
static char *find_way(const char *path, const char *root, int *reason)
{
    struct walk walk;
    *reason = begin(&walk, path);
    for (size_t name; *reason == 0 && (name = find_name(&walk)) > 0;) {
        if (name == 2 && walk.rest[0] == '.' && walk.rest[1] == '.') {
            leave_folder(&walk);
            walk.rest += name;
        } else if (is_in(walk.at, root)) {
            const char *below = strcmp(walk.at, root) == 0 ? NULL : kiln_path_below(walk.at, root);
            char *way = NULL;
            if (asprintf(&way, "%s%s%s", below ? below : "", below ? "/" : "", walk.rest) >= 0)
                return way;
            *reason = ENOMEM;
        } else {
            *reason = enter(&walk, name);
        }
    }
    return NULL;
}

bool kiln_scene_is_below(const char *path, const char *asset_root)
{
    int reason;
    char *root = realpath(asset_root, NULL);
    char *way = root ? find_way(path, root, &reason) : NULL;
    const bool is_below = way != NULL;
    free(way);
    free(root);
    return is_below;
}

int kiln_scene_open(const char *path, const char *asset_root, struct kiln_error *error)
{
    int reason = 0, file = -1;
    char *root = asset_root ? realpath(asset_root, NULL) : NULL;
    char *way = root ? find_way(path, root, &reason) : NULL;
    if (reason == 0) {
        file = way ? kiln_file_open_below(root, way, KILN_FILE_FLAGS) : open(path, KILN_FILE_FLAGS);
        reason = file < 0 ? errno : 0;
    }
    if (way && (reason == EXDEV || reason == ELOOP))
        kiln_error_set(error, KILN_INVALID_INPUT, "%s: the scene leads outside the asset root",
                       path);
    else if (reason == ENOMEM)
        kiln_error_no_memory(error, "%s", path);
    else if (reason != 0)
        kiln_error_set_errno(error, KILN_INVALID_INPUT, reason, "%s", path);
    free(way);
    free(root);
    return file;
}
