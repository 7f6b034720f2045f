/* This file lists the arrays of a mesh that cross the socket between kiln-decode and kiln. The
 * sender and the receiver both use this list, so they agree. */
#include "asset/geometry/mesh_in.h"

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
