/* A frame is the mean of moments, one by default. This header says when each of them is. */
#ifndef KILN_SCENE_INSTANT_H
#define KILN_SCENE_INSTANT_H

#include "scene/scene.h"

/* The time of a drawn moment, which may lie within a step, and what it is seen through: a place in
 * each pixel, and a point of the lens. */
struct kiln_instant {
    uint32_t step; /* steps to run before the moment is drawn: the moment is not after their end */
    float back;    /* time from the moment to the end of these steps, in steps: 0 to below 1 */
    float pixel_x, pixel_y; /* px right of and below the middle of each pixel */
    float lens_x, lens_y;   /* to the right and up from the middle of the lens, in its radii */
};

/* Returns the instant at the end of a step, seen through the middles of pixels and of the lens. */
static inline struct kiln_instant kiln_instant_at_step(uint32_t step)
{
    return (struct kiln_instant){.step = step};
}

/* Returns the number of moments whose mean is a frame. */
uint32_t kiln_scene_moment_count(const struct kiln_scene *scene);

/* Returns one of a frame's moments: 0 to kiln_scene_moment_count() - 1. The moments lie evenly in
 * the time that the shutter is open, which starts at the frame's own time or by the shutter's phase
 * later, and ends before the next frame. No moment is before the one with the number below it. The
 * places in the pixels and on the lens are the same in all frames; the last moment is seen through
 * the middle of the lens, as a pinhole would see it. */
struct kiln_instant kiln_scene_instant(const struct kiln_scene *scene, uint32_t frame,
                                       uint32_t moment);

/* Returns whether two instants are at the same time. */
static inline bool kiln_instants_coincide(struct kiln_instant a, struct kiln_instant b)
{
    return a.step == b.step && a.back == b.back;
}

/* Returns the clip time of an instant, s. */
float kiln_scene_instant_time(const struct kiln_scene *scene, struct kiln_instant instant);

/* Returns whether any moment of a frame lies within a step, which is the same in all frames. */
bool kiln_scene_has_instants_between(const struct kiln_scene *scene);

/* Returns the number of steps to run before all moments of a frame are drawn. */
uint32_t kiln_scene_last_step(const struct kiln_scene *scene, uint32_t frame);

#endif
