/* Reads the cells of flipbooks from files: images cut into columns and rows, and the frames of
 * videos. */
#ifndef KILN_ASSET_ATLAS_CELLS_IN_H
#define KILN_ASSET_ATLAS_CELLS_IN_H

#include "asset/loader/loader.h"
#include "base/thread.h"

struct kiln_cells_source {
    const char *path;
    /* divide an image; of a video, the first columns x rows frames are the cells */
    uint32_t columns, rows;
    /* edge of the resulting cells, px; they are resized in premultiplied linear light. A cell that
     * is wider than high, or higher than wide, keeps its proportions: it lies in the middle of the
     * resulting one, and what is left of that is transparent, or has no motion. */
    uint32_t edge;
    struct kiln_loader *loader; /* opens the file; may be NULL */
};

/* Fills columns * rows cells of edge x edge RGBA floats, premultiplied and linear, rows from the
 * top. KILN_INVALID_INPUT when the file is neither an image nor a video, an image does not divide
 * into the cells, or a video has too few frames. */
bool kiln_cells_load(const struct kiln_cells_source *source, float *cells,
                     struct kiln_threads *threads, struct kiln_error *error);

/* Fills columns * rows cells of edge x edge pairs with the motion that an image stores in red and
 * green. The full value is 1, and half of it (128 of 255) is 0, whatever
 * transfer function the image names. The motion of a cell that is no square is multiplied so that
 * it counts edges of the resulting cell, not its own. */
bool kiln_cells_load_motion(const struct kiln_cells_source *source, float *motion,
                            struct kiln_threads *threads, struct kiln_error *error);

/* Checks that an image divides into the cells, or that a video has a frame for each, for which it
 * decodes these frames. A file with one cell always passes. Else KILN_INVALID_INPUT with the
 * sizes. */
bool kiln_cells_check_layout(const struct kiln_cells_source *source, struct kiln_error *error);

/* Checks that kiln_cells_load can read a file, apart from the number of its cells: decodes an
 * image, or the first frame of a video. */
bool kiln_cells_check(struct kiln_loader *loader, const char *path, struct kiln_error *error);

#endif
