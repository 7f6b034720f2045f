/* A kiln_coarse_images holds the images between a frame and its smaller picture, for both
 * techniques of converting between them. A coarse pixel stands for factor x factor of the frame's,
 * and the coarse picture has the same middle as the frame. */
#ifndef KILN_DRAW_SPRITES_COARSE_IMAGES_H
#define KILN_DRAW_SPRITES_COARSE_IMAGES_H

#include "base/thread.h"
#include "gpu/framebuffer.h"

struct kiln_coarse_images {
    uint32_t factor;          /* 2 or 4 */
    uint32_t width, height;   /* of the frame, px */
    float beyond_x, beyond_y; /* how far the coarse picture reaches beyond the frame's left and
                               * upper edge, px of the frame */
    bool mixed;
    struct kiln_image depth;             /* farthest in a coarse pixel, m */
    struct kiln_image edges;             /* 1 where, in the pixel or one of the eight around it, the
                                          * depth is not that of a plane; else 0 */
    struct kiln_image color, bloom;      /* of the particles, coarse */
    struct kiln_framebuffer framebuffer; /* of these two */
    /* If mixed, of the frame's size: the depth near edges, 0 elsewhere, where nothing can be seen;
     * the particles against it. */
    struct kiln_image fine_depth, fine_color, fine_bloom;
    struct kiln_framebuffer fine_framebuffer;
};

/* Describes how the particles of a pass are blended in the frame. */
struct kiln_coarse_blend {
    struct kiln_framebuffer *target; /* colour, and bloom if there is any; of the frame's size */
    bool keep_bloom, sum_alpha;      /* as of struct kiln_particles_draw */
};

#endif
