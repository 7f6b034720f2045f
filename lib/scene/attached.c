/* This file takes what is attached to a node to the world: points, vectors, lengths and rotations,
 * objects of the backdrop and the camera. */
#include <math.h>
#include <string.h>

#include "scene/double3.h"
#include "scene/node.h"
#include "scene/scene.h"

/* ---- what is attached ------------------------------------------------------------------------ */

static float3 rotated(const struct kiln_node_frame *frame, float3 v, double scale)
{
    double y[3];
    double3_rotate(y, frame->turn, (const double[3]){(double)v.x, (double)v.y, (double)v.z});
    return FLOAT3((float)(y[0] * scale), (float)(y[1] * scale), (float)(y[2] * scale));
}

float3 kiln_attached_point(const struct kiln_scene *scene, const struct kiln_attach *attach,
                           float3 point, float time_s)
{
    if (!attach->name)
        return point;
    const struct kiln_node_frame frame = kiln_node_frame_at(scene, attach->node, time_s, time_s);
    double y[3];
    double3_rotate(y, frame.turn,
                   (const double[3]){(double)point.x, (double)point.y, (double)point.z});
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

void kiln_frame_velocity(const struct kiln_node_frame *frame, float3 point, float3 rate,
                         double velocity[3])
{
    const double at[3] = {(double)point.x, (double)point.y, (double)point.z};
    const double moves[3] = {(double)rate.x, (double)rate.y, (double)rate.z};
    double arm[3], own[3], around[3];
    double3_rotate(arm, frame->turn, at);
    double3_rotate(own, frame->turn, moves);
    double3_cross(around, frame->spin, arm);
    for (int c = 0; c < 3; c++)
        velocity[c] =
            frame->velocity[c] + frame->scale * (own[c] + around[c]) + frame->growth * arm[c];
}

void kiln_attached_velocity(const struct kiln_scene *scene, const struct kiln_attach *attach,
                            float3 point, float3 rate, float time_s, double velocity[3])
{
    const double moves[3] = {(double)rate.x, (double)rate.y, (double)rate.z};
    memcpy(velocity, moves, sizeof moves);
    if (!attach->name)
        return;
    const struct kiln_node_frame frame = kiln_node_frame_at(scene, attach->node, time_s, time_s);
    kiln_frame_velocity(&frame, point, rate, velocity);
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
    const float3 eye = kiln_scene_value3(scene, &camera->position, time_s);
    const float3 target = kiln_scene_value3(scene, &camera->target, time_s);
    const float3 way = float3_sub(target, eye);
    const float square = float3_dot(way, way);
    const float rise = square < KILN_CAMERA_NO_WAY ? 0.0f : way.y / sqrtf(square);
    float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    /* The frame's up cannot be the picture's up if the camera looks straight down or up. */
    if (fabsf(rise) > 0.9999f)
        up = FLOAT3(0.0f, 0.0f, rise > 0.0f ? 1.0f : -1.0f);
    return (struct kiln_camera_stand){
        .eye = kiln_attached_point(scene, &camera->attach, eye, time_s),
        .way = kiln_attached_vector(scene, &camera->attach, way, time_s),
        .distance = kiln_attached_length(scene, &camera->attach, sqrtf(square), time_s),
        .up = kiln_attached_vector(scene, &camera->attach, up, time_s),
    };
}
