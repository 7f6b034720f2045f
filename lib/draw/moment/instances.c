/* This file copies the meshes of particle systems into one array of corners, scaled to a box whose
 * longest edge is 1. Corners are stored triangle by triangle, so that drawing a triangle needs no
 * index table. */
#include "draw/moment/instances.h"

#include <stdlib.h>

#include "asset/geometry/mesh_measure.h"
#include "base/error.h"

/* Gives the edge of silhouette tiles: a scene with up to `most` particles that are meshes has tiles
 * with an edge of `edge` texels. */
static const struct {
    uint64_t most;
    uint32_t edge;
} SIZES[] = {{512, KILN_INSTANCE_LARGEST_TILE}, {2048, 32}, {16384, 16}};

static bool make_room(struct kiln_instances *instances, uint32_t triangles,
                      struct kiln_error *error)
{
    size_t count = (size_t)instances->corner_count + 3 * (size_t)triangles;
    float4(*more)[2] = realloc(instances->corners, count * sizeof *more);
    if (!more) {
        kiln_error_no_memory(error, "meshes of particles");
        return false;
    }
    instances->corners = more;
    return true;
}

static void add_corner(struct kiln_instances *instances, const struct kiln_mesh_measure *measure,
                       const float vertex[6])
{
    float4 *corner = instances->corners[instances->corner_count++];
    const float *middle = measure->middle;
    float scale = 1.0f / measure->edge;
    corner[0] = (float4){(vertex[0] - middle[0]) * scale, (vertex[1] - middle[1]) * scale,
                         (vertex[2] - middle[2]) * scale, 1.0f};
    corner[1] = (float4){vertex[3], vertex[4], vertex[5], 0.0f};
}

static bool add_mesh(struct kiln_instances *instances, const struct kiln_scene *scene,
                     uint32_t system, struct kiln_error *error)
{
    const struct kiln_mesh *mesh = scene->systems[system].look.mesh.shown;
    const struct kiln_mesh_measure measure = kiln_mesh_measure(mesh);
    if (!make_room(instances, mesh->triangle_count, error))
        return false;
    instances->meshes[system] = (struct kiln_instance_mesh){
        instances->corner_count, mesh->triangle_count, measure.reach / measure.edge};
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            add_corner(instances, &measure, mesh->vertices[mesh->triangles[i][k]]);
    return true;
}

void kiln_instances_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct kiln_instances *n = NULL;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        if (look->shape == KILN_SHAPE_MESH)
            kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS,
                               3 * (uint64_t)look->mesh.shown->triangle_count, sizeof *n->corners);
    }
}

bool kiln_instances_init(struct kiln_instances *instances, const struct kiln_scene *scene,
                         struct kiln_error *error)
{
    *instances = (struct kiln_instances){.corners = NULL};
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        if (system->enabled && system->look.shape == KILN_SHAPE_MESH &&
            !add_mesh(instances, scene, i, error))
            return false;
    }
    return true;
}

void kiln_instances_finish(struct kiln_instances *instances)
{
    free(instances->corners);
    *instances = (struct kiln_instances){.corners = NULL};
}

uint32_t kiln_instance_tile_edge(const struct kiln_scene *scene)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        if (system->enabled && system->look.shape == KILN_SHAPE_MESH)
            count += system->capacity;
    }
    uint32_t edge = 0;
    for (size_t i = sizeof SIZES / sizeof *SIZES; count > 0 && i-- > 0;)
        edge = count <= SIZES[i].most ? SIZES[i].edge : edge;
    return edge;
}
