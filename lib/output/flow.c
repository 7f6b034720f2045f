/* Estimates optical flow between two pictures, from coarse to fine. At each size, `to` is warped by
 * the flow so far, and the rest of the motion is found by minimising the difference of the pictures
 * plus a penalty for flow that is not smooth. Both terms grow like the distance, not its square, so
 * that a puff that appears pulls nothing along and edges of motion stay sharp. The minimum is
 * approached by relaxation in a fixed order of pixels, with plain arithmetic, so the result is the
 * same everywhere. */
#include "output/flow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAX_LEVELS = 12,
    MAX_CHANNELS = 4,
    LEAST_EDGE = 12, /* least edge of the coarsest picture, pixels */
    WARPS = 4,
    SWEEPS = 24,
};

static const float smoothness = 0.15f;
/* below this, a difference is penalised like its square */
static const float least_difference = 1e-3f;
/* bend of the flow, in pixels a pixel, below which it is penalised like its square */
static const float least_bend = 0.05f;
static const float over_relaxation = 1.7f;
static const float most_change = 1.0f; /* most change of the flow by one warp, pixels */

struct picture {
    uint32_t width, height, channels;
    float *pixels;
};

struct level {
    struct picture from, to;
};

/* Coefficients of one pixel's equations. */
struct equation {
    float xx, xy, yy, xt, yt; /* products of the derivatives of the pictures */
    float right, down;        /* stiffness between this pixel and its right and lower neighbour */
};

struct solver {
    uint32_t width, height;
    float *flow;  /* the present flow */
    float *start; /* the flow by which `to` was warped last */
    struct picture bent;
    struct equation *equations;
};

static uint32_t clamp_index(int64_t i, uint32_t count)
{
    return i < 0 ? 0 : i >= (int64_t)count ? count - 1 : (uint32_t)i;
}

static float *pixel(const struct picture *picture, int64_t x, int64_t y)
{
    size_t at =
        (size_t)clamp_index(y, picture->height) * picture->width + clamp_index(x, picture->width);
    return picture->pixels + at * picture->channels;
}

static bool create_picture(struct picture *picture, uint32_t width, uint32_t height,
                           uint32_t channels)
{
    *picture = (struct picture){width, height, channels,
                                calloc((size_t)width * height * channels, sizeof(float))};
    return picture->pixels != NULL;
}

/* ---- Pyramid ------------------------------------------------------------------------------- */

/* Blurs by (1 2 1)/4 both ways: derivatives of single pixels are mostly noise. */
static void blur(const struct picture *in, const struct picture *out)
{
    static const float weights[3] = {0.25f, 0.5f, 0.25f};
    for (uint32_t y = 0; y < in->height; y++) {
        for (uint32_t x = 0; x < in->width; x++) {
            float *sum = pixel(out, x, y);
            for (int64_t dy = -1; dy <= 1; dy++) {
                for (int64_t dx = -1; dx <= 1; dx++) {
                    const float *value = pixel(in, x + dx, y + dy);
                    for (uint32_t c = 0; c < in->channels; c++)
                        sum[c] += weights[dx + 1] * weights[dy + 1] * value[c];
                }
            }
        }
    }
}

/* Averages by (1 3 3 1)/8 both ways, which keeps fine texture from turning into coarse. */
static void halve(const struct picture *fine, const struct picture *coarse)
{
    static const float weights[4] = {0.125f, 0.375f, 0.375f, 0.125f};
    for (uint32_t y = 0; y < coarse->height; y++) {
        for (uint32_t x = 0; x < coarse->width; x++) {
            float *sum = pixel(coarse, x, y);
            for (int64_t i = 0; i < 16; i++) {
                const float *value =
                    pixel(fine, 2 * (int64_t)x + i % 4 - 1, 2 * (int64_t)y + i / 4 - 1);
                for (uint32_t c = 0; c < fine->channels; c++)
                    sum[c] += weights[i % 4] * weights[i / 4] * value[c];
            }
        }
    }
}

static bool build_pyramid(struct level *levels, uint32_t count, const float *const pictures[2])
{
    bool good = true;
    for (uint32_t i = 0; good && i < count; i++) {
        struct level *level = &levels[i];
        uint32_t width = level->from.width, height = level->from.height;
        uint32_t channels = level->from.channels;
        good = create_picture(&level->from, width, height, channels) &&
               create_picture(&level->to, width, height, channels);
        if (good && i == 0) {
            /* blur() only reads its input. */
            struct picture in[2] = {{width, height, channels, (float *)pictures[0]},
                                    {width, height, channels, (float *)pictures[1]}};
            blur(&in[0], &level->from);
            blur(&in[1], &level->to);
        } else if (good) {
            halve(&levels[i - 1].from, &level->from);
            halve(&levels[i - 1].to, &level->to);
        }
    }
    return good;
}

/* ---- One level ------------------------------------------------------------------------------ */

/* Warps `to` by the flow: bent(p) = to(p + flow(p)), interpolated linearly. */
static void bend(const struct solver *solver, const struct picture *to)
{
    for (uint32_t y = 0; y < to->height; y++) {
        for (uint32_t x = 0; x < to->width; x++) {
            const float *flow = solver->flow + 2 * ((size_t)y * to->width + x);
            float px = (float)x + flow[0], py = (float)y + flow[1];
            float fx = floorf(px), fy = floorf(py);
            int64_t ix = (int64_t)fx, iy = (int64_t)fy;
            const float *corners[4] = {pixel(to, ix, iy), pixel(to, ix + 1, iy),
                                       pixel(to, ix, iy + 1), pixel(to, ix + 1, iy + 1)};
            float *out = pixel(&solver->bent, x, y);
            for (uint32_t c = 0; c < to->channels; c++) {
                float top = corners[0][c] + (px - fx) * (corners[1][c] - corners[0][c]);
                float bottom = corners[2][c] + (px - fx) * (corners[3][c] - corners[2][c]);
                out[c] = top + (py - fy) * (bottom - top);
            }
        }
    }
}

/* Returns how stiff the flow is between two pixels: less where it already bends. */
static float stiffness(const float *a, const float *b)
{
    float du = a[0] - b[0], dv = a[1] - b[1];
    return smoothness * least_bend / sqrtf(du * du + dv * dv + least_bend * least_bend);
}

static struct equation make_equation(const struct solver *solver, const struct picture *from,
                                     uint32_t x, uint32_t y)
{
    struct equation equation = {0};
    const struct picture *bent = &solver->bent;
    const float *a = pixel(from, x, y), *b = pixel(bent, x, y);
    const float *flow = solver->flow + 2 * ((size_t)y * solver->width + x);
    float tx = (float)x + flow[0], ty = (float)y + flow[1];
    bool seen = tx >= 0.0f && ty >= 0.0f && tx <= (float)(solver->width - 1) &&
                ty <= (float)(solver->height - 1);
    for (uint32_t c = 0; seen && c < from->channels; c++) {
        float gx = 0.25f * (pixel(from, (int64_t)x + 1, y)[c] - pixel(from, (int64_t)x - 1, y)[c] +
                            pixel(bent, (int64_t)x + 1, y)[c] - pixel(bent, (int64_t)x - 1, y)[c]);
        float gy = 0.25f * (pixel(from, x, (int64_t)y + 1)[c] - pixel(from, x, (int64_t)y - 1)[c] +
                            pixel(bent, x, (int64_t)y + 1)[c] - pixel(bent, x, (int64_t)y - 1)[c]);
        float gt = b[c] - a[c];
        float weight = 0.1f / sqrtf(gt * gt + least_difference);
        equation.xx += weight * gx * gx;
        equation.xy += weight * gx * gy;
        equation.yy += weight * gy * gy;
        equation.xt += weight * gx * gt;
        equation.yt += weight * gy * gt;
    }
    if (x + 1 < solver->width)
        equation.right = stiffness(flow, flow + 2);
    if (y + 1 < solver->height)
        equation.down = stiffness(flow, flow + 2 * (size_t)solver->width);
    return equation;
}

/* Moves one pixel's flow towards the solution of its equations, with its neighbours' flow fixed. */
static void relax(const struct solver *solver, uint32_t x, uint32_t y)
{
    size_t width = solver->width, at = (size_t)y * width + x;
    const struct equation *equation = &solver->equations[at];
    float *flow = solver->flow + 2 * at;
    const float *start = solver->start + 2 * at;
    float pull = 1e-9f, sum[2] = {0};
    const struct {
        bool there;
        float stiffness;
        ptrdiff_t step;
    } sides[4] = {
        {x > 0, x > 0 ? equation[-1].right : 0, -2},
        {x + 1 < solver->width, equation->right, 2},
        {y > 0, y > 0 ? equation[-(ptrdiff_t)width].down : 0, -2 * (ptrdiff_t)width},
        {y + 1 < solver->height, equation->down, 2 * (ptrdiff_t)width},
    };
    for (int i = 0; i < 4; i++) {
        if (!sides[i].there)
            continue;
        pull += sides[i].stiffness;
        sum[0] += sides[i].stiffness * flow[sides[i].step];
        sum[1] += sides[i].stiffness * flow[sides[i].step + 1];
    }
    /* With f = start + d: (xx d.x + xy d.y + xt) + pull f.x - sum.x = 0, and so for y. */
    float a = equation->xx + pull, b = equation->xy, c = equation->yy + pull;
    float r0 = sum[0] - pull * start[0] - equation->xt,
          r1 = sum[1] - pull * start[1] - equation->yt;
    float determinant = a * c - b * b;
    float new0 = start[0] + (c * r0 - b * r1) / determinant;
    float new1 = start[1] + (a * r1 - b * r0) / determinant;
    flow[0] += over_relaxation * (new0 - flow[0]);
    flow[1] += over_relaxation * (new1 - flow[1]);
}

/* Limits how far one warp may change the flow, since derivatives hold only near a pixel. */
static void limit_change(const struct solver *solver, size_t count)
{
    for (size_t i = 0; i < 2 * count; i++) {
        float change = solver->flow[i] - solver->start[i];
        if (change > most_change)
            solver->flow[i] = solver->start[i] + most_change;
        else if (change < -most_change)
            solver->flow[i] = solver->start[i] - most_change;
    }
}

static float median_of_9(float values[9])
{
    for (int i = 1; i < 9; i++) {
        float value = values[i];
        int place = i;
        for (; place > 0 && values[place - 1] > value; place--)
            values[place] = values[place - 1];
        values[place] = value;
    }
    return values[4];
}

/* Replaces the flow by medians, which removes outliers of single pixels. */
static void take_medians(const struct solver *solver, size_t count)
{
    memcpy(solver->start, solver->flow, 2 * count * sizeof *solver->flow);
    const struct picture old = {solver->width, solver->height, 2, solver->start};
    for (uint32_t y = 0; y < solver->height; y++) {
        for (uint32_t x = 0; x < solver->width; x++) {
            for (size_t c = 0; c < 2; c++) {
                float values[9];
                for (int64_t i = 0; i < 9; i++)
                    values[i] = pixel(&old, (int64_t)x + i % 3 - 1, (int64_t)y + i / 3 - 1)[c];
                solver->flow[2 * ((size_t)y * solver->width + x) + c] = median_of_9(values);
            }
        }
    }
}

static void solve_level(struct solver *solver, const struct level *level)
{
    solver->width = level->from.width;
    solver->height = level->from.height;
    solver->bent.width = solver->width;
    solver->bent.height = solver->height;
    size_t count = (size_t)solver->width * solver->height;
    for (int warp = 0; warp < WARPS; warp++) {
        bend(solver, &level->to);
        memcpy(solver->start, solver->flow, 2 * count * sizeof *solver->flow);
        for (uint32_t y = 0; y < solver->height; y++) {
            for (uint32_t x = 0; x < solver->width; x++)
                solver->equations[(size_t)y * solver->width + x] =
                    make_equation(solver, &level->from, x, y);
        }
        for (int sweep = 0; sweep < SWEEPS; sweep++) {
            for (uint32_t y = 0; y < solver->height; y++) {
                for (uint32_t x = 0; x < solver->width; x++)
                    relax(solver, x, y);
            }
        }
        limit_change(solver, count);
        take_medians(solver, count);
    }
}

/* Enlarges the flow of the coarser level to this one's size; `start` holds the coarse flow
 * meanwhile. */
static void enlarge(struct solver *solver, const struct level *coarse, const struct level *fine)
{
    size_t count = (size_t)coarse->from.width * coarse->from.height;
    memcpy(solver->start, solver->flow, 2 * count * sizeof *solver->flow);
    const struct picture old = {coarse->from.width, coarse->from.height, 2, solver->start};
    for (uint32_t y = 0; y < fine->from.height; y++) {
        for (uint32_t x = 0; x < fine->from.width; x++) {
            float px = 0.5f * (float)x - 0.25f, py = 0.5f * (float)y - 0.25f;
            float fx = floorf(px), fy = floorf(py);
            for (int c = 0; c < 2; c++) {
                int64_t ix = (int64_t)fx, iy = (int64_t)fy;
                float top = pixel(&old, ix, iy)[c] +
                            (px - fx) * (pixel(&old, ix + 1, iy)[c] - pixel(&old, ix, iy)[c]);
                float bottom =
                    pixel(&old, ix, iy + 1)[c] +
                    (px - fx) * (pixel(&old, ix + 1, iy + 1)[c] - pixel(&old, ix, iy + 1)[c]);
                solver->flow[2 * ((size_t)y * fine->from.width + x) + (size_t)c] =
                    2.0f * (top + (py - fy) * (bottom - top));
            }
        }
    }
}

static uint32_t plan_levels(struct level *levels, uint32_t width, uint32_t height,
                            uint32_t channels)
{
    uint32_t count = 0;
    for (;; width = (width + 1) / 2, height = (height + 1) / 2) {
        levels[count++].from = (struct picture){width, height, channels, NULL};
        if (count == MAX_LEVELS || width < 2 * LEAST_EDGE || height < 2 * LEAST_EDGE)
            return count;
    }
}

bool kiln_flow_estimate(const float *from, const float *to, uint32_t width, uint32_t height,
                        uint32_t channels, float *flow)
{
    struct level levels[MAX_LEVELS] = {0};
    uint32_t count = plan_levels(levels, width, height, channels);
    size_t pixels = (size_t)width * height;
    struct solver solver = {
        .flow = flow,
        .start = malloc(2 * pixels * sizeof(float)),
        .equations = malloc(pixels * sizeof(struct equation)),
    };
    bool good = solver.start && solver.equations &&
                create_picture(&solver.bent, width, height, channels) &&
                build_pyramid(levels, count, (const float *const[2]){from, to});
    memset(flow, 0, 2 * pixels * sizeof *flow);
    for (uint32_t i = count; good && i-- > 0;) {
        if (i + 1 < count)
            enlarge(&solver, &levels[i + 1], &levels[i]);
        solve_level(&solver, &levels[i]);
    }
    for (uint32_t i = 0; i < count; i++) {
        free(levels[i].from.pixels);
        free(levels[i].to.pixels);
    }
    free(solver.start);
    free(solver.equations);
    free(solver.bent.pixels);
    return good;
}
