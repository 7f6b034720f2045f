/* Computes HDR-FLIP (EG 2021): LDR-FLIP at several exposures, which cover the light of the
 * reference. The largest error of each pixel counts. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "compare/flip.h"

/* ACES as (c0 x^2 + c1 x) / (c3 x^2 + c4 x + c5), Narkowicz's fit at 0.6 of its exposure. */
static const double ACES[6] = {0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.0,
                               0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14};

/* The least median that the last exposure is chosen by, relative to the brightest pixel: 2^-16. */
static const double LEAST_MEDIAN = 1.0 / 65536.0;

static float luminance(const float rgb[3])
{
    float y = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
    return y > 0.0f ? y : 0.0f;
}

/* Returns the larger root of T(x) = 0.85, where T is the ACES curve: x_max of the paper. */
static double solve_x_max(void)
{
    const double t = 0.85;
    double a = ACES[0] - t * ACES[3], b = ACES[1] - t * ACES[4], c = ACES[2] - t * ACES[5];
    double root = sqrt(b * b - 4.0 * a * c);
    double x1 = (-b - root) / (2.0 * a), x2 = (-b + root) / (2.0 * a);
    return x1 > x2 ? x1 : x2;
}

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

bool kiln_flip_choose_exposures(const struct kiln_flip_pair *pair,
                                struct kiln_flip_exposures *exposures, struct kiln_error *error)
{
    if (!kiln_flip_check_finite(pair->reference, pair, error))
        return false;
    size_t pixels = (size_t)pair->width * pair->height;
    float *values = malloc(pixels * sizeof *values);
    if (!values)
        return kiln_error_no_memory(error, "exposing %u x %u pixels", pair->width, pair->height);
    for (size_t i = 0; i < pixels; i++)
        values[i] = luminance(pair->reference + 3 * i);
    qsort(values, pixels, sizeof *values, compare_floats);
    double brightest = (double)values[pixels - 1];
    double median = (double)values[pixels / 2];
    free(values);

    /* If the reference is black, any light of the test picture shows without an exposure, at 0
     * stops. */
    if (!(brightest > 0.0)) {
        *exposures = (struct kiln_flip_exposures){.start = 0.0f, .stop = 1.0f, .count = 2};
        return true;
    }
    double least = LEAST_MEDIAN * brightest;
    if (!(median > least))
        median = least;
    double x = solve_x_max();
    double start = log2(x / brightest), stop = log2(x / median);
    double count = ceil(stop - start);
    count = count < 2.0 ? 2.0 : count;
    *exposures = (struct kiln_flip_exposures){
        .start = (float)start, .stop = (float)stop, .count = (uint32_t)count};
    return true;
}

struct expose {
    const float *from;
    float *to;
    float factor;
};

static void expose_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct expose *job = context;
    const float a = (float)ACES[0], b = (float)ACES[1], c = (float)ACES[3], d = (float)ACES[4],
                e = (float)ACES[5];
    for (size_t i = begin; i < end; i++) {
        float x = job->from[i] * job->factor;
        x = x > 0.0f ? x : 0.0f;
        x = x < 1e15f ? x : 1e15f; /* keeps its square finite */
        job->to[i] = x * (a * x + b) / (x * (c * x + d) + e);
    }
}

bool kiln_flip_hdr(const struct kiln_flip_pair *pair, const struct kiln_flip_params *params,
                   const struct kiln_flip_exposures *exposures, struct kiln_threads *threads,
                   float *errors, struct kiln_error *error)
{
    size_t pixels = (size_t)pair->width * pair->height;
    if (exposures->count < 2 || exposures->count > KILN_FLIP_MAX_EXPOSURES)
        return kiln_error_set(error, KILN_USAGE, "found %u exposures; expected 2 to %d",
                              exposures->count, KILN_FLIP_MAX_EXPOSURES);
    /* Values are checked here, since tone mapping would turn any value into a finite number. */
    if (!kiln_flip_check_finite(pair->reference, pair, error) ||
        !kiln_flip_check_finite(pair->test, pair, error))
        return false;
    float *mapped = malloc(6 * pixels * sizeof *mapped);
    float *now = malloc(pixels * sizeof *now);
    bool ok = mapped && now;
    if (!ok)
        kiln_error_no_memory(error, "comparing %u x %u pixels", pair->width, pair->height);
    memset(errors, 0, pixels * sizeof *errors);
    struct kiln_flip_pair exposed = {mapped, ok ? mapped + 3 * pixels : NULL, pair->width,
                                     pair->height};
    for (uint32_t i = 0; ok && i < exposures->count; i++) {
        float step = (exposures->stop - exposures->start) / (float)(exposures->count - 1);
        float factor = exp2f(exposures->start + (float)i * step);
        struct expose jobs[2] = {{pair->reference, mapped, factor},
                                 {pair->test, mapped + 3 * pixels, factor}};
        for (int image = 0; image < 2; image++)
            kiln_threads_for(threads, 3 * pixels, 1 << 16, expose_rows, &jobs[image]);
        ok = kiln_flip_ldr(&exposed, params, threads, now, error);
        for (size_t k = 0; ok && k < pixels; k++)
            errors[k] = now[k] > errors[k] ? now[k] : errors[k];
    }
    free(mapped);
    free(now);
    return ok;
}
