/* This file plans the blooms: the sizes of their reduced pictures and the weights of their filters.
 *
 * The Gaussian has a standard deviation that is a part of the picture's height. It is blurred in a
 * picture so small that its standard deviation is 2.5 pixels there, or in one of the source's size
 * where it is narrower. The reduction and the enlargement widen the glow, too. Their variances are
 * known, and the blur has the rest of the wanted variance. So the glow is a Gaussian of the wanted
 * width, within a hundredth of its peak, at any size.
 *
 * The pyramid always begins with a picture of 360 rows, or of 180, 90, ... where the source has
 * fewer rows, and halves it down to 12 rows. So each level is the same part of the picture's
 * height. Small pictures lack the finest levels, whose light their first level has.
 *
 * The thesis blurs by four passes of eleven taps of sigma 2: two at a third of the size, two at a
 * sixth (Heinz 2019, 3.2.5). Its glow has the same number of pixels in pictures of all sizes. */
#include "post/bloom_plan.h"

#include <math.h>

#include "shared/exact.h"

/* ---- filters --------------------------------------------------------------------------------- */

/* Sets the weights of a Gaussian of `taps` taps on one side, centre included. sigma: pixels. */
static void set_gaussian(struct kiln_bloom_plan *plan, float sigma, uint32_t taps)
{
    float sum = 0.0f;
    plan->taps = taps;
    for (uint32_t i = 0; i < taps; i++) {
        plan->weights[i] = exact_exp(-0.5f * (float)(i * i) / (sigma * sigma));
        sum += i == 0 ? plan->weights[i] : 2.0f * plan->weights[i];
    }
    for (uint32_t i = 0; i < taps; i++)
        plan->weights[i] /= sum;
}

/* Returns the number of pixels that hold `count` pixels after a reduction by a ratio. */
static uint32_t reduce(uint32_t count, float ratio)
{
    const float margin = 0.001f; /* so that rounding adds no pixel */
    const float reduced = ceilf((float)count / ratio - margin);
    return reduced > 1.0f ? exact_uint(reduced) : 1;
}

/* Appends a level that is reduced by a ratio. */
static void add_level(struct kiln_bloom_plan *plan, uint32_t width, uint32_t height, float ratio)
{
    plan->levels[plan->level_count++] =
        (struct kiln_bloom_level){reduce(width, ratio), reduce(height, ratio), ratio};
}

/* ---- kinds ----------------------------------------------------------------------------------- */

static void plan_thesis(struct kiln_bloom_plan *plan, uint32_t width, uint32_t height)
{
    add_level(plan, width, height, 3.0f);
    add_level(plan, plan->levels[0].width, plan->levels[0].height, 2.0f);
    plan->scale = 1.0f / 6.0f;
    set_gaussian(plan, 2.0f, 6);
}

static void plan_gaussian(struct kiln_bloom_plan *plan, uint32_t width, uint32_t height,
                          float sigma_part)
{
    const float reduced_sigma = 2.5f, reach = 4.0f; /* reach: in standard deviations */
    const float sigma = sigma_part * (float)height;
    const float ratio = exact_max(sigma / reduced_sigma, 1.0f);
    /* Variances in reduced pixels: 1/6 of the tent that reduces and that of the source's pixels,
     * which are squares; 1/3 of the cubic B-spline that enlarges (magnify.c). */
    const float wanted =
        (sigma * sigma - 1.0f / 12.0f) / (ratio * ratio) - 1.0f / 6.0f - 1.0f / 3.0f;
    const float blur = exact_sqrt(exact_max(wanted, 0.01f));
    add_level(plan, width, height, ratio);
    plan->scale = 1.0f / ratio;
    set_gaussian(plan, blur, exact_uint(ceilf(reach * blur)) + 1);
}

static void plan_pyramid(struct kiln_bloom_plan *plan, uint32_t width, uint32_t height)
{
    float rows = 360.0f; /* of level 0 */
    while (rows > (float)height && plan->missing_levels < KILN_BLOOM_MAX_LEVELS - 1) {
        rows *= 0.5f;
        plan->missing_levels++;
    }
    add_level(plan, width, height, exact_max((float)height / rows, 1.0f));
    plan->scale = 1.0f / plan->levels[0].ratio;
    while (plan->level_count + plan->missing_levels < KILN_BLOOM_MAX_LEVELS) {
        const struct kiln_bloom_level *last = &plan->levels[plan->level_count - 1];
        add_level(plan, last->width, last->height, 2.0f);
    }
}

void kiln_bloom_plan_init(struct kiln_bloom_plan *plan, const struct kiln_scene *scene,
                          uint32_t width, uint32_t height)
{
    *plan = (struct kiln_bloom_plan){.kind = scene->post.bloom};
    if (plan->kind == KILN_BLOOM_THESIS)
        plan_thesis(plan, width, height);
    else if (plan->kind == KILN_BLOOM_GAUSSIAN)
        plan_gaussian(plan, width, height, kiln_scene_value(scene, &scene->post.bloom_sigma, 0.0f));
    else
        plan_pyramid(plan, width, height);
}

float kiln_bloom_plan_radius(const struct kiln_bloom_plan *plan, uint32_t level, float radius)
{
    float below = radius;
    for (uint32_t i = 0; level == 0 && i < plan->missing_levels; i++)
        below *= radius;
    return below;
}
