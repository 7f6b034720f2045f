/* Declares rigs: the nodes of a glTF or GLB file with its cameras and the clips that move them,
 * without meshes. Poses are computed in IEEE doubles by + - * / and square roots alone, so every
 * machine gets the same bits. */
#ifndef KILN_ASSET_GEOMETRY_RIG_H
#define KILN_ASSET_GEOMETRY_RIG_H

#include <stdbool.h>
#include <stdint.h>

#include "kiln.h"

struct kiln_loader;

enum {
    KILN_MAX_RIG_NODES = 1 << 16,
    KILN_MAX_RIG_DEPTH = 1024, /* nodes from a root to a node that is posed */
    KILN_MAX_NODE_NAME = 64,   /* bytes of a name, including the zero at its end */
};

/* The camera that a node has. */
enum kiln_rig_camera { KILN_RIG_NO_CAMERA, KILN_RIG_PERSPECTIVE, KILN_RIG_ORTHOGRAPHIC };

/* No clip moves the nodes. */
#define KILN_RIG_AT_REST UINT32_MAX

struct kiln_rig;

/* Load the nodes of a file, as kiln_mesh_load and kiln_mesh_parse load its mesh. The caller
 * destroys the rig. */
struct kiln_rig *kiln_rig_load(struct kiln_loader *loader, const char *path,
                               struct kiln_error *error);
struct kiln_rig *kiln_rig_parse(const void *bytes, size_t size, const char *name,
                                struct kiln_error *error);
void kiln_rig_destroy(struct kiln_rig **rig);

uint64_t kiln_rig_bytes(const struct kiln_rig *rig);

/* Returns the SHA-256, in hex, of the hashes of the file and of those that it names. */
const char *kiln_rig_hash(const struct kiln_rig *rig);

/* Finds a node by its name or, if no node has that name, by its number in the file. joint: of nodes
 * of one name, joints of skins are meant, if there are any. KILN_INVALID_INPUT with the names that
 * there are after `name`, which stands for the file; also for a name of several nodes, and for a
 * node below more than KILN_MAX_RIG_DEPTH others. */
bool kiln_rig_find_node(const struct kiln_rig *rig, const char *node, bool joint, const char *name,
                        uint32_t *number, struct kiln_error *error);

/* Finds a clip as kiln_skin_find_clip does. */
bool kiln_rig_find_clip(const struct kiln_rig *rig, const char *clip, const char *name,
                        uint32_t *number, struct kiln_error *error);
uint32_t kiln_rig_clip_count(const struct kiln_rig *rig);
float kiln_rig_clip_length(const struct kiln_rig *rig, uint32_t clip);

/* Returns the camera of a node. *fov_rad becomes the vertical field of view of a perspective one.
 */
enum kiln_rig_camera kiln_rig_camera_of(const struct kiln_rig *rig, uint32_t node, double *fov_rad);

/* The least scale of a pose; a node that has less, or none, gets this one. */
#define KILN_RIG_LEAST_SCALE 1e-6

/* A scale of a node of a file that differs between its axes, mirrors or is too small. */
struct kiln_rig_scale {
    const char *name; /* of the node, or "" */
    uint32_t number;  /* of the node, in the file */
    double axes[3];
    double taken; /* the one scale that a pose has instead */
};

/* Finds such a scale of a node or of those above it, at rest or at a key of a clip. False: there is
 * none. */
bool kiln_rig_find_scale(const struct kiln_rig *rig, uint32_t node, uint32_t clip,
                         struct kiln_rig_scale *found);

/* A moment of a clip. */
struct kiln_rig_moment {
    uint32_t clip;        /* KILN_RIG_AT_REST: none, and the rest is not used */
    float seconds;        /* from 0 to the clip's length */
    float rate_seconds;   /* the same; rates are those at this moment */
    bool rate_is_behind;  /* at a key, rates are those before it */
    double clip_s_each_s; /* how fast the clip plays; 0: it stands */
};

/* The frame of a node in the file's space, and how fast it changes. A scale that differs between
 * axes is reduced: the frame has the direction of the node's z, y in the plane of z and the node's
 * y, and the scale along z. */
struct kiln_rig_pose {
    double at[3];
    double ahead[3], up[3]; /* unit vectors along z and y */
    double scale;
    double velocity[3]; /* per second */
    double spin[3];     /* rad/s */
    double growth;      /* of the scale, per second */
};

struct kiln_rig_pose kiln_rig_pose_at(const struct kiln_rig *rig, uint32_t node,
                                      const struct kiln_rig_moment *moment);

#endif
