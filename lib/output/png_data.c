/* Compresses the pixels of a picture to the data of a PNG.
 *
 * Fast data is made in bands of rows by deflate.c. A band is filtered and compressed by itself, so
 * that several threads can work at once. Its size depends on the picture's size alone, so the data
 * is the same for any number of threads. Bands are compressed in rounds of a few, whose output
 * waits in memory until it is taken.
 *
 * Small data is made by libdeflate.c from the whole picture, and taken in parts. */
#include "output/png_data.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "base/error.h"
#include "base/thread.h"
#include "output/adler.h"
#include "output/deflate.h"
#include "output/libdeflate.h"
#include "output/png_rows.h"

enum {
    BAND_BYTES = 256 << 10, /* what a band has at most, if its rows are not larger than that */
    TOGETHER = 16,          /* rows that share a filter */
    HEAD = 2,               /* bytes of a zlib stream before its data */
    TAIL = 4,               /* bytes behind it */
    BANDS_A_THREAD = 4,     /* of a round, so that a slow thread delays the round less */
    SMALL_PART = 1 << 20,   /* bytes that are taken at once */
    SMALL_LEVEL = 12        /* libdeflate's highest */
};

/* A band that was compressed. */
struct band {
    uint8_t *bytes; /* with room for HEAD before, and for TAIL behind */
    size_t start, size;
    uint32_t adler;
};

/* Holds the buffers of a thread. */
struct worker {
    uint8_t *rows, *scratch;
    struct kiln_deflate_scratch *deflate;
};

struct kiln_png_data {
    const struct kiln_picture *picture;
    enum kiln_png_effort effort;
    size_t row_bytes;
    kiln_png_filter *filter_rows;
    kiln_deflate_run *deflate;
    /* small data: all of it, NULL before the first call */
    uint8_t *small;
    size_t small_size, small_taken;
    /* fast data */
    uint32_t band_rows, band_count;
    struct kiln_threads *threads; /* NULL: the calling thread alone */
    struct worker *workers;
    uint32_t worker_count;
    struct band *bands; /* of a round */
    uint32_t round_size;
    uint32_t round; /* the first band of the round */
    uint32_t next;  /* the band that is taken next */
    uint32_t adler; /* of the bands before it */
};

/* ---- Creating and destroying ----------------------------------------------------------------- */

static bool create_worker(struct kiln_png_data *data, struct worker *worker)
{
    worker->rows = malloc(data->band_rows * data->row_bytes);
    worker->scratch = malloc(kiln_png_filter_scratch(data->picture));
    worker->deflate = malloc(sizeof *worker->deflate);
    return worker->rows && worker->scratch && worker->deflate;
}

static bool create_buffers(struct kiln_png_data *data)
{
    data->workers = calloc(data->worker_count, sizeof *data->workers);
    data->bands = calloc(data->round_size, sizeof *data->bands);
    bool ok = data->workers && data->bands;
    for (uint32_t i = 0; ok && i < data->worker_count; i++)
        ok = create_worker(data, &data->workers[i]);
    const size_t room = HEAD + kiln_deflate_room(data->band_rows * data->row_bytes) + TAIL;
    for (uint32_t i = 0; ok && i < data->round_size; i++)
        ok = (data->bands[i].bytes = malloc(room)) != NULL;
    return ok;
}

void kiln_png_data_destroy(struct kiln_png_data **data)
{
    struct kiln_png_data *d = *data;
    *data = NULL;
    if (!d)
        return;
    kiln_threads_destroy(&d->threads);
    for (uint32_t i = 0; d->workers && i < d->worker_count; i++) {
        free(d->workers[i].rows);
        free(d->workers[i].scratch);
        free(d->workers[i].deflate);
    }
    for (uint32_t i = 0; d->bands && i < d->round_size; i++)
        free(d->bands[i].bytes);
    free(d->workers);
    free(d->bands);
    free(d->small);
    free(d);
}

/* Divides the picture into bands, and creates what compresses them. */
static bool create_bands(struct kiln_png_data *data, uint32_t threads)
{
    const uint32_t height = data->picture->height;
    const size_t rows = BAND_BYTES / data->row_bytes;
    data->band_rows = rows < 1 ? 1 : rows > height ? height : (uint32_t)rows;
    data->band_count = (height - 1) / data->band_rows + 1;
    data->worker_count = threads < data->band_count ? threads : data->band_count;
    if (data->worker_count > 1)
        data->threads = kiln_threads_create(data->worker_count);
    if (!data->threads)
        data->worker_count = 1;
    data->round_size = data->threads ? data->worker_count * BANDS_A_THREAD : 1;
    return create_buffers(data);
}

static bool fail(const struct kiln_picture *picture, struct kiln_error *error)
{
    return kiln_error_no_memory(error, "compressing a picture of %u x %u pixels", picture->width,
                                picture->height);
}

struct kiln_png_data *kiln_png_data_create(const struct kiln_picture *picture,
                                           enum kiln_png_effort effort, uint32_t threads,
                                           struct kiln_error *error)
{
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error))
        return NULL;
    struct kiln_png_data *data = calloc(1, sizeof *data);
    bool ok = data != NULL;
    if (ok) {
        data->filter_rows = KILN_SIMD_PICK(kiln_png_filter_rows, simd);
        data->deflate = KILN_SIMD_PICK(kiln_deflate, simd);
        data->picture = picture;
        data->effort = effort;
        data->row_bytes = kiln_png_row_bytes(picture);
        data->adler = 1;
        ok = effort == KILN_PNG_SMALL || create_bands(data, threads);
    }
    if (ok)
        return data;
    fail(picture, error);
    kiln_png_data_destroy(&data);
    return NULL;
}

/* ---- Fast data ------------------------------------------------------------------------------- */

static uint32_t rows_of(const struct kiln_png_data *data, uint32_t band)
{
    const uint32_t first = band * data->band_rows, left = data->picture->height - first;
    return left < data->band_rows ? left : data->band_rows;
}

static void compress_bands(void *context, size_t begin, size_t end, uint32_t worker_index)
{
    struct kiln_png_data *data = context;
    const struct worker *worker = &data->workers[worker_index];
    for (size_t i = begin; i < end; i++) {
        const uint32_t number = data->round + (uint32_t)i, rows = rows_of(data, number);
        const size_t size = rows * data->row_bytes;
        struct band *band = &data->bands[i];
        data->filter_rows(data->picture, number * data->band_rows, rows, TOGETHER, worker->rows,
                          worker->scratch);
        band->start = HEAD;
        band->size = data->deflate(worker->rows, size, number + 1 == data->band_count,
                                   band->bytes + HEAD, worker->deflate);
        band->adler = kiln_adler32(worker->rows, size);
    }
}

static void compress_round(struct kiln_png_data *data)
{
    const uint32_t left = data->band_count - data->next;
    const uint32_t count = left < data->round_size ? left : data->round_size;
    data->round = data->next;
    if (data->threads)
        kiln_threads_for(data->threads, count, 1, compress_bands, data);
    else
        compress_bands(data, 0, count, 0);
}

/* Writes what surrounds the data of a zlib stream: the head before the first band, and the Adler-32
 * of all bands behind the last one. */
static void complete(const struct kiln_png_data *data, struct band *band)
{
    if (data->next == 0) {
        band->start = 0;
        band->size += HEAD;
        memcpy(band->bytes, (const uint8_t[HEAD]){0x78, 0x01}, HEAD);
    }
    if (data->next + 1 == data->band_count) {
        uint8_t *tail = band->bytes + band->start + band->size;
        band->size += TAIL;
        for (int i = 0; i < TAIL; i++)
            tail[i] = (uint8_t)(data->adler >> (24 - 8 * i));
    }
}

static bool next_band(struct kiln_png_data *data, const struct kiln_caller *caller,
                      const uint8_t **bytes, size_t *size, struct kiln_error *error)
{
    if (data->next == data->band_count)
        return true;
    if (data->next % data->round_size == 0) {
        if (!kiln_may_go_on(caller, error))
            return false;
        compress_round(data);
    }
    struct band *band = &data->bands[data->next - data->round];
    const size_t rows = rows_of(data, data->next);
    data->adler =
        (uint32_t)adler32_combine(data->adler, band->adler, (z_off_t)(rows * data->row_bytes));
    complete(data, band);
    data->next++;
    *bytes = band->bytes + band->start;
    *size = band->size;
    return true;
}

/* ---- Small data ------------------------------------------------------------------------------ */

/* Compresses rows; false when memory is short. */
static bool compress_rows(struct kiln_png_data *data, const uint8_t *rows, size_t size)
{
    struct kiln_compressor *compressor = kiln_compressor_create(SMALL_LEVEL);
    if (!compressor)
        return false;
    const size_t room = kiln_compressor_room(compressor, size);
    data->small = malloc(room);
    if (data->small)
        data->small_size = kiln_compressor_run(compressor, rows, size, data->small, room);
    kiln_compressor_destroy(&compressor);
    return data->small != NULL;
}

/* Compresses the whole picture; false when memory is short. */
static bool compress_small(struct kiln_png_data *data)
{
    const struct kiln_picture *picture = data->picture;
    const size_t size = picture->height * data->row_bytes;
    uint8_t *rows = malloc(size), *scratch = malloc(kiln_png_filter_scratch(picture));
    bool ok = rows && scratch;
    if (ok) {
        data->filter_rows(picture, 0, picture->height, TOGETHER, rows, scratch);
        ok = compress_rows(data, rows, size);
    }
    free(scratch);
    free(rows);
    return ok;
}

static bool next_small(struct kiln_png_data *data, const struct kiln_caller *caller,
                       const uint8_t **bytes, size_t *size, struct kiln_error *error)
{
    if (!data->small) {
        if (!kiln_may_go_on(caller, error))
            return false;
        if (!compress_small(data))
            return fail(data->picture, error);
    }
    const size_t left = data->small_size - data->small_taken;
    *bytes = data->small + data->small_taken;
    *size = left < SMALL_PART ? left : SMALL_PART;
    data->small_taken += *size;
    return true;
}

/* ---- The interface --------------------------------------------------------------------------- */

bool kiln_png_data_next(struct kiln_png_data *data, const struct kiln_caller *caller,
                        const uint8_t **bytes, size_t *size, struct kiln_error *error)
{
    *size = 0;
    return data->effort == KILN_PNG_SMALL ? next_small(data, caller, bytes, size, error)
                                          : next_band(data, caller, bytes, size, error);
}
