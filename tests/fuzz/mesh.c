/* Fuzzes the mesh loader: any bytes must give a mesh and a skinned mesh within the limits, at any
 * time of its animation clip, or an error. If this fails, a damaged OBJ or glTF file crashes kiln.
 * The importer may crash, since it runs in kiln-decode, the separate process that decodes
 * strangers' files; kiln must then report an error. */
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
