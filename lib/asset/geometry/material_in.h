/* Declares the materials of a mesh as kiln-decode sends them through its socket, as a part of
 * mesh_in.h's arrays. */
#ifndef KILN_ASSET_GEOMETRY_MATERIAL_IN_H
#define KILN_ASSET_GEOMETRY_MATERIAL_IN_H

#include "asset/geometry/material.h"
#include "asset/geometry/mesh.h"

/* The part of struct kiln_mesh_result for materials. kiln_looks_take checks its numbers. */
struct kiln_looks_result {
    uint32_t material_count, texture_count, byte_count;
    bool has_uvs, has_second_uvs, has_colors;
    struct kiln_material materials[KILN_MAX_MATERIALS];
    struct kiln_texture textures[KILN_MAX_TEXTURES];
    unsigned char *bytes; /* allocated for byte_count; its owner frees it */
    uint16_t of_triangles[KILN_MAX_MESH_TRIANGLES];
    float colors[KILN_MAX_MESH_VERTICES][4];
    float second_uvs[KILN_MAX_MESH_VERTICES][2];
};

struct kiln_mesh_result;

/* Checks the part `looks` of a result and copies it (material.c). NULL with an error that begins
 * with `name`. */
struct kiln_mesh_looks *kiln_looks_take(const char *name, const struct kiln_mesh_result *result,
                                        struct kiln_error *error);

#endif
