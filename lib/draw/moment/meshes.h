/* A kiln_meshes holds the backdrop's meshes, in the space of their files, and its terrain. */
#ifndef KILN_DRAW_MOMENT_MESHES_H
#define KILN_DRAW_MOMENT_MESHES_H

#include "asset/geometry/skin.h"
#include "draw/moment/painted.h"

/* Holds the meshes in the scene's order. */
struct kiln_meshes {
    uint32_t count;
    const struct kiln_mesh *loaded[KILN_MAX_MESHES]; /* the scene's mesh or one of `own` */
    struct kiln_mesh *own[KILN_MAX_MESHES];          /* terrains and posed copies, or NULL */
    const struct kiln_skin *skins[KILN_MAX_MESHES];  /* of animated meshes; others NULL */
    const struct kiln_animation *animations[KILN_MAX_MESHES];
    float
        posed_s[KILN_MAX_MESHES]; /* where in its clip each of those is loaded; below 0: nowhere */
    struct kiln_painted *painted; /* NULL: none takes paint */
};

/* Collects the meshes of a scene that outlives them. Errors are those of kiln_terrain_create;
 * kiln_meshes_finish then frees what was made. */
bool kiln_meshes_init(struct kiln_meshes *meshes, const struct kiln_scene *scene,
                      struct kiln_error *error);

/* Poses the animated meshes, vertices and bounds, at a clip time. */
void kiln_meshes_pose(struct kiln_meshes *meshes, float time_s);
void kiln_meshes_finish(struct kiln_meshes *meshes);

#endif
