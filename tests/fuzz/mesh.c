/* Fuzzes the mesh loader. For any bytes, kiln must load a mesh or report an error, without and with
 * its materials, and for glTF also a skinned mesh or an error, and nodes or an error. The numbers
 * of vertices and triangles must stay within KILN_MAX_MESH_*, and every vertex must be finite, also
 * in every pose of the animation clip. If this fails, a damaged mesh crashes kiln. The importer
 * runs in a process of its own, kiln-decode, and may crash there; kiln must report that as an
 * error. */
#include "fuzz.h"
#include "mesh_check.h"
#include "mesh_format.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct kiln_error error = {0};
    static const char *const names[] = {[KILN_MESH_OBJ] = "fuzz.obj",
                                        [KILN_MESH_GLTF] = "fuzz.gltf",
                                        [KILN_MESH_GLB] = "fuzz.glb",
                                        [KILN_MESH_PLY] = "fuzz.ply",
                                        [KILN_MESH_STL] = "fuzz.stl"};
    const enum kiln_mesh_format format = guess_format(data, size);
    const char *name = names[format];
    struct kiln_mesh *mesh = kiln_mesh_parse(data, size, name, &error);
    fuzz_taken = mesh != NULL;
    if (mesh)
        check_mesh(mesh);
    else
        require(error.code != KILN_OK && *error.message, "an error without a message");
    kiln_mesh_destroy(&mesh);
    struct kiln_mesh *painted = kiln_mesh_parse_with_materials(data, size, name, &error);
    if (painted)
        check_looks(painted);
    kiln_mesh_destroy(&painted);
    const bool may_move = format == KILN_MESH_GLTF || format == KILN_MESH_GLB;
    struct kiln_skin *skin = may_move ? kiln_skin_parse(data, size, name, &error) : NULL;
    if (skin)
        check_skin(skin);
    kiln_skin_destroy(&skin);
    struct kiln_rig *rig = may_move ? kiln_rig_parse(data, size, name, &error) : NULL;
    if (rig)
        check_rig(rig);
    kiln_rig_destroy(&rig);
    return 0;
}
