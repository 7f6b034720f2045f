/* This file steps a two-dimensional ideal fluid in its vorticity form, and samples it between its
 * lattice points. Vorticity moves with the flow and is made by buoyancy. The flow is the curl of a
 * stream function whose Laplacian is minus the vorticity. Fields are traced backwards as in Stam,
 * "Stable Fluids" (1999), with cubic interpolation, which hardly blurs. */
#include <string.h>

#include "asset/atlas/fluid.h"
#include "asset/atlas/quad.h"
#include "shared/exact.h"

enum {
    EDGE = KILN_FLUID_EDGE,
    SIZE = KILN_FLUID_SIZE,
    SWEEPS = 12,
    BLOCK = 16, /* samples of a diagonal that are relaxed at once: the widest vector */
};

static const float SPACING = 2.0f / EDGE;

static inline int held(int index)
{
    return index < 0 ? 0 : index >= EDGE ? EDGE - 1 : index;
}

/* ---- from vorticity to velocity -------------------------------------------------------------- */

/* Relaxes one diagonal, x + y = a, of an over-relaxed Gauss-Seidel sweep. The lowest row uses
 * itself as the row below, and the highest row itself as the row above. */
static inline void relax(struct kiln_fluid *fluid, int a)
{
    float *at = fluid->stream[a + 1] + KILN_FLUID_MARGIN, *before = at - KILN_FLUID_PITCH;
    float *after = at + KILN_FLUID_PITCH;
    const float *turning = fluid->turning[a];
    const int first = a < EDGE ? 1 : a - EDGE + 1, last = a < EDGE - 1 ? a : EDGE - 2;
    if (a < EDGE - 1)
        before[a] = at[a];
    if (a >= EDGE)
        after[a - EDGE + 1] = at[a - EDGE + 1];
    for (int begin = first & -BLOCK; begin <= last; begin += BLOCK) {
        for (int x = begin; x < begin + BLOCK; x++) {
            const float relaxation = x >= first && x <= last ? 1.75f : 0.0f;
            float around = before[x] + after[x] + before[x - 1] + after[x + 1];
            float solved = 0.25f * (around + SPACING * SPACING * turning[x]);
            at[x] += relaxation * (solved - at[x]);
        }
    }
}

/* Solves for the stream function by sweeps from the last step's solution. A sample needs those to
 * its left and below of its own sweep, and those to its right and above of the sweep before. So the
 * samples of a diagonal are independent, and a sweep may follow two diagonals behind another. */
static void solve_stream(struct kiln_fluid *fluid)
{
    for (int y = 0; y < EDGE; y++) {
        for (int x = 0; x < EDGE; x++)
            fluid->turning[x + y][x] = fluid->vorticity[y * EDGE + x];
    }
    for (int wave = 1; wave < KILN_FLUID_DIAGONALS + 2 * SWEEPS; wave++) {
        for (int a = wave, sweep = 0; sweep < SWEEPS && a > 0; a -= 2, sweep++) {
            if (a < KILN_FLUID_DIAGONALS - 1)
                relax(fluid, a);
        }
    }
}

static void take_velocity(struct kiln_fluid *fluid)
{
    enum { WIDE = EDGE + 2 };
    float stream[EDGE + 2][WIDE];
    const float scale = 0.5f / SPACING;
    for (int y = 0; y < EDGE; y++) {
        for (int x = 0; x < EDGE; x++)
            stream[y + 1][x + 1] = fluid->stream[x + y + 1][KILN_FLUID_MARGIN + x];
        stream[y + 1][0] = stream[y + 1][1];
        stream[y + 1][EDGE + 1] = stream[y + 1][EDGE];
    }
    memcpy(stream[0], stream[1], sizeof stream[0]);
    memcpy(stream[EDGE + 1], stream[EDGE], sizeof stream[0]);
    for (int y = 0; y < EDGE; y++) {
        const float higher = (fluid->swelling + fluid->strain) * kiln_fluid_coordinate((uint32_t)y);
        for (int x = 0; x < EDGE; x++) {
            float up = stream[y + 2][x + 1] - stream[y][x + 1];
            float slope = stream[y + 1][x + 2] - stream[y + 1][x];
            float at_x = ((float)x + 0.5f) * (2.0f / EDGE) - 1.0f;
            float wider = (fluid->swelling - fluid->strain) * at_x;
            fluid->velocity_x[y * EDGE + x] = scale * up + wider;
            fluid->velocity_y[y * EDGE + x] = fluid->rise - scale * slope + higher;
        }
    }
}

/* Adds the vorticity of buoyancy: hot gas rises, so gas that is hotter on its right turns left. */
static void turn(struct kiln_fluid *fluid, float dt)
{
    const float scale = 0.5f / SPACING * fluid->buoyancy * dt;
    const float remaining = 1.0f - fluid->drag * dt;
    for (int y = 0; y < EDGE; y++) {
        float row[EDGE + 2];
        memcpy(row + 1, fluid->heat + (size_t)y * EDGE, EDGE * sizeof(float));
        row[0] = row[1];
        row[EDGE + 1] = row[EDGE];
        float *vorticity = fluid->vorticity + (size_t)y * EDGE;
        for (int x = 0; x < EDGE; x++)
            vorticity[x] = remaining * vorticity[x] + scale * (row[x + 2] - row[x]);
    }
}

/* ---- moving with the flow -------------------------------------------------------------------- */

/* Size of a side of fields with one more row and column before the first and two behind the
 * last. */
enum { PADDED = EDGE + 3 };

/* Holds where the gas of a row of samples was before the step: the first of the samples around each
 * place, and the weights of four columns and rows. */
struct origins {
    int32_t at[EDGE]; /* index of the first of 4 x 4 padded samples */
    float wx[4][EDGE], wy[4][EDGE];
};

/* Computes the weights of Catmull and Rom's cubic at a fraction t of the way from the second to the
 * third of four samples. */
static inline void cubic_weights(float t, float weights[4][EDGE], int x)
{
    float t2 = t * t, t3 = t2 * t;
    weights[0][x] = -0.5f * t3 + t2 - 0.5f * t;
    weights[1][x] = 1.5f * t3 - 2.5f * t2 + 1.0f;
    weights[2][x] = -1.5f * t3 + 2.0f * t2 + 0.5f * t;
    weights[3][x] = 0.5f * t3 - 0.5f * t2;
}

static void trace(const struct kiln_fluid *fluid, int y, float dt, struct origins *origins)
{
    const float *velocity_x = fluid->velocity_x + (size_t)y * EDGE;
    const float *velocity_y = fluid->velocity_y + (size_t)y * EDGE;
    for (int x = 0; x < EDGE; x++) {
        float from_x = (float)x - velocity_x[x] * dt / SPACING;
        float from_y = (float)y - velocity_y[x] * dt / SPACING;
        from_x = exact_min(exact_max(from_x, 0.0f), EDGE - 1.0f);
        from_y = exact_min(exact_max(from_y, 0.0f), EDGE - 1.0f);
        int left = (int)from_x, bottom = (int)from_y;
        origins->at[x] = bottom * PADDED + left;
        cubic_weights(from_x - (float)left, origins->wx, x);
        cubic_weights(from_y - (float)bottom, origins->wy, x);
    }
}

/* Interpolates a field, clamped to the four samples around, so that no new extremes arise. */
static inline asset_quad carried(const asset_quad *from, const struct origins *origins, int x)
{
    asset_quad sum = {0};
    for (int j = 0; j < 4; j++) {
        const asset_quad *row = from + (size_t)j * PADDED;
        sum += (row[0] * origins->wx[0][x] + row[1] * origins->wx[1][x] +
                row[2] * origins->wx[2][x] + row[3] * origins->wx[3][x]) *
               origins->wy[j][x];
    }
    asset_quad a = from[PADDED + 1], b = from[PADDED + 2];
    asset_quad c = from[2 * PADDED + 1], d = from[2 * PADDED + 2];
    asset_quad low = asset_quad_min(asset_quad_min(a, b), asset_quad_min(c, d));
    asset_quad high = asset_quad_max(asset_quad_max(a, b), asset_quad_max(c, d));
    return asset_quad_min(asset_quad_max(sum, low), high);
}

static void carry(struct kiln_fluid *fluid, float dt)
{
    asset_quad samples[PADDED * PADDED];
    for (int y = 0; y < PADDED; y++) {
        const size_t row = (size_t)held(y - 1) * EDGE;
        asset_quad *to = samples + (size_t)y * PADDED;
        for (size_t x = 0; x < EDGE; x++)
            to[x + 1] = (asset_quad){fluid->vorticity[row + x], fluid->heat[row + x],
                                     fluid->place_x[row + x], fluid->place_y[row + x]};
        to[0] = to[1];
        to[EDGE + 1] = to[EDGE + 2] = to[EDGE];
    }
    for (int y = 0; y < EDGE; y++) {
        struct origins origins;
        trace(fluid, y, dt, &origins);
        for (int x = 0; x < EDGE; x++) {
            asset_quad moved = carried(samples + origins.at[x], &origins, x);
            const size_t i = (size_t)y * EDGE + (size_t)x;
            fluid->vorticity[i] = moved[0];
            fluid->heat[i] = moved[1];
            fluid->place_x[i] = moved[2];
            fluid->place_y[i] = moved[3];
        }
    }
}

static void step(struct kiln_fluid *fluid, float dt)
{
    turn(fluid, dt);
    solve_stream(fluid);
    take_velocity(fluid);
    carry(fluid, dt);
}

/* ---- between the samples --------------------------------------------------------------------- */

/* The taps of a quadratic B-spline: the middle one of three samples, and the weights of the
 * three. */
struct taps {
    int middle;
    float weights[3];
};

static inline struct taps taps_at(float x)
{
    float place = exact_min(exact_max((x + 1.0f) / SPACING - 0.5f, 0.0f), EDGE - 1.0f);
    int middle = (int)(place + 0.5f);
    float t = place - (float)middle;
    return (struct taps){
        middle, {0.5f * (0.5f - t) * (0.5f - t), 0.75f - t * t, 0.5f * (0.5f + t) * (0.5f + t)}};
}

/* Interpolates all rows of samples at the columns of the texels. */
static void spread(const float *field, uint32_t edge, struct kiln_fluid_scratch *scratch,
                   float weights[3][KILN_FLUID_FINEST])
{
    uint8_t at[3][KILN_FLUID_FINEST];
    const float texel_size = 2.0f / (float)edge;
    for (uint32_t x = 0; x < edge; x++) {
        struct taps taps = taps_at(((float)x + 0.5f) * texel_size - 1.0f);
        for (int i = 0; i < 3; i++) {
            weights[i][x] = taps.weights[i];
            at[i][x] = (uint8_t)held(taps.middle + i - 1);
        }
    }
    for (size_t y = 0; y < EDGE; y++) {
        for (size_t i = 0; i < 3; i++) {
            float *to = scratch->columns[y][i];
            for (uint32_t x = 0; x < edge; x++)
                to[x] = field[y * EDGE + at[i][x]];
        }
    }
}

static void sample(const float *field, uint32_t edge, struct kiln_fluid_scratch *scratch,
                   float *out)
{
    const float texel_size = 2.0f / (float)edge;
    float weights[3][KILN_FLUID_FINEST];
    spread(field, edge, scratch, weights);
    for (uint32_t y = 0; y < edge; y++, out += edge) {
        struct taps taps = taps_at(1.0f - ((float)y + 0.5f) * texel_size);
        const float(*below)[KILN_FLUID_FINEST] = scratch->columns[held(taps.middle - 1)];
        const float(*here)[KILN_FLUID_FINEST] = scratch->columns[taps.middle];
        const float(*above)[KILN_FLUID_FINEST] = scratch->columns[held(taps.middle + 1)];
        const float *w = taps.weights;
        for (uint32_t x = 0; x < edge; x++) {
            const float a = weights[0][x], b = weights[1][x], c = weights[2][x];
            float sum = 0.0f;
            sum += a * w[0] * below[0][x];
            sum += b * w[0] * below[1][x];
            sum += c * w[0] * below[2][x];
            sum += a * w[1] * here[0][x];
            sum += b * w[1] * here[1][x];
            sum += c * w[1] * here[2][x];
            sum += a * w[2] * above[0][x];
            sum += b * w[2] * above[1][x];
            sum += c * w[2] * above[2][x];
            out[x] = sum;
        }
    }
}

const struct kiln_fluid_code KILN_SIMD_NAME(kiln_fluid) = {.step = step, .sample = sample};
