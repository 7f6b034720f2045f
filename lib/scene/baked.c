/* This file answers questions about baked winds: which forces they sum up, and how large their
 * grids are. */
#include "scene/baked.h"

#include <math.h>
#include <stdio.h>

#include "scene/options.h"

/* The forces of a system or of a domain of gas, whose key in a file is `root`. */
struct list {
    const struct kiln_force *forces;
    uint32_t count;
    const char *root, *name;
};

static struct list list_of_system(const struct kiln_system *system)
{
    return (struct list){system->forces, system->force_count, "systems", system->name};
}

static struct list list_of_gas(const struct kiln_gas_domain *domain)
{
    return (struct list){domain->forces, domain->force_count, "gas", domain->name};
}

/* Returns force number i of a list. Behind its forces come those of its baked winds: `baked` is
 * then the number of the wind, and `inner` that of the force in it. Otherwise `baked` is that of
 * the force. */
static const struct kiln_force *find(const struct list *list, uint32_t i, uint32_t *baked,
                                     uint32_t *inner)
{
    *baked = i;
    if (i < list->count)
        return &list->forces[i];
    i -= list->count;
    for (uint32_t k = 0; k < list->count; k++) {
        const struct kiln_force *force = &list->forces[k];
        const uint32_t count = force->kind == KILN_FORCE_BAKED ? force->of.count : 0;
        *baked = k;
        *inner = i;
        if (i < count)
            return &force->of.at[i];
        i -= count;
    }
    return NULL;
}

static void write_path(const struct list *list, uint32_t i, char *path, size_t size)
{
    uint32_t baked = 0, inner = 0;
    const struct kiln_force *force = find(list, i, &baked, &inner);
    if (!force)
        return;
    const int length = snprintf(path, size, "%s.%s.forces.%u.%s", list->root, list->name, baked,
                                kiln_force_name(&list->forces[baked]));
    if (i >= list->count && length > 0 && (size_t)length < size)
        snprintf(path + length, size - (size_t)length, ".of.%u.%s", inner, kiln_force_name(force));
}

const struct kiln_force *kiln_system_force(const struct kiln_system *system, uint32_t i)
{
    const struct list list = list_of_system(system);
    uint32_t baked = 0, inner = 0;
    return find(&list, i, &baked, &inner);
}

const struct kiln_force *kiln_gas_force(const struct kiln_gas_domain *domain, uint32_t i)
{
    const struct list list = list_of_gas(domain);
    uint32_t baked = 0, inner = 0;
    return find(&list, i, &baked, &inner);
}

void kiln_system_force_path(const struct kiln_system *system, uint32_t i, char *path, size_t size)
{
    const struct list list = list_of_system(system);
    write_path(&list, i, path, size);
}

void kiln_gas_force_path(const struct kiln_gas_domain *domain, uint32_t i, char *path, size_t size)
{
    const struct list list = list_of_gas(domain);
    write_path(&list, i, path, size);
}

const struct kiln_force *kiln_owner_force(const struct kiln_scene *scene, uint32_t owner,
                                          uint32_t i)
{
    if (owner < scene->system_count)
        return kiln_system_force(&scene->systems[owner], i);
    return kiln_gas_force(&scene->gas[owner - scene->system_count], i);
}

void kiln_owner_force_path(const struct kiln_scene *scene, uint32_t owner, uint32_t i, char *path,
                           size_t size)
{
    if (owner < scene->system_count)
        kiln_system_force_path(&scene->systems[owner], i, path, size);
    else
        kiln_gas_force_path(&scene->gas[owner - scene->system_count], i, path, size);
}

uint64_t kiln_baked_samples(const struct kiln_force *baked, uint32_t size[3])
{
    const double edges[3] = {(double)baked->box_size.x.constant, (double)baked->box_size.y.constant,
                             (double)baked->box_size.z.constant};
    const double longest = fmax(edges[0], fmax(edges[1], edges[2]));
    for (int c = 0; c < 3; c++) {
        /* an edge that is as long as the longest but for rounding has as many cells */
        const double cells = ceil(baked->cells * edges[c] / longest - 1e-4);
        size[c] = cells < 1 ? 2 : (uint32_t)cells + 1;
    }
    return (uint64_t)size[0] * size[1] * size[2];
}
