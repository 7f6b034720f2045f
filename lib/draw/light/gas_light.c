/* This file gathers the light of burning gas into four point lights. Flames are shared between the
 * lights by where they are: the middle of the fire, and how far it spreads along each axis, place
 * four corners of a cube that share no edge. Each flame belongs to all four lights, mostly to the
 * one whose corner it is nearest to. All of this changes smoothly as the gas moves, so that lights
 * flicker with the fire and never jump.
 *
 * Gas swallows a part of its light. Of each large cell, the mean of the parts that leave along six
 * directions counts. It is exact along each of them for even gas within cells.
 *
 * Sums are taken over layers of cells and then over the layers, so that the result is the same for
 * any number of threads. */
#include "draw/light/gas_light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shared/exact.h"

static const double PI = 3.14159265358979;

enum { LIGHTS = KILN_GAS_LIGHTS };

/* Corners of a cube that share no edge. */
static const float CORNERS[LIGHTS][3] = {{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}};

/* ---- what leaves the gas --------------------------------------------------------------------- */

struct leave_job {
    const struct kiln_gas_block *block;
    float edge_m; /* of a large cell */
    int axis;     /* along which light leaves */
};

static size_t stride_of(const struct kiln_gas_block *block, int axis)
{
    const struct kiln_gas_place n = block->cells[0];
    return axis == 0 ? 1 : axis == 1 ? (size_t)n.x : (size_t)n.x * (size_t)n.y;
}

/* Returns the part of a cell's light that leaves it, and the gas between it and the border. before:
 * the optical depth of that gas; own: of the cell. */
static float part_leaving(float before, float own)
{
    const float even = own > 1e-3f ? (1.0f - exact_exp(-own)) / own : 1.0f - 0.5f * own;
    return before < 20.0f ? exact_exp(-before) * even : 0.0f;
}

/* Adds the parts that leave both ways along a line of `count` cells. */
static void leave_line(const struct leave_job *job, size_t first, size_t stride, int32_t count)
{
    const float *extinction = job->block->extinction[0] + first;
    const struct kiln_gas_glow *glow = job->block->glow + first;
    float *leaving = job->block->leaving + first;
    for (int way = 0; way < 2; way++) {
        float before = 0.0f;
        for (int32_t i = 0; i < count; i++) {
            const size_t at = (size_t)(way == 0 ? i : count - 1 - i) * stride;
            const float own = extinction[at] * job->edge_m;
            const float *rgb = glow[at].rgb;
            if ((rgb[0] + rgb[1]) + rgb[2] > 0.0f)
                leaving[at] += (1.0f / 6.0f) * part_leaving(before, own);
            before += own;
        }
    }
}

/* Visits the lines along the job's axis in planes across another one, so that threads share no
 * line. */
static void leave_planes(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct leave_job *job = context;
    const struct kiln_gas_place n = job->block->cells[0];
    const int32_t counts[3] = {n.x, n.y, n.z};
    const int across = job->axis == 2 ? 1 : 2, rest = 3 - job->axis - across;
    for (size_t plane = begin; plane < end; plane++)
        for (int32_t line = 0; line < counts[rest]; line++)
            leave_line(job,
                       plane * stride_of(job->block, across) +
                           (size_t)line * stride_of(job->block, rest),
                       stride_of(job->block, job->axis), counts[job->axis]);
}

static void find_leaving(const struct kiln_gas_block *block, struct kiln_threads *threads)
{
    const struct kiln_gas_place n = block->cells[0];
    memset(block->leaving, 0, sizeof(float) * (size_t)n.x * (size_t)n.y * (size_t)n.z);
    for (int axis = 0; axis < 3; axis++) {
        struct leave_job job = {block, block->cell_m * (float)KILN_GAS_CELL, axis};
        kiln_threads_for(threads, (size_t)(axis == 2 ? n.y : n.z), 4, leave_planes, &job);
    }
}

/* ---- sums ------------------------------------------------------------------------------------ */

static void add_sums(struct kiln_gas_sums *to, const struct kiln_gas_sums *from)
{
    for (int i = 0; i < 3; i++) {
        to->color[i] += from->color[i];
        to->at[i] += from->at[i];
        to->squares[i] += from->squares[i];
    }
    to->energy += from->energy;
}

/* Holds a large cell as a light. */
struct ember {
    float rgb[3], energy, at[3];
};

/* Returns whether a large cell sends any light. */
static bool ember_of(const struct kiln_gas_block *block, const int32_t cell[3], size_t number,
                     struct ember *ember)
{
    const struct kiln_gas_glow *glow = &block->glow[number];
    const float whole = (glow->rgb[0] + glow->rgb[1]) + glow->rgb[2];
    const float part = block->leaving[number];
    if (!(whole > 0.0f) || !(part > 0.0f))
        return false;
    ember->energy = whole * part;
    for (int i = 0; i < 3; i++) {
        ember->rgb[i] = glow->rgb[i] * part;
        ember->at[i] = (float)(cell[i] * KILN_GAS_CELL) + glow->at[i] / whole;
    }
    return true;
}

static void add_ember(struct kiln_gas_sums *sums, const struct ember *e, float share)
{
    const double energy = (double)(e->energy * share);
    for (int i = 0; i < 3; i++) {
        const double at = (double)e->at[i];
        sums->color[i] += (double)(e->rgb[i] * share);
        sums->at[i] += energy * at;
        sums->squares[i] += energy * at * at;
    }
    sums->energy += energy;
}

struct sum_job {
    const struct kiln_gas_block *block;
    struct kiln_gas_sums *layers; /* LIGHTS of each layer */
    bool shared;                  /* false: the first light gets all of it */
    float middle[3], inverse[3];  /* of the spread along each axis; 0: there is none */
};

/* Writes the shares of the lights in what is sent from a place. */
static void find_shares(const struct sum_job *job, const float at[3], float shares[LIGHTS])
{
    float sum = 0.0f, away[3];
    for (int i = 0; i < 3; i++)
        away[i] = exact_clamp((at[i] - job->middle[i]) * job->inverse[i], -2.0f, 2.0f);
    for (int k = 0; k < LIGHTS; k++) {
        const float along =
            CORNERS[k][0] * away[0] + CORNERS[k][1] * away[1] + CORNERS[k][2] * away[2];
        const float near = 1.5f + exact_clamp(0.577f * along, -1.4f, 1.4f);
        shares[k] = near * near;
        sum += shares[k];
    }
    for (int k = 0; k < LIGHTS; k++)
        shares[k] = shares[k] / sum;
}

static void sum_layers(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct sum_job *job = context;
    const struct kiln_gas_place n = job->block->cells[0];
    for (int32_t z = (int32_t)begin; z < (int32_t)end; z++) {
        struct kiln_gas_sums *sums = job->layers + (ptrdiff_t)z * LIGHTS;
        size_t number = (size_t)z * (size_t)n.y * (size_t)n.x;
        memset(sums, 0, LIGHTS * sizeof *sums);
        for (int32_t y = 0; y < n.y; y++)
            for (int32_t x = 0; x < n.x; x++, number++) {
                const int32_t cell[3] = {x, y, z};
                float shares[LIGHTS] = {1.0f};
                struct ember ember;
                if (!ember_of(job->block, cell, number, &ember))
                    continue;
                if (job->shared)
                    find_shares(job, ember.at, shares);
                for (int k = 0; k < (job->shared ? LIGHTS : 1); k++)
                    add_ember(&sums[k], &ember, shares[k]);
            }
    }
}

/* Sums up all layers. */
static void run_sums(struct sum_job *job, struct kiln_threads *threads,
                     struct kiln_gas_sums sums[LIGHTS])
{
    const int32_t layers = job->block->cells[0].z;
    memset(sums, 0, LIGHTS * sizeof *sums);
    kiln_threads_for(threads, (size_t)layers, 1, sum_layers, job);
    for (ptrdiff_t z = 0; z < layers; z++)
        for (ptrdiff_t k = 0; k < LIGHTS; k++)
            add_sums(&sums[k], &job->layers[z * LIGHTS + k]);
}

/* ---- lights ---------------------------------------------------------------------------------- */

/* Makes a point light. A volume V of gas that emits the radiance j a metre gives a surface that
 * faces it at distance d the irradiance j V / d^2, and a light of colour c gives it pi c / d^2. The
 * light's radius is how far its flames are spread, at least a large cell. */
static struct kiln_draw_light make_light(const struct kiln_gas_block *block,
                                         const struct kiln_gas_sums *s)
{
    const double cell = (double)block->cell_m;
    const double strength = (double)block->intensity * cell * cell * cell / PI;
    double at[3], square = (double)(KILN_GAS_CELL * KILN_GAS_CELL) / 4.0;
    for (int i = 0; i < 3; i++) {
        at[i] = s->at[i] / s->energy;
        const double spread = s->squares[i] / s->energy - at[i] * at[i];
        square += spread > 0.0 ? spread : 0.0;
    }
    const float radius2 = (float)(square * cell * cell);
    struct kiln_draw_light light = {.casters = {1, 0, 0, 1u | KILN_LAMP_THROUGH_SMOKE}};
    float place[3];
    for (int c = 0; c < 3; c++)
        place[c] = block->corner[c] + block->edges[0][c] * (float)at[0] +
                   block->edges[1][c] * (float)at[1] + block->edges[2][c] * (float)at[2];
    light.position_radius2 = (float4){place[0], place[1], place[2], radius2};
    light.color = (float4){(float)(strength * s->color[0]), (float)(strength * s->color[1]),
                           (float)(strength * s->color[2]), exact_sqrt(radius2)};
    return light;
}

uint32_t kiln_gas_light_gather(const struct kiln_gas_block *block, struct kiln_threads *threads,
                               struct kiln_draw_light *lights)
{
    struct sum_job job = {.block = block, .layers = block->layers};
    struct kiln_gas_sums sums[LIGHTS];
    uint32_t count = 0;
    if (!block->glow || !(block->intensity > 0.0f))
        return 0;
    find_leaving(block, threads);
    run_sums(&job, threads, sums);
    if (!(sums[0].energy > 0.0))
        return 0;
    for (int i = 0; i < 3; i++) {
        const double middle = sums[0].at[i] / sums[0].energy;
        const double spread = sums[0].squares[i] / sums[0].energy - middle * middle;
        job.middle[i] = (float)middle;
        job.inverse[i] = spread > 0.01 ? 1.0f / exact_sqrt((float)spread) : 0.0f;
    }
    job.shared = true;
    run_sums(&job, threads, sums);
    for (int k = 0; k < LIGHTS; k++)
        if (sums[k].energy > 0.0)
            lights[count++] = make_light(block, &sums[k]);
    return count;
}
