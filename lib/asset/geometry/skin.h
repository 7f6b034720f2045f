/* Declares meshes that move, from glTF and GLB files. Vertices follow bones (linear blend
 * skinning), or whole parts follow nodes. Clips animate bones, nodes and the weights of morph
 * targets. The bits are the same on every machine. */
#ifndef KILN_ASSET_GEOMETRY_SKIN_H
#define KILN_ASSET_GEOMETRY_SKIN_H

#include "asset/geometry/mesh.h"

enum {
    KILN_MAX_SKIN_NODES = 4096 + 1, /* those of a file, and a root of them */
    KILN_MAX_SKIN_JOINTS = 1024,    /* of one skin of a file */
    KILN_MAX_SKIN_BONES = 8192, /* joints of all skins, and nodes or instances that move parts */
    KILN_SKIN_INFLUENCES = 4,   /* the most bones that move one vertex */
    KILN_MAX_CLIPS = 256,
    KILN_MAX_CLIP_NAME = 64, /* bytes of a name, including the zero at its end */
    KILN_MAX_CLIP_CHANNELS = 1 << 15,
    KILN_MAX_CLIP_KEYS = 1 << 20,   /* keys of all clips of a file */
    KILN_MAX_SKIN_MORPHS = 4096,    /* morph targets whose weights clips move */
    KILN_MAX_CLIP_MORPHS = 1 << 14, /* such targets of all clips together */
    KILN_MAX_SKIN_DELTAS = 1 << 22, /* vertices of all such targets */
};

struct kiln_skin;

/* Load a mesh that moves, as kiln_mesh_load and kiln_mesh_parse do. KILN_INVALID_INPUT also when
 * the file has no animation. The caller destroys the skin. */
struct kiln_skin *kiln_skin_load(struct kiln_loader *loader, const char *path,
                                 struct kiln_error *error);
struct kiln_skin *kiln_skin_parse(const void *bytes, size_t size, const char *name,
                                  struct kiln_error *error);
void kiln_skin_destroy(struct kiln_skin **skin);

/* Returns the mesh in its rest pose, while no clip plays. Every pose has the same triangles. */
const struct kiln_mesh *kiln_skin_mesh(const struct kiln_skin *skin);

/* Returns the bytes of a skin and its mesh. */
uint64_t kiln_skin_bytes(const struct kiln_skin *skin);

/* Finds a clip by its name or, if no clip has that name, by its number from 0. KILN_INVALID_INPUT
 * with the list of clips after `name`, which stands for the file. */
bool kiln_skin_find_clip(const struct kiln_skin *skin, const char *clip, const char *name,
                         uint32_t *number, struct kiln_error *error);

uint32_t kiln_skin_bone_count(const struct kiln_skin *skin);
uint32_t kiln_skin_clip_count(const struct kiln_skin *skin);

/* Returns the name of a clip, which may be empty. */
const char *kiln_skin_clip_name(const struct kiln_skin *skin, uint32_t clip);

/* Returns the length of a clip, from 0 to its last key, s. */
float kiln_skin_clip_length(const struct kiln_skin *skin, uint32_t clip);

/* Computes position and unit normal of every vertex of kiln_skin_mesh, in units of the file, at a
 * moment of a clip. Before 0 and after the length, the pose stays that of the first and the last
 * moment. Any threads may call it at once; those that pose the same skin wait for each other. */
void kiln_skin_pose(const struct kiln_skin *skin, uint32_t clip, float seconds,
                    float (*vertices)[6]);

/* Writes a pose into the vertices of a mesh with as many vertices, and updates its bounds. */
void kiln_skin_pose_mesh(const struct kiln_skin *skin, uint32_t clip, float seconds,
                         struct kiln_mesh *mesh);

#endif
