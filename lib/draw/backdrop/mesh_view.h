/* A kiln_mesh_view holds meshes as the camera and the sun see them, on the host: the triangle that
 * each ray of the picture hits, and the shadow maps. */
#ifndef KILN_DRAW_BACKDROP_MESH_VIEW_H
#define KILN_DRAW_BACKDROP_MESH_VIEW_H

#include <stddef.h>
#include <stdint.h>

#include "asset/image/pyramid.h"
#include "draw/light/mesh_shadow.h"

enum {
    KILN_HIT_LAYERS = 1 + KILN_EDGE_SAMPLES, /* the centres of pixels, then their samples */
};

/* Describes a triangle by planes over u and v of rays (u, v, -1) in view space. A plane holds the
 * factors of u, v and 1. */
struct kiln_mesh_triangle {
    float nearness[3];  /* 1 / depth, 1/m */
    float normal[3][3]; /* world-space normal, of any length: a plane for each axis */
    float face[3];      /* world-space normal of the face, towards the eye, of any length */
    int32_t mesh;       /* its mesh, in the scene's order */
};

/* Holds a triangle's texture coordinates in the paint, times nearness: planes over u and v. */
struct kiln_mesh_uvs {
    float u[3], v[3];
};

struct kiln_mesh_view {
    const struct kiln_mesh_triangle *triangles; /* of all meshes */
    const int32_t *hits; /* by row, layer and column: 1 + number of the nearest triangle; 0: none */
    size_t pitch;        /* entries of a row of one layer */
    const struct kiln_mesh_uvs *uvs; /* of all triangles; NULL: no mesh takes paint */
    const struct kiln_pyramid *paint[KILN_MAX_MESHES]; /* NULL: the mesh takes no paint */
    const uint32_t *shadows[KILN_MAX_MESHES]; /* of each mesh: entries of its kiln_mesh_shadow */
};

#endif
