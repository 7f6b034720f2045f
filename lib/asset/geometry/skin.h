/* Meshes that move: vertices that follow bones (linear blend skinning) or whole parts that follow
 * nodes, and the clips that say how, out of glTF and GLB files. The same bits on every machine. */
#ifndef KILN_ASSET_GEOMETRY_SKIN_H
#define KILN_ASSET_GEOMETRY_SKIN_H

#include "asset/geometry/mesh.h"

enum {
    KILN_MAX_SKIN_NODES = 512,
    KILN_MAX_SKIN_BONES = 512,
    KILN_SKIN_INFLUENCES = 4, /* bones that move one vertex */
    KILN_MAX_CLIPS = 64,
    KILN_MAX_CLIP_NAME = 64, /* bytes, with the zero at its end */
    KILN_MAX_CLIP_CHANNELS = 1 << 14,
    KILN_MAX_CLIP_KEYS = 1 << 18, /* of all clips */
};

struct kiln_skin;

/* As kiln_mesh_load and kiln_mesh_parse, and KILN_INVALID_INPUT when nothing in the file moves, or
 * in ways that are none of nodes and bones with linear interpolation, or when the weights of a
 * vertex do not sum to one. The caller destroys it. */
struct kiln_skin *kiln_skin_load(struct kiln_loader *loader, const char *path,
                                 struct kiln_error *error);
struct kiln_skin *kiln_skin_parse(const void *bytes, size_t size, const char *name,
                                  struct kiln_error *error);
void kiln_skin_destroy(struct kiln_skin **skin);

/* Vertices where they are while no clip plays. Its triangles are those of every pose. */
const struct kiln_mesh *kiln_skin_mesh(const struct kiln_skin *skin);

/* A clip by its name or, where none is called so, by its number from 0. KILN_INVALID_INPUT with the
 * clips that there are, after `name`, which stands for the file. */
bool kiln_skin_find_clip(const struct kiln_skin *skin, const char *clip, const char *name,
                         uint32_t *number, struct kiln_error *error);

/* From 0 to its last key, s. */
float kiln_skin_clip_length(const struct kiln_skin *skin, uint32_t clip);

/* Position and unit normal of every vertex of kiln_skin_mesh, in its order and in units of the
 * file, at a moment of a clip; before 0 and after the length, nothing moves. */
void kiln_skin_pose(const struct kiln_skin *skin, uint32_t clip, float seconds,
                    float (*vertices)[6]);

/* kiln_skin_pose into the vertices of a mesh with as many, and the bounds that follow. */
void kiln_skin_pose_mesh(const struct kiln_skin *skin, uint32_t clip, float seconds,
                         struct kiln_mesh *mesh);

#endif
