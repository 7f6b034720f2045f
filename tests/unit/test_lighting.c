/* lib/draw/firelight and smoke_shadow: what particles shed and keep off, against closed forms. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "draw/light/firelight.h"
#include "draw/light/smoke_shadow.h"
#include "draw/moment/appearance_blocks.h"
#include "draw/moment/looks.h"
#include "support/cmocka.h"
#include "support/placed.h"
#include "support/scenes.h"

enum { GRID = KILN_SMOKE_GRID };

static void assert_near(double found, double expected, double tolerance)
{
    if (!(fabs(found - expected) <= tolerance))
        fail_msg("%.9g instead of %.9g", found, expected);
}

static uint32_t gather_fire(const struct placed *f, struct kiln_draw_light *lights)
{
    return kiln_firelight_gather(&f->moment, f->threads, lights);
}

static const char FIRE[] =
    "kiln: 1\n"
    "output: {fps: 60}\n"
    "systems:\n"
    "  fire:\n"
    "    emit: {life: 1 s}\n"
    "    look:\n"
    "      {blend: add, color: [3, 2, 1], size: 0.4 m, opacity: 0.5, fade: {in: 0, out: 0},\n"
    "       light: [1, 1, 2], lights: 3}\n";

/* A patch of radiance L and area A: pi c = L A, of which a cell fills a quarter. */
static void a_particle_sheds_what_it_emits(void **state)
{
    (void)state;
    struct placed f = {0};
    placed_set_up(&f, FIRE, NULL);
    struct kiln_draw_light lights[KILN_MAX_FIRE_LIGHTS];
    assert_true(kiln_scene_has_firelight(f.scene));
    assert_int_equal(gather_fire(&f, lights), 0);

    placed_add(&f, 0, (float3){1, 2, 3}, 1); /* half of its life has passed: the middle light */
    assert_int_equal(gather_fire(&f, lights), 1);
    const double area = 0.4 * 0.4, pi = acos(-1.0), factor = 0.25 * area * 0.5 / pi;
    assert_near((double)lights[0].color.x, 3 * factor, 1e-6);
    assert_near((double)lights[0].color.y, 2 * factor, 1e-6);
    assert_near((double)lights[0].color.z, 2 * 1 * factor, 1e-6);
    assert_near((double)lights[0].position_radius2.x, 1, 1e-6);
    assert_near((double)lights[0].position_radius2.y, 2, 1e-6);
    assert_near((double)lights[0].position_radius2.z, 3, 1e-6);
    assert_near((double)lights[0].position_radius2.w, 0.2 * 0.2, 1e-6);
    placed_tear_down(&f);
}

/* A particle belongs to the two lights next to its age: as it grows older the light of each changes
 * a little at a time, and the sum not at all. */
static void light_moves_without_jumps(void **state)
{
    (void)state;
    struct placed f = {0};
    placed_set_up(&f, FIRE, NULL);
    struct kiln_draw_light lights[KILN_MAX_FIRE_LIGHTS];
    const double whole = 3 * 0.25 * 0.16 * 0.5 / acos(-1.0);
    placed_add(&f, 0, (float3){0, 0, 0}, 1);
    for (uint32_t step = 1; step < 60; step++) {
        f.moment.view.clock_step.x = step;
        uint32_t count = gather_fire(&f, lights);
        assert_in_range(count, 1, 2);
        double sum = 0;
        for (uint32_t i = 0; i < count; i++)
            sum += (double)lights[i].color.x;
        assert_near(sum, whole, 1e-6);
        double progress = step / 60.0 * 2; /* of three lights */
        double first = whole * (1 - (progress - floor(progress)));
        assert_near((double)lights[0].color.x, first, 1e-5);
    }
    placed_tear_down(&f);
}

/* Two particles of an age: one light between them, as wide as they are apart. */
static void a_light_is_as_wide_as_its_particles(void **state)
{
    (void)state;
    struct placed f = {0};
    placed_set_up(&f, FIRE, NULL);
    struct kiln_draw_light lights[KILN_MAX_FIRE_LIGHTS];
    placed_add(&f, 0, (float3){-2, 1, 0}, 1);
    placed_add(&f, 0, (float3){4, 1, 0}, 1);
    assert_int_equal(gather_fire(&f, lights), 1);
    assert_near((double)lights[0].position_radius2.x, 1, 1e-6);
    assert_near((double)lights[0].position_radius2.w, 9 + 0.04, 1e-5);
    placed_tear_down(&f);
}

static const char SMOKE[] = "kiln: 1\n"
                            "output: {fps: 60}\n"
                            "systems:\n"
                            "  smoke:\n"
                            "    emit: {life: 1 s}\n"
                            "    look: {size: 0.5 m, opacity: 0.5, fade: {in: 0, out: 0}}\n";

static float depth_at(const struct kiln_smoke_grid *grid, float3 position)
{
    const float p[4] = {position.x, position.y, position.z, 1};
    int cell[3];
    for (int i = 0; i < 3; i++) {
        const float4 row = grid->world_to_grid[i];
        float at = row.x * p[0] + row.y * p[1] + row.z * p[2] + row.w * p[3];
        if (at < 0 || at >= 1)
            return -1;
        cell[i] = (int)(at * GRID);
    }
    return grid->depth[((size_t)cell[2] * GRID + (size_t)cell[1]) * GRID + (size_t)cell[0]];
}

static bool fill(struct placed *f, float3 direction, struct kiln_smoke_grid *grid)
{
    static float depth[GRID * GRID * GRID];
    struct kiln_error error = {0};
    struct kiln_smoke smoke = {0};
    struct kiln_smoke_shadow *shadow = kiln_smoke_shadow_create();
    assert_non_null(shadow);
    *grid = (struct kiln_smoke_grid){.direction = direction, .depth = depth};
    assert_true(kiln_smoke_gather(&smoke, &f->moment, f->threads, &error));
    bool any = kiln_smoke_shadow_fill(shadow, &smoke, f->threads, grid, 1);
    kiln_smoke_shadow_destroy(&shadow);
    kiln_smoke_finish(&smoke);
    return any;
}

/* A slab of many puffs: the light above it is whole, below it the optical depth is that of all, and
 * in its middle that of half, whichever way the light comes. */
static void a_slab_dims_by_its_optical_depth(void **state)
{
    (void)state;
    static const float3 directions[] = {{0, 1, 0}, {1, 0, 0}, {0.6f, 0.8f, 0}, {0, -0.6f, 0.8f}};
    /* Extinction of a puff, summed over space: see extinction_of(). */
    const double pi = acos(-1.0);
    const double puff = -log(1 - 0.6 * 0.5) * 15 / 16 * 0.25 * 0.25 * 32 * pi / 105;
    for (size_t d = 0; d < sizeof directions / sizeof *directions; d++) {
        struct placed f = {0};
        placed_set_up(&f, SMOKE, NULL);
        float3 n = directions[d];
        float3 a = fabsf(n.y) < 0.9f ? (float3){-n.z, 0, n.x} : (float3){1, 0, 0};
        float length = sqrtf(a.x * a.x + a.y * a.y + a.z * a.z);
        a = (float3){a.x / length, a.y / length, a.z / length};
        float3 b = {n.y * a.z - n.z * a.y, n.z * a.x - n.x * a.z, n.x * a.y - n.y * a.x};
        for (int i = 0; i < 2000; i++) { /* 4 x 4 m, 1 m thick */
            float u = -2 + 4 * ((float)(i % 20) + 0.5f) / 20;
            float v = -2 + 4 * ((float)(i / 20 % 20) + 0.5f) / 20;
            float w = -0.5f + ((float)(i / 400) + 0.5f) / 5;
            placed_add(&f, 0,
                       (float3){u * a.x + v * b.x + w * n.x, u * a.y + v * b.y + w * n.y,
                                u * a.z + v * b.z + w * n.z},
                       1);
        }
        struct kiln_smoke_grid grid;
        assert_true(fill(&f, n, &grid));
        const double whole = 2000 * puff / 16;
        assert_near((double)depth_at(&grid, (float3){0.9f * n.x, 0.9f * n.y, 0.9f * n.z}), 0,
                    0.01 * whole);
        assert_near((double)depth_at(&grid, (float3){0, 0, 0}), 0.5 * whole, 0.08 * whole);
        assert_near((double)depth_at(&grid, (float3){-0.9f * n.x, -0.9f * n.y, -0.9f * n.z}), whole,
                    0.05 * whole);
        placed_tear_down(&f);
    }
}

/* However large a puff is, and whichever grid of the pyramid it goes into, it keeps off as much:
 * its extinction times its radius squared. */
static void puffs_of_any_size_keep_their_sum(void **state)
{
    (void)state;
    static const char *const sizes[] = {"0.02 m", "0.2 m", "0.7 m", "3 m"};
    const double pi = acos(-1.0);
    for (size_t s = 0; s < 4; s++) {
        char override[64];
        snprintf(override, sizeof override, "systems.smoke.look.size=%s", sizes[s]);
        struct placed f = {0};
        placed_set_up(&f, SMOKE, override);
        placed_add(&f, 0, (float3){-2, 0, 0}, 1); /* the corners of the grid, */
        placed_add(&f, 0, (float3){2, 0.1f, 0.3f}, 1);
        struct kiln_smoke_grid grid;
        assert_true(fill(&f, (float3){0, 1, 0}, &grid));
        /* The lowest layer has the depth of all: its sum times the area is the whole. */
        double sum = 0,
               edge_m = 1 / sqrt((double)(grid.world_to_grid[1].x * grid.world_to_grid[1].x +
                                          grid.world_to_grid[1].y * grid.world_to_grid[1].y +
                                          grid.world_to_grid[1].z * grid.world_to_grid[1].z));
        for (int i = 0; i < GRID * GRID; i++)
            sum += (double)grid.depth[i];
        sum *= edge_m * edge_m / (GRID * GRID);
        double radius = strtod(sizes[s], NULL) / 2;
        double expected = 2 * -log(1 - 0.3) * 15 / 16 * radius * radius * 32 * pi / 105;
        assert_near(sum, expected, 0.02 * expected);
        placed_tear_down(&f);
    }
}

static void only_what_covers_throws_shadows(void **state)
{
    (void)state;
    static const char *const overrides[] = {"systems.smoke.look.blend=add",
                                            "systems.smoke.look.shadow=0",
                                            "systems.smoke.enabled=false"};
    struct placed f = {0};
    struct kiln_smoke_grid grid;
    placed_set_up(&f, SMOKE, NULL);
    assert_true(kiln_scene_has_smoke(f.scene));
    assert_false(kiln_scene_has_firelight(f.scene));
    assert_false(fill(&f, (float3){0, 1, 0}, &grid)); /* no particles yet */
    placed_tear_down(&f);
    for (size_t i = 0; i < 3; i++) {
        placed_set_up(&f, SMOKE, overrides[i]);
        assert_false(kiln_scene_has_smoke(f.scene));
        placed_add(&f, 0, (float3){0, 0, 0}, 1);
        assert_false(fill(&f, (float3){0, 1, 0}, &grid));
        placed_tear_down(&f);
        f = (struct placed){0};
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_particle_sheds_what_it_emits),
        cmocka_unit_test(light_moves_without_jumps),
        cmocka_unit_test(a_light_is_as_wide_as_its_particles),
        cmocka_unit_test(a_slab_dims_by_its_optical_depth),
        cmocka_unit_test(puffs_of_any_size_keep_their_sum),
        cmocka_unit_test(only_what_covers_throws_shadows),
    };
    return cmocka_run_group_tests_name("lighting", tests, NULL, NULL);
}
