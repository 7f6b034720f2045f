/* The vorticity form of an ideal fluid: vorticity moves with the flow and is made by buoyancy; the
 * flow is the curl of a stream function whose Laplacian is minus the vorticity. Backward tracing as
 * in Stam, "Stable Fluids" (1999), with cubic interpolation, which hardly blurs. */
#include "asset/fluid.h"

#include "base/vector.h"
#include "shared/exact.h"

#include <string.h>

enum { EDGE = KILN_FLUID_EDGE, SIZE = KILN_FLUID_SIZE, SWEEPS = 12 };

static const float SPACING = 2.0f / EDGE;

void kiln_fluid_init(struct kiln_fluid *fluid)
{
    memset(fluid, 0, sizeof *fluid);
    for (uint32_t i = 0; i < SIZE; i++) {
        fluid->place_x[i] = kiln_fluid_at(i % EDGE);
        fluid->place_y[i] = kiln_fluid_at(i / EDGE);
    }
}

static size_t held(int index)
{
    return index < 0 ? 0 : index >= EDGE ? EDGE - 1 : (size_t)index;
}

/* Gauss and Seidel's sweeps, over-relaxed, from the last step's solution. */
static void solve_stream(struct kiln_fluid *fluid)
{
    float *stream = fluid->stream;
    const float relaxation = 1.75f;
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (int y = 0; y < EDGE; y++) {
            const float *below = stream + held(y - 1) * EDGE, *above = stream + held(y + 1) * EDGE;
            float *row = stream + (size_t)y * EDGE;
            const float *turning = fluid->vorticity + (size_t)y * EDGE;
            for (int x = 1; x < EDGE - 1; x++) {
                float around = below[x] + above[x] + row[x - 1] + row[x + 1];
                float solved = 0.25f * (around + SPACING * SPACING * turning[x]);
                row[x] += relaxation * (solved - row[x]);
            }
        }
    }
}

static void take_velocity(struct kiln_fluid *fluid)
{
    const float *stream = fluid->stream;
    const float scale = 0.5f / SPACING;
    for (int y = 0; y < EDGE; y++) {
        for (int x = 0; x < EDGE; x++) {
            int i = y * EDGE + x;
            float up =
                stream[held(y + 1) * EDGE + (size_t)x] - stream[held(y - 1) * EDGE + (size_t)x];
            float slope =
                stream[(size_t)y * EDGE + held(x + 1)] - stream[(size_t)y * EDGE + held(x - 1)];
            float wider = (fluid->swelling - fluid->strain) * kiln_fluid_at((uint32_t)x);
            float higher = (fluid->swelling + fluid->strain) * kiln_fluid_at((uint32_t)y);
            fluid->velocity_x[i] = scale * up + wider;
            fluid->velocity_y[i] = fluid->rise - scale * slope + higher;
        }
    }
}

/* Hot gas pushes up: what is hotter on its right side turns to the left. */
static void turn(struct kiln_fluid *fluid, float dt)
{
    const float scale = 0.5f / SPACING * fluid->buoyancy * dt;
    const float kept = 1.0f - fluid->drag * dt;
    for (int y = 0; y < EDGE; y++) {
        for (int x = 0; x < EDGE; x++) {
            size_t row = (size_t)y * EDGE;
            float slope = fluid->heat[row + held(x + 1)] - fluid->heat[row + held(x - 1)];
            fluid->vorticity[row + (size_t)x] =
                kept * fluid->vorticity[row + (size_t)x] + scale * slope;
        }
    }
}

/* Weights of Catmull and Rom's cubic at a fraction t of the way from the second of four samples. */
static void cubic_weights(float t, float w[4])
{
    float t2 = t * t, t3 = t2 * t;
    w[0] = -0.5f * t3 + t2 - 0.5f * t;
    w[1] = 1.5f * t3 - 2.5f * t2 + 1.0f;
    w[2] = -1.5f * t3 + 2.0f * t2 + 0.5f * t;
    w[3] = 0.5f * t3 - 0.5f * t2;
}

/* Where a sample's gas was before, as indices and weights of 4 x 4 samples. */
struct origin {
    size_t columns[4], rows[4];
    float wx[4], wy[4];
};

static void trace(const struct kiln_fluid *fluid, int i, float dt, struct origin *origin)
{
    float x = (float)(i % EDGE) - fluid->velocity_x[i] * dt / SPACING;
    float y = (float)(i / EDGE) - fluid->velocity_y[i] * dt / SPACING;
    x = exact_min(exact_max(x, 0.0f), EDGE - 1.0f);
    y = exact_min(exact_max(y, 0.0f), EDGE - 1.0f);
    int left = (int)x, bottom = (int)y;
    cubic_weights(x - (float)left, origin->wx);
    cubic_weights(y - (float)bottom, origin->wy);
    for (int k = 0; k < 4; k++) {
        origin->columns[k] = held(left + k - 1);
        origin->rows[k] = held(bottom + k - 1) * EDGE;
    }
}

/* Between the four samples around it, so that no new extremes arise. */
static float carried(const struct origin *origin, const float *field)
{
    float sum = 0.0f;
    for (int j = 0; j < 4; j++) {
        const float *row = field + origin->rows[j];
        float along =
            row[origin->columns[0]] * origin->wx[0] + row[origin->columns[1]] * origin->wx[1] +
            row[origin->columns[2]] * origin->wx[2] + row[origin->columns[3]] * origin->wx[3];
        sum += along * origin->wy[j];
    }
    float a = field[origin->rows[1] + origin->columns[1]];
    float b = field[origin->rows[1] + origin->columns[2]];
    float c = field[origin->rows[2] + origin->columns[1]];
    float d = field[origin->rows[2] + origin->columns[2]];
    float low = exact_min(exact_min(a, b), exact_min(c, d)),
          high = exact_max(exact_max(a, b), exact_max(c, d));
    return exact_min(exact_max(sum, low), high);
}

static void carry(struct kiln_fluid *fluid, float dt)
{
    float *fields[4] = {fluid->vorticity, fluid->heat, fluid->place_x, fluid->place_y};
    for (int i = 0; i < SIZE; i++) {
        struct origin origin;
        trace(fluid, i, dt, &origin);
        for (int f = 0; f < 4; f++)
            fluid->scratch[f][i] = carried(&origin, fields[f]);
    }
    for (int f = 0; f < 4; f++)
        memcpy(fields[f], fluid->scratch[f], sizeof fluid->scratch[f]);
}

KILN_WIDE_VECTORS
void kiln_fluid_step(struct kiln_fluid *fluid, float dt)
{
    turn(fluid, dt);
    solve_stream(fluid);
    take_velocity(fluid);
    carry(fluid, dt);
}

float kiln_fluid_sample(const float field[KILN_FLUID_SIZE], float x, float y)
{
    float column = exact_min(exact_max((x + 1.0f) / SPACING - 0.5f, 0.0f), EDGE - 1.0f);
    float row = exact_min(exact_max((y + 1.0f) / SPACING - 0.5f, 0.0f), EDGE - 1.0f);
    int middle_x = (int)(column + 0.5f), middle_y = (int)(row + 0.5f);
    float tx = column - (float)middle_x, ty = row - (float)middle_y;
    float wx[3] = {0.5f * (0.5f - tx) * (0.5f - tx), 0.75f - tx * tx,
                   0.5f * (0.5f + tx) * (0.5f + tx)};
    float wy[3] = {0.5f * (0.5f - ty) * (0.5f - ty), 0.75f - ty * ty,
                   0.5f * (0.5f + ty) * (0.5f + ty)};
    float sum = 0.0f;
    for (int j = 0; j < 3; j++) {
        const float *samples = field + held(middle_y + j - 1) * EDGE;
        for (int i = 0; i < 3; i++)
            sum += wx[i] * wy[j] * samples[held(middle_x + i - 1)];
    }
    return sum;
}
