/* A kiln_mesh_view holds meshes as camera and sun see them, on the host: the triangle that each ray
 * of the picture hits, and the shadow maps. */
#ifndef KILN_DRAW_BACKDROP_MESH_VIEW_H
#define KILN_DRAW_BACKDROP_MESH_VIEW_H

#include <stddef.h>
#include <stdint.h>

#include "asset/image/pyramid.h"
#include "draw/light/mesh_shadow.h"

enum {
    KILN_HIT_LAYERS = 1 + KILN_EDGE_SAMPLES, /* the centres of pixels, and their samples */
};

/* Describes a triangle along rays (u, v, -1) in view space by planes over u and v, as factors of u,
 * v and 1. */
struct kiln_mesh_triangle {
    float nearness[3];  /* 1 / depth, 1/m */
    float normal[3][3]; /* in the world, of any length, by axis */
    float face[3];      /* in the world, towards the eye */
    int32_t mesh;       /* in the scene's order */
};

/* Holds a triangle's texture coordinates in the paint, times nearness: planes over u and v. */
struct kiln_mesh_uvs {
    float u[3], v[3];
};

struct kiln_mesh_view {
    const struct kiln_mesh_triangle *triangles; /* of all meshes */
    const int32_t *hits; /* by row, layer and column: 1 + the triangle that is nearest; 0: none */
    size_t pitch;        /* columns */
    const struct kiln_mesh_uvs *uvs; /* of all triangles; NULL: no mesh takes paint */
    const struct kiln_pyramid *paint[KILN_MAX_MESHES]; /* NULL: takes none */
    const uint32_t *shadows[KILN_MAX_MESHES]; /* of each mesh: texels of struct kiln_mesh_shadow */
};

#endif
