/* Computes SSIM in bands of rows. The five moments are filtered across into a buffer, then down, in
 * loops along the row that the compiler turns into vector code. Each row has its own sum, so that
 * the result does not depend on the threads. */
#include "compare/ssim.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"

enum { RADIUS = 5, TAPS = 2 * RADIUS + 1, BAND = 32, BAND_ROWS = BAND + 2 * RADIUS, MOMENTS = 5 };

struct ssim {
    const float *planes[2];
    size_t width, height;
    float weights[TAPS];
    float *buffers; /* one for each worker, as struct work divides it */
    size_t buffer_size;
    double *row_sums;
};

/* A worker's memory. */
struct work {
    float *rows;   /* filtered across: MOMENTS rows of width, BAND_ROWS times */
    float *padded; /* one row with RADIUS zeros on both sides */
    float *down;   /* MOMENTS rows of width */
};

static struct work work_of(const struct ssim *ssim, uint32_t worker)
{
    float *start = ssim->buffers + worker * ssim->buffer_size;
    size_t row = MOMENTS * ssim->width;
    return (struct work){start, start + (BAND_ROWS + 1) * row, start + BAND_ROWS * row};
}

/* Returns the sum of the weights of a window around `at`, which is cut off at the picture's edges.
 */
static float total_weight(const struct ssim *ssim, size_t at, size_t count)
{
    float total = 0;
    for (size_t k = 0; k < TAPS; k++)
        total += at + k >= RADIUS && at + k - RADIUS < count ? ssim->weights[k] : 0.0f;
    return total;
}

/* Filters the products of a and b across, or a alone where b is NULL. */
static void filter_across(const struct ssim *ssim, const float *a, const float *b, float *padded,
                          float *out)
{
    size_t width = ssim->width;
    for (size_t x = 0; x < width; x++)
        padded[RADIUS + x] = b ? a[x] * b[x] : a[x];
    memset(out, 0, width * sizeof *out);
    for (size_t k = 0; k < TAPS; k++) {
        float w = ssim->weights[k];
        for (size_t x = 0; x < width; x++)
            out[x] += w * padded[x + k];
    }
    for (size_t x = 0; x < width; x++) {
        if (x == RADIUS && width > TAPS) /* between the borders the window is whole */
            x = width - RADIUS;
        out[x] /= total_weight(ssim, x, width);
    }
}

static void filter_row_across(const struct ssim *ssim, size_t row, float *padded, float *out)
{
    const float *a = ssim->planes[0] + row * ssim->width, *b = ssim->planes[1] + row * ssim->width;
    const float *const factors[MOMENTS][2] = {{a, NULL}, {b, NULL}, {a, a}, {b, b}, {a, b}};
    for (size_t m = 0; m < MOMENTS; m++)
        filter_across(ssim, factors[m][0], factors[m][1], padded, out + m * ssim->width);
}

static double similarity_at(const float *moments, size_t stride)
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    double a = (double)moments[0], b = (double)moments[stride];
    double aa = (double)moments[2 * stride] - a * a, bb = (double)moments[3 * stride] - b * b;
    double ab = (double)moments[4 * stride] - a * b;
    return (2 * a * b + c1) * (2 * ab + c2) / ((a * a + b * b + c1) * (aa + bb + c2));
}

/* Returns the sum of similarities in row `row`; work->rows start at row `top` of the picture. */
static double sum_row(const struct ssim *ssim, size_t row, size_t top, const struct work *work)
{
    size_t count = MOMENTS * ssim->width;
    float total = total_weight(ssim, row, ssim->height);
    memset(work->down, 0, count * sizeof *work->down);
    for (size_t k = 0; k < TAPS; k++) {
        if (row + k < RADIUS || row + k - RADIUS >= ssim->height)
            continue;
        const float *from = work->rows + (row + k - RADIUS - top) * count;
        float w = ssim->weights[k] / total;
        for (size_t i = 0; i < count; i++)
            work->down[i] += w * from[i];
    }
    double sum = 0;
    for (size_t x = 0; x < ssim->width; x++)
        sum += similarity_at(work->down + x, ssim->width);
    return sum;
}

static void sum_bands(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct ssim *ssim = context;
    struct work work = work_of(ssim, worker);
    for (size_t band = begin; band < end; band++) {
        size_t first = band * BAND;
        size_t last = first + BAND < ssim->height ? first + BAND : ssim->height;
        size_t top = first > RADIUS ? first - RADIUS : 0;
        size_t bottom = last + RADIUS < ssim->height ? last + RADIUS : ssim->height;
        for (size_t row = top; row < bottom; row++)
            filter_row_across(ssim, row, work.padded,
                              work.rows + (row - top) * MOMENTS * ssim->width);
        for (size_t row = first; row < last; row++)
            ssim->row_sums[row] = sum_row(ssim, row, top, &work);
    }
}

bool kiln_ssim(const float *reference, const float *test, uint32_t width, uint32_t height,
               struct kiln_threads *threads, double *similarity, struct kiln_error *error)
{
    struct ssim ssim = {.planes = {reference, test}, .width = width, .height = height};
    float sum_of_weights = 0;
    for (int i = 0; i < TAPS; i++) {
        ssim.weights[i] = (float)exp(-(i - RADIUS) * (i - RADIUS) / (2.0 * 1.5 * 1.5));
        sum_of_weights += ssim.weights[i];
    }
    for (int i = 0; i < TAPS; i++)
        ssim.weights[i] /= sum_of_weights;
    ssim.buffer_size = (size_t)(BAND_ROWS + 1) * MOMENTS * width + width + TAPS;
    ssim.buffers = calloc(kiln_threads_count(threads), ssim.buffer_size * sizeof(float));
    ssim.row_sums = calloc(height, sizeof *ssim.row_sums);
    bool ok = ssim.buffers && ssim.row_sums;
    if (ok) {
        kiln_threads_for(threads, (height + BAND - 1) / BAND, 1, sum_bands, &ssim);
        double sum = 0;
        for (uint32_t y = 0; y < height; y++)
            sum += ssim.row_sums[y];
        *similarity = sum / ((double)width * height);
    } else {
        kiln_error_no_memory(error, "comparing %u x %u pixels", width, height);
    }
    free(ssim.buffers);
    free(ssim.row_sums);
    return ok;
}
