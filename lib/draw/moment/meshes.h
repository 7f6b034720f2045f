/* A kiln_meshes holds the backdrop's meshes, in the space of their files, and its terrains. */
#ifndef KILN_DRAW_MOMENT_MESHES_H
#define KILN_DRAW_MOMENT_MESHES_H

#include "asset/geometry/skin.h"
#include "base/footprint.h"
#include "draw/moment/painted.h"

/* Holds the meshes in the order of the scene's objects; the arrays are indexed by mesh. */
struct kiln_meshes {
    uint32_t count;
    const struct kiln_mesh *loaded[KILN_MAX_MESHES]; /* the mesh to draw: the scene's, or `own` */
    struct kiln_mesh *own[KILN_MAX_MESHES];          /* a terrain, or a posed copy; else NULL */
    const struct kiln_skin *skins[KILN_MAX_MESHES];  /* NULL: the mesh is not animated */
    const struct kiln_animation *animations[KILN_MAX_MESHES];
    float posed_s[KILN_MAX_MESHES]; /* animation time of the pose, s; below 0: not posed yet */
    struct kiln_painted *painted;   /* paint on meshes; NULL: no mesh takes paint */
};

/* Collects the meshes of a scene, which must outlive them. Errors are those of kiln_terrain_create
 * and kiln_painted_create; kiln_meshes_finish must be called after an error, too. */
bool kiln_meshes_init(struct kiln_meshes *meshes, const struct kiln_scene *scene,
                      struct kiln_error *error);

/* Adds the memory of terrains, of copies of meshes that move, and of painted textures. */
void kiln_meshes_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);

/* Counts the vertices and triangles of all meshes of the backdrop, with those of terrains. */
void kiln_meshes_count(const struct kiln_scene *scene, uint64_t *vertices, uint64_t *triangles);

/* Poses the animated meshes for a clip time: their vertices and their bounds. */
void kiln_meshes_pose(struct kiln_meshes *meshes, float time_s);
void kiln_meshes_finish(struct kiln_meshes *meshes);

#endif
