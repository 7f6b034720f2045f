/* Draws hand-made opaque particles into float images before a backdrop. */
#ifndef KILN_TESTS_OPAQUE_H
#define KILN_TESTS_OPAQUE_H

#include "draw/solids/solids.h"
#include "support/drawing.h"

enum { WIDTH = 320, HEIGHT = 240, PIXELS = WIDTH * HEIGHT };

/* Images of WIDTH x HEIGHT pixels, which must be the size of the scene. */
struct fixture {
    struct drawing drawing;
    struct kiln_image depth, color, bloom;
    struct kiln_solids_stage *stage;
};

void opaque_init(struct fixture *f, struct kiln_device *device, const char *text,
                 const char *const *overrides, size_t count);
void opaque_finish(struct fixture *f);
void opaque_draw(struct fixture *f, uint32_t count);

#endif
