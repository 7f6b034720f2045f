/* The textures of particles: every cell of every atlas is one layer of one mipmapped array texture,
 * so that systems of different looks draw in one call and every rasteriser samples alike (Heinz
 * 2019, 3.2.4; cells as layers do not bleed into each other). */
#ifndef KILN_ASSET_ATLAS_ATLAS_H
#define KILN_ASSET_ATLAS_ATLAS_H

#include "base/thread.h"
#include "gpu/device.h"
#include "shared/draw_layout.h"
#include "shared/particle.h"

enum {
    KILN_ATLAS_LEVELS = 8,          /* edges of KILN_ATLAS_CELL to 1 */
    KILN_ATLAS_LAYER_BYTES = 87380, /* RGBA of all levels of a cell */
    KILN_ATLAS_MOTION = 32,         /* edge of a layer of motion, texels */
    KILN_ATLAS_MOVES_BYTES = 2 * KILN_ATLAS_MOTION * KILN_ATLAS_MOTION,
};

/* The cells of one texture. */
struct kiln_atlas_range {
    uint32_t first_layer, cells;
    uint32_t kind; /* KILN_CELL_MASK or KILN_CELL_COLOR (shared/draw_layout.h) */
    float motion;  /* edges of the cell that a full value of the motion texture means; 0: none */
};

/* The textures of a system, of which each particle has one. */
struct kiln_atlas_textures {
    struct kiln_atlas_range textures[KILN_MAX_TEXTURES];
    uint32_t count;
};

struct kiln_atlas {
    struct kiln_device *device; /* NULL: host only */
    uint8_t *texels;            /* KILN_ATLAS_LAYER_BYTES a layer */
    int8_t *moves;  /* KILN_ATLAS_MOVES_BYTES a layer: pairs, where cells are on their way to the */
                    /* next, right and down; NULL when none moves */
    GLuint texture; /* 2-D array, RGBA8, with mip levels; 0 until it is sent */
    GLuint motion;  /* 2-D array of the same layers, RG8_SNORM; 1 x 1 x 1 when none moves */
    struct kiln_atlas_textures systems[KILN_MAX_SYSTEMS];
    uint32_t layers;
};

/* What a system asks for. */
struct kiln_atlas_request {
    const char *const
        *sources;           /* "builtin:NAME", or image files cut into columns x rows cells, or */
    uint32_t count;         /* videos, whose first columns x rows frames are the cells; 1 to */
                            /* KILN_MAX_TEXTURES of them */
    uint32_t columns, rows; /* a built-in flipbook is made with as many cells */
    const char *motion;     /* "none", "auto" (what built-in ones know) or an absolute path */
    float motion_scale;     /* of a file: edges of the cell that a full value means */
    struct kiln_loader *loader; /* of the files; may be NULL */
};

/* Makes the cells for count systems, on the host; equal ones share layers. cache: a folder of
 * base/cache.h, where flipbooks are kept for other processes; NULL: none. A file that is neither
 * image nor video or does not have the cells is KILN_INVALID_INPUT. */
bool kiln_atlas_init(struct kiln_atlas *atlas, struct kiln_device *device,
                     const struct kiln_atlas_request *requests, uint32_t count, const char *cache,
                     struct kiln_threads *threads, struct kiln_error *error);

/* Makes the two textures, unless they are there. Needs a device; more layers than that has are
 * KILN_DEVICE_FAILED. */
bool kiln_atlas_send(struct kiln_atlas *atlas, struct kiln_error *error);

/* The texels of a level of a layer, rows from the top. */
const uint8_t *kiln_atlas_level(const struct kiln_atlas *atlas, uint32_t layer, uint32_t level);

void kiln_atlas_finish(struct kiln_atlas *atlas);

#endif
