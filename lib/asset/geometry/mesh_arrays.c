/* This file lists the arrays of a mesh that cross the socket between kiln-decode and kiln. The
 * sender and the receiver both use this list, so they agree. It also makes and frees the result
 * that holds these arrays. */
#include <stdlib.h>
#include <sys/mman.h>

#include "asset/geometry/mesh_in.h"

/* The memory comes from mmap, as malloc would take it. For malloc's memory the address sanitizer
 * also writes an eighth of its size to mark it, here 17 MB twice for each result, which would take
 * three quarters of the time of the fuzz tests of meshes. */
struct kiln_mesh_result *kiln_mesh_result_create(bool large_pages)
{
    struct kiln_mesh_result *result =
        mmap(NULL, sizeof *result, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (result == MAP_FAILED)
        return NULL;
    if (large_pages) /* small ones do where the kernel has none */
        (void)madvise(result, sizeof *result, MADV_HUGEPAGE);
    return result;
}

void kiln_mesh_result_destroy(struct kiln_mesh_result **result)
{
    if (!*result)
        return;
    free((*result)->skin.deltas);
    free((*result)->looks.bytes);
    munmap(*result, sizeof **result);
    *result = NULL;
}

bool kiln_mesh_visit_arrays(struct kiln_mesh_result *result,
                            const struct kiln_decode_request *wanted,
                            bool (*visit)(void *user, void *array, size_t bytes), void *user)
{
    struct kiln_skin_result *skin = &result->skin;
    struct kiln_looks_result *looks = &result->looks;
    const size_t vertices = result->vertex_count;
    const bool moving = wanted->moving, materials = wanted->materials;
    const bool clips = moving || wanted->rig;
    const struct {
        void *array;
        size_t count, size;
        bool wanted;
    } arrays[] = {
        {result->vertices, vertices, sizeof *result->vertices, true},
        {result->triangles, result->triangle_count, sizeof *result->triangles, true},
        {result->uvs, vertices, sizeof *result->uvs, wanted->uvs || (materials && looks->has_uvs)},
        {looks->materials, looks->material_count, sizeof *looks->materials, materials},
        {looks->textures, looks->texture_count, sizeof *looks->textures, materials},
        {looks->bytes, looks->byte_count, 1, materials},
        {looks->of_triangles, result->triangle_count, sizeof *looks->of_triangles, materials},
        {looks->colors, vertices, sizeof *looks->colors, materials && looks->has_colors},
        {looks->second_uvs, vertices, sizeof *looks->second_uvs,
         materials && looks->has_second_uvs},
        {skin->nodes, skin->node_count, sizeof *skin->nodes, moving},
        {skin->bones, skin->bone_count, sizeof *skin->bones, moving},
        {skin->clips, skin->clip_count, sizeof *skin->clips, clips},
        {skin->channels, skin->channel_count, sizeof *skin->channels, clips},
        {skin->keys, skin->key_count, sizeof *skin->keys, clips},
        {skin->weights, vertices, sizeof *skin->weights, moving},
        {skin->morphs, skin->morph_count, sizeof *skin->morphs, moving},
        {skin->morph_channels, skin->morph_channel_count, sizeof *skin->morph_channels, moving},
        {skin->deltas, skin->delta_count, sizeof *skin->deltas, moving},
        {result->rig.nodes, result->rig.node_count, sizeof *result->rig.nodes, wanted->rig},
    };
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        if (arrays[i].wanted && arrays[i].count > 0 &&
            !visit(user, arrays[i].array, arrays[i].count * arrays[i].size))
            return false;
    }
    return true;
}
