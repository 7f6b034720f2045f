/* Declares nodes: places in a scene that move and turn, to which emitters, objects, lights and the
 * camera are attached. What is attached lies in the node's frame: z is ahead, y up and x left.
 *
 * A pose at a time is exact: it does not depend on the steps of a simulation. It is computed in
 * IEEE doubles from values of the scene and from paths, so every machine gets the same bits. */
#ifndef KILN_SCENE_NODE_H
#define KILN_SCENE_NODE_H

#include <stdbool.h>
#include <stdint.h>

#include "scene/animation.h"
#include "scene/path.h"
#include "shared/platform.h"

struct kiln_object;
struct kiln_rig;
struct kiln_scene;

enum { KILN_MAX_NODES = 256 };

enum kiln_heading {
    KILN_HEADING_FIXED, /* the rotation alone turns the node */
    KILN_HEADING_PATH,  /* an axis points along the path of the node's position */
};

enum kiln_ahead {
    KILN_AHEAD_Z,
    KILN_AHEAD_Y,
    KILN_AHEAD_X,
    KILN_AHEAD_MINUS_Z,
    KILN_AHEAD_MINUS_Y,
    KILN_AHEAD_MINUS_X,
};

/* Names the node that a part of a scene is attached to. */
struct kiln_attach {
    const char *name; /* NULL: none, the part lies in the world */
    uint32_t node;    /* follows: number of the node */
};

/* A position: a value over time, or a path if that has points. */
struct kiln_node_position {
    struct kiln_value3 value; /* m */
    struct kiln_path path;
};

struct kiln_scene_node {
    const char *name;
    struct kiln_attach parent;
    struct kiln_node_position position; /* in the parent's frame */
    struct kiln_value3 rotation;        /* rad: about x, then y, then z; within `heading` */
    enum kiln_heading heading;
    enum kiln_ahead ahead; /* the axis that `heading` turns along the path */
    struct kiln_value scale;
    const char *file;                /* absolute path of a glTF file; NULL: none */
    const char *file_node;           /* the node of the file, by name or number */
    struct kiln_animation animation; /* of the file */
    const char *mesh;  /* the name of an object, in whose frame the node lies; NULL: none */
    const char *joint; /* the joint of its file, by name or number */
    uint32_t object;   /* follows: the number of the object */
    /* follows, of both: the nodes of the file, of which one moves this node within its frame */
    const struct kiln_rig *rig;
    uint32_t rig_node;
};

/* The frame of a node in the world, and how fast it changes. */
struct kiln_node_frame {
    double at[3];       /* m */
    double turn[4];     /* unit quaternion from the frame to the world: x, y, z, w */
    double scale;       /* metres in one unit of the frame */
    double velocity[3]; /* m/s */
    double spin[3];     /* rad/s, about an axis of the world */
    double growth;      /* of the scale, 1/s */
};

/* Returns the frame of a node at a clip time. Its rates are those just before or at another time:
 * where a value has a corner or jumps, the rate before it is another one. */
struct kiln_node_frame kiln_node_frame_at(const struct kiln_scene *scene, uint32_t node,
                                          float time_s, float rate_s);

/* Returns the frame of an object of the backdrop that is a mesh, in the same way. */
struct kiln_node_frame kiln_object_frame_at(const struct kiln_scene *scene,
                                            const struct kiln_object *object, float time_s,
                                            float rate_s);

/* The frames of a node at both ends of a step. */
struct kiln_node_step {
    struct kiln_node_frame start, end;
    /* The end of a node that does not jump: where the place, the rotation or the scale of the node,
     * or of one of its parents, jumps within the step, that part goes on as before in its parent's
     * frame. Without a jump, this is `end`. */
    struct kiln_node_frame on;
    bool jumps;
};

/* Returns the frames of a node at both ends of a step, from 1. The rates at the end are those just
 * before. */
struct kiln_node_step kiln_node_step_at(const struct kiln_scene *scene, uint32_t node,
                                        uint32_t step);

/* Returns those of an object of the backdrop that is a mesh. */
struct kiln_node_step kiln_object_step_at(const struct kiln_scene *scene,
                                          const struct kiln_object *object, uint32_t step);

/* Returns the quaternion of the rotation about x, then y, then z, by angles in radians. */
void kiln_node_turn_of_angles(float3 angles, double turn[4]);

/* Returns the node that a node lies in: its parent, or that of the object whose joint it is. */
const struct kiln_attach *kiln_node_outer(const struct kiln_scene *scene, uint32_t node);

/* Returns the animation that moves a node within its file, or NULL. */
const struct kiln_animation *kiln_node_animation(const struct kiln_scene *scene, uint32_t node);

/* Returns whether a node, with all of its parents, has one frame at all times. */
bool kiln_node_stands(const struct kiln_scene *scene, uint32_t node);

/* Returns whether a node is another one or one of its parents, near or far. */
bool kiln_node_carries(const struct kiln_scene *scene, uint32_t node, uint32_t other);

/* Take what is attached from the node's frame to the world at a clip time: a point, a vector that
 * keeps its length, a length, and a rotation as the columns of a matrix. What is not attached stays
 * as it is, to the bit. */
float3 kiln_attached_point(const struct kiln_scene *scene, const struct kiln_attach *attach,
                           float3 point, float time_s);
float3 kiln_attached_vector(const struct kiln_scene *scene, const struct kiln_attach *attach,
                            float3 vector, float time_s);
float kiln_attached_length(const struct kiln_scene *scene, const struct kiln_attach *attach,
                           float length, float time_s);
void kiln_attached_rotation(const struct kiln_scene *scene, const struct kiln_attach *attach,
                            float columns[3][3], float time_s);

/* Computes the velocity in the world, m/s, of a point that moves by `rate` in a frame. */
void kiln_frame_velocity(const struct kiln_node_frame *frame, float3 point, float3 rate,
                         double velocity[3]);

/* Computes the velocity in the world, m/s, of a point that is attached and moves by `rate` in the
 * node's frame. */
void kiln_attached_velocity(const struct kiln_scene *scene, const struct kiln_attach *attach,
                            float3 point, float3 rate, float time_s, double velocity[3]);

/* Return what an object is in the world at a clip time: its centre, its edges, the direction of its
 * axis, a radius or height, and its rotation. */
float3 kiln_object_center(const struct kiln_scene *scene, const struct kiln_object *object,
                          float time_s);
float3 kiln_object_size(const struct kiln_scene *scene, const struct kiln_object *object,
                        float time_s);
float3 kiln_object_axis(const struct kiln_scene *scene, const struct kiln_object *object,
                        float time_s);
float kiln_object_length(const struct kiln_scene *scene, const struct kiln_object *object,
                         const struct kiln_value *length, float time_s);
void kiln_object_rotation(const struct kiln_scene *scene, const struct kiln_object *object,
                          float time_s, float columns[3][3]);

/* Below this square of the way from the eye to the target, the camera looks along -z. */
#define KILN_CAMERA_NO_WAY 1e-12f

/* The place and the line of sight of the camera, in the world. */
struct kiln_camera_stand {
    float3 eye; /* m */
    float3 way; /* the direction from the eye to the target, as long as the way in its node is */
    float distance; /* from the eye to the target, m */
    float3 up;      /* unit vector, of which the part across the line of sight counts */
};

struct kiln_camera_stand kiln_scene_camera_at(const struct kiln_scene *scene, float time_s);

#endif
