/* This file projects the blocks of a domain to the picture. A block touches the tiles of the
 * rectangle around its corners; where it reaches the near plane, it touches all tiles. */
#include "draw/volume/volume_tiles.h"

#include <stdlib.h>

#include "base/error.h"

/* The rectangle of tiles that a block touches, [from, to), and its depths. */
struct kiln_block_box {
    uint32_t x_from, x_to, y_from, y_to;
    struct kiln_tile_depths depths;
};

struct tiles_job {
    struct kiln_volume_tiles *tiles;
    const struct kiln_volume_march *march;
    uint32_t across, down;
    float view[3][3]; /* rows: from cells to metres along the axes of the view */
};

void kiln_volume_tiles_finish(struct kiln_volume_tiles *tiles)
{
    free(tiles->depths);
    free(tiles->boxes);
    *tiles = (struct kiln_volume_tiles){.depths = NULL};
}

static bool make_room(struct kiln_volume_tiles *tiles, uint32_t tile_count, uint32_t boxes,
                      struct kiln_error *error)
{
    if (tile_count > tiles->tile_room) {
        free(tiles->depths);
        tiles->depths = malloc(tile_count * sizeof *tiles->depths);
        tiles->tile_room = tiles->depths ? tile_count : 0;
    }
    if (boxes > tiles->box_room) {
        free(tiles->boxes);
        tiles->boxes = malloc(boxes * sizeof *tiles->boxes);
        tiles->box_room = tiles->boxes ? boxes : 0;
    }
    return (tiles->depths && tiles->boxes) || kiln_error_no_memory(error, "drawn gas");
}

/* Returns the tile of a place in pixels. */
static uint32_t tile_of(float pixel, uint32_t tiles)
{
    const float tile = exact_clamp(pixel * (1.0f / VOLUME_TILE), 0.0f, (float)tiles);
    return exact_uint(tile);
}

static struct kiln_block_box box_of(const struct tiles_job *job, struct kiln_gas_place brick)
{
    const struct kiln_volume_march *m = job->march;
    const float margin = 1.0f; /* px */
    const float first[3] = {(float)(brick.x * GAS_BRICK), (float)(brick.y * GAS_BRICK),
                            (float)(brick.z * GAS_BRICK)};
    float low[3] = {1e9f, 1e9f, 1e9f}, high[3] = {-1e9f, -1e9f, -1e9f};
    for (int i = 0; i < 8; i++) {
        float at[3], seen[3];
        for (int k = 0; k < 3; k++) /* half a cell more, where samples are held at the border */
            at[k] = first[k] + (i >> k & 1 ? (float)GAS_BRICK + 1.0f : -0.5f) - m->eye[k];
        for (int k = 0; k < 3; k++)
            seen[k] = job->view[k][0] * at[0] + job->view[k][1] * at[1] + job->view[k][2] * at[2];
        low[2] = exact_min(low[2], seen[2]);
        high[2] = exact_max(high[2], seen[2]);
        const float scale = 1.0f / exact_max(seen[2], 1e-6f);
        const float x = m->middle_x + seen[0] * scale / m->pixel_x;
        const float y = m->middle_y - seen[1] * scale / m->pixel_y;
        low[0] = exact_min(low[0], x);
        high[0] = exact_max(high[0], x);
        low[1] = exact_min(low[1], y);
        high[1] = exact_max(high[1], y);
    }
    struct kiln_block_box box = {.depths = {low[2], high[2]}};
    if (high[2] <= m->near_m)
        return box;
    if (low[2] <= m->near_m) {
        box.x_to = job->across;
        box.y_to = job->down;
        return box;
    }
    const float last = (float)(VOLUME_TILE - 1);
    box.x_from = tile_of(low[0] - margin, job->across);
    box.x_to = tile_of(high[0] + margin + last, job->across);
    box.y_from = tile_of(low[1] - margin, job->down);
    box.y_to = tile_of(high[1] + margin + last, job->down);
    return box;
}

static void project_blocks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct tiles_job *job = context;
    for (size_t i = begin; i < end; i++)
        job->tiles->boxes[i] = box_of(job, kiln_volume_place(job->march->field, (uint32_t)i));
}

/* Joins the depths of the blocks that touch each tile of a row. */
static void join_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct tiles_job *job = context;
    for (size_t row = begin; row < end; row++) {
        struct kiln_tile_depths *depths = job->tiles->depths + row * job->across;
        for (uint32_t x = 0; x < job->across; x++)
            depths[x] = (struct kiln_tile_depths){1e9f, -1e9f};
        for (uint32_t i = 0; i < job->march->field->count; i++) {
            const struct kiln_block_box *box = &job->tiles->boxes[i];
            if (row < box->y_from || row >= box->y_to)
                continue;
            for (uint32_t x = box->x_from; x < box->x_to; x++) {
                depths[x].near_m = exact_min(depths[x].near_m, box->depths.near_m);
                depths[x].far_m = exact_max(depths[x].far_m, box->depths.far_m);
            }
        }
    }
}

bool kiln_volume_tiles_find(struct kiln_volume_tiles *tiles, const struct kiln_volume_march *march,
                            struct kiln_threads *threads, struct kiln_error *error)
{
    struct tiles_job job = {.tiles = tiles,
                            .march = march,
                            .across = kiln_tiles_along(march->width),
                            .down = kiln_tiles_along(march->height)};
    const float square = march->cell_m * march->cell_m;
    for (int i = 0; i < 3; i++) {
        job.view[0][i] = square * march->right[i];
        job.view[1][i] = square * march->up[i];
        job.view[2][i] = square * march->forward[i];
    }
    if (!make_room(tiles, job.across * job.down, march->field->count, error))
        return false;
    kiln_threads_for(threads, march->field->count, 256, project_blocks, &job);
    kiln_threads_for(threads, job.down, 1, join_rows, &job);
    return true;
}
