/* This file answers questions about baked winds: which forces they sum up, and how large their
 * grids are. */
#include "scene/baked.h"

#include <math.h>
#include <stdio.h>

#include "scene/options.h"

const struct kiln_force *kiln_system_force(const struct kiln_system *system, uint32_t i)
{
    if (i < system->force_count)
        return &system->forces[i];
    i -= system->force_count;
    for (uint32_t k = 0; k < system->force_count; k++) {
        const struct kiln_force *force = &system->forces[k];
        if (force->kind != KILN_FORCE_BAKED)
            continue;
        if (i < force->of.count)
            return &force->of.at[i];
        i -= force->of.count;
    }
    return NULL;
}

void kiln_system_force_path(const struct kiln_system *system, uint32_t i, char *path, size_t size)
{
    if (i < system->force_count) {
        snprintf(path, size, "systems.%s.forces.%u.%s", system->name, i,
                 kiln_force_name(&system->forces[i]));
        return;
    }
    i -= system->force_count;
    for (uint32_t k = 0; k < system->force_count; k++) {
        const struct kiln_force *force = &system->forces[k];
        if (force->kind != KILN_FORCE_BAKED)
            continue;
        if (i < force->of.count) {
            snprintf(path, size, "systems.%s.forces.%u.%s.of.%u.%s", system->name, k,
                     kiln_force_name(force), i, kiln_force_name(&force->of.at[i]));
            return;
        }
        i -= force->of.count;
    }
}

void kiln_gas_force_path(const struct kiln_gas_domain *domain, uint32_t i, char *path, size_t size)
{
    snprintf(path, size, "gas.%s.forces.%u.%s", domain->name, i,
             kiln_force_name(&domain->forces[i]));
}

const struct kiln_force *kiln_owner_force(const struct kiln_scene *scene, uint32_t owner,
                                          uint32_t i)
{
    if (owner < scene->system_count)
        return kiln_system_force(&scene->systems[owner], i);
    const struct kiln_gas_domain *domain = &scene->gas[owner - scene->system_count];
    return i < domain->force_count ? &domain->forces[i] : NULL;
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
