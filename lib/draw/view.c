/* Scene camera to matrices. Only pictures depend on this, never the state, so cglm may be used. */
#include "draw/view.h"

#include <cglm/cglm.h>

static const float FULL_TURN = 6.28318531f;

struct kiln_view kiln_view_compute(const struct kiln_scene *scene, uint32_t step)
{
    const struct kiln_camera *camera = &scene->camera;
    float time_s = kiln_scene_time(scene, step);
    float3 position = kiln_scene_value3(scene, &camera->position, time_s);
    float3 target = kiln_scene_value3(scene, &camera->target, time_s);
    float fov = kiln_scene_value(scene, &camera->fov, time_s);
    float roll = kiln_scene_value(scene, &camera->roll, time_s);

    vec3 eye = {position.x, position.y, position.z};
    vec3 center = {target.x, target.y, target.z};
    vec3 up = {0.0f, 1.0f, 0.0f};
    vec3 forward;
    glm_vec3_sub(center, eye, forward);
    /* Keys may lead the eye through its target: any direction is better than none. */
    if (glm_vec3_norm2(forward) < 1e-12f) {
        glm_vec3_copy((vec3){0.0f, 0.0f, -1.0f}, forward);
        glm_vec3_add(eye, forward, center);
    }
    glm_vec3_normalize(forward);
    /* Straight down or up: the world's up says nothing about the picture's. */
    if (fabsf(forward[1]) > 0.9999f)
        glm_vec3_copy((vec3){0.0f, 0.0f, forward[1] > 0.0f ? 1.0f : -1.0f}, up);
    if (roll != 0.0f)
        glm_vec3_rotate(up, fmodf(roll, FULL_TURN), forward);

    mat4 m;
    glm_lookat(eye, center, up, m);

    struct kiln_view view = {
        .eye = {position.x, position.y, position.z,
                kiln_scene_value(scene, &camera->near_plane, time_s)},
        .clock = {time_s, scene->dt_s, scene->dt_s * (float)scene->steps_per_frame, 1.0f},
        .clock_step = {step, scene->seed, 0, 0},
    };
    for (int row = 0; row < 3; row++)
        view.world_to_view[row] = (float4){m[0][row], m[1][row], m[2][row], m[3][row]};
    float tan_y = tanf(0.5f * fov);
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
