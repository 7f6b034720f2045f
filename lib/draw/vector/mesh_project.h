/* This header declares the perspective projection of triangles for struct kiln_mesh_rows. */
#ifndef KILN_DRAW_VECTOR_MESH_PROJECT_H
#define KILN_DRAW_VECTOR_MESH_PROJECT_H

#include <stdbool.h>

#include "draw/vector/mesh_rows.h"
#include "shared/platform.h"

/* Nearest distance to the eye at which triangles are drawn, m: this, or that of a camera whose near
 * plane is nearer. */
#define KILN_MESH_NEAREST 0.01f

/* Bounds the pixels that a triangle may touch. low, high: the least and the greatest x and y of its
 * corners, px; width: of the picture, px. */
void kiln_mesh_bound(const float low[2], const float high[2], float width,
                     struct kiln_projected_triangle *flat);

/* Projects a triangle by planes over u and v of rays (u, v, -1) from an eye at the origin, in which
 * it spans a pyramid. Nearness is 1 / depth, 1/m. corner: in view space, m; frustum, principal:
 * as in struct kiln_view. nearest: where triangles are cut, m. *volume becomes the dot product of a
 * corner and the face's normal, *face, which is not unit. Returns false, with no pixels to draw,
 * for a triangle that is seen edge-on or lies beside the picture. */
bool kiln_mesh_project(const float3 corner[3], float4 frustum, float4 principal, float nearest,
                       struct kiln_projected_triangle *flat, float3 *face, float *volume);

#endif
