/* Draws hand-made opaque particles, which are spheres or meshes, together with a backdrop, into
 * images of 32-bit floats, for tests of lib/draw/solids. */
#ifndef KILN_TESTS_OPAQUE_H
#define KILN_TESTS_OPAQUE_H

#include "draw/solids/solids.h"
#include "support/drawing.h"

enum { WIDTH = 320, HEIGHT = 240, PIXELS = WIDTH * HEIGHT };

/* The stage that draws opaque particles, and its render targets of WIDTH x HEIGHT pixels. The
 * scene's output.size must be the same. */
struct fixture {
    struct drawing drawing;
    struct kiln_image depth, color, bloom;
    struct kiln_solids_stage *stage;
};

void opaque_init(struct fixture *f, struct kiln_device *device, const char *text,
                 const char *const *overrides, size_t count);
void opaque_finish(struct fixture *f);

/* Draws the first `count` particles that the test gave to drawing_place, and fetches all images to
 * the host. */
void opaque_draw(struct fixture *f, uint32_t count);

#endif
