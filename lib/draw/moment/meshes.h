/* The backdrop's meshes, in the space of their files, and its terrain. */
#ifndef KILN_DRAW_MOMENT_MESHES_H
#define KILN_DRAW_MOMENT_MESHES_H

#include "asset/geometry/skin.h"
#include "draw/moment/painted.h"

/* In the scene's order. */
struct kiln_meshes {
    uint32_t count;
    const struct kiln_mesh *loaded[KILN_MAX_MESHES]; /* the scene's, or its own: */
    struct kiln_mesh *own[KILN_MAX_MESHES];          /* terrain and poses; others have NULL here */
    const struct kiln_skin *skins[KILN_MAX_MESHES];  /* of those that move, and how: others NULL */
    const struct kiln_animation *animations[KILN_MAX_MESHES];
    float
        posed_s[KILN_MAX_MESHES]; /* where in its clip each of those is loaded; below 0: nowhere */
    struct kiln_painted *painted; /* NULL: none takes paint */
};

/* Of a scene that outlives them. Errors as of kiln_terrain_create; kiln_meshes_finish then frees
 * what there is. */
bool kiln_meshes_init(struct kiln_meshes *meshes, const struct kiln_scene *scene,
                      struct kiln_error *error);

/* Moves the vertices of those that move, and their bounds, to where they are at a clip time. */
void kiln_meshes_pose(struct kiln_meshes *meshes, float time_s);
void kiln_meshes_finish(struct kiln_meshes *meshes);

#endif
