/* Runs the suite `paint` of `kiln bench`, which measures the painting of a mesh (Drone 2007,
 * 7.6.1). The mesh is a ball on which splats lie evenly. It is painted by each gather, and with a
 * hundredth of the splats in a frame. */
#include "sim/paint/paint.h"

#include <stdlib.h>

#include "base/clock.h"
#include "base/error.h"
#include "bench/suite.h"
#include "shared/random.h"

enum { RINGS = 48, AROUND = 2 * RINGS, MEASURE = KILN_PASS_simulate };

/* The ways to paint: a gather, and how many of the splats it takes in a frame. */
static const struct kiln_lane LANES[] = {
    {.name = "gather=near"}, {.name = "gather=all"}, {.name = "gather=all, a hundredth a frame"}};
enum { LANE_COUNT = sizeof LANES / sizeof *LANES };

struct paint_bench {
    const struct kiln_bench_run *run;
    struct kiln_threads *threads;
    struct kiln_mesh *mesh;
    struct kiln_chart *chart;
    struct kiln_paint_grid grid;
    kiln_paint_block *block;
    struct kiln_splat *splats;
    uint32_t count;
    float (*texels)[4];
    struct kiln_samples *samples; /* [LANE_COUNT] */
};

/* Makes a ball of radius 1; longitude goes along u, latitude along v. */
static struct kiln_mesh *make_ball(void)
{
    struct kiln_mesh *mesh = calloc(1, sizeof *mesh);
    if (!mesh)
        return NULL;
    const size_t vertices = (size_t)(RINGS + 1) * (AROUND + 1);
    mesh->vertices = calloc(vertices, sizeof *mesh->vertices);
    mesh->uvs = calloc(vertices, sizeof *mesh->uvs);
    mesh->triangles = calloc((size_t)RINGS * AROUND * 2, sizeof *mesh->triangles);
    if (!mesh->vertices || !mesh->uvs || !mesh->triangles) {
        kiln_mesh_destroy(&mesh);
        return NULL;
    }
    for (uint32_t i = 0; i <= RINGS; i++) {
        const struct exact_angle down = exact_sincos(0.5f * EXACT_TWO_PI * (float)i / RINGS);
        for (uint32_t k = 0; k <= AROUND; k++) {
            const struct exact_angle longitude = exact_sincos(EXACT_TWO_PI * (float)k / AROUND);
            const float at[3] = {down.sine * longitude.cosine, down.cosine,
                                 down.sine * longitude.sine};
            for (int c = 0; c < 6; c++)
                mesh->vertices[mesh->vertex_count][c] = at[c % 3];
            mesh->uvs[mesh->vertex_count][0] = (float)k / AROUND;
            mesh->uvs[mesh->vertex_count++][1] = (float)i / RINGS;
        }
    }
    for (uint32_t i = 0; i < RINGS * AROUND; i++) {
        const uint32_t a = i + i / AROUND, b = a + AROUND + 1;
        const uint32_t corners[2][3] = {{a, a + 1, b}, {b, a + 1, b + 1}};
        for (int k = 0; k < 6; k++)
            mesh->triangles[mesh->triangle_count + (uint32_t)k / 3][k % 3] = corners[k / 3][k % 3];
        mesh->triangle_count += 2;
    }
    for (int c = 0; c < 3; c++) {
        mesh->min[c] = -1.0f;
        mesh->max[c] = 1.0f;
    }
    return mesh;
}

/* Spreads splats of a hundredth of the ball's radius evenly over the ball. */
static void make_splats(struct paint_bench *paint_bench)
{
    for (uint32_t i = 0; i < paint_bench->count; i++) {
        const uint32_t stream = random_stream(1, i);
        const float y = 2.0f * random_unit(stream, 0) - 1.0f, r = exact_sqrt(1.0f - y * y);
        const struct exact_angle longitude = exact_sincos(EXACT_TWO_PI * random_unit(stream, 1));
        const float at[3] = {r * longitude.cosine, y, r * longitude.sine};
        paint_bench->splats[i] = (struct kiln_splat){.position = {at[0], at[1], at[2]},
                                                     .opacity = 0.8f,
                                                     .normal = {at[0], at[1], at[2]},
                                                     .radius_squared = 1e-4f,
                                                     .color = {0.8f, 0.3f, 0.1f},
                                                     .slope = 2e4f};
    }
}

static bool set_up(struct paint_bench *paint_bench, uint32_t edge, struct kiln_error *error)
{
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error))
        return false;
    paint_bench->block = KILN_SIMD_PICK(kiln_paint_block_of, simd);
    paint_bench->threads = kiln_threads_create(paint_bench->run->params->threads);
    paint_bench->mesh = make_ball();
    paint_bench->splats = calloc(paint_bench->count, sizeof *paint_bench->splats);
    paint_bench->texels = calloc((size_t)edge * edge, sizeof *paint_bench->texels);
    paint_bench->samples = calloc(LANE_COUNT, sizeof *paint_bench->samples);
    if (!paint_bench->threads || !paint_bench->mesh || !paint_bench->splats ||
        !paint_bench->texels || !paint_bench->samples) {
        kiln_error_no_memory(error, "measurements");
        return false;
    }
    make_splats(paint_bench);
    paint_bench->chart = kiln_chart_create(paint_bench->mesh, edge, "ball", error);
    return paint_bench->chart &&
           kiln_paint_grid_init(&paint_bench->grid, paint_bench->chart, error);
}

static bool paint(struct paint_bench *paint_bench, size_t lane, double *ms,
                  struct kiln_error *error)
{
    const struct kiln_paint_gather gather = {.threads = paint_bench->threads,
                                             .block = paint_bench->block,
                                             .chart = paint_bench->chart,
                                             .grid = lane == 0 ? &paint_bench->grid : NULL};
    const double start_s = kiln_clock_seconds();
    bool changed;
    const bool ok = kiln_paint_gather(&gather, paint_bench->splats,
                                      lane == 2 ? paint_bench->count / 100 : paint_bench->count,
                                      paint_bench->texels, &changed, error);
    *ms = 1e3 * (kiln_clock_seconds() - start_s);
    return ok;
}

/* Paints by all lanes in turn. The first turn only warms up. */
static bool take_turns(struct paint_bench *paint_bench, struct kiln_error *error)
{
    const struct kiln_bench_params *params = paint_bench->run->params;
    double spent_ms = 0.0;
    for (uint32_t turn = 0; turn <= paint_bench->run->bench->repetitions; turn++) {
        if (turn > KILN_BENCH_MIN_REPETITIONS && spent_ms > 1e3 * params->seconds)
            return true;
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            struct kiln_samples *samples = &paint_bench->samples[lane];
            double ms = 0.0;
            if (params->stop && params->stop(params->user)) {
                kiln_error_set(error, KILN_INTERRUPTED, "stopped");
                return false;
            }
            if (!paint(paint_bench, lane, &ms, error))
                return false;
            if (turn > 0)
                samples->ms[MEASURE][samples->count++] = ms;
            spent_ms += turn > 0 ? ms : 0.0;
        }
    }
    return true;
}

static bool run_count(const struct kiln_bench_run *run, uint32_t count, uint32_t edge,
                      struct kiln_error *error)
{
    struct paint_bench paint_bench = {.run = run, .count = count};
    const struct kiln_comparison comparison = {.lanes = LANES,
                                               .lane_count = LANE_COUNT,
                                               .measures = KILN_MEASURE(simulate),
                                               .as = "paint",
                                               .x = (double)count};
    const bool ok = set_up(&paint_bench, edge, error) && take_turns(&paint_bench, error) &&
                    kiln_bench_add_samples(run, &comparison, paint_bench.samples, error);
    kiln_paint_grid_finish(&paint_bench.grid);
    kiln_chart_destroy(&paint_bench.chart);
    kiln_mesh_destroy(&paint_bench.mesh);
    free(paint_bench.samples);
    free(paint_bench.splats);
    free(paint_bench.texels);
    kiln_threads_destroy(&paint_bench.threads);
    return ok;
}

bool kiln_suite_paint(const struct kiln_bench_run *run, struct kiln_error *error)
{
    static const uint32_t counts[] = {1000, 10000, 100000};
    const struct kiln_bench_part part = {
        .name = "paint",
        .title = "Painting a ball, a texture of 256 x 256 texels (Drone 2007, 7.6.1)",
        .sweep = "splats",
        .unit = "ms",
        .reference = LANES[0].name,
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    const size_t count = run->params->quick ? 1 : sizeof counts / sizeof *counts;
    for (size_t i = 0; i < count; i++) {
        kiln_bench_say(run, "%u splats", counts[i]);
        if (!run_count(run, counts[i], 256, error))
            return false;
    }
    return kiln_bench_add_note(run->bench, error,
                               "Both gathers paint the same. A hundredth of the particles paint in "
                               "each frame, as in the paper (7.6.1.3).");
}
