/* What particles painted on the backdrop's meshes, as textures with mip levels for both techniques.
 */
#ifndef KILN_DRAW_MOMENT_PAINTED_H
#define KILN_DRAW_MOMENT_PAINTED_H

#include "asset/geometry/mesh.h"
#include "asset/image/pyramid.h"
#include "particles/pool.h"
#include "scene/scene.h"

struct kiln_painted;

/* meshes: those of the scene, in its order, the ones that take paint unwrapped; they are needed for
 * this call alone, the scene as long as it lives. NULL with an error, as kiln_chart_create. */
struct kiln_painted *kiln_painted_create(const struct kiln_scene *scene,
                                         const struct kiln_mesh *const *meshes,
                                         struct kiln_error *error);
void kiln_painted_destroy(struct kiln_painted **painted);

/* Brings the textures up to what is painted now. */
void kiln_painted_update(struct kiln_painted *painted, const struct kiln_pool *pool);

/* Of a mesh by its number: premultiplied colour and the part covered, which go on beyond triangles;
 * NULL: it takes none. */
const struct kiln_pyramid *kiln_painted_picture(const struct kiln_painted *painted, uint32_t mesh);

/* A number that grows with every change of a mesh's texture, from 1; and of all of them. */
uint32_t kiln_painted_changes(const struct kiln_painted *painted, uint32_t mesh);
uint64_t kiln_painted_all_changes(const struct kiln_painted *painted);

#endif
