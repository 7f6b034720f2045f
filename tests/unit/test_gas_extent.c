/* lib/scene/gas_extent: how far gas is expected to spread. If this test fails, a service refuses
 * scenes that would fit, or lets through those that would not, and plans are wrong. */
#include <math.h>
#include <stdio.h>

#include "scene/gas_extent.h"
#include "scene/gas_shape.h"
#include "support/cmocka.h"
#include "support/scenes.h"

/* Loads a scene of 60 frames at 30 a second with a domain of 64^3 cells of 10 cm, in which a disc
 * of 0.4 m on the floor gives smoke of temperature 0.5 that does not cool: 2.4 m a second at first.
 */
static struct kiln_scene *scene_of(const char *setting, const char *more)
{
    char text[1024], key[128];
    const char *overrides[2] = {setting ? key : NULL};
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {size: [64, 36], fps: 30, frames: 60}\ngas:\n"
             "  a:\n    box: {size: [6.4, 6.4, 6.4]}\n    cells: 64\n    buoyancy: 10\n"
             "    smoke_weight: 0\n    cooling: {glow: 0, even: 0}\n    burn: none\n"
             "    sources: [{from: {disc: {radius: 0.4 m}}, reach: 0.1 m, rate: 20, temperature: "
             "0.5}]\n%s",
             more);
    snprintf(key, sizeof key, "gas.a.sources.0.%s", setting ? setting : "");
    return load_scene(text, overrides);
}

static struct kiln_gas_extent extent_of(const char *setting, const char *more, double time_s)
{
    struct kiln_scene *scene = scene_of(setting, more);
    const struct kiln_gas_extent extent = kiln_gas_extent_at(scene, 0, time_s);
    kiln_scene_destroy(&scene);
    return extent;
}

static void expect_cells(struct kiln_gas_extent extent, int x, int y, int z)
{
    if (extent.cells.x != x || extent.cells.y != y || extent.cells.z != z)
        fail_msg("%d x %d x %d cells", extent.cells.x, extent.cells.y, extent.cells.z);
}

/* Noise takes a quarter of the heat. So the front rises by a quarter of sqrt(10 * 0.375 * 1.5) =
 * 2.37 m/s, over three times the 0.5 m that the source reaches, and is at 0.1 m + 0.59 m after a
 * second. A brick, 0.8 m, lies above the gas, one and a half aside, and a margin of another one
 * around them. Turbulence of 0.6 of the buoyancy lets it widen by 0.208 m a metre. */
static void a_plume_is_a_cone(void **state)
{
    (void)state;
    const double top = 0.1 + 0.25 * sqrt(10 * 0.375 * 1.5) + 0.8, near = 0.1;
    const struct kiln_gas_extent extent = extent_of(NULL, "", 1.0);
    double bricks = 0.0;
    for (int k = 0; k < 1000; k++) {
        const double y = top * (k + 0.5) / 1000;
        const double half = 0.5 + 0.208 * fmax(y - near, 0.0) + 1.2;
        bricks += 0.8 * 4 * half * half * top / 1000 / (0.8 * 0.8 * 0.8);
    }
    assert_true(fabs((double)extent.bricks - bricks) < 0.03 * bricks + 1);
    /* 2 * (0.5 + 0.208 * 1.39 + 1.2 + 0.8) = 5.58 m wide, and 2.29 m high */
    expect_cells(extent, 64, 32, 64);
    expect_cells(extent_of(NULL, "", 0.0), 64, 32, 64);
}

/* A wider source, more turbulence and more heat each let the gas be expected in more bricks. */
static void spread_follows_the_source(void **state)
{
    (void)state;
    const uint64_t bricks = extent_of(NULL, "", 2.0).bricks;
    assert_true(extent_of("from.disc.radius=0.8", "", 2.0).bricks > bricks * 5 / 4);
    assert_true(extent_of("temperature=1", "", 2.0).bricks > bricks);
    assert_true(extent_of(NULL, "    turbulence: {strength: 0}\n", 2.0).bricks < bricks);
    assert_true(extent_of("from={cone: {radius: 0.4 m}}", "", 2.0).bricks >= bricks);
}

/* Gas has spread to no less later, and never to more than there is. */
static void extents_grow(void **state)
{
    (void)state;
    struct kiln_scene *scene = scene_of(NULL, "");
    uint64_t before = 0;
    for (int i = 0; i <= 100; i++) {
        const struct kiln_gas_extent extent = kiln_gas_extent_at(scene, 0, 0.2 * i);
        assert_true(extent.bricks >= before && extent.bricks <= 512);
        before = extent.bricks;
    }
    expect_cells(kiln_gas_extent_at(scene, 0, 20.0), 64, 64, 64);
    assert_true(kiln_gas_extent(scene, 0).bricks == kiln_gas_extent_at(scene, 0, 2.0).bricks);
    kiln_scene_destroy(&scene);
}

static void sources_that_are_off_give_none(void **state)
{
    (void)state;
    assert_true(extent_of("rate=0", "", 1.0).bricks == 0);
    expect_cells(extent_of("rate=0", "", 1.0), 0, 0, 0);
    assert_true(extent_of("rate={keys: {1 s: 0, 1.1 s: 20}}", "", 0.9).bricks == 0);
    assert_true(extent_of("rate={keys: {1 s: 0, 1.1 s: 20}}", "", 1.9).bricks > 0);
    assert_true(extent_of(NULL, "    enabled: false\n", 1.0).bricks == 0);
}

/* Expects all of the domain. */
static void expect_whole(const char *setting, const char *more, double time_s)
{
    const struct kiln_gas_extent extent = extent_of(setting, more, time_s);
    expect_cells(extent, 64, 64, 64);
    assert_true(extent.bricks == 512);
}

/* Gas fills all of a domain where little is known of its way. */
static void what_is_not_known_counts_as_whole(void **state)
{
    (void)state;
    expect_whole(NULL, "    sides: {top: closed}\n", 20.0);
    assert_true(extent_of(NULL, "    sides: {top: closed}\n", 1.0).bricks < 256);
    expect_whole("temperature=0", "", 0.5);
    expect_whole(NULL, "    attach: n\nnodes: {n: {position: [0, 0, 0]}}\n", 0.5);
    const struct kiln_gas_extent filled =
        extent_of("from=box: {origin: [0, 3.2, 0], size: [6.4, 6.4, 6.4]}", "", 0.5);
    expect_cells(filled, 64, 64, 64);
    assert_true(filled.bricks > 400);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plume_is_a_cone),
        cmocka_unit_test(spread_follows_the_source),
        cmocka_unit_test(extents_grow),
        cmocka_unit_test(sources_that_are_off_give_none),
        cmocka_unit_test(what_is_not_known_counts_as_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
