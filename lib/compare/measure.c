/* Takes every measure of a pair of pictures: FLIP, SSIM, and differences in levels. Pictures with
 * alpha are put on black and on white for FLIP and SSIM, and the worse of the two counts. */
#include "compare/measure.h"

#include <stdlib.h>

#include "base/clock.h"
#include "base/error.h"
#include "compare/flip.h"
#include "compare/ssim.h"

struct taking {
    struct kiln_measurement *measurement;
    const struct kiln_compare_picture *pictures[2];
    const struct kiln_measure_params *params;
    struct kiln_threads *threads;
    struct kiln_error *error;
    size_t pixels;
    float *white[2]; /* linear light on white, where there is alpha */
    float *errors;   /* errors of FLIP on white */
    float *luma[2];
};

static bool allocate(struct taking *taking)
{
    bool alpha = taking->pictures[0]->alpha != NULL;
    size_t pixels = taking->pixels;
    taking->measurement->errors = malloc(pixels * sizeof(float));
    bool ok = taking->measurement->errors != NULL;
    for (int i = 0; i < 2; i++) {
        taking->luma[i] = malloc(pixels * sizeof(float));
        taking->white[i] = alpha ? malloc(3 * pixels * sizeof(float)) : NULL;
        ok = ok && taking->luma[i] && (!alpha || taking->white[i]);
    }
    taking->errors = alpha ? malloc(pixels * sizeof(float)) : NULL;
    ok = ok && (!alpha || taking->errors);
    return ok || kiln_error_no_memory(taking->error, "comparing %u x %u pixels",
                                      taking->pictures[0]->width, taking->pictures[0]->height);
}

static void put_on_white(const struct kiln_compare_picture *picture, size_t pixels, float *out)
{
    for (size_t i = 0; i < pixels; i++) {
        for (size_t c = 0; c < 3; c++)
            out[3 * i + c] = picture->linear[3 * i + c] + (1.0f - picture->alpha[i]);
    }
}

static bool take_flip_of(const struct taking *taking, const float *reference, const float *test,
                         float *errors)
{
    const struct kiln_flip_params params = {(float)taking->params->pixels_per_degree};
    const struct kiln_flip_pair pair = {reference, test, taking->pictures[0]->width,
                                        taking->pictures[0]->height};
    struct kiln_flip_exposures exposures;
    if (!taking->params->hdr)
        return kiln_flip_ldr(&pair, &params, taking->threads, errors, taking->error);
    return kiln_flip_choose_exposures(&pair, &exposures, taking->error) &&
           kiln_flip_hdr(&pair, &params, &exposures, taking->threads, errors, taking->error);
}

static bool take_flip(const struct taking *taking)
{
    struct kiln_measurement *m = taking->measurement;
    double start_s = kiln_clock_seconds();
    bool ok =
        take_flip_of(taking, taking->pictures[0]->linear, taking->pictures[1]->linear, m->errors);
    if (ok && taking->errors) {
        for (int i = 0; i < 2; i++)
            put_on_white(taking->pictures[i], taking->pixels, taking->white[i]);
        ok = take_flip_of(taking, taking->white[0], taking->white[1], taking->errors);
        for (size_t i = 0; ok && i < taking->pixels; i++)
            m->errors[i] = taking->errors[i] > m->errors[i] ? taking->errors[i] : m->errors[i];
    }
    m->flip_s = kiln_clock_seconds() - start_s;
    return ok && kiln_pool_errors(m->errors, taking->pixels, &m->flip, taking->error);
}

/* Makes Rec. 709 luma of the levels, with black at 0 and white at 1; `ground` is the luma behind
 * the picture. */
static void make_luma(const struct kiln_compare_picture *picture, size_t pixels, float ground,
                      float *out)
{
    const float *level = picture->levels;
    for (size_t i = 0; i < pixels; i++, level += 3) {
        float luma = (0.2126f * level[0] + 0.7152f * level[1] + 0.0722f * level[2]) / 255.0f;
        out[i] = luma + (picture->alpha ? ground * (1.0f - picture->alpha[i]) : 0.0f);
    }
}

static bool take_ssim(const struct taking *taking)
{
    struct kiln_measurement *m = taking->measurement;
    m->ssim = 1.0;
    for (int ground = 0; ground < (taking->pictures[0]->alpha ? 2 : 1); ground++) {
        double similarity = 0;
        for (int i = 0; i < 2; i++)
            make_luma(taking->pictures[i], taking->pixels, (float)ground, taking->luma[i]);
        if (!kiln_ssim(taking->luma[0], taking->luma[1], m->width, m->height, taking->threads,
                       &similarity, taking->error))
            return false;
        m->ssim = similarity < m->ssim ? similarity : m->ssim;
    }
    return true;
}

bool kiln_measurement_take(struct kiln_measurement *measurement,
                           const struct kiln_compare_picture *reference,
                           const struct kiln_compare_picture *test,
                           const struct kiln_measure_params *params, struct kiln_threads *threads,
                           struct kiln_error *error)
{
    *measurement =
        (struct kiln_measurement){.width = reference->width, .height = reference->height};
    struct taking taking = {.measurement = measurement,
                            .pictures = {reference, test},
                            .params = params,
                            .threads = threads,
                            .error = error,
                            .pixels = (size_t)reference->width * reference->height};
    bool ok = kiln_compare_picture_match(reference, test, error) && allocate(&taking) &&
              take_flip(&taking) && take_ssim(&taking) &&
              kiln_level_difference_measure(reference, test, params->threshold, params->window,
                                            &measurement->levels, error);
    for (int i = 0; i < 2; i++) {
        free(taking.luma[i]);
        free(taking.white[i]);
    }
    free(taking.errors);
    return ok;
}

void kiln_measurement_finish(struct kiln_measurement *measurement)
{
    free(measurement->errors);
    measurement->errors = NULL;
}
