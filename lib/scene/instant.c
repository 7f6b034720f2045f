/* This file computes what the moments of a frame are: when, and through which places of the pixels
 * and of the lens they are seen. A moment may lie within a step; then it is drawn between the
 * states before and after that step (lib/draw/moment/between.h).
 *
 * The moments of a frame are the points of a lattice over time, lens and pixel: the n-th of N in
 * time is number a n mod N on the lens and b n mod N in the pixel, where a and b are near the parts
 * of N that spread points evenly (powers of the inverse plastic number). So no place goes with a
 * time. The pattern is the same in all frames, so that nothing flickers. All moments have the same
 * weight: their places are as dense as the filter is high. */
#include "scene/instant.h"

#include "option/unit.h"
#include "shared/exact.h"

/* rad: the turn from a point of a spiral to the next one, after which no points line up. */
static const float GOLDEN_ANGLE = 2.39996323f;

/* The filter of pixels is a Gaussian, cut at FILTER_RADIUS. The surfaces themselves are
 * antialiased over a pixel, which makes the whole filter one of half a pixel's deviation. */
static const float FILTER_DEVIATION = 0.4f /* px */, FILTER_RADIUS = 1.0f /* px */;

/* Factors by which the lattice steps. */
static const double LENS_PART = 0.7548776662, PIXEL_PART = 0.5698402910;

uint32_t kiln_scene_moment_count(const struct kiln_scene *scene)
{
    const uint32_t times = scene->camera.shutter_samples, places = scene->pixel_samples;
    return times > places ? times : places;
}

static uint32_t greatest_divisor(uint32_t a, uint32_t b)
{
    while (b != 0) {
        const uint32_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* Returns the number of a moment's place, 0 to count - 1: each number once, and 0 for the last
 * moment. */
static uint32_t place_of(uint32_t moment, uint32_t count, double part)
{
    uint32_t stride = (uint32_t)(part * count);
    while (stride > 1 && greatest_divisor(stride, count) != 1)
        stride--;
    return (uint32_t)((uint64_t)stride * (moment + 1) % count);
}

struct place {
    float x, y;
};

static struct place place_on_spiral(uint32_t number, float radius)
{
    const struct exact_angle turn = exact_sincos((float)number * GOLDEN_ANGLE);
    return (struct place){radius * turn.cosine, radius * turn.sine};
}

/* Returns a place on the lens, in its radii. Place 0 is its middle, and the last one is at its rim;
 * between them the squares of the radii grow evenly, so that all parts of the disc get as much. */
static struct place place_on_lens(uint32_t number, uint32_t count)
{
    if (number == 0)
        return (struct place){0.0f, 0.0f};
    return place_on_spiral(number, sqrtf((float)number / (float)(count - 1)));
}

/* Returns a place in a pixel before the mean of all places is taken off, px: its distance from the
 * middle is the one that a part of the filter is within. */
static struct place place_under_filter(uint32_t number, uint32_t count)
{
    const float most = FILTER_RADIUS / FILTER_DEVIATION;
    const float whole = 1.0f - exact_exp(-0.5f * most * most);
    const float within = whole * ((float)number + 0.5f) / (float)count;
    const float ln = exact_log2(1.0f - within) * 0.693147181f;
    return place_on_spiral(number, FILTER_DEVIATION * sqrtf(exact_max(-2.0f * ln, 0.0f)));
}

/* Returns a place in a pixel, px. The mean of all places is the pixel's middle, so that the picture
 * does not shift. */
static struct place place_in_pixel(uint32_t number, uint32_t count)
{
    struct place sum = {0.0f, 0.0f};
    for (uint32_t i = 0; i < count; i++) {
        const struct place place = place_under_filter(i, count);
        sum = (struct place){sum.x + place.x, sum.y + place.y};
    }
    const struct place place = place_under_filter(number, count);
    return (struct place){place.x - sum.x / (float)count, place.y - sum.y / (float)count};
}

/* Returns the time of a moment. */
static struct kiln_instant time_of(const struct kiln_scene *scene, uint32_t frame, uint32_t moment)
{
    const double near_a_step = 1e-6;
    const struct kiln_camera *camera = &scene->camera;
    const uint32_t first = kiln_scene_frame_step(scene, frame);
    double after = scene->steps_per_frame * camera->shutter_phase / KILN_DEG(360);
    if (camera->shutter_samples > 1) {
        const double open_steps = scene->steps_per_frame * camera->shutter_angle / KILN_DEG(360);
        after += moment * open_steps / kiln_scene_moment_count(scene);
    }
    /* A moment that only rounding keeps from the end of a step is at its end. */
    const uint32_t whole = (uint32_t)(after + near_a_step);
    if (after - whole <= near_a_step)
        return kiln_instant_at_step(first + whole);
    return (struct kiln_instant){.step = first + whole + 1, .back = (float)(whole + 1 - after)};
}

struct kiln_instant kiln_scene_instant(const struct kiln_scene *scene, uint32_t frame,
                                       uint32_t moment)
{
    const uint32_t count = kiln_scene_moment_count(scene);
    struct kiln_instant instant = time_of(scene, frame, moment);
    const struct place lens = place_on_lens(place_of(moment, count, LENS_PART), count);
    instant.lens_x = lens.x;
    instant.lens_y = lens.y;
    if (scene->pixel_samples == 1)
        return instant;
    const struct place pixel = place_in_pixel(place_of(moment, count, PIXEL_PART), count);
    instant.pixel_x = pixel.x;
    instant.pixel_y = pixel.y;
    return instant;
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
