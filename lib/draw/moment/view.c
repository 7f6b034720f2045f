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

/* Returns the unit direction of the way from the eye to the target; -z where both are in one place,
 * as when key frames lead the eye through its target. */
static float3 forward_of(float3 way)
{
    if (float3_dot(way, way) < KILN_CAMERA_NO_WAY)
        return (float3){0.0f, 0.0f, -1.0f};
    return normalized(way);
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

/* Places the principal point right of and below the picture's middle, px. It is rounded to the grid
 * on which GL places corners (GL_SUBPIXEL_BITS), so that GL and the host round corners alike. */
static void set_principal(struct kiln_view *view, float right, float below)
{
    const float grid = 256.0f;
    const float x = floorf(right * grid + 0.5f) / grid, y = floorf(below * grid + 0.5f) / grid;
    const float4 frustum = view->frustum;
    view->principal =
        (float4){0.5f * frustum.z + x, 0.5f * frustum.w + y, x * (2.0f * frustum.x / frustum.z),
                 -y * (2.0f * frustum.y / frustum.w)};
}

/* Returns the distance of the plane of focus along the line of sight, m. */
static float focus_of(const struct kiln_scene *scene, float distance, float time_s)
{
    const float focus = kiln_scene_value(scene, &scene->camera.focus, time_s);
    return focus > 0.0f ? focus : exact_max(distance, 1e-3f);
}

/* Moves the eye to the instant's point of the lens, and the picture by what keeps the plane of
 * focus in its place. Moves the picture by the instant's place in the pixels, too. */
static void look_through(struct kiln_view *view, struct kiln_instant instant, float3 right,
                         float3 forward, float radius, float focus)
{
    const float3 up = float3_cross(right, forward);
    const float x = instant.lens_x * radius, y = instant.lens_y * radius;
    const float4 frustum = view->frustum;
    float3 eye = {view->eye.x, view->eye.y, view->eye.z};
    eye = float3_add_scaled(float3_add_scaled(eye, right, x), up, y);
    view->eye = (float4){eye.x, eye.y, eye.z, view->eye.w};
    set_world_to_view(right, forward, eye, view->world_to_view);
    set_principal(view, x / focus * (0.5f * frustum.z / frustum.x) - instant.pixel_x,
                  -y / focus * (0.5f * frustum.w / frustum.y) - instant.pixel_y);
}

struct kiln_view kiln_view_compute(const struct kiln_scene *scene, struct kiln_instant instant)
{
    const struct kiln_camera *camera = &scene->camera;
    float time_s = kiln_scene_instant_time(scene, instant);
    const struct kiln_camera_stand stand = kiln_scene_camera_at(scene, time_s);
    const float3 position = stand.eye;
    const struct exact_angle half_fov =
        exact_sincos(0.5f * kiln_scene_value(scene, &camera->fov, time_s));
    float roll = kiln_scene_value(scene, &camera->roll, time_s);

    float3 forward = forward_of(stand.way), up = stand.up;
    if (roll != 0.0f)
        up = rotate(up, forward, roll);
    float3 right = normalized(float3_cross(forward, up));

    struct kiln_view view = {
        .eye = {position.x, position.y, position.z,
                kiln_scene_value(scene, &camera->near_plane, time_s)},
        .clock = {time_s, scene->dt_s, scene->dt_s * (float)scene->steps_per_frame, 1.0f},
        .clock_step = {instant.step, scene->seed, 0, 0},
        .within = {instant.back, 0.0f, 0.0f, 0.0f},
        .exposure = {exact_exp2(kiln_scene_value(scene, &scene->post.exposure, time_s)), 0.0f, 0.0f,
                     0.0f},
    };
    float tan_y = half_fov.sine / half_fov.cosine;
    float width = (float)scene->width, height = (float)scene->height;
    view.frustum = (float4){tan_y * width / height, tan_y, width, height};
    look_through(&view, instant, right, forward,
                 0.5f * kiln_scene_value(scene, &camera->aperture, time_s),
                 focus_of(scene, stand.distance, time_s));
    return view;
}

struct kiln_view kiln_view_coarse(const struct kiln_view *view, uint32_t factor)
{
    struct kiln_view coarse = *view;
    float part = (float)factor;
    uint32_t width = (exact_uint(view->frustum.z) + factor - 1) / factor;
    uint32_t height = (exact_uint(view->frustum.w) + factor - 1) / factor;
    coarse.frustum = (float4){view->frustum.x * ((float)width * part / view->frustum.z),
                              view->frustum.y * ((float)height * part / view->frustum.w),
                              (float)width, (float)height};
    coarse.clock.w = view->clock.w / part;
    const float x = (view->principal.x - 0.5f * view->frustum.z) / part;
    const float y = (view->principal.y - 0.5f * view->frustum.w) / part;
    coarse.principal = (float4){0.5f * coarse.frustum.z + x, 0.5f * coarse.frustum.w + y,
                                view->principal.z, view->principal.w};
    return coarse;
}

float3 kiln_view_forward(const struct kiln_view *view)
{
    const float4 *z = &view->world_to_view[2];
    return (float3){-z->x, -z->y, -z->z};
}
