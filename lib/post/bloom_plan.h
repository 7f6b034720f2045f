/* A kiln_bloom_plan says at which sizes a bloom is blurred and with which weights. All techniques
 * follow the same plan. Sizes are parts of the picture's height, so a glow looks the same in
 * pictures of all sizes; only those of the thesis are counted in pixels. */
#ifndef KILN_POST_BLOOM_PLAN_H
#define KILN_POST_BLOOM_PLAN_H

#include "scene/scene.h"

enum {
    KILN_BLOOM_MAX_TAPS = 11,  /* of a Gaussian on one side, centre included */
    KILN_BLOOM_MAX_LEVELS = 6, /* reduced pictures, one smaller than the other */
};

struct kiln_bloom_level {
    uint32_t width, height; /* pixels */
    float ratio;            /* how many pixels of the level before are one pixel of this level along
                             * an axis; of level 0, how many of the source */
};

struct kiln_bloom_plan {
    enum kiln_bloom_kind kind; /* not KILN_BLOOM_NONE */
    uint32_t level_count;
    struct kiln_bloom_level levels[KILN_BLOOM_MAX_LEVELS];
    float scale;   /* size of the result divided by that of the source */
    uint32_t taps; /* of the Gaussian of each level on one side, centre included */
    float weights[KILN_BLOOM_MAX_TAPS]; /* from the centre outwards; those of both sides sum to 1 */
    uint32_t missing_levels;            /* of the pyramid: levels that are finer than the source */
};

/* Plans the bloom of the scene for a source of width x height pixels. The kind of bloom must not be
 * KILN_BLOOM_NONE. */
void kiln_bloom_plan_init(struct kiln_bloom_plan *plan, const struct kiln_scene *scene,
                          uint32_t width, uint32_t height);

/* Returns the part of the pyramid's levels below `level` when that level is mixed with them: 0 for
 * this level alone, 1 for the levels below it alone. radius: post.bloom.radius. */
float kiln_bloom_plan_radius(const struct kiln_bloom_plan *plan, uint32_t level, float radius);

#endif
