/* Declares the textures of particles. Every cell of every atlas is one layer of one mipmapped array
 * texture. So systems with different looks are drawn in one call, every rasteriser samples the same
 * texels, and cells do not bleed into each other (Heinz 2019, 3.2.4). */
#ifndef KILN_ASSET_ATLAS_ATLAS_H
#define KILN_ASSET_ATLAS_ATLAS_H

#include "base/footprint.h"
#include "base/thread.h"
#include "gpu/device.h"
#include "shared/draw_layout.h"
#include "shared/particle.h"

enum {
    KILN_ATLAS_LEVELS = 8,          /* levels with edges from KILN_ATLAS_CELL to 1 */
    KILN_ATLAS_LAYER_BYTES = 87412, /* bytes of all levels of a cell and of its strip, RGBA */
    KILN_ATLAS_MOTION = 32,         /* edge of a layer of motion, texels */
    KILN_ATLAS_MOVES_BYTES = 2 * KILN_ATLAS_MOTION * KILN_ATLAS_MOTION,
};

/* The cells of one texture. */
struct kiln_atlas_range {
    uint32_t first_layer, cells;
    uint32_t kind; /* KILN_CELL_MASK or KILN_CELL_COLOR (shared/draw_layout.h) */
    /* motion, in edges of the cell, that a full value of the motion texture stands for; 0: none */
    float motion;
};

/* The textures of a system; each particle has one of them. */
struct kiln_atlas_textures {
    struct kiln_atlas_range textures[KILN_MAX_TEXTURES];
    uint32_t count;
};

struct kiln_atlas {
    struct kiln_device *device; /* NULL: host only */
    uint8_t *texels;            /* levels, then strip, of each layer: KILN_ATLAS_LAYER_BYTES */
    /* motion towards the next cell, right and down, KILN_ATLAS_MOVES_BYTES a layer; */
    int8_t *moves;
    /* NULL when no cell moves */
    GLuint texture; /* 2-D array, RGBA8, with mip levels; 0 before kiln_atlas_send */
    GLuint strips;  /* 2-D array of the layers' strips, each one texel wide */
    GLuint motion;  /* 2-D array of the same layers, RG8_SNORM; 1 x 1 x 1 when no cell moves */
    struct kiln_atlas_textures systems[KILN_MAX_SYSTEMS];
    uint32_t layers;
};

/* The flipbooks that a system asks for. */
struct kiln_atlas_request {
    const char *const
        *sources;           /* "builtin:NAME", or image files cut into columns x rows cells, or */
    uint32_t count;         /* videos, whose first columns x rows frames are the cells; 1 to */
                            /* KILN_MAX_TEXTURES of them */
    uint32_t columns, rows; /* divide each source; a built-in flipbook has columns * rows cells */
    /* "none", "auto" (the motion that built-in flipbooks have) or an absolute path */
    const char *motion;
    /* of a file: the motion to the right and up, in edges of the cell, that full red and full green
     * stand for */
    float motion_full[2];
    struct kiln_loader *loader; /* opens the files; may be NULL */
};

/* Makes the cells for `count` systems, on the host. Equal flipbooks share layers. cache: a folder
 * of base/cache.h, where flipbooks are kept for other processes; NULL: none. A file that is neither
 * image nor video, or does not have the cells, is KILN_INVALID_INPUT. */
bool kiln_atlas_init(struct kiln_atlas *atlas, struct kiln_device *device,
                     const struct kiln_atlas_request *requests, uint32_t count, const char *cache,
                     struct kiln_threads *threads, struct kiln_error *error);

/* Adds the memory of an atlas, and of making it without a cache. Returns the number of its
 * layers. */
uint64_t kiln_atlas_footprint(const struct kiln_atlas_request *requests, uint32_t count,
                              struct kiln_footprint *footprint);

/* Uploads the two textures, unless they are there. Needs a device. KILN_DEVICE_FAILED when there
 * are more layers than the device allows. */
bool kiln_atlas_send(struct kiln_atlas *atlas, struct kiln_error *error);

/* Returns the texels of a level of a layer, rows from the top. */
const uint8_t *kiln_atlas_level(const struct kiln_atlas *atlas, uint32_t layer, uint32_t level);

void kiln_atlas_finish(struct kiln_atlas *atlas);

#endif
