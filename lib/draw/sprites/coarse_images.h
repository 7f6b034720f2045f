/* A kiln_coarse_images holds the images that particles at a coarse resolution need, for conversion
 * on the host and in GL. A coarse pixel covers factor x factor pixels of the frame, and the coarse
 * picture has the same middle as the frame. */
#ifndef KILN_DRAW_SPRITES_COARSE_IMAGES_H
#define KILN_DRAW_SPRITES_COARSE_IMAGES_H

#include "base/thread.h"
#include "gpu/framebuffer.h"

struct kiln_coarse_images {
    uint32_t factor;          /* 2 or 4 */
    uint32_t width, height;   /* size of the frame, px */
    float margin_x, margin_y; /* how far the coarse picture reaches beyond the frame's left and
                               * upper edge, px of the frame */
    bool mixed;               /* true: particles near edges are drawn at full resolution, too */
    struct kiln_image depth;  /* the farthest depth in each coarse pixel, m */
    /* 1 where the depths in a coarse pixel, or in one of the eight around it, do not lie on a
     * plane; else 0 */
    struct kiln_image edges;
    struct kiln_image color, bloom;      /* the particles at the coarse resolution */
    struct kiln_framebuffer framebuffer; /* the framebuffer of color and bloom */
    /* These exist only if mixed, with the frame's size. fine_depth is the depth near edges and 0
     * elsewhere, so that no particle is visible there; the other two show the particles with it. */
    struct kiln_image fine_depth, fine_color, fine_bloom;
    struct kiln_framebuffer fine_framebuffer;
};

/* Describes how the particles of a pass are blended in the frame. */
struct kiln_coarse_blend {
    struct kiln_framebuffer *target; /* colour, and bloom if there is any, of the frame's size */
    bool keep_bloom, sum_alpha;      /* as in struct kiln_particles_draw */
};

#endif
