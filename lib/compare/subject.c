/* Converts pictures of any type to linear light and levels. Eight-bit pictures, the most frequent,
 * are converted by tables and keep their levels exactly; all others are computed. */
#include "compare/subject.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "base/error.h"

struct conversion {
    const struct kiln_asset_image *image;
    const uint8_t *masked; /* or NULL */
    struct kiln_subject *subject;
    float linear_of[256], level_of[256]; /* for 8-bit pictures */
    atomic_size_t bad;                   /* the first pixel that is not finite; SIZE_MAX: none */
};

static double srgb_to_linear(double x)
{
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

static float linear_to_level(float x)
{
    float size = fabsf(x);
    float encoded = size <= 0.0031308f ? 12.92f * size : 1.055f * powf(size, 1.0f / 2.4f) - 0.055f;
    return copysignf(255.0f * encoded, x);
}

static void make_tables(struct conversion *conversion)
{
    for (int i = 0; i < 256; i++) {
        double x = i / 255.0;
        bool srgb = conversion->image->srgb;
        conversion->linear_of[i] = (float)(srgb ? srgb_to_linear(x) : x);
        conversion->level_of[i] = srgb ? (float)i : linear_to_level((float)x);
    }
}

static void convert_bytes(const struct conversion *conversion, size_t begin, size_t end)
{
    const uint8_t *in = (const uint8_t *)conversion->image->pixels + 4 * begin;
    const struct kiln_subject *subject = conversion->subject;
    float *linear = subject->linear, *levels = subject->levels;
    for (size_t i = begin; i < end; i++, in += 4) {
        for (size_t c = 0; c < 3; c++) {
            linear[3 * i + c] = conversion->linear_of[in[c]];
            levels[3 * i + c] = conversion->level_of[in[c]];
        }
        if (!subject->alpha || in[3] == 255)
            continue;
        for (size_t c = 0; c < 3; c++) {
            linear[3 * i + c] *= (float)in[3] / 255.0f;
            levels[3 * i + c] = linear_to_level(linear[3 * i + c]);
        }
    }
    for (size_t i = begin; subject->alpha && i < end; i++)
        subject->alpha[i] = (float)((const uint8_t *)conversion->image->pixels)[4 * i + 3] / 255.0f;
}

static void put_black(const struct kiln_subject *subject, size_t pixel)
{
    for (size_t c = 0; c < 3; c++)
        subject->linear[3 * pixel + c] = subject->levels[3 * pixel + c] = 0.0f;
    if (subject->alpha)
        subject->alpha[pixel] = 1.0f;
}

static void note_bad(struct conversion *conversion, size_t pixel)
{
    size_t first = atomic_load(&conversion->bad);
    while (pixel < first && !atomic_compare_exchange_weak(&conversion->bad, &first, pixel))
        ;
}

static float value_at(const struct kiln_asset_image *image, size_t index)
{
    if (image->type == KILN_IMAGE_F32)
        return ((const float *)image->pixels)[index];
    return (float)((const uint16_t *)image->pixels)[index] / 65535.0f;
}

static void convert_values(struct conversion *conversion, size_t begin, size_t end)
{
    const struct kiln_asset_image *image = conversion->image;
    const struct kiln_subject *subject = conversion->subject;
    for (size_t i = begin; i < end; i++) {
        float alpha = subject->alpha ? value_at(image, 4 * i + 3) : 1.0f;
        float factor = image->premultiplied ? 1.0f : alpha;
        bool finite = isfinite(alpha);
        for (size_t c = 0; c < 3; c++) {
            float x = value_at(image, 4 * i + c);
            float light = image->srgb ? (float)srgb_to_linear((double)x) : x;
            subject->linear[3 * i + c] = factor * light;
            subject->levels[3 * i + c] =
                image->srgb && factor == 1.0f ? 255.0f * x : linear_to_level(factor * light);
            finite = finite && isfinite(x);
        }
        if (subject->alpha)
            subject->alpha[i] = alpha;
        if (!finite && conversion->masked && conversion->masked[i])
            put_black(subject, i);
        else if (!finite)
            note_bad(conversion, i);
    }
}

static void convert(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct conversion *conversion = context;
    if (conversion->image->type == KILN_IMAGE_U8)
        convert_bytes(conversion, begin, end);
    else
        convert_values(conversion, begin, end);
}

static struct kiln_subject *allocate(const struct kiln_asset_image *image)
{
    struct kiln_subject *subject = calloc(1, sizeof *subject);
    if (!subject)
        return NULL;
    size_t pixels = (size_t)image->width * image->height;
    bool has_alpha = image->channels == 2 || image->channels == 4;
    *subject = (struct kiln_subject){
        .width = image->width,
        .height = image->height,
        .channels = image->channels,
        .hdr = image->type == KILN_IMAGE_F32,
        .linear = malloc(3 * pixels * sizeof(float)),
        .levels = malloc(3 * pixels * sizeof(float)),
        .alpha = has_alpha ? malloc(pixels * sizeof(float)) : NULL,
    };
    if (!subject->linear || !subject->levels || (has_alpha && !subject->alpha))
        kiln_subject_destroy(&subject);
    return subject;
}

struct kiln_subject *kiln_subject_create(const struct kiln_asset_image *image,
                                         const uint8_t *masked, const char *name,
                                         struct kiln_threads *threads, struct kiln_error *error)
{
    struct conversion conversion = {.image = image, .masked = masked, .subject = allocate(image)};
    if (!conversion.subject) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: no memory to compare %u x %u pixels", name,
                       image->width, image->height);
        return NULL;
    }
    atomic_init(&conversion.bad, SIZE_MAX);
    if (image->type == KILN_IMAGE_U8)
        make_tables(&conversion);
    kiln_threads_for(threads, (size_t)image->width * image->height, 1 << 14, convert, &conversion);
    size_t bad = atomic_load(&conversion.bad);
    if (bad != SIZE_MAX) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: pixel %zu,%zu has a value that is not finite", name, bad % image->width,
                       bad / image->width);
        kiln_subject_destroy(&conversion.subject);
    }
    return conversion.subject;
}

void kiln_subject_destroy(struct kiln_subject **subject)
{
    if (!*subject)
        return;
    free((*subject)->linear);
    free((*subject)->levels);
    free((*subject)->alpha);
    free(*subject);
    *subject = NULL;
}

bool kiln_subject_match(const struct kiln_subject *reference, const struct kiln_subject *test,
                        struct kiln_error *error)
{
    static const char *const kinds[] = {"no", "grey", "grey and alpha", "RGB", "RGBA"};
    if (reference->width != test->width || reference->height != test->height)
        return kiln_error_set(
            error, KILN_FRAME_FAILED,
            "the sizes differ: the reference has %u x %u pixels, the test %u x %u",
            reference->width, reference->height, test->width, test->height);
    if (reference->channels != test->channels)
        return kiln_error_set(error, KILN_FRAME_FAILED,
                              "the channels differ: the reference has %s, the test %s",
                              kinds[reference->channels % 5], kinds[test->channels % 5]);
    return true;
}
