/* This file converts between the frame and its coarse picture on the host: it measures depths and
 * edges, and enlarges the pictures. Threads share the rows, and coarse_rows_simd.c processes them
 * with the widest vectors that the machine has. */
#include "draw/sprites/coarse_cpu.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "draw/sprites/coarse_rows.h"
#include "shared/coarse.h"
#include "shared/exact.h"

enum { ROWS_AT_A_TIME = 4 }; /* rows that a thread takes at once */

struct kiln_coarse_cpu {
    struct kiln_coarse_images *images;
    struct kiln_threads *threads;
    const struct kiln_coarse_loops *loops;
    struct kiln_coarse_place *columns, *rows; /* by column and by row of the frame */
    uint8_t *nonplanar; /* this and the two below: as in struct kiln_coarse_rows */
    struct kiln_coarse_pixel *interpolated;
    struct kiln_coarse_columns *measured;
};

static int32_t limit(int32_t index, uint32_t count)
{
    return index < 0 ? 0 : index < (int32_t)count ? index : (int32_t)count - 1;
}

/* Returns where a column or a row of the frame lies among `count` coarse ones; margin: px of the
 * frame by which the coarse picture reaches beyond the frame's edge. */
static struct kiln_coarse_place find_place(uint32_t pixel, float margin, uint32_t factor,
                                           uint32_t count)
{
    struct kiln_coarse_place place = {.at = ((float)pixel + 0.5f + margin) / (float)factor - 0.5f};
    int32_t low = exact_int(place.at + 1.0f) - 1; /* floor, since `at` > -1 */
    place.part = place.at - (float)low;
    place.containing = limit(place.part < 0.5f ? low : low + 1, count);
    const float4 weights = coarse_spline(place.part);
    memcpy(place.weights, &weights, sizeof place.weights);
    for (int32_t i = 0; i < 4; i++)
        place.taps[i] = limit(low - 1 + i, count);
    return place;
}

static bool find_places(struct kiln_coarse_cpu *coarse)
{
    const struct kiln_coarse_images *images = coarse->images;
    coarse->columns = calloc(images->width, sizeof *coarse->columns);
    coarse->rows = calloc(images->height, sizeof *coarse->rows);
    if (!coarse->columns || !coarse->rows)
        return false;
    for (uint32_t x = 0; x < images->width; x++)
        coarse->columns[x] = find_place(x, images->margin_x, images->factor, images->depth.width);
    for (uint32_t y = 0; y < images->height; y++)
        coarse->rows[y] = find_place(y, images->margin_y, images->factor, images->depth.height);
    return true;
}

static bool make_scratch(struct kiln_coarse_cpu *coarse)
{
    const struct kiln_coarse_images *images = coarse->images;
    const size_t width = images->depth.width, threads = kiln_threads_count(coarse->threads);
    coarse->nonplanar = calloc(width * images->depth.height, sizeof *coarse->nonplanar);
    coarse->interpolated = aligned_alloc(16, width * threads * sizeof *coarse->interpolated);
    coarse->measured = calloc(threads, sizeof *coarse->measured);
    bool ok = coarse->nonplanar && coarse->interpolated && coarse->measured;
    for (size_t i = 0; ok && i < threads; i++) {
        struct kiln_coarse_columns *measured = &coarse->measured[i];
        measured->farthest = malloc(images->width * sizeof *measured->farthest);
        measured->nonplanar = malloc(images->width * sizeof *measured->nonplanar);
        ok = measured->farthest && measured->nonplanar;
    }
    return ok;
}

struct kiln_coarse_cpu *kiln_coarse_cpu_create(struct kiln_coarse_images *images,
                                               struct kiln_threads *threads,
                                               struct kiln_error *error)
{
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error))
        return NULL;
    struct kiln_coarse_cpu *coarse = calloc(1, sizeof *coarse);
    if (coarse)
        *coarse = (struct kiln_coarse_cpu){
            .images = images, .threads = threads, .loops = KILN_SIMD_PICK(kiln_coarse_loops, simd)};
    if (!coarse || !make_scratch(coarse) || !find_places(coarse)) {
        kiln_error_no_memory(error, "coarse particles");
        kiln_coarse_cpu_destroy(&coarse);
    }
    return coarse;
}

void kiln_coarse_cpu_destroy(struct kiln_coarse_cpu **coarse)
{
    struct kiln_coarse_cpu *c = *coarse;
    if (!c)
        return;
    free(c->columns);
    free(c->rows);
    free(c->nonplanar);
    free(c->interpolated);
    for (size_t i = 0; c->measured && i < kiln_threads_count(c->threads); i++) {
        free(c->measured[i].farthest);
        free(c->measured[i].nonplanar);
    }
    free(c->measured);
    free(c);
    *coarse = NULL;
}

static struct kiln_coarse_rows begin(const struct kiln_coarse_cpu *coarse)
{
    return (struct kiln_coarse_rows){.images = coarse->images,
                                     .columns = coarse->columns,
                                     .rows = coarse->rows,
                                     .nonplanar = coarse->nonplanar,
                                     .interpolated = coarse->interpolated,
                                     .measured = coarse->measured};
}

static bool run(struct kiln_coarse_cpu *coarse, uint32_t height, kiln_coarse_loop *loop,
                struct kiln_coarse_rows *rows, struct kiln_error *error)
{
    return kiln_threads_try(coarse->threads, height, ROWS_AT_A_TIME, loop, rows, error);
}

bool kiln_coarse_cpu_measure(struct kiln_coarse_cpu *coarse, struct kiln_image *depth,
                             struct kiln_error *error)
{
    struct kiln_coarse_images *images = coarse->images;
    struct kiln_coarse_rows rows = begin(coarse);
    rows.depth = kiln_image_host(depth, KILN_READ, error);
    if (rows.depth)
        rows.coarse_depth = kiln_image_host(&images->depth, KILN_OVERWRITE, error);
    if (rows.coarse_depth)
        rows.edges = kiln_image_host(&images->edges, KILN_OVERWRITE, error);
    if (!rows.edges)
        return false;
    const uint32_t height = images->depth.height;
    if (!run(coarse, height, coarse->loops->measure, &rows, error) ||
        !run(coarse, height, coarse->loops->find_edges, &rows, error))
        return false;
    if (!images->mixed)
        return true;
    rows.fine_depth = kiln_image_host(&images->fine_depth, KILN_OVERWRITE, error);
    return rows.fine_depth && run(coarse, images->height, coarse->loops->mask, &rows, error);
}

/* Makes the pixels of the images that `enlarge` reads available on the host; returns false with an
 * error. */
static bool open_images(struct kiln_coarse_images *images, struct kiln_image *depth,
                        struct kiln_coarse_rows *rows, struct kiln_error *error)
{
    rows->depth = kiln_image_host(depth, KILN_READ, error);
    rows->coarse_depth = kiln_image_host(&images->depth, KILN_READ, error);
    rows->edges = kiln_image_host(&images->edges, KILN_READ, error);
    rows->coarse_color = kiln_image_host(&images->color, KILN_READ, error);
    rows->coarse_bloom = kiln_image_host(&images->bloom, KILN_READ, error);
    bool all = rows->depth && rows->coarse_depth && rows->edges && rows->coarse_color &&
               rows->coarse_bloom;
    if (!all || !images->mixed)
        return all;
    rows->fine_color = kiln_image_host(&images->fine_color, KILN_READ, error);
    rows->fine_bloom = kiln_image_host(&images->fine_bloom, KILN_READ, error);
    return rows->fine_color && rows->fine_bloom;
}

bool kiln_coarse_cpu_enlarge(struct kiln_coarse_cpu *coarse, const struct kiln_coarse_blend *blend,
                             struct kiln_image *depth, struct kiln_error *error)
{
    struct kiln_coarse_rows rows = begin(coarse);
    rows.keep_bloom = blend->keep_bloom;
    rows.over = blend->sum_alpha ? 0.0f : 1.0f;
    if (!open_images(coarse->images, depth, &rows, error))
        return false;
    const bool blooms = blend->target->count > 1;
    rows.color = kiln_image_host(blend->target->images[0], KILN_OVERWRITE, error);
    if (rows.color && blooms)
        rows.bloom = kiln_image_host(blend->target->images[1],
                                     blend->keep_bloom ? KILN_READ_WRITE : KILN_OVERWRITE, error);
    if (!rows.color || (blooms && !rows.bloom))
        return false;
    return run(coarse, coarse->images->height, coarse->loops->enlarge, &rows, error);
}
