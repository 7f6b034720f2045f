/* Measures how large and how thick a mesh is. lib/scene/particle_mesh.c and
 * lib/draw/moment/instances.c use the sizes to draw particles as meshes and, in shadows, as spheres
 * that stand for the meshes. */
#ifndef KILN_ASSET_GEOMETRY_MESH_MEASURE_H
#define KILN_ASSET_GEOMETRY_MESH_MEASURE_H

#include "asset/geometry/mesh.h"

/* Sizes of a mesh in the units of the file. */
struct kiln_mesh_measure {
    float middle[3]; /* centre of the bounding box */
    float edge;      /* longest edge of the bounding box; above 0, since a triangle has an area */
    float reach;     /* distance from the middle to the farthest vertex */
    /* radius of a sphere whose shadow has the area of the mesh's shadow, averaged over all
     * directions of light; at most `reach` */
    float shadow_radius;
};

struct kiln_mesh_measure kiln_mesh_measure(const struct kiln_mesh *mesh);

/* Measures the thinnest part of a closed mesh: the least distance from the middle of a triangle,
 * inwards along its normal, to the other side. Infinite if no such ray meets another side. Returns
 * false when memory is short. */
bool kiln_mesh_thinnest(const struct kiln_mesh *mesh, double *thinnest);

#endif
