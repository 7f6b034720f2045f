/* A kiln_cells holds the cells of flipbooks as the CPU rasteriser samples them (Heinz 2019, 3.2.4,
 * equation 3.2). A particle is between two cells, by its progress through life. For a large
 * particle the rasteriser samples both cells, and their motion. For a small particle of a large
 * system the two cells are mixed beforehand: the part of the way between them is rounded to one of
 * KILN_CELL_PHASES, and the mixed cell is rounded to bytes and kept. Large cells are not mixed,
 * since so many of them would not stay in the processor's cache.
 *
 * The CPU rasteriser (particles_cpu.c) calls it for each piece of the particles: threads that make
 * sprites want cells (sprite_cells.h), then kiln_cells_mix makes those that are missing, then
 * threads that draw tiles sample them (tile_draw.h). Texels must stay as texels.h reads them. The
 * limits below decide only between speed and accuracy, but change pixels. */
#ifndef KILN_DRAW_SPRITES_CELLS_H
#define KILN_DRAW_SPRITES_CELLS_H

#include <stdatomic.h>

#include "asset/atlas/atlas.h"
#include "base/thread.h"

enum {
    KILN_CELL_TEXEL = 8,   /* bytes of a texel of four channels (draw/sprites/texels.h) */
    KILN_CELL_PAIR = 4,    /* bytes of a texel of two channels */
    KILN_CELL_MARGIN = 2,  /* columns besides the edge: the outer texels stand twice */
    KILN_CELL_PHASES = 16, /* steps from a cell to the next one */
    KILN_CELL_NUMBERS = KILN_CELL_PHASES * KILN_ATLAS_LEVELS, /* cells of a layer */

    /* The levels below are those of the atlas: level 0 has the largest cells, and each level has
     * half the edge of the one before. */

    /* Mixed cells of KILN_CELL_MIXED_LEVEL have only every second phase, so that they fit the
     * cache. */
    KILN_CELL_LARGE_STEP = 2,
    /* Cells of this level and of smaller ones may be sampled by floats (KILN_CELL_FINE_MOST). */
    KILN_CELL_FINE_LEVEL = 3,
    /* Cells of this level and of smaller ones may be mixed, under the conditions below. */
    KILN_CELL_MIXED_LEVEL = 2,
};

/* Cells are mixed if nothing in them moves farther than this, texels. Mixing blurs what moves. */
#define KILN_CELL_MIXED_MOVE 0.5f

/* Cells are mixed for systems of at least so many slots. In a smaller system each sprite is seen
 * alone with its error, and hardly two sprites share a mixed cell. */
#define KILN_CELL_MIXED_LEAST (1u << 16)

/* In systems of at most so many slots, small cells without motion are sampled by floats, for
 * billboards that lie in the plane of the picture. A place that is rounded to bytes has an error
 * which shows where light falls off within a texel or two. */
#define KILN_CELL_FINE_MOST 1024u

struct kiln_cells;

/* Names a cell: phase / KILN_CELL_PHASES of the way from a layer of the atlas to the next one of
 * its texture, at a level of detail; phase 0 is the layer itself. */
struct kiln_cell_name {
    uint32_t layer, next_layer, phase, level;
    float motion; /* how far the texture's motion goes, as kiln_atlas_range says */
};

/* Holds where a cell, the one after it, and all mixed cells between them are visible: ranges of u,
 * v, u + v and u - v, in parts of the edge. It is empty (from[0] >= to[0]) where they are clear all
 * over. */
struct kiln_cell_hull {
    float from[4], to[4];
};

/* Lays the cells of an atlas out for sampling. The atlas must outlive them. Returns NULL with an
 * error. */
struct kiln_cells *kiln_cells_create(const struct kiln_atlas *atlas, struct kiln_error *error);
void kiln_cells_destroy(struct kiln_cells **cells);

/* Returns the number of a cell, which will exist after the next kiln_cells_mix. Any thread may call
 * it. */
uint32_t kiln_cells_want(struct kiln_cells *cells, const struct kiln_cell_name *name);

/* Mixes the wanted cells that do not exist yet. */
bool kiln_cells_mix(struct kiln_cells *cells, struct kiln_threads *threads,
                    struct kiln_error *error);

/* Holds the data that sampling reads. Cells are edge + 1 rows of edge + KILN_CELL_MARGIN texels, in
 * which the outer texels of the atlas's cell are repeated, so that a sample between two needs no
 * clamping. After each cell comes a copy with only heat and alpha (blue and alpha), for sprites
 * that need no more. Motion is a cell of two channels with KILN_ATLAS_MOTION for an edge: right and
 * down, 128 for none, 127 more for a full move. */
struct kiln_cells_content {
    const uint8_t *const *texels; /* by a cell's number; NULL: the cell is not mixed yet */
    const atomic_bool *wanted;    /* by a cell's number; true: kiln_cells_want was called for it */
    const struct kiln_cell_hull *hulls;
    const uint8_t *moves; /* by layer, move_bytes each; NULL when nothing moves */
    size_t move_bytes;
};

struct kiln_cells_content kiln_cells_content(const struct kiln_cells *cells);

/* Returns how many texels a laid-out cell has. */
static inline size_t kiln_cells_texels(size_t edge)
{
    return (edge + 1) * (edge + KILN_CELL_MARGIN);
}

/* Returns the motion from the layer of a cell, or NULL when nothing moves. */
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
    return &content->hulls[number / KILN_CELL_NUMBERS * KILN_ATLAS_LEVELS +
                           number % KILN_ATLAS_LEVELS];
}

#endif
