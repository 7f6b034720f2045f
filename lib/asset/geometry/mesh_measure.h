/* Measures how large a mesh is, for drawing it at a given size. */
#ifndef KILN_ASSET_GEOMETRY_MESH_MEASURE_H
#define KILN_ASSET_GEOMETRY_MESH_MEASURE_H

#include "asset/geometry/mesh.h"

/* In the units of the file. */
struct kiln_mesh_measure {
    float middle[3]; /* of the box around it */
    float edge;      /* the longest of that box: above 0, since a triangle has an area */
    float reach;     /* from the middle to the farthest vertex */
    float shade; /* radius of the sphere whose shadow is as large as the mesh's is on average over
                  * all directions, at most `reach` */
};

struct kiln_mesh_measure kiln_mesh_measure(const struct kiln_mesh *mesh);

#endif
