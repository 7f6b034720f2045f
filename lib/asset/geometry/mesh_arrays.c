/* This file lists the arrays of a mesh that cross the socket between kiln-decode and kiln. The
 * sender and the receiver both use this list, so they agree. */
#include "asset/geometry/mesh_in.h"

bool kiln_mesh_visit_arrays(struct kiln_mesh_result *result, bool uvs, bool moving,
                            bool (*visit)(void *user, void *array, size_t bytes), void *user)
{
    struct kiln_skin_result *skin = &result->skin;
    const size_t vertices = result->vertex_count;
    const struct {
        void *array;
        size_t count, size;
        bool wanted;
    } arrays[] = {
        {result->vertices, vertices, sizeof *result->vertices, true},
        {result->triangles, result->triangle_count, sizeof *result->triangles, true},
        {result->uvs, vertices, sizeof *result->uvs, uvs},
        {skin->nodes, skin->node_count, sizeof *skin->nodes, moving},
        {skin->bones, skin->bone_count, sizeof *skin->bones, moving},
        {skin->clips, skin->clip_count, sizeof *skin->clips, moving},
        {skin->channels, skin->channel_count, sizeof *skin->channels, moving},
        {skin->keys, skin->key_count, sizeof *skin->keys, moving},
        {skin->weights, vertices, sizeof *skin->weights, moving},
        {skin->morphs, skin->morph_count, sizeof *skin->morphs, moving},
        {skin->morph_channels, skin->morph_channel_count, sizeof *skin->morph_channels, moving},
        {skin->deltas, skin->delta_count, sizeof *skin->deltas, moving},
    };
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        if (arrays[i].wanted && !visit(user, arrays[i].array, arrays[i].count * arrays[i].size))
            return false;
    }
    return true;
}
