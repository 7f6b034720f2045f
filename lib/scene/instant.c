/* This file computes when the moments of a frame are. A moment may lie within a step; then it is
 * drawn between the states before and after that step (lib/draw/moment/between.h). */
#include "scene/instant.h"

#include "option/unit.h"

uint32_t kiln_scene_moment_count(const struct kiln_scene *scene)
{
    return scene->camera.shutter_samples;
}

struct kiln_instant kiln_scene_instant(const struct kiln_scene *scene, uint32_t frame,
                                       uint32_t moment)
{
    const double near_a_step = 1e-6;
    const struct kiln_camera *camera = &scene->camera;
    const double open_steps = scene->steps_per_frame * camera->shutter_angle / KILN_DEG(360);
    const double after = moment * open_steps / camera->shutter_samples;
    /* A moment that only rounding keeps from the end of a step is at its end. */
    const uint32_t whole = (uint32_t)(after + near_a_step);
    const uint32_t first = kiln_scene_frame_step(scene, frame);
    if (after - whole <= near_a_step)
        return kiln_instant_at_step(first + whole);
    return (struct kiln_instant){.step = first + whole + 1, .back = (float)(whole + 1 - after)};
}

float kiln_scene_instant_time(const struct kiln_scene *scene, struct kiln_instant instant)
{
    const double steps = (double)instant.step - (double)scene->warmup_steps - (double)instant.back;
    return (float)(steps * (double)scene->rate.den / (double)scene->rate.num);
}

bool kiln_scene_has_instants_between(const struct kiln_scene *scene)
{
    bool any = false;
    for (uint32_t i = 0; i < kiln_scene_moment_count(scene); i++)
        any = any || kiln_scene_instant(scene, 0, i).back > 0.0f;
    return any;
}

uint32_t kiln_scene_last_step(const struct kiln_scene *scene, uint32_t frame)
{
    return kiln_scene_instant(scene, frame, kiln_scene_moment_count(scene) - 1).step;
}
