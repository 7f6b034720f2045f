/* Computes LDR-FLIP tile by tile. Colours are converted once to the opponent space of the contrast
 * sensitivity filters; each tile is then filtered across and down and judged while it lies in the
 * cache. Inner loops run over plain arrays, which the compiler turns into vector code. Constants
 * and steps are those of HPG 2020, sections 4 and 5. */
#include "compare/flip.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/vector.h"

enum {
    TILE_WIDTH = 256,
    TILE_HEIGHT = 64,
    MAX_RADIUS = 64, /* of a filter, at 400 pixels a degree */
    PADDED_WIDTH = TILE_WIDTH + 2 * MAX_RADIUS,
    LANES = 16,
};

/* The white of D65 and the matrices between linear Rec. 709 and XYZ. */
static const float WHITE[3] = {0.950428545f, 1.0f, 1.088900371f};
static const double TO_XYZ[3][3] = {
    {10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
    {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0}};

/* One-dimensional filters: three for contrast sensitivity, where the blue-yellow one is a sum of
 * two Gaussians, and a Gaussian with its first and second derivative for features. */
enum { CSF_Y, CSF_X, CSF_Z1, CSF_Z2, GAUSS, GAUSS_1, GAUSS_2, FILTER_COUNT };

struct filters {
    int radius[FILTER_COUNT];
    float weights[FILTER_COUNT][2 * MAX_RADIUS + 1];
};

/* The opponent planes of a picture: achromatic (y), red-green (x) and blue-yellow (z). */
struct planes {
    float *y, *x, *z;
};

struct flip {
    const struct kiln_flip_pair *pair;
    struct filters filters;
    float from_xyz[3][3];
    float max_distance; /* HyAB distance of green and blue to the power 0.7: cmax */
    struct planes planes[2];
    float *errors;
    uint32_t tiles_across;
};

/* ---- set-up ---------------------------------------------------------------------------------- */

static void invert(const double m[3][3], float out[3][3])
{
    double determinant = 0;
    double cofactors[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
            cofactors[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
        determinant += i == 0 ? m[0][0] * cofactors[0][0] + m[0][1] * cofactors[0][1] +
                                    m[0][2] * cofactors[0][2]
                              : 0;
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            out[i][j] = (float)(cofactors[j][i] / determinant);
    }
}

/* Fills the weights with G(x) = sqrt(a sqrt(pi / b)) exp(-pi^2 x^2 / b), where x is in degrees.
 * Returns their sum. */
static double gaussian(float *weights, int radius, double ppd, double a, double b)
{
    const double pi = acos(-1.0);
    double sum = 0;
    for (int i = -radius; i <= radius; i++) {
        double x = i / ppd;
        double w = sqrt(a * sqrt(pi / b)) * exp(-pi * pi * x * x / b);
        weights[i + radius] = (float)w;
        sum += w;
    }
    return sum;
}

static void scale(float *weights, int radius, double factor)
{
    for (int i = 0; i <= 2 * radius; i++)
        weights[i] = (float)((double)weights[i] * factor);
}

static void make_contrast_filters(struct filters *f, double ppd)
{
    const double pi = acos(-1.0);
    int radius = (int)ceil(3.0 * sqrt(0.04 / (2.0 * pi * pi)) * ppd);
    for (int i = CSF_Y; i <= CSF_Z2; i++)
        f->radius[i] = radius;
    scale(f->weights[CSF_Y], radius, 1.0 / gaussian(f->weights[CSF_Y], radius, ppd, 1.0, 0.0047));
    scale(f->weights[CSF_X], radius, 1.0 / gaussian(f->weights[CSF_X], radius, ppd, 1.0, 0.0053));
    double z1 = gaussian(f->weights[CSF_Z1], radius, ppd, 34.1, 0.04);
    double z2 = gaussian(f->weights[CSF_Z2], radius, ppd, 13.5, 0.025);
    double both = sqrt(z1 * z1 + z2 * z2);
    scale(f->weights[CSF_Z1], radius, 1.0 / both);
    scale(f->weights[CSF_Z2], radius, 1.0 / both);
}

/* Scales a derivative so that its lobes sum to 1 and -1. */
static void normalize_lobes(float *weights, int radius)
{
    double above = 0, below = 0;
    for (int i = 0; i <= 2 * radius; i++) {
        above += weights[i] > 0 ? (double)weights[i] : 0;
        below -= weights[i] < 0 ? (double)weights[i] : 0;
    }
    for (int i = 0; i <= 2 * radius; i++)
        weights[i] = (float)((double)weights[i] / (weights[i] > 0 ? above : below));
}

static void make_feature_filters(struct filters *f, double ppd)
{
    double sigma = 0.5 * 0.082 * ppd;
    int radius = (int)ceil(3.0 * sigma);
    double sum = 0;
    for (int i = -radius; i <= radius; i++) {
        double g = exp(-(double)(i * i) / (2.0 * sigma * sigma));
        f->weights[GAUSS][i + radius] = (float)g;
        f->weights[GAUSS_1][i + radius] = (float)(-i * g);
        f->weights[GAUSS_2][i + radius] = (float)((i * i / (sigma * sigma) - 1.0) * g);
        sum += g;
    }
    scale(f->weights[GAUSS], radius, 1.0 / sum);
    normalize_lobes(f->weights[GAUSS_1], radius);
    normalize_lobes(f->weights[GAUSS_2], radius);
    for (int i = GAUSS; i <= GAUSS_2; i++)
        f->radius[i] = radius;
}

/* ---- colours --------------------------------------------------------------------------------- */

/* Computes x^p for 0 < x as 2^(p log2 x), each by a polynomial; the relative error is below 2e-6
 * for |p log2 x| < 20. libm's pow is as exact as a double, but does not vectorise. */
static inline float power(float x, float p)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    /* Splitting off the exponent of x / sqrt(1/2) leaves m in [sqrt(1/2), sqrt(2)). */
    int32_t exponent = (int32_t)(bits - 0x3f3504f3u) >> 23;
    bits -= (uint32_t)exponent << 23;
    float m;
    memcpy(&m, &bits, sizeof m);
    /* log2 m = 2 / ln 2 * artanh((m - 1) / (m + 1)) */
    float t = (m - 1.0f) / (m + 1.0f), t2 = t * t;
    float series =
        1.0f + t2 * (0.333333333f + t2 * (0.2f + t2 * (0.142857143f + t2 * 0.11111111f)));
    float y = p * ((float)exponent + 2.88539008f * t * series);
    y = y < -126.0f ? -126.0f : y > 126.0f ? 126.0f : y;

    float whole = floorf(y + 0.5f);
    float r = (y - whole) * 0.693147181f;
    float e = 1.0f + r * (1.0f + r * (0.5f + r * (0.166666667f +
                                                  r * (0.0416666667f + r * (0.00833333333f +
                                                                            r * 0.00138888889f)))));
    uint32_t scale_bits = (uint32_t)((int32_t)whole + 127) << 23;
    float factor;
    memcpy(&factor, &scale_bits, sizeof factor);
    return e * factor;
}

static inline float clamp01(float x)
{
    x = x < 0.0f ? 0.0f : x;
    return x > 1.0f ? 1.0f : x;
}

/* Converts a row of linear colours to the opponent space of the filters (HPG 2020, 4.1). */
KILN_WIDE_VECTORS
static void to_opponent(const float *rgb, size_t count, float *y, float *x, float *z)
{
    const float m00 = (float)(TO_XYZ[0][0] / 0.950428545),
                m01 = (float)(TO_XYZ[0][1] / 0.950428545),
                m02 = (float)(TO_XYZ[0][2] / 0.950428545);
    const float m10 = (float)TO_XYZ[1][0], m11 = (float)TO_XYZ[1][1], m12 = (float)TO_XYZ[1][2];
    const float m20 = (float)(TO_XYZ[2][0] / 1.088900371),
                m21 = (float)(TO_XYZ[2][1] / 1.088900371),
                m22 = (float)(TO_XYZ[2][2] / 1.088900371);
    for (size_t i = 0; i < count; i++) {
        float r = clamp01(rgb[3 * i]), g = clamp01(rgb[3 * i + 1]), b = clamp01(rgb[3 * i + 2]);
        float xn = m00 * r + m01 * g + m02 * b;
        float yn = m10 * r + m11 * g + m12 * b;
        float zn = m20 * r + m21 * g + m22 * b;
        y[i] = 116.0f * yn - 16.0f;
        x[i] = 500.0f * (xn - yn);
        z[i] = 200.0f * (yn - zn);
    }
}

static inline float lab_curve(float t)
{
    const float delta = 6.0f / 29.0f;
    float root = power(t > 1e-6f ? t : 1e-6f, 1.0f / 3.0f);
    float line = t / (3.0f * delta * delta) + 4.0f / 29.0f;
    return t > delta * delta * delta ? root : line;
}

struct lab {
    float l, a, b;
};

/* Converts linear RGB to CIELab with the Hunt effect: colours are weaker in the dark. */
static inline struct lab hunt_lab(float r, float g, float b)
{
    float x = (float)TO_XYZ[0][0] * r + (float)TO_XYZ[0][1] * g + (float)TO_XYZ[0][2] * b;
    float y = (float)TO_XYZ[1][0] * r + (float)TO_XYZ[1][1] * g + (float)TO_XYZ[1][2] * b;
    float z = (float)TO_XYZ[2][0] * r + (float)TO_XYZ[2][1] * g + (float)TO_XYZ[2][2] * b;
    float fx = lab_curve(x / WHITE[0]), fy = lab_curve(y), fz = lab_curve(z / WHITE[2]);
    struct lab lab;
    lab.l = 116.0f * fy - 16.0f;
    lab.a = 5.0f * (fx - fy) * lab.l; /* 500 * 0.01 */
    lab.b = 2.0f * (fy - fz) * lab.l;
    return lab;
}

/* Returns the HyAB distance to the power 0.7 (HPG 2020, 4.1.3). */
static inline float color_distance(struct lab p, struct lab q)
{
    float da = p.a - q.a, db = p.b - q.b;
    float distance = fabsf(p.l - q.l) + sqrtf(da * da + db * db);
    return distance > 0.0f ? power(distance, 0.7f) : 0.0f;
}

static inline struct lab filtered_lab(const float from_xyz[3][3], float y, float x, float z)
{
    float yn = (y + 16.0f) / 116.0f;
    float xw = (yn + x / 500.0f) * WHITE[0], zw = (yn - z / 200.0f) * WHITE[2];
    float r = from_xyz[0][0] * xw + from_xyz[0][1] * yn + from_xyz[0][2] * zw;
    float g = from_xyz[1][0] * xw + from_xyz[1][1] * yn + from_xyz[1][2] * zw;
    float b = from_xyz[2][0] * xw + from_xyz[2][1] * yn + from_xyz[2][2] * zw;
    return hunt_lab(clamp01(r), clamp01(g), clamp01(b));
}

/* ---- filters --------------------------------------------------------------------------------- */

/* Sets to[i] to the sum of weights[k] * from[i + k], k up to 2 radius. count is a multiple of
 * LANES, and from has 2 radius more. */
KILN_WIDE_VECTORS
static void filter_across(const float *from, const float *weights, int radius, float *to, int count)
{
    for (int i = 0; i < count; i += LANES) {
        float sum[LANES] = {0};
        for (int k = 0; k <= 2 * radius; k++) {
            for (int lane = 0; lane < LANES; lane++)
                sum[lane] += weights[k] * from[i + k + lane];
        }
        memcpy(to + i, sum, sizeof sum);
    }
}

/* Filters down the rows of a tile, which are `stride` floats apart, as filter_across does along a
 * row. */
KILN_WIDE_VECTORS
static void filter_down(const float *from, size_t stride, const float *weights, int radius,
                        float *to, int count)
{
    for (int i = 0; i < count; i += LANES) {
        float sum[LANES] = {0};
        for (int k = 0; k <= 2 * radius; k++) {
            for (int lane = 0; lane < LANES; lane++)
                sum[lane] += weights[k] * from[(size_t)k * stride + (size_t)(i + lane)];
        }
        memcpy(to + i, sum, sizeof sum);
    }
}

/* A tile holds the rows of both images after each filter has gone across. */
enum { TILE_ROWS = TILE_HEIGHT + 2 * MAX_RADIUS };

struct tile {
    float across[2][FILTER_COUNT][TILE_ROWS][TILE_WIDTH];
};

/* Copies one row of a plane with `radius` more values on each side, clamped to the edge. */
static void pad_row(const float *row, uint32_t width, int64_t left, int radius, float *padded)
{
    for (int i = 0; i < TILE_WIDTH + 2 * radius; i++) {
        int64_t x = left + i - radius;
        padded[i] = row[x < 0 ? 0 : x >= (int64_t)width ? (int64_t)width - 1 : x];
    }
}

static void filter_tile_across(const struct flip *flip, struct tile *tile, int64_t left,
                               int64_t top, int rows)
{
    const struct filters *f = &flip->filters;
    uint32_t width = flip->pair->width, height = flip->pair->height;
    float padded[PADDED_WIDTH + LANES] = {0};
    for (int image = 0; image < 2; image++) {
        const struct planes *planes = &flip->planes[image];
        const float *sources[FILTER_COUNT] = {planes->y, planes->x, planes->z, planes->z,
                                              planes->y, planes->y, planes->y};
        for (int k = 0; k < FILTER_COUNT; k++) {
            int radius = f->radius[k];
            for (int row = -radius; row < rows + radius; row++) {
                int64_t y = top + row;
                y = y < 0 ? 0 : y >= (int64_t)height ? (int64_t)height - 1 : y;
                pad_row(sources[k] + (size_t)y * width, width, left, radius, padded);
                filter_across(padded, f->weights[k], radius, tile->across[image][k][row + radius],
                              TILE_WIDTH);
            }
        }
    }
}

/* ---- the error of a row of a tile ------------------------------------------------------------ */

enum { FEATURE_COUNT = 4 }; /* edges across and down, points across and down */

struct row {
    float color[2][3][TILE_WIDTH]; /* filtered y, x, z */
    float feature[2][FEATURE_COUNT][TILE_WIDTH];
};

static void filter_row_down(const struct flip *flip, const struct tile *tile, int row,
                            struct row *out)
{
    const struct filters *f = &flip->filters;
    /* The rows are filtered by FIRST, and the columns of the result by SECOND. */
    static const int FIRST[FEATURE_COUNT] = {GAUSS_1, GAUSS, GAUSS_2, GAUSS};
    static const int SECOND[FEATURE_COUNT] = {GAUSS, GAUSS_1, GAUSS, GAUSS_2};
    for (int image = 0; image < 2; image++) {
        float second_z[TILE_WIDTH];
        for (int k = CSF_Y; k <= CSF_Z2; k++)
            filter_down(tile->across[image][k][row], TILE_WIDTH, f->weights[k], f->radius[k],
                        k == CSF_Z2 ? second_z : out->color[image][k], TILE_WIDTH);
        for (int i = 0; i < TILE_WIDTH; i++)
            out->color[image][2][i] += second_z[i];
        for (int k = 0; k < FEATURE_COUNT; k++)
            filter_down(tile->across[image][FIRST[k]][row], TILE_WIDTH, f->weights[SECOND[k]],
                        f->radius[SECOND[k]], out->feature[image][k], TILE_WIDTH);
    }
}

/* Returns the size of a feature. Features were filtered from the plane y; FLIP defines them on (y +
 * 16) / 116, whose slopes are 116 times smaller. */
static inline float feature_size(float across, float down)
{
    return sqrtf(across * across + down * down) * (1.0f / 116.0f);
}

/* Computes the errors of a row: the colour error, remapped at the knee, is raised to the power of 1
 * minus the feature error (HPG 2020, 4.1.3, 4.2 and 4.3). */
KILN_WIDE_VECTORS
static void judge_row(const struct row *row, const float from_xyz[3][3], float max_distance,
                      float *errors, int count)
{
    const float knee = 0.4f * max_distance, at_knee = 0.95f;
    for (int i = 0; i < count; i++) {
        struct lab p =
            filtered_lab(from_xyz, row->color[0][0][i], row->color[0][1][i], row->color[0][2][i]);
        struct lab q =
            filtered_lab(from_xyz, row->color[1][0][i], row->color[1][1][i], row->color[1][2][i]);
        float distance = color_distance(p, q);
        float below = distance * (at_knee / knee);
        float above = at_knee + (distance - knee) / (max_distance - knee) * (1.0f - at_knee);
        float color = distance < knee ? below : above;
        color = color > 1.0f ? 1.0f : color;

        float edge = feature_size(row->feature[0][0][i], row->feature[0][1][i]) -
                     feature_size(row->feature[1][0][i], row->feature[1][1][i]);
        float point = feature_size(row->feature[0][2][i], row->feature[0][3][i]) -
                      feature_size(row->feature[1][2][i], row->feature[1][3][i]);
        edge = fabsf(edge);
        point = fabsf(point);
        float feature = 0.707106781f * (edge > point ? edge : point);
        feature = sqrtf(feature > 1.0f ? 1.0f : feature);
        float error = power(color > 1e-9f ? color : 1e-9f, 1.0f - feature);
        errors[i] = color > 1e-9f ? (error > 1.0f ? 1.0f : error) : 0.0f;
    }
}

/* ---- the picture ----------------------------------------------------------------------------- */

struct tile_job {
    struct flip *flip;
    struct tile *tiles; /* one a worker */
};

static void judge_tiles(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct tile_job *job = context;
    const struct flip *flip = job->flip;
    struct tile *tile = &job->tiles[worker];
    uint32_t width = flip->pair->width, height = flip->pair->height;
    struct row row;
    for (size_t index = begin; index < end; index++) {
        uint32_t left = (uint32_t)(index % flip->tiles_across) * TILE_WIDTH;
        uint32_t top = (uint32_t)(index / flip->tiles_across) * TILE_HEIGHT;
        uint32_t columns = width - left < TILE_WIDTH ? width - left : TILE_WIDTH;
        uint32_t rows = height - top < TILE_HEIGHT ? height - top : TILE_HEIGHT;
        filter_tile_across(flip, tile, left, top, (int)rows);
        for (uint32_t y = 0; y < rows; y++) {
            float *errors = flip->errors + (size_t)(top + y) * width + left;
            filter_row_down(flip, tile, (int)y, &row);
            judge_row(&row, flip->from_xyz, flip->max_distance, errors, (int)columns);
        }
    }
}

static void convert_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct flip *flip = context;
    size_t width = flip->pair->width;
    const float *sources[2] = {flip->pair->reference, flip->pair->test};
    for (size_t row = begin; row < end; row++) {
        for (int image = 0; image < 2; image++) {
            const struct planes *p = &flip->planes[image];
            size_t at = row * width;
            to_opponent(sources[image] + 3 * at, width, p->y + at, p->x + at, p->z + at);
        }
    }
}

bool kiln_flip_check_finite(const float *picture, const struct kiln_flip_pair *pair,
                            struct kiln_error *error)
{
    size_t count = (size_t)pair->width * pair->height * 3;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(picture[i]))
            return kiln_error_set(error, KILN_INVALID_INPUT,
                                  "%s picture: pixel %zu,%zu has a value that is not finite",
                                  picture == pair->test ? "test" : "reference", i / 3 % pair->width,
                                  i / 3 / pair->width);
    }
    return true;
}

bool kiln_flip_ldr(const struct kiln_flip_pair *pair, const struct kiln_flip_params *params,
                   struct kiln_threads *threads, float *errors, struct kiln_error *error)
{
    static_assert(CSF_Y == 0 && CSF_X == 1 && CSF_Z1 == 2, "the order of struct row's colours");
    if (!(params->pixels_per_degree >= 4.0f && params->pixels_per_degree <= 400.0f))
        return kiln_error_set(error, KILN_USAGE, "found %g pixels a degree; expected 4 to 400",
                              (double)params->pixels_per_degree);
    if (!kiln_flip_check_finite(pair->reference, pair, error) ||
        !kiln_flip_check_finite(pair->test, pair, error))
        return false;

    struct flip flip = {.pair = pair, .errors = errors};
    make_contrast_filters(&flip.filters, (double)params->pixels_per_degree);
    make_feature_filters(&flip.filters, (double)params->pixels_per_degree);
    invert(TO_XYZ, flip.from_xyz);
    flip.max_distance = color_distance(hunt_lab(0.0f, 1.0f, 0.0f), hunt_lab(0.0f, 0.0f, 1.0f));
    flip.tiles_across = (pair->width + TILE_WIDTH - 1) / TILE_WIDTH;
    size_t pixels = (size_t)pair->width * pair->height;
    size_t tiles_down = (pair->height + TILE_HEIGHT - 1) / TILE_HEIGHT;

    float *memory = malloc(6 * pixels * sizeof *memory);
    struct tile *tiles = calloc(kiln_threads_count(threads), sizeof *tiles);
    bool ok = memory && tiles;
    if (ok) {
        for (int i = 0; i < 2; i++) {
            float *start = memory + (size_t)i * 3 * pixels;
            flip.planes[i] = (struct planes){start, start + pixels, start + 2 * pixels};
        }
        kiln_threads_for(threads, pair->height, 16, convert_rows, &flip);
        struct tile_job job = {.flip = &flip, .tiles = tiles};
        kiln_threads_for(threads, flip.tiles_across * tiles_down, 1, judge_tiles, &job);
    } else {
        kiln_error_no_memory(error, "comparing %u x %u pixels", pair->width, pair->height);
    }
    free(memory);
    free(tiles);
    return ok;
}
