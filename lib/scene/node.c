/* This file computes the frames of nodes, and takes what is attached to a node to the world.
 *
 * A frame is the product of those of its chain of parents, and of the pose that a file of nodes
 * has. Its rates follow from those of values and paths by the rules of differentiation, so that a
 * simulation knows the way of a node between two steps to the fourth order. */
#include "scene/node.h"

#include <math.h>
#include <string.h>

#include "asset/geometry/rig.h"
#include "base/matrix.h"
#include "scene/scene.h"
#include "shared/exact.h"
#include "shared/random.h"

/* ---- quaternions of doubles: x, y, z, w
 * ------------------------------------------------------- */

static void cross(double y[3], const double a[3], const double b[3])
{
    y[0] = a[1] * b[2] - a[2] * b[1];
    y[1] = a[2] * b[0] - a[0] * b[2];
    y[2] = a[0] * b[1] - a[1] * b[0];
}

/* Rotates v by a unit quaternion. */
static void rotate(double y[3], const double turn[4], const double v[3])
{
    double across[3], more[3];
    cross(across, turn, v);
    cross(more, turn, across);
    for (int c = 0; c < 3; c++)
        y[c] = v[c] + 2 * (turn[3] * across[c] + more[c]);
}

/* Computes the rotation by b, then by a. y may be neither of them. */
static void multiply(double y[4], const double a[4], const double b[4])
{
    double square = 0;
    y[0] = a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1];
    y[1] = a[3] * b[1] + a[1] * b[3] + a[2] * b[0] - a[0] * b[2];
    y[2] = a[3] * b[2] + a[2] * b[3] + a[0] * b[1] - a[1] * b[0];
    y[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
    for (int c = 0; c < 4; c++)
        square += y[c] * y[c];
    for (int c = 0; c < 4; c++)
        y[c] /= sqrt(square);
}

/* Makes the quaternion of a rotation about one axis, by half of the angle. */
static void about_axis(double y[4], int axis, struct exact_angle half)
{
    y[0] = y[1] = y[2] = 0;
    y[axis] = (double)half.sine;
    y[3] = (double)half.cosine;
}

void kiln_node_turn_of_angles(float3 angles, double turn[4])
{
    double x[4], y[4], z[4], both[4];
    about_axis(x, 0, exact_sincos(0.5f * angles.x));
    about_axis(y, 1, exact_sincos(0.5f * angles.y));
    about_axis(z, 2, exact_sincos(0.5f * angles.z));
    multiply(both, y, x);
    multiply(turn, z, both);
}

/* Makes the quaternion of the rotation that takes z to `ahead` and y to `up`. */
static void turn_of_frame(double turn[4], const double ahead[3], const double up[3])
{
    double m[3][3]; /* columns */
    cross(m[0], up, ahead);
    memcpy(m[1], up, sizeof m[1]);
    memcpy(m[2], ahead, sizeof m[2]);
    const double trace = m[0][0] + m[1][1] + m[2][2];
    if (trace > 0) {
        const double s = 2 * sqrt(1 + trace);
        turn[0] = (m[1][2] - m[2][1]) / s;
        turn[1] = (m[2][0] - m[0][2]) / s;
        turn[2] = (m[0][1] - m[1][0]) / s;
        turn[3] = 0.25 * s;
        return;
    }
    const int i = m[0][0] > m[1][1] ? (m[0][0] > m[2][2] ? 0 : 2) : (m[1][1] > m[2][2] ? 1 : 2);
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double s = 2 * sqrt(1 + m[i][i] - m[j][j] - m[k][k]);
    turn[i] = 0.25 * s;
    turn[j] = (m[i][j] + m[j][i]) / s;
    turn[k] = (m[i][k] + m[k][i]) / s;
    turn[3] = (m[j][k] - m[k][j]) / s;
}

/* The rotation that takes the axis that is ahead to z, for each word of `ahead`. */
#define ROOT_HALF 0.70710678118654752
static const double TO_Z[][4] = {
    [KILN_AHEAD_Z] = {0, 0, 0, 1},
    [KILN_AHEAD_Y] = {ROOT_HALF, 0, 0, ROOT_HALF},
    [KILN_AHEAD_X] = {0, -ROOT_HALF, 0, ROOT_HALF},
    [KILN_AHEAD_MINUS_Z] = {0, 1, 0, 0},
    [KILN_AHEAD_MINUS_Y] = {-ROOT_HALF, 0, 0, ROOT_HALF},
    [KILN_AHEAD_MINUS_X] = {0, ROOT_HALF, 0, ROOT_HALF},
};

/* ---- frames ---------------------------------------------------------------------------------- */

/* The two moments of a frame, for values. */
struct moments {
    const float4 *keys;
    struct value_clocks now, rates;
};

static float rate_of(const struct moments *m, const struct kiln_value *value)
{
    return value_rate_at(m->keys, *value, m->rates);
}

static float3 rates_of(const struct moments *m, const struct kiln_value3 *value)
{
    return FLOAT3(rate_of(m, &value->x), rate_of(m, &value->y), rate_of(m, &value->z));
}

/* Sets the rotation by angles, and the spin that their rates are. */
static void set_rotation(struct kiln_node_frame *frame, const struct moments *m,
                         const struct kiln_value3 *rotation)
{
    const float3 angles = value3_at(m->keys, *rotation, m->now), rates = rates_of(m, rotation);
    double about_z[4], about_both[4], y[4], of_y[3], of_x[3];
    kiln_node_turn_of_angles(angles, frame->turn);
    about_axis(about_z, 2, exact_sincos(0.5f * angles.z));
    about_axis(y, 1, exact_sincos(0.5f * angles.y));
    multiply(about_both, about_z, y);
    rotate(of_y, about_z, (const double[3]){0, (double)rates.y, 0});
    rotate(of_x, about_both, (const double[3]){(double)rates.x, 0, 0});
    for (int c = 0; c < 3; c++)
        frame->spin[c] = of_x[c] + of_y[c] + (c == 2 ? (double)rates.z : 0);
}

/* Turns a frame along its path, outside of its own rotation. */
static void set_heading(struct kiln_node_frame *frame, const struct kiln_path_place *place,
                        enum kiln_ahead ahead)
{
    double along[4], heading[4], inside[4], spin[3];
    turn_of_frame(along, place->ahead, place->up);
    multiply(heading, along, TO_Z[ahead]);
    memcpy(inside, frame->turn, sizeof inside);
    multiply(frame->turn, heading, inside);
    rotate(spin, heading, frame->spin);
    for (int c = 0; c < 3; c++)
        frame->spin[c] = spin[c] + place->spin[c];
}

/* Returns the frame of a place, a rotation by angles and a scale. */
static struct kiln_node_frame frame_of(const struct moments *m, const struct kiln_value3 *position,
                                       const struct kiln_value3 *rotation,
                                       const struct kiln_value *scale)
{
    const float3 at = value3_at(m->keys, *position, m->now), velocity = rates_of(m, position);
    struct kiln_node_frame frame = {
        .at = {(double)at.x, (double)at.y, (double)at.z},
        .velocity = {(double)velocity.x, (double)velocity.y, (double)velocity.z},
        .scale = (double)value_at(m->keys, *scale, m->now),
        .growth = (double)rate_of(m, scale),
    };
    set_rotation(&frame, m, rotation);
    return frame;
}

/* Returns the frame in its parent that a node would have without its file. */
static struct kiln_node_frame frame_of_keys(const struct kiln_scene *scene,
                                            const struct kiln_scene_node *node,
                                            const struct moments *m)
{
    if (node->mesh) {
        const struct kiln_object *object = &scene->backdrop.objects[node->object];
        return frame_of(m, &object->center, &object->rotation, &object->scale);
    }
    struct kiln_node_frame frame =
        frame_of(m, &node->position.value, &node->rotation, &node->scale);
    if (node->position.path.points.count > 0) {
        const struct kiln_path_place place =
            kiln_path_at(&node->position.path, m->now.time_s, m->rates.time_s);
        memcpy(frame.at, place.at, sizeof frame.at);
        memcpy(frame.velocity, place.velocity, sizeof frame.velocity);
        if (node->heading == KILN_HEADING_PATH)
            set_heading(&frame, &place, node->ahead);
    }
    return frame;
}

/* Returns the frame of a node of a file in the file's space. */
static struct kiln_node_frame frame_of_file(const struct kiln_scene *scene, uint32_t node,
                                            const struct moments *m)
{
    const struct kiln_animation *animation = kiln_node_animation(scene, node);
    struct kiln_rig_moment moment = {.clip = KILN_RIG_AT_REST};
    if (animation)
        moment = (struct kiln_rig_moment){
            .clip = animation->number,
            .seconds = kiln_scene_animation_s(animation, m->now.time_s),
            .rate_seconds = kiln_scene_animation_s(animation, m->rates.time_s),
            .rate_is_behind = animation->speed.constant < 0.0f,
            .clip_s_each_s = (double)kiln_scene_animation_speed(animation, m->rates.time_s),
        };
    const struct kiln_scene_node *n = &scene->nodes[node];
    const struct kiln_rig_pose pose = kiln_rig_pose_at(n->rig, n->rig_node, &moment);
    struct kiln_node_frame frame = {.scale = pose.scale, .growth = pose.growth};
    memcpy(frame.at, pose.at, sizeof frame.at);
    memcpy(frame.velocity, pose.velocity, sizeof frame.velocity);
    memcpy(frame.spin, pose.spin, sizeof frame.spin);
    turn_of_frame(frame.turn, pose.ahead, pose.up);
    return frame;
}

/* Returns a frame that lies in another one, in the world. */
static struct kiln_node_frame inside_of(const struct kiln_node_frame *parent,
                                        const struct kiln_node_frame *own)
{
    struct kiln_node_frame frame = {.scale = parent->scale * own->scale,
                                    .growth =
                                        parent->growth * own->scale + parent->scale * own->growth};
    double at[3], moved[3], carried[3], spin[3], inside[3];
    rotate(at, parent->turn, own->at);
    rotate(spin, parent->turn, own->spin);
    for (int c = 0; c < 3; c++)
        inside[c] = parent->growth * own->at[c] + parent->scale * own->velocity[c];
    rotate(moved, parent->turn, inside);
    for (int c = 0; c < 3; c++)
        at[c] *= parent->scale;
    cross(carried, parent->spin, at);
    for (int c = 0; c < 3; c++) {
        frame.at[c] = parent->at[c] + at[c];
        frame.velocity[c] = parent->velocity[c] + carried[c] + moved[c];
        frame.spin[c] = parent->spin[c] + spin[c];
    }
    multiply(frame.turn, parent->turn, own->turn);
    return frame;
}

/* Returns the frame of a node in that of its parent. */
static struct kiln_node_frame own_frame(const struct kiln_scene *scene, uint32_t node,
                                        const struct moments *m)
{
    const struct kiln_scene_node *n = &scene->nodes[node];
    const struct kiln_node_frame outer = frame_of_keys(scene, n, m);
    if (!n->rig)
        return outer;
    const struct kiln_node_frame inner = frame_of_file(scene, node, m);
    return inside_of(&outer, &inner);
}

struct kiln_node_frame kiln_node_frame_at(const struct kiln_scene *scene, uint32_t node,
                                          float time_s, float rate_s)
{
    const uint32_t key = random_noise_key(scene->seed);
    const struct moments m = {scene->keys, value_clocks_at(time_s, key, key),
                              value_clocks_at(rate_s, key, key)};
    struct kiln_node_frame frame = own_frame(scene, node, &m);
    for (const struct kiln_attach *parent = kiln_node_outer(scene, node); parent->name;
         parent = kiln_node_outer(scene, parent->node)) {
        const struct kiln_node_frame outer = own_frame(scene, parent->node, &m);
        frame = inside_of(&outer, &frame);
    }
    return frame;
}

struct kiln_node_frame kiln_object_frame_at(const struct kiln_scene *scene,
                                            const struct kiln_object *object, float time_s,
                                            float rate_s)
{
    const uint32_t key = random_noise_key(scene->seed);
    const struct moments m = {scene->keys, value_clocks_at(time_s, key, key),
                              value_clocks_at(rate_s, key, key)};
    const struct kiln_scene_node own = {.position = {.value = object->center},
                                        .rotation = object->rotation,
                                        .scale = object->scale};
    const struct kiln_node_frame frame = frame_of_keys(scene, &own, &m);
    if (!object->attach.name)
        return frame;
    const struct kiln_node_frame outer =
        kiln_node_frame_at(scene, object->attach.node, time_s, rate_s);
    return inside_of(&outer, &frame);
}

/* ---- questions ------------------------------------------------------------------------------- */

const struct kiln_attach *kiln_node_outer(const struct kiln_scene *scene, uint32_t node)
{
    const struct kiln_scene_node *n = &scene->nodes[node];
    return n->mesh ? &scene->backdrop.objects[n->object].attach : &n->parent;
}

const struct kiln_animation *kiln_node_animation(const struct kiln_scene *scene, uint32_t node)
{
    const struct kiln_scene_node *n = &scene->nodes[node];
    const struct kiln_animation *animation =
        n->mesh ? &scene->backdrop.objects[n->object].animation : &n->animation;
    return n->rig && animation->enabled ? animation : NULL;
}

static bool are_constant(const struct kiln_value3 *position, const struct kiln_value3 *rotation,
                         const struct kiln_value *scale)
{
    return kiln_value3_is_constant(position) && kiln_value3_is_constant(rotation) &&
           scale->count == 0;
}

bool kiln_node_stands(const struct kiln_scene *scene, uint32_t node)
{
    const struct kiln_scene_node *n = &scene->nodes[node];
    const struct kiln_object *object = n->mesh ? &scene->backdrop.objects[n->object] : NULL;
    const struct kiln_attach *outer = kiln_node_outer(scene, node);
    const bool stands =
        n->position.path.points.count == 0 && !kiln_node_animation(scene, node) &&
        are_constant(&n->position.value, &n->rotation, &n->scale) &&
        (!object || are_constant(&object->center, &object->rotation, &object->scale));
    return stands && (!outer->name || kiln_node_stands(scene, outer->node));
}

bool kiln_node_carries(const struct kiln_scene *scene, uint32_t node, uint32_t other)
{
    const struct kiln_attach *outer = kiln_node_outer(scene, other);
    while (other != node && outer->name) {
        other = outer->node;
        outer = kiln_node_outer(scene, other);
    }
    return other == node;
}

/* ---- what is attached ------------------------------------------------------------------------ */

static float3 rotated(const struct kiln_node_frame *frame, float3 v, double scale)
{
    double y[3];
    rotate(y, frame->turn, (const double[3]){(double)v.x, (double)v.y, (double)v.z});
    return FLOAT3((float)(y[0] * scale), (float)(y[1] * scale), (float)(y[2] * scale));
}

float3 kiln_attached_point(const struct kiln_scene *scene, const struct kiln_attach *attach,
                           float3 point, float time_s)
{
    if (!attach->name)
        return point;
    const struct kiln_node_frame frame = kiln_node_frame_at(scene, attach->node, time_s, time_s);
    double y[3];
    rotate(y, frame.turn, (const double[3]){(double)point.x, (double)point.y, (double)point.z});
    return FLOAT3((float)(frame.at[0] + y[0] * frame.scale),
                  (float)(frame.at[1] + y[1] * frame.scale),
                  (float)(frame.at[2] + y[2] * frame.scale));
}

float3 kiln_attached_vector(const struct kiln_scene *scene, const struct kiln_attach *attach,
                            float3 vector, float time_s)
{
    if (!attach->name)
        return vector;
    const struct kiln_node_frame frame = kiln_node_frame_at(scene, attach->node, time_s, time_s);
    return rotated(&frame, vector, 1);
}

float kiln_attached_length(const struct kiln_scene *scene, const struct kiln_attach *attach,
                           float length, float time_s)
{
    if (!attach->name)
        return length;
    return (float)(kiln_node_frame_at(scene, attach->node, time_s, time_s).scale * (double)length);
}

void kiln_attached_rotation(const struct kiln_scene *scene, const struct kiln_attach *attach,
                            float columns[3][3], float time_s)
{
    if (!attach->name)
        return;
    const struct kiln_node_frame frame = kiln_node_frame_at(scene, attach->node, time_s, time_s);
    for (int c = 0; c < 3; c++) {
        const float3 y = rotated(&frame, FLOAT3(columns[c][0], columns[c][1], columns[c][2]), 1);
        columns[c][0] = y.x;
        columns[c][1] = y.y;
        columns[c][2] = y.z;
    }
}

void kiln_attached_velocity(const struct kiln_scene *scene, const struct kiln_attach *attach,
                            float3 point, float3 rate, float time_s, double velocity[3])
{
    const double at[3] = {(double)point.x, (double)point.y, (double)point.z};
    const double moves[3] = {(double)rate.x, (double)rate.y, (double)rate.z};
    double arm[3], own[3], around[3];
    memcpy(velocity, moves, sizeof moves);
    if (!attach->name)
        return;
    const struct kiln_node_frame frame = kiln_node_frame_at(scene, attach->node, time_s, time_s);
    rotate(arm, frame.turn, at);
    rotate(own, frame.turn, moves);
    cross(around, frame.spin, arm);
    for (int c = 0; c < 3; c++)
        velocity[c] =
            frame.velocity[c] + frame.scale * (own[c] + around[c]) + frame.growth * arm[c];
}

float3 kiln_object_center(const struct kiln_scene *scene, const struct kiln_object *object,
                          float time_s)
{
    return kiln_attached_point(scene, &object->attach,
                               kiln_scene_value3(scene, &object->center, time_s), time_s);
}

float3 kiln_object_size(const struct kiln_scene *scene, const struct kiln_object *object,
                        float time_s)
{
    const float3 size = kiln_scene_value3(scene, &object->size, time_s);
    if (!object->attach.name)
        return size;
    return float3_scale(size, kiln_attached_length(scene, &object->attach, 1.0f, time_s));
}

float3 kiln_object_axis(const struct kiln_scene *scene, const struct kiln_object *object,
                        float time_s)
{
    return kiln_attached_vector(scene, &object->attach,
                                kiln_scene_value3(scene, &object->axis, time_s), time_s);
}

float kiln_object_length(const struct kiln_scene *scene, const struct kiln_object *object,
                         const struct kiln_value *length, float time_s)
{
    return kiln_attached_length(scene, &object->attach, kiln_scene_value(scene, length, time_s),
                                time_s);
}

void kiln_object_rotation(const struct kiln_scene *scene, const struct kiln_object *object,
                          float time_s, float columns[3][3])
{
    kiln_scene_rotation(kiln_scene_value3(scene, &object->rotation, time_s), columns);
    kiln_attached_rotation(scene, &object->attach, columns, time_s);
}

struct kiln_camera_stand kiln_scene_camera_at(const struct kiln_scene *scene, float time_s)
{
    const struct kiln_camera *camera = &scene->camera;
    struct kiln_camera_stand stand = {
        .eye = kiln_scene_value3(scene, &camera->position, time_s),
        .target = kiln_scene_value3(scene, &camera->target, time_s),
        .up = FLOAT3(0.0f, 1.0f, 0.0f),
    };
    const float3 way = float3_sub(stand.target, stand.eye);
    const float square = float3_dot(way, way);
    const float rise = square < KILN_CAMERA_NO_WAY ? 0.0f : way.y / sqrtf(square);
    /* Where the camera looks straight down or up, the frame's up cannot be the picture's up. */
    if (fabsf(rise) > 0.9999f)
        stand.up = FLOAT3(0.0f, 0.0f, rise > 0.0f ? 1.0f : -1.0f);
    stand.eye = kiln_attached_point(scene, &camera->attach, stand.eye, time_s);
    stand.target = kiln_attached_point(scene, &camera->attach, stand.target, time_s);
    stand.up = kiln_attached_vector(scene, &camera->attach, stand.up, time_s);
    return stand;
}
