/* Fuzzes the mesh loader: any bytes are a mesh within the limits or an error, never a crash; of
 * this process, that is: the importer has one of its own. What moves is within them at any moment.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/skin.h"
#include "fuzz.h"

static void require(bool condition, const char *what)
{
    if (!condition) {
        fprintf(stderr, "fuzz: %s\n", what);
        abort();
    }
}

static void check_mesh(const struct kiln_mesh *mesh)
{
    require(mesh->triangle_count >= 1 && mesh->triangle_count <= KILN_MAX_MESH_TRIANGLES &&
                mesh->vertex_count >= 3 && mesh->vertex_count <= KILN_MAX_MESH_VERTICES,
            "a mesh beyond the limits");
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        for (int c = 0; c < 6; c++)
            require(isfinite(mesh->vertices[i][c]), "a vertex that is no place");
    }
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        for (int c = 0; c < 3; c++)
            require(mesh->triangles[i][c] < mesh->vertex_count, "a corner without a vertex");
    }
}

static void check_skin(const struct kiln_skin *skin)
{
    struct kiln_mesh *mesh = kiln_mesh_copy(kiln_skin_mesh(skin));
    require(mesh != NULL, "no memory");
    const float length = kiln_skin_clip_length(skin, 0);
    for (int i = 0; i < 4; i++) {
        check_mesh(mesh);
        kiln_skin_pose_mesh(skin, 0, length * (float)i / 3.0f, mesh);
    }
    check_mesh(mesh);
    kiln_mesh_destroy(&mesh);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct kiln_error error = {0};
    const char *name = size && data[0] == 'g'   ? "fuzz.glb"
                       : size && data[0] == '{' ? "fuzz.gltf"
                                                : "fuzz.obj";
    struct kiln_mesh *mesh = kiln_mesh_parse(data, size, name, &error);
    if (mesh)
        check_mesh(mesh);
    else
        require(error.code != KILN_OK && *error.message, "an error without a message");
    kiln_mesh_destroy(&mesh);
    struct kiln_skin *skin =
        strcmp(name, "fuzz.obj") == 0 ? NULL : kiln_skin_parse(data, size, name, &error);
    if (skin)
        check_skin(skin);
    kiln_skin_destroy(&skin);
    return 0;
}
