/* A kiln_painted holds the paint on the backdrop's meshes as textures with mip levels, for both
 * techniques of the backdrop. */
#ifndef KILN_DRAW_MOMENT_PAINTED_H
#define KILN_DRAW_MOMENT_PAINTED_H

#include "asset/geometry/mesh.h"
#include "asset/image/pyramid.h"
#include "base/footprint.h"
#include "particles/pool.h"
#include "scene/scene.h"

struct kiln_painted;

/* Makes the textures of the scene's meshes. meshes: in the scene's order, unwrapped where they take
 * paint; they need not outlive this call, but the scene must outlive the result. Returns NULL with
 * an error, as kiln_chart_create does. */
struct kiln_painted *kiln_painted_create(const struct kiln_scene *scene,
                                         const struct kiln_mesh *const *meshes,
                                         struct kiln_error *error);

/* Adds the memory of the painted textures of a scene. */
void kiln_painted_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_painted_destroy(struct kiln_painted **painted);

/* Updates the textures from the pool's paint. */
void kiln_painted_update(struct kiln_painted *painted, const struct kiln_pool *pool);

/* Returns the texture of a mesh by its number. A texel is premultiplied colour and the part that
 * paint covers; texels outside of triangles are filled in, too. Returns NULL for a mesh that takes
 * no paint. */
const struct kiln_pyramid *kiln_painted_picture(const struct kiln_painted *painted, uint32_t mesh);

/* kiln_painted_changes returns a number that grows with every change of a mesh's texture, from 1
 * on. kiln_painted_all_changes returns the sum of these numbers over all meshes. */
uint32_t kiln_painted_changes(const struct kiln_painted *painted, uint32_t mesh);
uint64_t kiln_painted_all_changes(const struct kiln_painted *painted);

#endif
