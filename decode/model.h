/* Declares a model: what a reader of mesh files finds in a file. surface.c makes one surface of a
 * model that does not move, skin.c the parts of one that moves. */
#ifndef KILN_DECODE_MODEL_H
#define KILN_DECODE_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "asset/geometry/material_in.h"

/* Triangles that have one material. Corners are numbers of vertices, and vertices need not differ.
 */
struct decode_model_mesh {
    size_t vertex_count, triangle_count;
    float (*positions)[3];
    float (*normals)[3]; /* of any length; NULL: the file has none */
    float (*uvs)[2];     /* NULL: none */
    /* colours of vertices and a second set of texture coordinates, of a mesh that is read with its
     * materials; NULL: none */
    float (*colors)[4], (*second_uvs)[2];
    uint32_t (*triangles)[3];
    uint32_t material; /* by which the triangles of a surface are ordered */
    uint32_t source;   /* the material's number in the file */
    uint16_t look;     /* the number of the material in the result (looks.h) */
};

/* A mesh as a node of the file places it. */
struct decode_model_part {
    size_t mesh;
    double rows[3][4]; /* the matrix that takes its vertices to their places */
};

/* The parts are in the order of the file. A model that moves has nodes, too. */
struct decode_model {
    struct decode_model_mesh *meshes;
    size_t mesh_count;
    struct decode_model_part *parts;
    size_t part_count;
    struct kiln_looks_result *looks; /* where materials go; NULL: they are not wanted */
    char *notes; /* for the user, a line each; KILN_MESSAGE_SIZE bytes (decode_note) */
};

/* Gives an empty model as many meshes, which are empty, and a part for each that leaves it where it
 * is. False: memory is short. */
bool decode_model_allocate(struct decode_model *model, size_t count);

void decode_model_finish(struct decode_model *model);

/* A corner of a triangle. */
struct decode_corner {
    float position[3], normal[3], uv[2];
    bool has_normal;
};

/* Computes the normals of corners that have none, of three corners a triangle: edges up to 50
 * degrees are smooth, others are creases (surface.c). */
bool decode_find_normals(struct decode_corner *corners, size_t count, struct kiln_error *error);

#endif
