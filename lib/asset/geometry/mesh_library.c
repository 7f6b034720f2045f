/* This file keeps the meshes of a scene in a list, since scenes name few files. A file is imported
 * once for each way that is asked for: plain, with texture coordinates, moving, or its nodes alone.
 */
#include "asset/geometry/mesh_library.h"

#include <stdlib.h>
#include <string.h>

#include "asset/loader/loader.h"
#include "base/budget.h"
#include "base/error.h"

enum way { PLAIN, UNWRAPPED, MOVING, NODES };

struct entry {
    struct entry *next;
    char *path;
    enum way way;
    struct kiln_mesh *mesh; /* NULL if the mesh moves */
    struct kiln_skin *skin;
    struct kiln_rig *rig; /* of nodes alone */
};

struct kiln_mesh_library {
    struct kiln_loader *loader;
    struct entry *entries;
};

struct kiln_mesh_library *kiln_mesh_library_create(struct kiln_loader *loader)
{
    struct kiln_mesh_library *library = calloc(1, sizeof *library);
    if (library)
        library->loader = loader;
    return library;
}

static void destroy_entry(struct entry *entry)
{
    kiln_mesh_destroy(&entry->mesh);
    kiln_skin_destroy(&entry->skin);
    kiln_rig_destroy(&entry->rig);
    free(entry->path);
    free(entry);
}

void kiln_mesh_library_destroy(struct kiln_mesh_library **library)
{
    if (!*library)
        return;
    for (struct entry *entry = (*library)->entries, *next; entry; entry = next) {
        next = entry->next;
        destroy_entry(entry);
    }
    free(*library);
    *library = NULL;
}

static bool import(const struct kiln_mesh_library *library, struct entry *entry,
                   struct kiln_error *error)
{
    const char *path = entry->path;
    if (entry->way == NODES) {
        entry->rig = kiln_rig_load(library->loader, path, error);
        return entry->rig != NULL;
    }
    if (entry->way == MOVING)
        entry->skin = kiln_skin_load(library->loader, path, error);
    else if (entry->way == UNWRAPPED)
        entry->mesh = kiln_mesh_load_unwrapped(library->loader, path, error);
    else
        entry->mesh = kiln_mesh_load(library->loader, path, error);
    const struct kiln_mesh *mesh = entry->skin ? kiln_skin_mesh(entry->skin) : entry->mesh;
    return mesh && kiln_budget_take(kiln_loader_budget(library->loader), KILN_LIMIT_triangles,
                                    mesh->triangle_count, path, error);
}

/* Returns the entry of a file, and imports the file if it has none; NULL: it cannot be imported. */
static const struct entry *get(struct kiln_mesh_library *library, const char *path, enum way way,
                               struct kiln_error *error)
{
    struct entry *entry = library->entries;
    while (entry && (entry->way != way || strcmp(entry->path, path) != 0))
        entry = entry->next;
    if (entry)
        return entry;
    char *copy = strdup(path);
    entry = copy ? calloc(1, sizeof *entry) : NULL;
    if (!entry) {
        free(copy);
        kiln_error_no_memory(error, "reading %s", path);
        return NULL;
    }
    *entry = (struct entry){.next = library->entries, .path = copy, .way = way};
    if (!import(library, entry, error)) {
        destroy_entry(entry);
        return NULL;
    }
    library->entries = entry;
    return entry;
}

const struct kiln_mesh *kiln_mesh_library_get(struct kiln_mesh_library *library, const char *path,
                                              struct kiln_error *error)
{
    const struct entry *entry = get(library, path, PLAIN, error);
    return entry ? entry->mesh : NULL;
}

const struct kiln_mesh *kiln_mesh_library_get_unwrapped(struct kiln_mesh_library *library,
                                                        const char *path, struct kiln_error *error)
{
    const struct entry *entry = get(library, path, UNWRAPPED, error);
    return entry ? entry->mesh : NULL;
}

const struct kiln_skin *kiln_mesh_library_get_skin(struct kiln_mesh_library *library,
                                                   const char *path, struct kiln_error *error)
{
    const struct entry *entry = get(library, path, MOVING, error);
    return entry ? entry->skin : NULL;
}

const struct kiln_rig *kiln_mesh_library_get_rig(struct kiln_mesh_library *library,
                                                 const char *path, struct kiln_error *error)
{
    const struct entry *entry = get(library, path, NODES, error);
    return entry ? entry->rig : NULL;
}

/* Orders by path; of one path, a mesh that moves comes first, since it tells most. */
static int by_path(const void *a, const void *b)
{
    const struct entry *x = *(const struct entry *const *)a, *y = *(const struct entry *const *)b;
    const int order = strcmp(x->path, y->path);
    return order ? order : (int)y->way - (int)x->way;
}

bool kiln_mesh_library_visit(const struct kiln_mesh_library *library,
                             bool (*visit)(void *user, const char *path,
                                           const struct kiln_mesh *mesh,
                                           const struct kiln_skin *skin),
                             void *user)
{
    size_t count = 0;
    for (const struct entry *entry = library->entries; entry; entry = entry->next)
        count++;
    const struct entry **entries = malloc((count + 1) * sizeof *entries);
    bool ok = entries != NULL;
    count = 0;
    for (const struct entry *entry = library->entries; ok && entry; entry = entry->next) {
        if (entry->way != NODES)
            entries[count++] = entry;
    }
    if (ok)
        qsort(entries, count, sizeof(struct entry *), by_path);
    for (size_t i = 0; ok && i < count; i++) {
        const struct entry *entry = entries[i];
        if (i == 0 || strcmp(entries[i - 1]->path, entry->path) != 0)
            ok = visit(user, entry->path, entry->skin ? kiln_skin_mesh(entry->skin) : entry->mesh,
                       entry->skin);
    }
    free(entries);
    return ok;
}

uint64_t kiln_mesh_library_bytes(const struct kiln_mesh_library *library)
{
    uint64_t bytes = 0;
    for (const struct entry *entry = library->entries; entry; entry = entry->next) {
        if (entry->rig)
            bytes += kiln_rig_bytes(entry->rig);
        else
            bytes += entry->skin ? kiln_skin_bytes(entry->skin) : kiln_mesh_bytes(entry->mesh);
    }
    return bytes;
}
