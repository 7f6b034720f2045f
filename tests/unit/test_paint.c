/* Painting with particles: where texels lie, what they gather, and that it is the same by whatever
 * way. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "shared/random.h"
#include "sim/paint/paint.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/scenes.h"
#include "support/simulation.h"

static void assert_near(double found, double expected, double allowed)
{
    if (!(fabs(found - expected) <= allowed))
        fail_msg("%.9g instead of %.9g, allowed %g off", found, expected, allowed);
}

/* ---- meshes ---------------------------------------------------------------------------------- */

enum { MOST = 4096 };

struct body {
    struct kiln_mesh mesh;
    float vertices[MOST][6], uvs[MOST][2];
    uint32_t triangles[2 * MOST][3];
};

static struct body body; /* too large for a stack */

static void begin_body(void)
{
    memset(&body, 0, sizeof body);
    body.mesh =
        (struct kiln_mesh){.vertices = body.vertices, .triangles = body.triangles, .uvs = body.uvs};
}

static uint32_t add_vertex(const double place[3], const double normal[3], double u, double v)
{
    const uint32_t i = body.mesh.vertex_count++;
    assert_true(i < MOST);
    for (int c = 0; c < 3; c++) {
        body.vertices[i][c] = (float)place[c];
        body.vertices[i][c + 3] = (float)normal[c];
        if (i == 0 || body.vertices[i][c] < body.mesh.min[c])
            body.mesh.min[c] = body.vertices[i][c];
        if (i == 0 || body.vertices[i][c] > body.mesh.max[c])
            body.mesh.max[c] = body.vertices[i][c];
    }
    body.uvs[i][0] = (float)u;
    body.uvs[i][1] = (float)v;
    return i;
}

static void add_triangle(uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *triangle = body.triangles[body.mesh.triangle_count++];
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
}

/* At (2 u, 1, 3 v), over a part of the texture. */
static void add_quad(double u, double v, double width, double height)
{
    const double up[3] = {0, 1, 0};
    uint32_t corners[4];
    for (int i = 0; i < 4; i++) {
        const double at[2] = {u + (i & 1 ? width : 0), v + (i & 2 ? height : 0)};
        corners[i] = add_vertex((const double[3]){2 * at[0], 1, 3 * at[1]}, up, at[0], at[1]);
    }
    add_triangle(corners[0], corners[1], corners[2]);
    add_triangle(corners[2], corners[1], corners[3]);
}

static const double PI = 3.14159265358979;

/* Of radius 1: longitude along u, latitude along v. */
static void add_ball(int rings)
{
    const int around = 2 * rings;
    for (int i = 0; i <= rings; i++) {
        for (int k = 0; k <= around; k++) {
            const double down = PI * i / rings, way = 2 * PI * k / around;
            const double place[3] = {sin(down) * cos(way), cos(down), sin(down) * sin(way)};
            add_vertex(place, place, (double)k / around, (double)i / rings);
        }
    }
    for (int i = 0; i < rings; i++) {
        for (int k = 0; k < around; k++) {
            const uint32_t a = (uint32_t)(i * (around + 1) + k), b = a + (uint32_t)around + 1;
            add_triangle(a, a + 1, b);
            add_triangle(b, a + 1, b + 1);
        }
    }
}

static struct kiln_chart *chart_body(uint32_t edge)
{
    struct kiln_error error = {0};
    struct kiln_chart *chart = kiln_chart_create(&body.mesh, edge, "body", &error);
    if (!chart)
        fail_msg("%s", error.message);
    return chart;
}

/* ---- charts ---------------------------------------------------------------------------------- */

static void quad_is_linear(void **state)
{
    (void)state;
    begin_body();
    add_quad(0, 0, 1, 1);
    struct kiln_chart *chart = chart_body(64);
    assert_int_equal(chart->count, 64 * 64);
    for (uint32_t i = 0; i < chart->count; i++) {
        const uint32_t texel = chart->texels[i];
        assert_near((double)chart->place[0][i], 2 * (texel % 64 + 0.5) / 64, 1e-6);
        assert_near((double)chart->place[1][i], 1, 0);
        assert_near((double)chart->place[2][i], 3 * (texel / 64 + 0.5) / 64, 1e-6);
        assert_near((double)chart->normal[1][i], 1, 0);
    }
    kiln_chart_destroy(&chart);
}

/* A part of the texture: its texels, and two around them that are where their neighbours are. */
static void quad_has_border(void **state)
{
    (void)state;
    begin_body();
    add_quad(0.25, 0.25, 0.5, 0.5);
    struct kiln_chart *chart = chart_body(64);
    assert_int_equal(chart->count, 36 * 36);
    for (uint32_t i = 0; i < chart->count; i++) {
        const double column = fmin(fmax(chart->texels[i] % 64, 16), 47);
        const double row = fmin(fmax(chart->texels[i] / 64, 16), 47);
        assert_near((double)chart->place[0][i], 2 * (column + 0.5) / 64, 1e-6);
        assert_near((double)chart->place[2][i], 3 * (row + 0.5) / 64, 1e-6);
    }
    kiln_chart_destroy(&chart);
}

/* Within what chords are off arcs. */
static void ball_is_round(void **state)
{
    (void)state;
    begin_body();
    add_ball(24);
    struct kiln_chart *chart = chart_body(128);
    const double off = 1 - cos(PI / 24);
    assert_int_equal(chart->count, 128 * 128);
    for (uint32_t i = 0; i < chart->count; i++) {
        const double way = 2 * PI * (chart->texels[i] % 128 + 0.5) / 128;
        const double down = PI * (chart->texels[i] / 128 + 0.5) / 128;
        const double place[3] = {sin(down) * cos(way), cos(down), sin(down) * sin(way)};
        for (int c = 0; c < 3; c++) {
            assert_near((double)chart->place[c][i], place[c], 3 * off);
            assert_near((double)chart->normal[c][i], place[c], 3 * off);
        }
    }
    kiln_chart_destroy(&chart);
}

static void assert_refused(const char *reason)
{
    struct kiln_error error = {0};
    assert_null(kiln_chart_create(&body.mesh, 64, "body", &error));
    expect_error(&error, KILN_INVALID_INPUT, "%s", reason);
}

static void bad_places_are_refused(void **state)
{
    (void)state;
    begin_body();
    add_quad(0, 0, 0.5, 0.5);
    add_quad(0.5, 0, 0.25, 0.5); /* shares an edge, and is no overlap */
    struct kiln_chart *chart = chart_body(64);
    kiln_chart_destroy(&chart);
    add_quad(0.4, 0.4, 0.2, 0.2);
    assert_refused(
        "body: the triangles 1 (around 0.6667 1 1) and 4 (around 0.9333 1 1.4) both lie at the "
        "texture coordinates 0.4141 0.4141; for paint, triangles must not overlap there");
    begin_body();
    add_quad(0.5, 0, 0.6, 0.5);
    assert_refused("body: triangle 0 has a corner at the texture coordinates 1.1 0; for paint, all "
                   "are from 0 to 1");
    begin_body();
    add_quad(0.5, 0, 0, 0.5);
    assert_refused("body: no triangle has a texel in it by its texture coordinates, with 64 texels "
                   "along an edge");
    begin_body();
    add_quad(0, 0, (double)NAN, 0.5);
    assert_refused("body: triangle 0 has a corner at the texture coordinates nan 0; for paint, all "
                   "are from 0 to 1");
}

/* ---- the gather ------------------------------------------------------------------------------ */

enum { EDGE = 64, SPLATS = 700 };

static struct kiln_splat splats[SPLATS];
static float painted[EDGE * EDGE][4];

static void make_splats(void)
{
    for (uint32_t i = 0; i < SPLATS; i++) {
        float number[12];
        for (uint32_t k = 0; k < 12; k++)
            number[k] = random_unit(random_stream(77, i), k);
        const float radius = 0.02f + 0.2f * number[3];
        splats[i] = (struct kiln_splat){
            .position = {2.4f * number[0] - 1.2f, 2.4f * number[1] - 1.2f, 2.4f * number[2] - 1.2f},
            .opacity = number[4],
            .radius_squared = radius * radius,
            .color = {number[5], number[6], number[7]},
            .slope = (1.0f + 9.0f * number[8]) / (radius * radius),
        };
        for (int c = 0; c < 3 && i % 2; c++)
            splats[i].normal[c] = 2.0f * number[9 + c] - 1.0f;
    }
}

static void paint_texel(const struct kiln_chart *chart, uint32_t i, double out[4])
{
    for (uint32_t s = 0; s < SPLATS; s++) {
        const struct kiln_splat *splat = &splats[s];
        double square = 0, facing = 0;
        for (int c = 0; c < 3; c++) {
            const double way = (double)chart->place[c][i] - (double)splat->position[c];
            square += way * way;
            facing += (double)chart->normal[c][i] * (double)splat->normal[c];
        }
        double inside = ((double)splat->radius_squared - square) * (double)splat->slope;
        inside = fmin(fmax(inside, 0), 1);
        const double part =
            facing < 0 ? 0 : inside * inside * (3 - 2 * inside) * (double)splat->opacity;
        for (int c = 0; c < 4; c++)
            out[c] += ((c < 3 ? (double)splat->color[c] : 1.0) - out[c]) * part;
    }
}

/* near: with the grid. */
static void gather(const struct kiln_chart *chart, bool near, enum kiln_simd simd, uint32_t threads,
                   float texels[EDGE * EDGE][4])
{
    struct kiln_error error = {0};
    struct kiln_paint_grid grid;
    assert_true(kiln_paint_grid_init(&grid, chart, &error));
    const struct kiln_paint_gather all = {.threads = kiln_threads_create(threads),
                                          .block = KILN_SIMD_PICK(kiln_paint_block_of, simd),
                                          .chart = chart,
                                          .grid = near ? &grid : NULL};
    struct kiln_threads *workers = all.threads;
    bool changed = false;
    memset(texels, 0, sizeof painted);
    assert_true(kiln_paint_gather(&all, splats, SPLATS, texels, &changed, &error));
    assert_true(changed);
    assert_true(kiln_paint_gather(&all, splats, 0, texels, &changed, &error));
    assert_false(changed);
    kiln_threads_destroy(&workers);
    kiln_paint_grid_finish(&grid);
}

static void gathers_agree(void **state)
{
    (void)state;
    static float again[EDGE * EDGE][4];
    begin_body();
    add_ball(16);
    make_splats();
    struct kiln_chart *chart = chart_body(EDGE);
    gather(chart, true, kiln_simd_narrowest(), 1, painted);
    for (uint32_t i = 0; i < chart->count; i++) {
        double expected[4] = {0};
        paint_texel(chart, i, expected);
        for (int c = 0; c < 4; c++)
            assert_near((double)painted[chart->texels[i]][c], expected[c], 2e-5);
    }
    for (enum kiln_simd simd = kiln_simd_narrowest(); simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd))
            continue;
        for (int near = 0; near < 2; near++) {
            gather(chart, near != 0, simd, 1 + (uint32_t)simd, again);
            assert_memory_equal(painted, again, sizeof painted);
        }
    }
    kiln_chart_destroy(&chart);
}

/* Splats that reach every block have more entries than the lists may have, so they are painted in
 * parts. If this fails, a scene takes hundreds of MiB for each painted mesh, which nobody expects,
 * or the parts are other paint. */
static void many_large_splats_agree(void **state)
{
    (void)state;
    enum { MANY = 40000, MOST_ENTRIES = 1 << 21 };
    static float texels[2][EDGE * EDGE][4];
    struct kiln_error error = {0};
    begin_body();
    add_ball(16);
    make_splats();
    struct kiln_chart *chart = chart_body(EDGE);
    struct kiln_splat *many = calloc(MANY, sizeof *many);
    assert_non_null(many);
    for (uint32_t i = 0; i < MANY; i++) {
        many[i] = splats[i % SPLATS];
        many[i].radius_squared = 16.0f + (float)i / MANY;
        many[i].slope = 0.05f;
    }
    assert_true(MANY * (uint64_t)chart->block_count > MOST_ENTRIES);
    for (int near = 0; near < 2; near++) {
        struct kiln_paint_grid grid;
        assert_true(kiln_paint_grid_init(&grid, chart, &error));
        struct kiln_threads *workers = kiln_threads_create(2);
        const struct kiln_paint_gather all = {
            .threads = workers,
            .block = KILN_SIMD_PICK(kiln_paint_block_of, kiln_simd_narrowest()),
            .chart = chart,
            .grid = near ? &grid : NULL};
        bool changed = false;
        assert_true(kiln_paint_gather(&all, many, MANY, texels[near], &changed, &error));
        assert_true(changed && grid.list_capacity <= MOST_ENTRIES);
        kiln_threads_destroy(&workers);
        kiln_paint_grid_finish(&grid);
    }
    assert_memory_equal(texels[0], texels[1], sizeof texels[0]);
    free(many);
    kiln_chart_destroy(&chart);
}

/* ---- runs ------------------------------------------------------------------------------------ */

#define STILL                                                                                      \
    "kiln: 1\n"                                                                                    \
    "output: {frames: 90}\n"                                                                       \
    "backdrop: {objects: [{mesh: {file: meshes/slab.obj, paint: {size: 128}}}]}\n"                 \
    "systems:\n"                                                                                   \
    "  drops:\n"                                                                                   \
    "    emit: {bursts: {0 s: 50}, life: 9 s, speed: 0, from: {box: {size: [4, 0.1, 4]}}}\n"       \
    "    paint: {when: near, radius: [0.2, 0.4], opacity: 0.7}\n"                                  \
    "    look: {color: [0.9, 0.2, 0.1]}\n"                                                         \
    "  others:\n"                                                                                  \
    "    emit: {bursts: {0 s: 22}, life: 9 s, speed: 0, from: {box: {size: [4, 0.1, 4]}}}\n"       \
    "    paint: {when: near, radius: [0.2, 0.4], opacity: 0.7}\n"                                  \
    "    look: {color: [0.1, 0.3, 0.9]}\n"

static struct kiln_scene *load(const char *text, const char *setting)
{
    struct kiln_error error = {0};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = &setting;
    params.override_count = setting ? 1 : 0;
    params.asset_root = KILN_SOURCE_DIR "/scenes";
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), SCENE_NAME, &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

/* What is painted after so many steps, for the caller to free. */
static float (*paint_run(const char *text, const char *setting, uint32_t steps, uint32_t *edge))[4]
{
    struct kiln_scene *scene = load(text, setting);
    struct simulation run;
    simulation_start(&run, scene, NULL, 2);
    simulation_run(&run, steps);
    assert_int_equal(run.pool.canvas_count, 1);
    *edge = run.pool.canvases[0].edge;
    const size_t size = (size_t)*edge * *edge * 4 * sizeof(float);
    float(*texels)[4] = malloc(size);
    assert_non_null(texels);
    memcpy(texels, run.pool.canvases[0].texels, size);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
    return texels;
}

static void assert_same_paint(const char *setting, uint32_t steps, const char *other,
                              uint32_t other_steps, bool same)
{
    uint32_t edge, other_edge;
    float(*a)[4] = paint_run(STILL, setting, steps, &edge);
    float(*b)[4] = paint_run(STILL, other, other_steps, &other_edge);
    assert_int_equal(edge, other_edge);
    assert_int_equal(memcmp(a, b, (size_t)edge * edge * sizeof *a) == 0, same);
    free(a);
    free(b);
}

/* Of particles at rest, a round of turns paints what one step of all of them does (7.6.1.3). */
static void turns_add_up(void **state)
{
    (void)state;
    static const char few[] = "backdrop.objects.0.mesh.paint.per_step=9";
    assert_same_paint(NULL, 1, few, 8, true);
    assert_same_paint(NULL, 1, few, 7, false);
    assert_same_paint(NULL, 5, "backdrop.objects.0.mesh.paint.per_step=72", 5, true);
    assert_same_paint(NULL, 5, "backdrop.objects.0.mesh.paint.gather=all", 5, true);
}

/* Drops paint when they hit and never again: no splat that had its turn waits for another. */
static void splats_have_one_turn(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\n"
        "output: {frames: 90}\n"
        "backdrop: {objects: [{mesh: {file: meshes/slab.obj, paint: {size: 128, per_step: 1}}}]}\n"
        "systems:\n"
        "  drops:\n"
        "    emit: {bursts: {0 s: 9}, life: 9 s, speed: 2, from: {box: {origin: [0, 1, 0],\n"
        "        size: [4, 0.1, 4], direction: [0, -1, 0]}}}\n"
        "    collide: {dies: true}\n"
        "    paint: {radius: 30 cm, opacity: 0.5}\n";
    uint32_t edge;
    float(*once)[4] = paint_run(text, NULL, 60, &edge); /* nine turns after the last hit */
    float(*later)[4] = paint_run(text, NULL, 80, &edge);
    double cover = 0;
    for (uint32_t i = 0; i < edge * edge; i++)
        cover += (double)once[i][3];
    assert_true(cover > 100);
    assert_memory_equal(once, later, (size_t)edge * edge * sizeof *once);
    free(once);
    free(later);
}

/* A drop that falls on a slab which moved, turned and grew leaves its mark where it hit, in its
 * colour, and nowhere else: on the slab's surface, if it is a ball, too. */
static void check_mark(const char *setting, double across)
{
    static const char text[] =
        "kiln: 1\n"
        "output: {frames: 90}\n"
        "backdrop:\n"
        "  floor: {height: 2 m}\n"
        "  objects:\n"
        "    - mesh: {file: meshes/slab.obj, position: [{keys: {0 s: 0, 1 s: 2}}, 2, -1],\n"
        "          rotation: [0, 90 deg, 0], scale: 2, paint: {size: 256}}\n"
        "systems:\n"
        "  drops:\n"
        "    emit: {bursts: {0 s: 1}, life: 9 s, speed: 2, from: {point: {origin: [1, 3.5, 1],\n"
        "        direction: [0, -1, 0]}}}\n"
        "    collide: {dies: true}\n"
        "    paint: {radius: 30 cm, soft: 0}\n"
        "    look: {color: [0.75, 0.5, 0.25]}\n";
    uint32_t edge;
    float(*texels)[4] = paint_run(text, setting, 60, &edge);
    /* The slab's own x is along -z, its z along x, and its v against its z. */
    double count = 0, u = 0, v = 0;
    for (uint32_t i = 0; i < edge * edge; i++) {
        if (texels[i][3] == 0.0f)
            continue;
        count++;
        u += (i % edge + 0.5) / edge;
        v += (i / edge + 0.5) / edge;
        if (texels[i][3] == 1.0f) {
            assert_near((double)texels[i][0], 0.75, 1e-6);
            assert_near((double)texels[i][2], 0.25, 1e-6);
        }
    }
    free(texels);
    assert_near(count * 10 * 10 / (edge * edge), PI * 0.3 * 0.3, 0.01);
    assert_near(u / count, 0.5 - 2.0 / 10, 0.002);
    assert_near(v / count, 0.5 - across / 10, 0.002);
}

static void marks_are_where_drops_hit(void **state)
{
    (void)state;
    /* After 0.75 s, when the slab's middle is at [1.5, 2, -1]: 2 m from it along z, -0.5 along x.
     */
    check_mark(NULL, -0.5);
    /* After 0.765 s, near the end of a step. */
    check_mark("systems.drops.emit.from.point.origin=[1, 3.53, 1]", -0.53);
    /* A ball of 20 cm after 0.65 s. */
    check_mark("systems.drops.interact=[{collide: 20 cm}]", -0.3);
}

/* The hash says what is painted, and a pool that takes over another one takes that, too. */
static void paint_is_state(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_scene *scene = load(STILL, "backdrop.objects.0.mesh.paint.per_step=9");
    struct simulation run, other;
    uint64_t alive;
    simulation_start(&run, scene, NULL, 2);
    simulation_start(&other, scene, NULL, 1);
    simulation_run(&run, 3);
    const struct kiln_state_hash before = simulation_hash(&run, &alive);
    assert_int_equal(alive, 72);
    assert_true(kiln_pool_copy(&other.pool, &run.pool, &error));
    struct kiln_state_hash taken = simulation_hash(&other, &alive);
    assert_memory_equal(&before, &taken, sizeof before);
    other.step = run.step;
    simulation_run(&run, 6);
    simulation_run(&other, 6);
    const struct kiln_state_hash after = simulation_hash(&run, &alive);
    taken = simulation_hash(&other, &alive);
    assert_memory_equal(&after, &taken, sizeof after);
    uint32_t painted_texel = 0;
    while (run.pool.canvases[0].texels[painted_texel][3] == 0.0f)
        painted_texel++;
    run.pool.canvases[0].texels[painted_texel][1] += 0.001f;
    taken = simulation_hash(&run, &alive);
    assert_memory_not_equal(&after, &taken, sizeof after);
    simulation_end(&run);
    simulation_end(&other);
    kiln_scene_destroy(&scene);
}

/* Needles between the middles of texels, all at one place: no texel is in two of them. */
static void needles_without_end_are_refused(void **state)
{
    (void)state;
    enum { MANY = 20000 };
    static float vertices[3][6], uvs[3][2] = {{0, 0}, {0, 1}, {1e-4f, 0.5f}};
    static uint32_t triangles[MANY][3];
    const struct kiln_mesh mesh = {.vertex_count = 3,
                                   .triangle_count = MANY,
                                   .vertices = vertices,
                                   .triangles = triangles,
                                   .uvs = uvs};
    struct kiln_error error = {0};
    for (int i = 0; i < MANY; i++)
        for (uint32_t k = 0; k < 3; k++)
            triangles[i][k] = k;
    assert_null(kiln_chart_create(&mesh, 2048, "needles", &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "needles: the triangles lie in more than 16777216 rows of texels altogether; for "
                 "paint, unwrap the mesh into less narrow triangles, or set a smaller size");
}

static void bad_scenes_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *setting, *reason;
    } cases[] = {
        {"backdrop.objects.0.mesh.paint.size=100",
         "--set backdrop.objects.0.mesh.paint.size: found 100; allowed are powers of two from 16 "
         "to 2048"},
        {"backdrop.objects.0.mesh.file=meshes/cabin.obj",
         "--set backdrop.objects.0.mesh.file: 'meshes/cabin.obj': the mesh, or a part of it, has "
         "no texture coordinates, which paint needs"},
        {"systems.drops.paint.when=impact",
         "--set systems.drops.paint.when: impact needs systems.drops.collide: without it, no "
         "particle bounces or ends at a surface"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_error error = {0};
        struct kiln_scene_params params = kiln_scene_defaults();
        params.overrides = &cases[i].setting;
        params.override_count = 1;
        params.asset_root = KILN_SOURCE_DIR "/scenes";
        assert_null(kiln_scene_parse(STILL, strlen(STILL), SCENE_NAME, &params, &error));
        expect_error(&error, KILN_INVALID_INPUT, "%s", cases[i].reason);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quad_is_linear),
        cmocka_unit_test(quad_has_border),
        cmocka_unit_test(ball_is_round),
        cmocka_unit_test(bad_places_are_refused),
        cmocka_unit_test(gathers_agree),
        cmocka_unit_test(many_large_splats_agree),
        cmocka_unit_test(turns_add_up),
        cmocka_unit_test(splats_have_one_turn),
        cmocka_unit_test(marks_are_where_drops_hit),
        cmocka_unit_test(paint_is_state),
        cmocka_unit_test(needles_without_end_are_refused),
        cmocka_unit_test(bad_scenes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
