/* A kiln_cells holds the cells of flipbooks as the CPU rasteriser samples them (Heinz 2019, 3.2.4,
 * equation 3.2). A large particle takes a sample of both cells that it is between, and one of their
 * motion. For a small particle of a large system the two cells are mixed beforehand: its place
 * between them is rounded to one of KILN_CELL_PHASES, and the mixed cell is rounded to bytes and
 * kept. (Mixed large cells would not stay in the cache.) */
#ifndef KILN_DRAW_SPRITES_CELLS_H
#define KILN_DRAW_SPRITES_CELLS_H

#include <stdatomic.h>

#include "asset/atlas/atlas.h"
#include "base/thread.h"

enum {
    KILN_CELL_TEXEL = 8,  /* bytes: as draw/sprites/texels.h has them */
    KILN_CELL_PAIR = 4,   /* of two channels */
    KILN_CELL_MARGIN = 2, /* columns more than the edge: the outer texels stand twice */
    KILN_CELL_PHASES = 16,
    KILN_CELL_NUMBERS = KILN_CELL_PHASES * KILN_ATLAS_LEVELS, /* cells of a layer */
    KILN_CELL_LARGE_STEP = 2,  /* phases of the largest that is mixed, so that they fit a cache */
    KILN_CELL_FINE_LEVEL = 3,  /* the largest that is sampled by floats */
    KILN_CELL_MIXED_LEVEL = 2, /* the largest that is mixed... */
};
#define KILN_CELL_MIXED_MOVE 0.5f /* ...if nothing moves farther, texels: mixing blurs that... */
#define KILN_CELL_MIXED_LEAST                                                                      \
    (1u << 16) /* ...for systems of so many slots: of few sprites each is                          \
                * seen alone with its error, and hardly two share a cell */
#define KILN_CELL_FINE_MOST                                                                        \
    1024u /* of systems of no more slots small cells without motion are sampled by floats: the     \
           * error of places in bytes shows where light falls off within a texel or two */

struct kiln_cells;

/* Names a cell: phase / KILN_CELL_PHASES of the way from a layer of the atlas to the next one of
 * its texture, at a level of detail; phase 0 is the layer itself. */
struct kiln_cell_name {
    uint32_t layer, next_layer, phase, level;
    float motion; /* of the texture: kiln_atlas_range */
};

/* Holds where a cell, the one after it, and all mixed cells between them are visible: ranges of u,
 * v, u + v and u - v, in parts of the edge. It is empty (from[0] >= to[0]) where they are clear all
 * over. */
struct kiln_cell_hull {
    float from[4], to[4];
};

/* NULL with an error; the atlas must outlive it. */
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
    const uint8_t *const *texels; /* by number, of those that are there */
    const atomic_bool *wanted;    /* by number: kiln_cells_want need not be called again */
    const struct kiln_cell_hull *hulls;
    const uint8_t *moves; /* by layer, move_bytes each; NULL when nothing moves */
    size_t move_bytes;
};

struct kiln_cells_content kiln_cells_content(const struct kiln_cells *cells);

/* Texels of a cell. */
static inline size_t kiln_cells_texels(size_t edge)
{
    return (edge + 1) * (edge + KILN_CELL_MARGIN);
}

static inline const uint8_t *kiln_cells_moves(const struct kiln_cells_content *content,
                                              uint32_t number)
{
    return content->moves ? content->moves + number / KILN_CELL_NUMBERS * content->move_bytes
                          : NULL;
}

static inline const struct kiln_cell_hull *kiln_cells_hull(const struct kiln_cells_content *content,
                                                           uint32_t number)
{
    return &content->hulls[number / KILN_CELL_NUMBERS * KILN_ATLAS_LEVELS +
                           number % KILN_ATLAS_LEVELS];
}

#endif
