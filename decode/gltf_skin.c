/* This file reads the skins of glTF documents: which nodes move vertices, and from which space each
 * takes them. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gltf.h"

static const double identity[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

static bool put_offsets(struct gltf *g, const float *matrices, struct gltf_skin *out)
{
    for (uint32_t i = 0; i < out->count; i++) {
        const float *m = matrices + (size_t)16 * i;
        for (int row = 0; row < 3; row++) {
            for (int column = 0; column < 4; column++)
                out->bones[i].offset[row][column] = (double)m[4 * column + row];
        }
        const double last[4] = {(double)m[3], (double)m[7], (double)m[11], (double)m[15]};
        if (!gltf_check_last_row(g, last))
            return false;
    }
    return true;
}

bool gltf_read_skin(struct gltf *g, uint32_t skin, struct gltf_skin *out)
{
    const json_t *json = gltf_element(g, GLTF_SKINS, skin);
    const json_t *joints = gltf_member(json, "joints");
    uint32_t accessor = 0;
    *out = (struct gltf_skin){.count = gltf_size(joints)};
    if (out->count == 0 || out->count > KILN_MAX_SKIN_JOINTS)
        return GLTF_SET(g, "skin %u has %u joints; allowed are 1 to %d", skin, out->count,
                        KILN_MAX_SKIN_JOINTS);
    out->bones = calloc(out->count, sizeof *out->bones);
    if (!out->bones)
        return decode_out_of_memory(g->error);
    uint32_t number = 0;
    size_t i_at = 0;
    for (const json_t *i; (i = gltf_item(joints, i_at)); i_at++) {
        (void)gltf_index(i, &out->bones[number].node); /* gltf_find_nodes has checked */
        memcpy(out->bones[number++].offset, identity, sizeof identity);
    }
    if (!gltf_reference(g, json, "inverseBindMatrices", GLTF_ACCESSORS, &accessor))
        return false;
    if (accessor == GLTF_NONE)
        return true;
    float *matrices = gltf_read(g, accessor, "MAT4", (struct gltf_range){0, out->count});
    const bool ok = matrices && put_offsets(g, matrices, out);
    free(matrices);
    return ok;
}

void gltf_blend(const struct kiln_skin_weights *weights, const double (*bones)[3][4],
                double rows[3][4])
{
    double sum = 0.0;
    for (int k = 0; k < KILN_SKIN_INFLUENCES; k++)
        sum += (double)weights->weights[k];
    memset(rows, 0, sizeof identity);
    for (int k = 0; k < KILN_SKIN_INFLUENCES; k++) {
        const double weight = (double)weights->weights[k] / sum;
        const double(*bone)[4] = bones[weights->bones[k]];
        for (int i = 0; weight > 0.0 && i < 12; i++)
            rows[i / 4][i % 4] += weight * bone[i / 4][i % 4];
    }
}
