/* This file describes the materials of a mesh for kiln check. Emission is left out where there is
 * none, and alpha where it counts for nothing. */
#include "scene/mesh_looks.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

/* Writes which texture a material uses, behind `before`. */
static void write_map(FILE *out, const struct kiln_mesh_looks *looks,
                      const struct kiln_material *material, enum kiln_material_use use,
                      const char *before)
{
    const struct kiln_material_map *map = &material->maps[use];
    if (map->texture == KILN_NO_TEXTURE)
        return;
    const struct kiln_texture *texture = &looks->textures[map->texture];
    if (*texture->file)
        fprintf(out, "%s'%s'%s", before, texture->file, texture->is_missing ? " (missing)" : "");
    else
        fprintf(out, "%sa picture of %" PRIu32 " bytes in the file", before, texture->byte_count);
    if (map->uv_set > 0)
        fputs(" (by the second texture coordinates)", out);
}

static void write_alpha(FILE *out, const struct kiln_mesh_looks *looks,
                        const struct kiln_material *material)
{
    if (material->alpha_mode == KILN_ALPHA_OPAQUE)
        return;
    fprintf(out, "; alpha %g", (double)material->alpha);
    write_map(out, looks, material, KILN_USE_ALPHA, " times ");
    if (material->alpha_mode == KILN_ALPHA_MASK)
        fprintf(out, ", cut at %g", (double)material->cutoff);
    else
        fputs(", blended", out);
}

static void write_material(FILE *out, const struct kiln_mesh_looks *looks,
                           const struct kiln_material *m)
{
    const float *e = m->emission;
    fprintf(out, "material '%s', not drawn yet: base colour %.3g %.3g %.3g", m->name,
            (double)m->color[0], (double)m->color[1], (double)m->color[2]);
    write_map(out, looks, m, KILN_USE_COLOR, " times ");
    write_alpha(out, looks, m);
    fprintf(out, "; roughness %.3g", (double)m->roughness);
    write_map(out, looks, m, KILN_USE_ROUGHNESS, " times ");
    fprintf(out, "; metalness %.3g", (double)m->metalness);
    write_map(out, looks, m, KILN_USE_METALNESS, " times ");
    if (e[0] > 0 || e[1] > 0 || e[2] > 0)
        fprintf(out, "; emission %.3g %.3g %.3g", (double)e[0], (double)e[1], (double)e[2]);
    if (e[0] > 0 || e[1] > 0 || e[2] > 0)
        write_map(out, looks, m, KILN_USE_EMISSION, " times ");
    write_map(out, looks, m, KILN_USE_NORMAL, "; normals of ");
    write_map(out, looks, m, KILN_USE_HEIGHT, "; heights of ");
    fprintf(out, "%s%s\n", m->is_two_sided ? "; two-sided" : "", m->is_unlit ? "; unlit" : "");
}

char *kiln_mesh_looks_describe(const struct kiln_mesh_looks *looks)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    for (uint32_t i = 0; i < looks->material_count; i++)
        write_material(out, looks, &looks->materials[i]);
    if (looks->colors)
        fputs("colours of vertices, not drawn yet\n", out);
    const bool ok = !ferror(out);
    if (fclose(out) != 0 || !ok) {
        free(text);
        return NULL;
    }
    return text;
}
