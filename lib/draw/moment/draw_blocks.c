/* This file uploads the uniform blocks of the view and of the backdrop for each picture and binds
 * them. */
#include "draw/moment/draw_blocks.h"

#include <assert.h>
#include <stddef.h>

static_assert(sizeof(struct kiln_view) == 160, "std140");
static_assert(offsetof(struct kiln_view, eye) == 48, "std140");
static_assert(sizeof(struct kiln_draw_light) == 176, "std140");
static_assert(offsetof(struct kiln_draw_backdrop, counts) == 96, "std140");
static_assert(offsetof(struct kiln_draw_backdrop, lights) == 112, "std140");
static_assert(sizeof(struct kiln_draw_backdrop) ==
                  208 + 176 * KILN_MOST_LAMPS + 16 * KILN_HAZE_PARTS,
              "std140, and no padding, which the backdrop would compare");
static_assert(sizeof(struct kiln_draw_backdrop) <= 16384, "what every GL allows a uniform block");

void kiln_draw_blocks_init(struct kiln_draw_blocks *blocks, struct kiln_device *device)
{
    kiln_buffer_init(&blocks->view, device, sizeof(struct kiln_view), "view");
    kiln_buffer_init(&blocks->backdrop, device, sizeof(struct kiln_draw_backdrop), "backdrop");
}

void kiln_draw_blocks_finish(struct kiln_draw_blocks *blocks)
{
    kiln_buffer_finish(&blocks->view);
    kiln_buffer_finish(&blocks->backdrop);
}

bool kiln_draw_blocks_bind(struct kiln_draw_blocks *blocks, const struct kiln_view *view,
                           const struct kiln_draw_backdrop *backdrop, struct kiln_error *error)
{
    GLuint view_buffer = kiln_buffer_upload(&blocks->view, view, error);
    GLuint backdrop_buffer = kiln_buffer_upload(&blocks->backdrop, backdrop, error);
    if (!view_buffer || !backdrop_buffer)
        return false;
    glBindBufferBase(GL_UNIFORM_BUFFER, KILN_BIND_VIEW, view_buffer);
    glBindBufferBase(GL_UNIFORM_BUFFER, KILN_BIND_BACKDROP, backdrop_buffer);
    return true;
}
