/* A kiln_cells holds the cells of flipbooks as the CPU rasteriser samples them (Heinz 2019, 3.2.4,
 * equation 3.2). By its progress through life, a particle shows a mixture of two adjacent cells.
 * For a large particle the rasteriser samples both cells, and their motion. For a small particle of
 * a large system the two cells are mixed beforehand, along their motion: the part of the way
 * between them is rounded to one of KILN_CELL_PHASES, and the mixed cell is rounded to bytes and
 * kept. Large cells are not mixed, since so many of them would not stay in the processor's cache.
 *
 * The CPU rasteriser (particles_cpu.c) calls it for each piece of the particles: threads that make
 * sprites request cells (sprite_cells.h), then kiln_cells_mix makes those that are missing, then
 * threads that draw tiles sample them (tile_draw.h). Texels must stay as texels.h reads them. The
 * limits below decide only between speed and accuracy, but change pixels. */
#ifndef KILN_DRAW_SPRITES_CELLS_H
#define KILN_DRAW_SPRITES_CELLS_H

#include <stdatomic.h>

#include "asset/atlas/atlas.h"
#include "base/footprint.h"
#include "base/thread.h"

enum {
    KILN_CELL_PAIR = 4,    /* bytes of a texel of two channels (draw/sprites/texels.h) */
    KILN_CELL_MARGIN = 2,  /* columns besides the edge: the outer texels are repeated */
    KILN_CELL_PHASES = 16, /* steps from a cell to the next one */
    KILN_CELL_LEVELS = KILN_STRIP_LEVEL + 1,
    KILN_CELL_NUMBERS = KILN_CELL_PHASES * KILN_CELL_LEVELS, /* slots of a layer */

    /* The levels below are those of the atlas: level 0 has the largest cells, and each level has
     * half the edge of the one before. Cells of KILN_STRIP_LEVEL repeat the strip in all columns.
     */

    /* Mixed cells of KILN_CELL_MIXED_LEVEL have only every second phase, so that they fit into the
     * processor's cache. */
    KILN_CELL_LARGE_STEP = 2,
    /* Flipbooks with at least KILN_CELL_MANY cells change little from a cell to the next one. They
     * have only every second of the phases that others have, for the same reason. */
    KILN_CELL_MANY = 32,
    KILN_CELL_MANY_STEP = 2,
    /* Cells of this level and of coarser levels may be sampled in floats (KILN_CELL_FINE_MOST). */
    KILN_CELL_FINE_LEVEL = 3,
    /* Cells of this level and of coarser levels may be mixed, under the conditions below. */
    KILN_CELL_MIXED_LEVEL = 2,
};

/* Cells are mixed only for systems with at least this many slots. In a smaller system the error of
 * a single sprite is visible, and few sprites share a mixed cell. */
#define KILN_CELL_MIXED_LEAST (1u << 16)

/* In systems with at most this many slots, small cells without motion are sampled in floats, for
 * billboards that are parallel to the picture. Places that are rounded to a 255th of a texel have
 * an error that is visible where light falls off within a texel or two. */
#define KILN_CELL_FINE_MOST 1024u

struct kiln_cells;

/* Names a cell: phase / KILN_CELL_PHASES of the way from a layer of the atlas to the next one of
 * its texture, at a level of detail; phase 0 is the layer itself. */
struct kiln_cell_name {
    uint32_t layer, next_layer, phase, level;
    float motion; /* the `motion` of the texture's kiln_atlas_range */
};

/* Bounds the visible parts of a cell, of the next cell, and of all mixed cells between them, by
 * ranges of u, v, u + v and u - v, in parts of the edge. It is empty (from[0] >= to[0]) if all of
 * them are transparent everywhere. */
struct kiln_cell_hull {
    float from[4], to[4];
};

/* Prepares the cells of an atlas: finds hulls and lays out motion. The atlas must outlive the
 * result. Returns NULL with an error. */
struct kiln_cells *kiln_cells_create(const struct kiln_atlas *atlas, struct kiln_error *error);

/* Adds the memory of the cells of an atlas of so many layers. mixed: some systems are large enough
 * for mixed cells. */
void kiln_cells_footprint(uint64_t layers, bool mixed, struct kiln_footprint *footprint);
void kiln_cells_destroy(struct kiln_cells **cells);

/* Returns the number of a cell, which will exist after the next kiln_cells_mix. Any thread may call
 * it. */
uint32_t kiln_cells_request(struct kiln_cells *cells, const struct kiln_cell_name *name);

/* Makes the requested cells that do not exist yet: copies layers of the atlas for phase 0, mixes
 * them for other phases. Returns false with KILN_DEVICE_FAILED when memory is short. */
bool kiln_cells_mix(struct kiln_cells *cells, struct kiln_threads *threads,
                    struct kiln_error *error);

/* Names the forms that each cell has, for sprites that need some channels only. A form has the last
 * channels of RGBA, each in two bytes. */
enum kiln_cell_form {
    KILN_CELL_RGBA,
    KILN_CELL_HEAT_ALPHA, /* heat is the blue channel of masks */
    KILN_CELL_ALPHA,
    KILN_CELL_FORMS, /* number of forms */
};

/* Holds the laid-out forms of a cell; NULL: the cell is not made yet. */
struct kiln_cell_texels {
    uint8_t *forms[KILN_CELL_FORMS];
};

/* Returns the number of channels that a form has. */
static inline uint32_t kiln_cell_channels(enum kiln_cell_form form)
{
    return form == KILN_CELL_RGBA ? 4 : form == KILN_CELL_HEAT_ALPHA ? 2 : 1;
}

/* Holds the data that sampling reads. Cells have edge + 1 rows of edge + KILN_CELL_MARGIN texels:
 * the outer texels of the atlas's cell are repeated, so that a bilinear sample needs no clamping.
 * Motion is a cell of two channels, right and down, with the edge
 * KILN_ATLAS_MOTION: 128 stands for no motion, 128 + 127 for a full move. */
struct kiln_cells_content {
    const struct kiln_cell_texels *texels; /* by a cell's number */
    const atomic_bool
        *requested; /* by a cell's number; true: kiln_cells_request was called for it */
    const struct kiln_cell_hull *hulls;
    const uint8_t *moves; /* motion by layer, move_bytes each; NULL: no cell moves */
    size_t move_bytes;
};

struct kiln_cells_content kiln_cells_content(const struct kiln_cells *cells);

/* Returns the edge of the cells of a level, texels. */
static inline uint32_t kiln_cell_edge(uint32_t level)
{
    return level == KILN_STRIP_LEVEL ? KILN_ATLAS_STRIP : (uint32_t)KILN_ATLAS_CELL >> level;
}

/* Returns how many texels a laid-out cell has. */
static inline size_t kiln_cells_texels(size_t edge)
{
    return (edge + 1) * (edge + KILN_CELL_MARGIN);
}

/* Returns the motion from a cell's layer to the next one; NULL when no cell moves. */
static inline const uint8_t *kiln_cells_moves(const struct kiln_cells_content *content,
                                              uint32_t number)
{
    return content->moves ? content->moves + number / KILN_CELL_NUMBERS * content->move_bytes
                          : NULL;
}

/* Returns the hull of a cell; all phases of a layer and level share it. */
static inline const struct kiln_cell_hull *kiln_cells_hull(const struct kiln_cells_content *content,
                                                           uint32_t number)
{
    return &content
                ->hulls[number / KILN_CELL_NUMBERS * KILN_CELL_LEVELS + number % KILN_CELL_LEVELS];
}

#endif
