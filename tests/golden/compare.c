/* compare GOLDEN TEST: exit 0 when two pictures look the same.
 *
 * Pixels are exact per driver only, so goldens allow what another driver's rounding gives. FLIP
 * judges what an eye would see, the count of pixels beyond STEP what it might overlook. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "asset/image.h"
#include "compare/flip.h"
#include "compare/pool.h"

static const int STEP = 10;            /* levels of 255 */
static const double MAX_SHARE = 0.005; /* of the pixels may differ by more than STEP */
static const double MAX_FLIP_MEAN = 0.01;
static const double MAX_FLIP_P99 = 0.10;

struct difference {
    double share; /* of pixels beyond STEP */
    int largest;
    uint32_t x, y; /* where */
    double flip_mean, flip_p99;
};

static void count_levels(const struct kiln_asset_image *a, const struct kiln_asset_image *b,
                         struct difference *d)
{
    const uint8_t *p = a->pixels, *q = b->pixels;
    uint64_t beyond = 0;
    for (uint32_t y = 0; y < a->height; y++) {
        for (uint32_t x = 0; x < a->width; x++, p += 4, q += 4) {
            int worst = 0;
            for (int c = 0; c < 4; c++) {
                int delta = abs(p[c] - q[c]);
                worst = delta > worst ? delta : worst;
            }
            beyond += worst > STEP;
            if (worst > d->largest) {
                d->largest = worst;
                d->x = x;
                d->y = y;
            }
        }
    }
    d->share = (double)beyond / ((double)a->width * a->height);
}

static float *linear_pixels(const struct kiln_asset_image *image)
{
    size_t pixels = (size_t)image->width * image->height;
    const uint8_t *p = image->pixels;
    float *rgb = calloc(pixels + 1, 3 * sizeof *rgb);
    for (size_t i = 0; rgb && i < pixels; i++) {
        for (size_t c = 0; c < 3; c++) {
            double x = p[4 * i + c] / 255.0;
            rgb[3 * i + c] = (float)(x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4));
        }
    }
    return rgb;
}

static bool measure_flip(const struct kiln_asset_image *a, const struct kiln_asset_image *b,
                         struct difference *d, struct kiln_error *error)
{
    size_t pixels = (size_t)a->width * a->height;
    float *p = linear_pixels(a), *q = linear_pixels(b);
    float *errors = calloc(pixels + 1, sizeof *errors);
    struct kiln_threads *threads = kiln_threads_create(0);
    struct kiln_flip_pair pair = {p, q, a->width, a->height};
    struct kiln_error_pool pool = {0};
    bool ok = p && q && errors && threads &&
              kiln_flip_ldr(&pair, &KILN_FLIP_DEFAULTS, threads, errors, error) &&
              kiln_pool_errors(errors, pixels, &pool, error) &&
              kiln_pool_percentile(errors, pixels, 0.99, &d->flip_p99, error);
    d->flip_mean = pool.mean;
    kiln_threads_destroy(&threads);
    free(errors);
    free(p);
    free(q);
    return ok;
}

static bool judge(const char *golden, const char *test, const struct kiln_asset_image *a,
                  const struct kiln_asset_image *b)
{
    struct difference d = {0};
    struct kiln_error error = {.message = "out of memory"};
    count_levels(a, b, &d);
    if (!measure_flip(a, b, &d, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return false;
    }
    bool same = d.share <= MAX_SHARE && d.flip_mean <= MAX_FLIP_MEAN && d.flip_p99 <= MAX_FLIP_P99;
    printf("%s against %s: %s\n  FLIP mean %.4f (limit %g), 99th percentile %.4f (limit %g)\n"
           "  %.3f %% of pixels beyond %d levels (limit %g %%), largest %d at %u,%u\n",
           test, golden, same ? "same" : "different", d.flip_mean, MAX_FLIP_MEAN, d.flip_p99,
           MAX_FLIP_P99, 100.0 * d.share, STEP, 100.0 * MAX_SHARE, d.largest, d.x, d.y);
    return same;
}

static bool same(const char *golden, const char *test)
{
    struct kiln_error error = {0};
    struct kiln_asset_image *a = kiln_asset_image_load(golden, &error);
    struct kiln_asset_image *b = a ? kiln_asset_image_load(test, &error) : NULL;
    bool ok = false;
    if (!b)
        fprintf(stderr, "%s\n", error.message);
    else if (a->width != b->width || a->height != b->height || a->type != KILN_IMAGE_U8 ||
             b->type != KILN_IMAGE_U8)
        fprintf(stderr, "%s is %ux%u, %s is %ux%u; both must be 8-bit and of one size\n", golden,
                a->width, a->height, test, b->width, b->height);
    else
        ok = judge(golden, test, a, b);
    kiln_asset_image_destroy(&a);
    kiln_asset_image_destroy(&b);
    return ok;
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: compare GOLDEN TEST\n");
        return 2;
    }
    return same(argv[1], argv[2]) ? 0 : 1;
}
