/* Fuzzes the mesh loader. For any bytes, kiln must load a mesh or report an error, and for glTF
 * also a skinned mesh or an error. The numbers of vertices and triangles must stay within
 * KILN_MAX_MESH_*, and every vertex must be finite, also in every pose of the animation clip. If
 * this fails, a damaged OBJ or glTF file crashes kiln. The importer runs in a process of its own,
 * kiln-decode, and may crash there; kiln must report that as an error. */
#include <string.h>

#include "fuzz.h"
#include "mesh_check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct kiln_error error = {0};
    const char *name = size && data[0] == 'g'   ? "fuzz.glb"
                       : size && data[0] == '{' ? "fuzz.gltf"
                                                : "fuzz.obj";
    struct kiln_mesh *mesh = kiln_mesh_parse(data, size, name, &error);
    fuzz_taken = mesh != NULL;
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
