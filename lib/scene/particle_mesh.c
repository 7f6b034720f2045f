/* Loads the meshes that particles look like and checks their size. */
#include "scene/particle_mesh.h"

#include <inttypes.h>
#include <stdio.h>

#include "asset/geometry/mesh_measure.h"
#include "scene/asset_path.h"

bool kiln_particle_mesh_settle(struct kiln_reader *reader, const struct kiln_node *root,
                               struct kiln_system *system)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    struct kiln_look *look = &system->look;
    if (look->shape != KILN_SHAPE_MESH && !look->mesh.file)
        return true;
    char path[128];
    snprintf(path, sizeof path, "systems.%s.look.mesh.file", system->name);
    if (!look->mesh.file)
        return kiln_reader_error_at(reader, root, path, "must name a file where shape is mesh");
    struct kiln_error error = {0};
    const struct kiln_mesh *mesh = kiln_mesh_library_get(scene->meshes, look->mesh.file, &error);
    if (!mesh)
        return kiln_asset_fail(reader, root, path, look->mesh.file, &error);
    if (look->shape != KILN_SHAPE_MESH)
        return true;
    const struct kiln_mesh_measure measure = kiln_mesh_measure(mesh);
    look->mesh.shown = mesh;
    look->mesh.shade = measure.shadow_radius / measure.edge;
    if (mesh->triangle_count > KILN_MAX_PARTICLE_TRIANGLES)
        return kiln_reader_error_at(
            reader, root, path, "the mesh has %u triangles; the mesh of a particle has at most %d",
            mesh->triangle_count, KILN_MAX_PARTICLE_TRIANGLES);
    return true;
}

bool kiln_particle_mesh_count(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    uint64_t meshes = 0, triangles = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        if (!system->enabled || system->look.shape != KILN_SHAPE_MESH)
            continue;
        meshes += system->capacity;
        triangles += (uint64_t)system->capacity * system->look.mesh.shown->triangle_count;
        char path[128];
        snprintf(path, sizeof path, "systems.%s.emit", system->name);
        if (meshes > KILN_MAX_INSTANCES)
            return kiln_reader_error_at(
                reader, root, path,
                "up to %" PRIu64
                " particles at once are meshes; a scene has at most %d: lower rate, bursts or life",
                meshes, KILN_MAX_INSTANCES);
        if (triangles > KILN_MAX_INSTANCE_TRIANGLES)
            return kiln_reader_error_at(
                reader, root, path,
                "up to %" PRIu64
                " triangles are drawn for particles at once; a scene has at most %d: lower rate, "
                "bursts or life, or take a mesh of fewer than %u triangles",
                triangles, KILN_MAX_INSTANCE_TRIANGLES, system->look.mesh.shown->triangle_count);
    }
    return true;
}
