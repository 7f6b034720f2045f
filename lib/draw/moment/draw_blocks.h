/* A kiln_draw_blocks holds two uniform blocks for techniques in GL: the view (the frame's camera),
 * and the backdrop with the lights on the particles. */
#ifndef KILN_DRAW_MOMENT_DRAW_BLOCKS_H
#define KILN_DRAW_MOMENT_DRAW_BLOCKS_H

#include "gpu/buffer.h"
#include "shared/draw_layout.h"

struct kiln_draw_blocks {
    struct kiln_buffer view, backdrop;
};

void kiln_draw_blocks_init(struct kiln_draw_blocks *blocks, struct kiln_device *device);
void kiln_draw_blocks_finish(struct kiln_draw_blocks *blocks);

/* Uploads both blocks and leaves them bound to KILN_BIND_VIEW and KILN_BIND_BACKDROP. */
bool kiln_draw_blocks_bind(struct kiln_draw_blocks *blocks, const struct kiln_view *view,
                           const struct kiln_draw_backdrop *backdrop, struct kiln_error *error);

#endif
