/* This file computes the view of a frame (matrix, frustum, times) from the scene's camera, in
 * arithmetic that gives the same bits on every machine. */
#include "draw/moment/view.h"

#include "base/matrix.h"
#include "shared/exact.h"

static const float FULL_TURN = 6.28318531f;

static float3 normalized(float3 v)
{
    float length = sqrtf(float3_dot(v, v));
    return (float3){v.x / length, v.y / length, v.z / length};
}

/* Returns v rotated about an axis of length 1, by Rodrigues' formula. */
static float3 rotate(float3 v, float3 axis, float angle)
{
    angle -= FULL_TURN * floorf(angle / FULL_TURN);
    const struct exact_angle turn = exact_sincos(angle);
    float3 across = float3_cross(axis, v);
    float along = float3_dot(axis, v) * (1.0f - turn.cosine);
    float3 sum = float3_add(float3_scale(v, turn.cosine), float3_scale(across, turn.sine));
    return float3_add(sum, float3_scale(axis, along));
}

/* Returns the unit direction from the eye to the target; -z where both are in one place, as when
 * key frames lead the eye through its target. */
static float3 forward_of(float3 position, float3 target)
{
    float3 forward = float3_sub(target, position);
    if (float3_dot(forward, forward) < 1e-12f)
        return (float3){0.0f, 0.0f, -1.0f};
    return normalized(forward);
}

/* Writes the inverse of the camera's pose. */
static void set_world_to_view(float3 right, float3 forward, float3 eye, float4 rows[3])
{
    const float3 up = float3_cross(right, forward);
    mat4 m = {{right.x, right.y, right.z, 0.0f},
              {up.x, up.y, up.z, 0.0f},
              {-forward.x, -forward.y, -forward.z, 0.0f},
              {eye.x, eye.y, eye.z, 1.0f}};
    glm_inv_tr(m);
    kiln_matrix_to_rows(m, rows);
}

struct kiln_view kiln_view_compute(const struct kiln_scene *scene, struct kiln_instant instant)
{
    const struct kiln_camera *camera = &scene->camera;
    float time_s = kiln_scene_instant_time(scene, instant);
    float3 position = kiln_scene_value3(scene, &camera->position, time_s);
    float3 target = kiln_scene_value3(scene, &camera->target, time_s);
    const struct exact_angle half_fov =
        exact_sincos(0.5f * kiln_scene_value(scene, &camera->fov, time_s));
    float roll = kiln_scene_value(scene, &camera->roll, time_s);

    float3 forward = forward_of(position, target), up = {0.0f, 1.0f, 0.0f};
    /* Where the camera looks straight down or up, the world's up cannot be the picture's up. */
    if (fabsf(forward.y) > 0.9999f)
        up = (float3){0.0f, 0.0f, forward.y > 0.0f ? 1.0f : -1.0f};
    if (roll != 0.0f)
        up = rotate(up, forward, roll);
    float3 right = normalized(float3_cross(forward, up));

    struct kiln_view view = {
        .eye = {position.x, position.y, position.z,
                kiln_scene_value(scene, &camera->near_plane, time_s)},
        .clock = {time_s, scene->dt_s, scene->dt_s * (float)scene->steps_per_frame, 1.0f},
        .clock_step = {instant.step, scene->seed, 0, 0},
        .within = {instant.back, 0.0f, 0.0f, 0.0f},
    };
    set_world_to_view(right, forward, position, view.world_to_view);
    float tan_y = half_fov.sine / half_fov.cosine;
    float width = (float)scene->width, height = (float)scene->height;
    view.frustum = (float4){tan_y * width / height, tan_y, width, height};
    return view;
}

struct kiln_view kiln_view_coarse(const struct kiln_view *view, uint32_t factor)
{
    struct kiln_view coarse = *view;
    float part = (float)factor;
    uint32_t width = ((uint32_t)view->frustum.z + factor - 1) / factor;
    uint32_t height = ((uint32_t)view->frustum.w + factor - 1) / factor;
    coarse.frustum = (float4){view->frustum.x * ((float)width * part / view->frustum.z),
                              view->frustum.y * ((float)height * part / view->frustum.w),
                              (float)width, (float)height};
    coarse.clock.w = view->clock.w / part;
    return coarse;
}

float3 kiln_view_forward(const struct kiln_view *view)
{
    const float4 *z = &view->world_to_view[2];
    return (float3){-z->x, -z->y, -z->z};
}
