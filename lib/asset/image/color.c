/* This file converts pixels to sRGB: by a curve for each channel to light, by a matrix to sRGB's
 * primaries, and by sRGB's own curve. It computes in IEEE arithmetic alone, and powers by
 * shared/exact.h, so that a picture is the same on every processor. */
#include "asset/image/color.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "asset/image/linear.h"
#include "shared/exact.h"

const struct kiln_primaries kiln_rec709 = {
    {0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};

/* White of a profile's connection space, D50 (ICC.1:2022, 7.2.16). */
static const double D50[3] = {0.9642, 1.0, 0.8249};

/* ---- curves ---------------------------------------------------------------------------------- */

struct kiln_curve kiln_power_curve(float gamma)
{
    return (struct kiln_curve){.gamma = gamma, .a = 1.0f};
}

struct kiln_curve kiln_srgb_curve(void)
{
    return (struct kiln_curve){
        .gamma = 2.4f, .a = 1.0f / 1.055f, .b = 0.055f / 1.055f, .c = 1.0f / 12.92f, .d = 0.04045f};
}

static float clamp01(float x)
{
    return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f; /* a NaN becomes 0 */
}

static float table_at(const struct kiln_curve *curve, uint32_t i)
{
    const uint8_t *at = curve->table + (size_t)2 * i;
    return (float)(at[0] << 8 | at[1]) / 65535.0f;
}

float kiln_curve_at(const struct kiln_curve *curve, float x)
{
    if (curve->table) {
        const float place = clamp01(x) * (float)(curve->count - 1);
        const uint32_t i = place < (float)(curve->count - 2) ? (uint32_t)place : curve->count - 2;
        const float low = table_at(curve, i), high = table_at(curve, i + 1);
        return low + (high - low) * (place - (float)i);
    }
    if (x < curve->d)
        return clamp01(curve->c * x + curve->f);
    const float base = curve->a * x + curve->b;
    const float power = curve->gamma == 1.0f ? base
                        : base > 0.0f        ? exact_pow(base, curve->gamma)
                                             : 0.0f;
    return clamp01(power + curve->e);
}

/* ---- matrices -------------------------------------------------------------------------------- */

static void multiply(const double a[3][3], const double b[3][3], double product[3][3])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            product[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    }
}

static bool invert(const double m[3][3], double inverse[3][3])
{
    double cofactors[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const int p = (i + 1) % 3, q = (i + 2) % 3, r = (j + 1) % 3, s = (j + 2) % 3;
            cofactors[i][j] = m[p][r] * m[q][s] - m[p][s] * m[q][r];
        }
    }
    const double determinant =
        m[0][0] * cofactors[0][0] + m[0][1] * cofactors[0][1] + m[0][2] * cofactors[0][2];
    if (!(determinant > 1e-9 || determinant < -1e-9))
        return false;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            inverse[i][j] = cofactors[j][i] / determinant;
    }
    return true;
}

/* Finds the matrix that adapts XYZ from a white to D50: Bradford's response of the eye, scaled
 * (ICC.1:2022, annex E). */
static bool adapt_to_d50(const double white[3], double adapt[3][3])
{
    static const double bradford[3][3] = {
        {0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};
    double back[3][3], scaled[3][3];
    if (!invert(bradford, back))
        return false;
    for (int i = 0; i < 3; i++) {
        const double *row = bradford[i];
        const double from = row[0] * white[0] + row[1] * white[1] + row[2] * white[2];
        const double to = row[0] * D50[0] + row[1] * D50[1] + row[2] * D50[2];
        if (!(from > 1e-9))
            return false;
        for (int j = 0; j < 3; j++)
            scaled[i][j] = row[j] * (to / from);
    }
    multiply(back, scaled, adapt);
    return true;
}

/* Finds XYZ, for their own white, by light of some primaries. */
static bool find_own_columns(const struct kiln_primaries *primaries, double white[3],
                             double own[3][3])
{
    const double *const places[3] = {primaries->red, primaries->green, primaries->blue};
    const double *w = primaries->white;
    double inverse[3][3];
    if (!(w[1] > 1e-6))
        return false;
    white[0] = w[0] / w[1];
    white[1] = 1.0;
    white[2] = (1.0 - w[0] - w[1]) / w[1];
    for (int i = 0; i < 3; i++) {
        own[0][i] = places[i][0];
        own[1][i] = places[i][1];
        own[2][i] = 1.0 - places[i][0] - places[i][1];
    }
    if (!invert(own, inverse))
        return false;
    for (int i = 0; i < 3; i++) {
        const double *row = inverse[i];
        const double part = row[0] * white[0] + row[1] * white[1] + row[2] * white[2];
        if (!(part > 0.0))
            return false;
        for (int j = 0; j < 3; j++)
            own[j][i] *= part;
    }
    return true;
}

/* Finds XYZ for the white D50 by light of some primaries. */
static bool find_columns(const struct kiln_primaries *primaries, double columns[3][3])
{
    double white[3], own[3][3], adapt[3][3];
    if (!find_own_columns(primaries, white, own) || !adapt_to_d50(white, adapt))
        return false;
    multiply(adapt, own, columns);
    return true;
}

bool kiln_primaries_luminance(const struct kiln_primaries *primaries, double weights[3])
{
    double white[3], own[3][3];
    if (!find_own_columns(primaries, white, own))
        return false;
    memcpy(weights, own[1], sizeof own[1]);
    return true;
}

bool kiln_primaries_are_rec709(const struct kiln_primaries *primaries)
{
    static const double most = 1e-4;
    bool near = true;
    for (int i = 0; i < 2; i++)
        near = near && fabs(primaries->red[i] - kiln_rec709.red[i]) < most &&
               fabs(primaries->green[i] - kiln_rec709.green[i]) < most &&
               fabs(primaries->blue[i] - kiln_rec709.blue[i]) < most &&
               fabs(primaries->white[i] - kiln_rec709.white[i]) < most;
    return near;
}

bool kiln_xyz_to_srgb(double to_srgb[3][3])
{
    double white[3], own[3][3];
    return find_own_columns(&kiln_rec709, white, own) && invert(own, to_srgb);
}

bool kiln_columns_to_srgb(const double xyz[3][3], double to_srgb[3][3])
{
    double columns[3][3], inverse[3][3];
    if (!find_columns(&kiln_rec709, columns) || !invert(columns, inverse))
        return false;
    multiply(inverse, xyz, to_srgb);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            if (!(to_srgb[i][j] > -100.0 && to_srgb[i][j] < 100.0))
                return false;
        }
    }
    return true;
}

bool kiln_primaries_to_srgb(const struct kiln_primaries *primaries, double to_srgb[3][3])
{
    double columns[3][3];
    return find_columns(primaries, columns) && kiln_columns_to_srgb(columns, to_srgb);
}

/* ---- pixels ---------------------------------------------------------------------------------- */

/* Encodes light of 8 bits: a level is found from the level of a nearby light. */
struct encoder {
    float begins[257]; /* the least light of each level; the last is beyond all light */
    uint8_t nearby[1025];
};

static void make_encoder(struct encoder *encoder)
{
    encoder->begins[0] = 0.0f;
    for (int level = 1; level < 256; level++)
        encoder->begins[level] = kiln_decode_srgb(((float)level - 0.5f) / 255.0f);
    encoder->begins[256] = 2.0f;
    uint8_t level = 0;
    for (int i = 0; i <= 1024; i++) {
        while (encoder->begins[level + 1] <= (float)i / 1024.0f)
            level++;
        encoder->nearby[i] = level;
    }
}

static uint8_t encode8(const struct encoder *encoder, float light)
{
    uint8_t level = encoder->nearby[(uint32_t)(light * 1024.0f)];
    while (encoder->begins[level + 1] <= light)
        level++;
    return level;
}

static uint16_t encode16(float light)
{
    const float x =
        light <= 0.0031308f ? 12.92f * light : 1.055f * exact_pow(light, 1.0f / 2.4f) - 0.055f;
    return (uint16_t)(clamp01(x) * 65535.0f + 0.5f);
}

/* Computes the light of sRGB's primaries. */
static void find_light(const struct kiln_color *color, const float light[3], float found[3])
{
    for (int i = 0; i < 3; i++) {
        const double *row = color->to_srgb[i];
        found[i] = clamp01((float)(row[0] * (double)light[0] + row[1] * (double)light[1] +
                                   row[2] * (double)light[2]));
    }
}

bool kiln_color_is_srgb(const struct kiln_color *color)
{
    enum { STEP = 15 }; /* of the levels that are tried */
    struct encoder encoder;
    float light[3][256 / STEP + 1];
    make_encoder(&encoder);
    for (int c = 0; c < 3; c++) {
        for (int level = 0; level < 256; level++) {
            const float x = (float)level / 255.0f;
            const float at = kiln_curve_at(&color->curves[c], x);
            const int found = encode8(&encoder, at);
            if (found < level - 1 || found > level + 1)
                return false;
            if (level % STEP == 0)
                light[c][level / STEP] = at;
        }
    }
    for (int i = 0; i < 18 * 18 * 18; i++) {
        const int steps[3] = {i % 18, i / 18 % 18, i / 324};
        const float at[3] = {light[0][steps[0]], light[1][steps[1]], light[2][steps[2]]};
        float found[3];
        find_light(color, at, found);
        for (int c = 0; c < 3; c++) {
            const int level = encode8(&encoder, found[c]), own = STEP * steps[c];
            if (level < own - 1 || level > own + 1)
                return false;
        }
    }
    return true;
}

/* Returns the light of all numbers of the picture's depth for each curve, or NULL. The caller frees
 * it. */
static float *make_lights(const struct kiln_color *color, size_t numbers)
{
    float *lights = malloc(3 * numbers * sizeof *lights);
    for (size_t c = 0; lights && c < 3; c++) {
        for (size_t i = 0; i < numbers; i++)
            lights[c * numbers + i] =
                kiln_curve_at(&color->curves[c], (float)i / (float)(numbers - 1));
    }
    return lights;
}

void kiln_light_convert(const double to_srgb[3][3], float *pixels, size_t count)
{
    for (; count > 0; count--, pixels += 4) {
        const double light[3] = {(double)pixels[0], (double)pixels[1], (double)pixels[2]};
        for (int i = 0; i < 3; i++) {
            const double *row = to_srgb[i];
            pixels[i] = (float)(row[0] * light[0] + row[1] * light[1] + row[2] * light[2]);
        }
    }
}

bool kiln_color_convert(const struct kiln_color *color, struct kiln_asset_image *image)
{
    const bool deep = image->type == KILN_IMAGE_U16, grey = image->channels < 3;
    const size_t numbers = deep ? 65536 : 256;
    const size_t pixels = (size_t)image->width * image->height;
    uint8_t *bytes = image->pixels;
    uint16_t *words = image->pixels;
    struct encoder encoder;
    float *lights = make_lights(color, numbers);
    if (!lights)
        return false;
    make_encoder(&encoder);
    for (size_t i = 0; i < pixels; i++) {
        float light[3], found[3];
        for (size_t c = 0; c < 3; c++)
            light[c] = lights[c * numbers + (deep ? words[4 * i + c] : bytes[4 * i + c])];
        if (grey)
            found[0] = found[1] = found[2] = light[0];
        else
            find_light(color, light, found);
        for (size_t c = 0; c < 3; c++) {
            if (deep)
                words[4 * i + c] = encode16(found[c]);
            else
                bytes[4 * i + c] = encode8(&encoder, found[c]);
        }
    }
    free(lights);
    return true;
}

/* ---- CIELAB ---------------------------------------------------------------------------------- */

/* Returns the part of white's X, Y or Z for a number of CIELAB (CIE 015:2018, 8.2.1). */
static double part_of_white(double f)
{
    const double delta = 6.0 / 29.0;
    return f > delta ? f * f * f : 3.0 * delta * delta * (f - 4.0 / 29.0);
}

/* Finds the matrix from parts of a white's X, Y and Z to light of sRGB's primaries. */
static bool find_white_to_srgb(const double white[2], double to_srgb[3][3])
{
    double adapt[3][3];
    if (!(white[1] > 1e-6))
        return false;
    const double xyz[3] = {white[0] / white[1], 1.0, (1.0 - white[0] - white[1]) / white[1]};
    if (!adapt_to_d50(xyz, adapt))
        return false;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            adapt[i][j] *= xyz[j];
    }
    return kiln_columns_to_srgb(adapt, to_srgb);
}

bool kiln_lab_convert(const struct kiln_lab *lab, struct kiln_asset_image *image)
{
    const bool deep = image->type == KILN_IMAGE_U16;
    const double step = deep ? 1.0 / 256.0 : 1.0;
    const size_t pixels = (size_t)image->width * image->height;
    uint8_t *bytes = image->pixels;
    uint16_t *words = image->pixels;
    struct kiln_color color;
    struct encoder encoder;
    if (!find_white_to_srgb(lab->white, color.to_srgb))
        return false;
    make_encoder(&encoder);
    for (size_t i = 0; i < pixels; i++) {
        double n[3];
        float found[3];
        for (size_t c = 0; c < 3; c++)
            n[c] = (double)(deep ? words[4 * i + c] : bytes[4 * i + c]);
        const double y = (n[0] * (100.0 / lab->brightest) + 16.0) / 116.0;
        const double x = y + (n[1] * step - 128.0) / 500.0, z = y - (n[2] * step - 128.0) / 200.0;
        const float parts[3] = {(float)part_of_white(x), (float)part_of_white(y),
                                (float)part_of_white(z)};
        find_light(&color, parts, found);
        for (size_t c = 0; c < 3; c++) {
            if (deep)
                words[4 * i + c] = encode16(found[c]);
            else
                bytes[4 * i + c] = encode8(&encoder, found[c]);
        }
    }
    return true;
}
