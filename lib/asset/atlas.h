/* The textures of particles: every cell of every atlas is one layer of one mipmapped array texture,
 * so that systems of different looks draw in one call and every rasteriser samples alike (Heinz
 * 2019, 3.2.4; cells as layers do not bleed into each other). */
#ifndef KILN_ASSET_ATLAS_H
#define KILN_ASSET_ATLAS_H

#include "base/thread.h"
#include "gpu/device.h"
#include "shared/particle.h"

enum { KILN_ATLAS_CELL = 128 }; /* edge of a layer, px; cells of files are resized to it */

/* One system's cells. */
struct kiln_atlas_range {
    uint32_t first_layer, cells;
    uint32_t kind; /* KILN_CELL_MASK or KILN_CELL_COLOR (shared/draw_layout.h) */
};

struct kiln_atlas {
    GLuint texture; /* 2-D array, RGBA8, with mip levels */
    struct kiln_atlas_range systems[KILN_MAX_SYSTEMS];
    uint32_t layers;
};

/* What a system asks for: "builtin:NAME", or an image file cut into columns x rows cells. */
struct kiln_atlas_request {
    const char *source;
    uint32_t columns, rows;
};

/* Makes the texture for count systems; equal requests share layers. A file that is no image or does
 * not divide into the cells is KILN_INVALID_INPUT; more layers than the device has,
 * KILN_DEVICE_FAILED. */
bool kiln_atlas_init(struct kiln_atlas *atlas, struct kiln_device *device,
                     const struct kiln_atlas_request *requests, uint32_t count,
                     struct kiln_threads *threads, struct kiln_error *error);
void kiln_atlas_finish(struct kiln_atlas *atlas);

#endif
