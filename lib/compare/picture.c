/* Converts pictures of any type to linear light and levels. Eight-bit pictures, the most frequent,
 * are converted by tables and keep their levels exactly; all others are computed. */
#include "compare/picture.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "base/error.h"

struct conversion {
    const struct kiln_asset_image *image;
    const uint8_t *masked; /* or NULL */
    struct kiln_compare_picture *picture;
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

/* Returns the light, multiplied by alpha, of a number that is multiplied by alpha in its encoding.
 * lib/asset/image/linear.c has the same formulas in floats, for textures; their light is up to 11
 * units in the last place off, which would change the numbers of verdicts. */
static double associated_light(double x, double alpha)
{
    if (x <= alpha)
        return alpha > 0.0 ? alpha * srgb_to_linear(x / alpha) : 0.0;
    return alpha + srgb_to_linear(x) - srgb_to_linear(alpha);
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
    const struct kiln_compare_picture *picture = conversion->picture;
    float *linear = picture->linear, *levels = picture->levels;
    for (size_t i = begin; i < end; i++, in += 4) {
        for (size_t c = 0; c < 3; c++) {
            linear[3 * i + c] = conversion->linear_of[in[c]];
            levels[3 * i + c] = conversion->level_of[in[c]];
        }
        if (!picture->alpha || in[3] == 255)
            continue;
        for (size_t c = 0; c < 3; c++) {
            if (conversion->image->premultiplied)
                linear[3 * i + c] = (float)associated_light(in[c] / 255.0, in[3] / 255.0);
            else
                linear[3 * i + c] *= (float)in[3] / 255.0f;
            levels[3 * i + c] = linear_to_level(linear[3 * i + c]);
        }
    }
    for (size_t i = begin; picture->alpha && i < end; i++)
        picture->alpha[i] = (float)((const uint8_t *)conversion->image->pixels)[4 * i + 3] / 255.0f;
}

static void put_black(const struct kiln_compare_picture *picture, size_t pixel)
{
    for (size_t c = 0; c < 3; c++)
        picture->linear[3 * pixel + c] = picture->levels[3 * pixel + c] = 0.0f;
    if (picture->alpha)
        picture->alpha[pixel] = 1.0f;
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

/* Returns the light, multiplied by alpha, of a number. */
static float light_of(const struct kiln_asset_image *image, float x, float alpha)
{
    if (image->srgb && image->premultiplied && alpha != 1.0f)
        return (float)associated_light((double)x, (double)alpha);
    const float factor = image->premultiplied ? 1.0f : alpha;
    return factor * (image->srgb ? (float)srgb_to_linear((double)x) : x);
}

static void convert_values(struct conversion *conversion, size_t begin, size_t end)
{
    const struct kiln_asset_image *image = conversion->image;
    const struct kiln_compare_picture *picture = conversion->picture;
    for (size_t i = begin; i < end; i++) {
        float alpha = picture->alpha ? value_at(image, 4 * i + 3) : 1.0f;
        bool finite = isfinite(alpha);
        for (size_t c = 0; c < 3; c++) {
            float x = value_at(image, 4 * i + c);
            float light = light_of(image, x, alpha);
            picture->linear[3 * i + c] = light;
            picture->levels[3 * i + c] =
                image->srgb && alpha == 1.0f ? 255.0f * x : linear_to_level(light);
            finite = finite && isfinite(x);
        }
        if (picture->alpha)
            picture->alpha[i] = alpha;
        if (!finite && conversion->masked && conversion->masked[i])
            put_black(picture, i);
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

static struct kiln_compare_picture *allocate(const struct kiln_asset_image *image)
{
    struct kiln_compare_picture *picture = calloc(1, sizeof *picture);
    if (!picture)
        return NULL;
    size_t pixels = (size_t)image->width * image->height;
    bool has_alpha = image->channels == 2 || image->channels == 4;
    *picture = (struct kiln_compare_picture){
        .width = image->width,
        .height = image->height,
        .hdr = image->type == KILN_IMAGE_F32,
        .linear = malloc(3 * pixels * sizeof(float)),
        .levels = malloc(3 * pixels * sizeof(float)),
        .alpha = has_alpha ? malloc(pixels * sizeof(float)) : NULL,
    };
    if (!picture->linear || !picture->levels || (has_alpha && !picture->alpha))
        kiln_compare_picture_destroy(&picture);
    return picture;
}

/* Alpha that is 1 everywhere says no more than none. */
static void drop_solid_alpha(struct kiln_compare_picture *picture)
{
    const size_t pixels = (size_t)picture->width * picture->height;
    size_t i = 0;
    while (picture->alpha && i < pixels && picture->alpha[i] == 1.0f)
        i++;
    if (!picture->alpha)
        return;
    picture->file_alpha = i == pixels ? KILN_ALPHA_SOLID : KILN_ALPHA_SOME;
    if (i == pixels) {
        free(picture->alpha);
        picture->alpha = NULL;
    }
}

struct kiln_compare_picture *kiln_compare_picture_create(const struct kiln_asset_image *image,
                                                         const uint8_t *masked, const char *name,
                                                         struct kiln_threads *threads,
                                                         struct kiln_error *error)
{
    struct conversion conversion = {.image = image, .masked = masked, .picture = allocate(image)};
    if (!conversion.picture) {
        kiln_error_no_memory(error, "comparing %u x %u pixels of %s", image->width, image->height,
                             name);
        return NULL;
    }
    atomic_init(&conversion.bad, SIZE_MAX);
    if (image->type == KILN_IMAGE_U8)
        make_tables(&conversion);
    kiln_threads_for(threads, (size_t)image->width * image->height, 1 << 14, convert, &conversion);
    drop_solid_alpha(conversion.picture);
    size_t bad = atomic_load(&conversion.bad);
    if (bad != SIZE_MAX) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: pixel %zu,%zu has a value that is not finite", name, bad % image->width,
                       bad / image->width);
        kiln_compare_picture_destroy(&conversion.picture);
    }
    return conversion.picture;
}

void kiln_compare_picture_destroy(struct kiln_compare_picture **picture)
{
    if (!*picture)
        return;
    free((*picture)->linear);
    free((*picture)->levels);
    free((*picture)->alpha);
    free(*picture);
    *picture = NULL;
}

bool kiln_compare_pictures_agree(struct kiln_compare_picture *const pictures[2],
                                 struct kiln_error *error)
{
    if (!pictures[0]->alpha == !pictures[1]->alpha)
        return true;
    struct kiln_compare_picture *solid = pictures[pictures[0]->alpha ? 1 : 0];
    const size_t pixels = (size_t)solid->width * solid->height;
    solid->alpha = malloc(pixels * sizeof *solid->alpha);
    if (!solid->alpha)
        return kiln_error_no_memory(error, "comparing %u x %u pixels", solid->width, solid->height);
    for (size_t i = 0; i < pixels; i++)
        solid->alpha[i] = 1.0f;
    return true;
}

const char *kiln_compare_alpha_note(const struct kiln_compare_picture *reference,
                                    const struct kiln_compare_picture *test)
{
    static const char *const notes[3][3] = {
        [KILN_ALPHA_NONE] = {"",
                             "the test has alpha, which is opaque everywhere; the reference has "
                             "none",
                             "the test has alpha, the reference has none"},
        [KILN_ALPHA_SOLID] = {"the reference has alpha, which is opaque everywhere; the test has "
                              "none",
                              "", "the test has alpha, that of the reference is opaque everywhere"},
        [KILN_ALPHA_SOME] = {"the reference has alpha, the test has none",
                             "the reference has alpha, that of the test is opaque everywhere", ""},
    };
    return notes[reference->file_alpha][test->file_alpha];
}

bool kiln_compare_picture_match(const struct kiln_compare_picture *reference,
                                const struct kiln_compare_picture *test, struct kiln_error *error)
{
    if (reference->width != test->width || reference->height != test->height)
        return kiln_error_set(
            error, KILN_FRAME_FAILED,
            "the sizes differ: the reference has %u x %u pixels, the test %u x %u",
            reference->width, reference->height, test->width, test->height);
    return true;
}
