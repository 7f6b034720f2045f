/* This file reads the cells of flipbooks from images and videos and resizes them for atlas.c. An
 * image is resized cell by cell, so that neighbours do not bleed into each other. Each row of a
 * cell is filtered horizontally and then added, weighted, to those rows of the resized cell whose
 * filter covers it. The filter is Mitchell and Netravali's cubic ("Reconstruction Filters in
 * Computer Graphics", 1988), widened where a cell shrinks.
 *
 * Resized cells are squares. A cell that is no square keeps its proportions: it lies in the middle
 * of the square, with nothing around it. */
#include "asset/atlas/cells_in.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "asset/image/image.h"
#include "asset/image/linear.h"
#include "asset/image/video_in.h"
#include "base/error.h"

/* ---- pixels ---------------------------------------------------------------------------------- */

static void read_raw(const struct kiln_asset_image *image, size_t pixel, float rgba[4])
{
    for (size_t c = 0; c < 4; c++) {
        if (image->type == KILN_IMAGE_U8)
            rgba[c] = (float)((const uint8_t *)image->pixels)[pixel * 4 + c] / 255.0f;
        else if (image->type == KILN_IMAGE_U16)
            rgba[c] = (float)((const uint16_t *)image->pixels)[pixel * 4 + c] / 65535.0f;
        else
            rgba[c] = ((const float *)image->pixels)[pixel * 4 + c];
    }
}

/* Reads a pixel as premultiplied linear light. */
static void read_light(const struct kiln_asset_image *image, size_t pixel, float rgba[4])
{
    read_raw(image, pixel, rgba);
    for (int c = 0; c < 3; c++)
        rgba[c] = kiln_light_of(image, rgba[c], rgba[3]);
}

/* Reads a pixel as motion, in red and green. The value 128 (of 8 bits), 32768 (of 16 bits) or 0.5
 * (of floats) means no motion, and the largest value means 1. */
static void read_motion(const struct kiln_asset_image *image, size_t pixel, float rgba[4])
{
    read_raw(image, pixel, rgba);
    float rest = image->type == KILN_IMAGE_U8    ? 128.0f / 255.0f
                 : image->type == KILN_IMAGE_U16 ? 32768.0f / 65535.0f
                                                 : 0.5f;
    for (int c = 0; c < 2; c++)
        rgba[c] = (rgba[c] - rest) / (1.0f - rest);
    rgba[2] = rgba[3] = 0.0f;
}

/* ---- filter ---------------------------------------------------------------------------------- */

/* The weights, along one axis, by which samples of a cell are summed into samples of the resized
 * cell. Where the cell takes only a part of the axis, it fades out at its own edges; elsewhere its
 * outermost samples go on beyond its edges. */
struct filter {
    uint32_t taps;   /* number of samples that are summed into each resized sample */
    uint32_t *first; /* for each resized sample: the first sample that is summed */
    float *weights;  /* weights in the order [resized sample][tap] */
};

static float cubic(float x)
{
    x = fabsf(x);
    if (x < 1.0f)
        return (7.0f * x * x * x - 12.0f * x * x + 16.0f / 3.0f) / 6.0f;
    if (x < 2.0f)
        return (-7.0f / 3.0f * x * x * x + 12.0f * x * x - 20.0f * x + 32.0f / 3.0f) / 6.0f;
    return 0.0f;
}

static void filter_finish(struct filter *filter)
{
    free(filter->first);
    free(filter->weights);
}

/* Returns the sum of the weights of all samples around a place, also of those beyond the edges. */
static float whole_sum(float middle, float widening)
{
    const float first = floorf(middle - 2.0f * widening);
    const uint32_t taps = (uint32_t)(4.0f * widening) + 3;
    float sum = 0.0f;
    for (uint32_t k = 0; k < taps; k++)
        sum += cubic((first + (float)k + 0.5f - middle) / widening);
    return sum;
}

/* part: of the axis that the cell takes, in its middle. */
static bool filter_init(struct filter *filter, uint32_t from, uint32_t to, float part)
{
    const float step = (float)from / ((float)to * part), widening = step > 1.0f ? step : 1.0f;
    const float before = 0.5f * (1.0f - part) * (float)to; /* samples before the cell */
    uint32_t taps = (uint32_t)(4.0f * widening) + 2;
    filter->taps = taps < from ? taps : from;
    filter->first = calloc(to, sizeof *filter->first);
    filter->weights = calloc((size_t)to * filter->taps, sizeof *filter->weights);
    if (!filter->first || !filter->weights)
        return false;
    for (uint32_t i = 0; i < to; i++) {
        float middle = ((float)i + 0.5f - before) * step, lowest = floorf(middle - 2.0f * widening);
        float last_first = (float)(from - filter->taps);
        float first = fminf(fmaxf(lowest, 0.0f), last_first), sum = 0.0f;
        float *weights = filter->weights + (size_t)i * filter->taps;
        filter->first[i] = (uint32_t)first;
        for (uint32_t k = 0; k < filter->taps; k++) {
            weights[k] = cubic((first + (float)k + 0.5f - middle) / widening);
            sum += weights[k];
        }
        if (part < 1.0f)
            sum = whole_sum(middle, widening);
        for (uint32_t k = 0; k < filter->taps; k++)
            weights[k] /= sum;
    }
    return true;
}

/* ---- images ---------------------------------------------------------------------------------- */

struct resize {
    const struct kiln_asset_image *image;
    void (*read)(const struct kiln_asset_image *image, size_t pixel, float rgba[4]);
    bool is_light; /* false: motion, which may be negative */
    uint32_t columns, cell_width, cell_height, edge;
    struct filter across, down;
    float *rows; /* for each worker: a row of a cell, and a row of the resized cell */
    float *cells;
};

/* Reads a row of a cell and filters it horizontally. */
static void filter_row(const struct resize *job, size_t first_pixel, float *row, float *resized)
{
    for (uint32_t x = 0; x < job->cell_width; x++)
        job->read(job->image, first_pixel + x, row + (size_t)x * 4);
    const float *weights = job->across.weights;
    for (uint32_t x = 0; x < job->edge; x++, resized += 4, weights += job->across.taps) {
        const float *from = row + (size_t)job->across.first[x] * 4;
        float sum[4] = {0};
        for (uint32_t k = 0; k < job->across.taps; k++, from += 4) {
            for (int c = 0; c < 4; c++)
                sum[c] += weights[k] * from[c];
        }
        memcpy(resized, sum, sizeof sum);
    }
}

static void resize_cell(const struct resize *job, size_t cell, float *row, float *resized)
{
    size_t left = cell % job->columns * job->cell_width;
    size_t top = cell / job->columns * job->cell_height, row_floats = (size_t)job->edge * 4;
    float *out = job->cells + cell * job->edge * row_floats;
    for (uint32_t y = 0; y < job->cell_height; y++) {
        filter_row(job, (top + y) * job->image->width + left, row, resized);
        for (uint32_t to = 0; to < job->edge; to++) {
            uint32_t tap = y - job->down.first[to];
            if (y < job->down.first[to] || tap >= job->down.taps)
                continue;
            float weight = job->down.weights[(size_t)to * job->down.taps + tap];
            for (size_t i = 0; i < row_floats; i++)
                out[to * row_floats + i] += weight * resized[i];
        }
    }
    /* The filter overshoots at hard edges; negative light becomes 0. */
    for (size_t i = 0; job->is_light && i < job->edge * row_floats; i++)
        out[i] = fmaxf(out[i], 0.0f);
}

static void resize_cells(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct resize *job = context;
    size_t floats = ((size_t)job->cell_width + job->edge) * 4;
    float *row = job->rows + worker * floats;
    for (size_t cell = begin; cell < end; cell++)
        resize_cell(job, cell, row, row + (size_t)job->cell_width * 4);
}

static bool check_division(uint32_t width, uint32_t height, const struct kiln_cells_source *source,
                           struct kiln_error *error)
{
    return (width % source->columns == 0 && height % source->rows == 0) ||
           kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: %u x %u pixels do not divide into %u columns and %u rows",
                          source->path, width, height, source->columns, source->rows);
}

/* Makes motion relative to the edges of the square that a cell lies in. part: of each edge that the
 * cell takes. */
static void shrink_motion(float *cells, size_t texels, const float part[2])
{
    for (size_t i = 0; i < texels; i++) {
        cells[4 * i] *= part[0];
        cells[4 * i + 1] *= part[1];
    }
}

/* Resizes all cells of an image into `cells`, which the caller has filled with zeros. */
static bool resize_image(const struct kiln_asset_image *image,
                         const struct kiln_cells_source *source, bool motion, float *cells,
                         struct kiln_threads *threads, struct kiln_error *error)
{
    struct resize job = {.image = image,
                         .read = motion ? read_motion : read_light,
                         .is_light = !motion,
                         .columns = source->columns,
                         .cell_width = image->width / source->columns,
                         .cell_height = image->height / source->rows,
                         .edge = source->edge,
                         .cells = cells};
    if (!check_division(image->width, image->height, source, error))
        return false;
    const float width = (float)job.cell_width, height = (float)job.cell_height;
    const float longer = fmaxf(width, height), part[2] = {width / longer, height / longer};
    const size_t count = (size_t)source->columns * source->rows;
    job.rows = calloc(kiln_threads_count(threads),
                      ((size_t)job.cell_width + job.edge) * 4 * sizeof(float));
    bool ok = job.rows && filter_init(&job.across, job.cell_width, job.edge, part[0]) &&
              filter_init(&job.down, job.cell_height, job.edge, part[1]);
    if (ok)
        kiln_threads_for(threads, count, 1, resize_cells, &job);
    if (ok && motion)
        shrink_motion(cells, count * source->edge * source->edge, part);
    if (!ok)
        kiln_error_no_memory(error, "the cells of %s", source->path);
    filter_finish(&job.across);
    filter_finish(&job.down);
    free(job.rows);
    return ok;
}

/* ---- videos ---------------------------------------------------------------------------------- */

/* Reads the frames that become cells, and calls `take` with each. With a `take` of NULL, it only
 * checks that the frames can be decoded. */
static bool read_frames(const struct kiln_cells_source *source,
                        bool (*take)(void *user, const struct kiln_asset_image *image,
                                     uint32_t number, struct kiln_error *error),
                        void *user, struct kiln_error *error)
{
    struct kiln_video_in *video = kiln_video_in_open(source->loader, source->path, error);
    const uint32_t count = source->columns * source->rows;
    bool ok = video != NULL;
    for (uint32_t i = 0; ok && i < count; i++) {
        struct kiln_asset_image *image = NULL;
        ok = kiln_video_in_read(video, &image, error);
        if (ok && !image)
            ok =
                kiln_error_set(error, KILN_INVALID_INPUT,
                               "%s: the video has %u frames; %u columns and %u rows need %u frames",
                               source->path, i, source->columns, source->rows, count);
        ok = ok && (!take || take(user, image, i, error));
        kiln_asset_image_destroy(&image);
    }
    kiln_video_in_close(&video);
    return ok;
}

struct frames {
    struct kiln_cells_source one; /* the source, with a frame as its only cell */
    float *cells;
    struct kiln_threads *threads;
};

static bool resize_frame(void *user, const struct kiln_asset_image *image, uint32_t number,
                         struct kiln_error *error)
{
    const struct frames *frames = user;
    const size_t cell = (size_t)frames->one.edge * frames->one.edge * 4;
    return resize_image(image, &frames->one, false, frames->cells + number * cell, frames->threads,
                        error);
}

static bool load_video(const struct kiln_cells_source *source, float *cells,
                       struct kiln_threads *threads, struct kiln_error *error)
{
    struct frames frames = {*source, cells, threads};
    frames.one.columns = frames.one.rows = 1;
    return read_frames(source, resize_frame, &frames, error);
}

/* ---- files ----------------------------------------------------------------------------------- */

bool kiln_cells_load(const struct kiln_cells_source *source, float *cells,
                     struct kiln_threads *threads, struct kiln_error *error)
{
    size_t floats = (size_t)source->columns * source->rows * source->edge * source->edge * 4;
    memset(cells, 0, floats * sizeof *cells);
    if (kiln_video_in_has_suffix(source->path))
        return load_video(source, cells, threads, error);
    struct kiln_asset_image *image =
        kiln_asset_image_load_sheet(source->loader, source->path, error);
    bool ok = image && resize_image(image, source, false, cells, threads, error);
    kiln_asset_image_destroy(&image);
    return ok;
}

bool kiln_cells_load_motion(const struct kiln_cells_source *source, float *motion,
                            struct kiln_threads *threads, struct kiln_error *error)
{
    size_t pixels = (size_t)source->columns * source->rows * source->edge * source->edge;
    float *cells = calloc(pixels, 4 * sizeof *cells);
    if (!cells)
        return kiln_error_no_memory(error, "the cells of %s", source->path);
    struct kiln_asset_image *image =
        kiln_asset_image_load_data(source->loader, source->path, error);
    bool ok = image && resize_image(image, source, true, cells, threads, error);
    kiln_asset_image_destroy(&image);
    for (size_t i = 0; ok && i < pixels; i++)
        memcpy(motion + 2 * i, cells + 4 * i, 2 * sizeof *motion);
    free(cells);
    return ok;
}

bool kiln_cells_check_layout(const struct kiln_cells_source *source, struct kiln_error *error)
{
    uint32_t size[2];
    if (source->columns * source->rows == 1)
        return true;
    if (kiln_video_in_has_suffix(source->path))
        return read_frames(source, NULL, NULL, error);
    return kiln_asset_sheet_size(source->loader, source->path, size, error) &&
           check_division(size[0], size[1], source, error);
}

bool kiln_cells_check(struct kiln_loader *loader, const char *path, struct kiln_error *error)
{
    const struct kiln_cells_source one = {.loader = loader, .path = path, .columns = 1, .rows = 1};
    return kiln_video_in_has_suffix(path) ? read_frames(&one, NULL, NULL, error)
                                          : kiln_asset_sheet_check(loader, path, error);
}
