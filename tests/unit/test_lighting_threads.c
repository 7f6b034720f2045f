/* lib/draw/firelight and smoke_shadow: fast, but the same as a plain reading of what they are, and
 * the same for any number of threads. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "draw/light/firelight.h"
#include "draw/light/smoke_shadow.h"
#include "draw/moment/appearance_blocks.h"
#include "draw/moment/looks.h"
#include "draw/moment/view.h"
#include "support/cmocka.h"
#include "support/pools.h"
#include "support/scenes.h"

enum { GRID = KILN_SMOKE_GRID, CELLS = GRID * GRID * GRID, LEVELS = 4, MOST = 40000, STEP = 30 };

static const char SCENE[] =
    "kiln: 1\n"
    "output: {fps: 60}\n"
    "systems:\n"
    "  dust: {emit: {life: 1 s}, look: {size: {life: [0.05, 0.2]}, opacity: 0.3}}\n"
    "  puffs: {emit: {life: 1 s}, look: {size: {life: [0.5, 6]}, opacity: 0.6, shadow: 0.5}}\n"
    "  fire:\n"
    "    emit: {life: 1 s}\n"
    "    look: {blend: add, color: [3, 2, 1], size: 0.4 m, light: [1, 1, 2], lights: 5}\n";

/* What a run leaves: all that threads might change. */
struct result {
    bool smoke;
    uint32_t light_count;
    struct kiln_draw_light lights[KILN_MAX_FIRE_LIGHTS];
    float4 rows[KILN_MAX_SMOKE_GRIDS][3];
    float depth[KILN_MAX_SMOKE_GRIDS][CELLS];
};

static const float3 DIRECTIONS[KILN_MAX_SMOKE_GRIDS] = {{0, 1, 0}, {0.48f, 0.6f, 0.64f}};

struct fixture {
    struct kiln_scene *scene;
    struct kiln_pool pool;
    struct kiln_particle *records;
    struct kiln_moment moment;
};

static float part_of(uint32_t i, uint32_t factor)
{
    return (float)(i * factor >> 8 & 0xffff) / 65536.0f;
}

/* `counts` particles of each system in a box of 8 x 4 x 3 m, of all ages; every fifth slot dead. */
static void set_up(struct fixture *f, const uint32_t counts[3])
{
    static const uint32_t capacities[3] = {MOST, MOST, MOST};
    struct kiln_error error = {0};
    *f = (struct fixture){.scene = load_scene(SCENE, NULL)};
    pool_init(&f->pool, NULL, capacities, 3);
    f->records = kiln_buffer_host(&f->pool.records, KILN_READ_WRITE, &error);
    assert_non_null(f->records);
    assert_true(kiln_moment_init(&f->moment, NULL, f->scene, NULL, &error));
    assert_true(kiln_moment_fill(&f->moment, &f->pool, kiln_instant_at_step(STEP), true, &error));
    for (uint32_t system = 0; system < 3; system++) {
        struct kiln_pool_system *slots = &f->pool.systems[system];
        slots->next_serial = counts[system];
        for (uint32_t i = 0; i < counts[system]; i++) {
            float x = 8 * part_of(i, 2654435761u), y = 4 * part_of(i, 2246822519u);
            float z = 3 * part_of(i, 3266489917u) + (float)system;
            uint32_t alive = i % 5 == 4 ? 0 : KILN_PARTICLE_ALIVE;
            f->records[slots->base + i] = (struct kiln_particle){
                .position_serial = {FLOAT_BITS(x), FLOAT_BITS(y), FLOAT_BITS(z), i},
                .velocity_birth = {0, 0, 0, (1 + i % STEP) << KILN_BIRTH_STEP_SHIFT | alive}};
        }
    }
}

static void tear_down(struct fixture *f)
{
    kiln_moment_finish(&f->moment);
    kiln_pool_finish(&f->pool);
    kiln_scene_destroy(&f->scene);
}

/* Twice into the same memory, so that what a moment leaves would be seen in the next. */
static void light(const struct fixture *f, uint32_t thread_count, struct result *result)
{
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(thread_count);
    struct kiln_smoke_shadow *shadow = kiln_smoke_shadow_create();
    struct kiln_smoke smoke = {0};
    assert_true(threads && shadow);
    memset(result, 0, sizeof *result);
    for (int k = 0; k < 2; k++) {
        struct kiln_smoke_grid grids[KILN_MAX_SMOKE_GRIDS];
        for (int i = 0; i < KILN_MAX_SMOKE_GRIDS; i++)
            grids[i] =
                (struct kiln_smoke_grid){.direction = DIRECTIONS[i], .depth = result->depth[i]};
        result->light_count = kiln_firelight_gather(&f->moment, threads, result->lights);
        assert_true(kiln_smoke_gather(&smoke, &f->moment, threads, &error));
        result->smoke =
            kiln_smoke_shadow_fill(shadow, &smoke, threads, grids, KILN_MAX_SMOKE_GRIDS);
        for (int i = 0; i < KILN_MAX_SMOKE_GRIDS && result->smoke; i++)
            memcpy(result->rows[i], grids[i].world_to_grid, sizeof result->rows[i]);
    }
    kiln_smoke_finish(&smoke);
    kiln_smoke_shadow_destroy(&shadow);
    kiln_threads_destroy(&threads);
}

static void threads_make_no_difference(void **state)
{
    (void)state;
    static struct result one, more;
    static const uint32_t amounts[][3] = {{MOST, 3000, MOST}, {50, 7, 3}};
    static const uint32_t thread_counts[] = {2, 3, 7};
    for (int a = 0; a < 2; a++) {
        struct fixture f;
        set_up(&f, amounts[a]);
        light(&f, 1, &one);
        assert_true(one.smoke && one.light_count > 0);
        for (int t = 0; t < 3; t++) {
            light(&f, thread_counts[t], &more);
            assert_memory_equal(&one, &more, sizeof one);
        }
        tear_down(&f);
    }
}

/* A grid by the book, in double precision. */
struct book {
    double cell; /* m */
    double levels[LEVELS][CELLS];
};

static double bump(double distance2)
{
    return distance2 < 1 ? (1 - distance2) * (1 - distance2) : 0;
}

/* at: the centre in units of the grid's edge. */
static void put_by_the_book(struct book *book, const double at[3], double radius, double extinction)
{
    int level = 0;
    double cell = book->cell;
    for (; level < LEVELS - 1 && radius > 2.5 * cell; level++)
        cell *= 2;
    int edge = GRID >> level;
    double r = fmax(radius / cell, 1.2), sum = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < edge * edge * edge; i++) {
            double x = at[0] * edge - (i % edge + 0.5), y = at[1] * edge - (i / edge % edge + 0.5);
            double z = at[2] * edge - (i / (edge * edge) + 0.5);
            double weight = bump((x * x + y * y + z * z) / (r * r));
            if (pass == 0)
                sum += weight;
            else
                book->levels[level][i] += extinction * weight / (sum * cell * cell * cell);
        }
    }
}

static double nearest(const double *cells, int edge, int x, int y, int z)
{
    x = x < 0 ? 0 : x < edge ? x : edge - 1;
    y = y < 0 ? 0 : y < edge ? y : edge - 1;
    z = z < 0 ? 0 : z < edge ? z : edge - 1;
    return cells[(z * edge + y) * edge + x];
}

/* A coarse level at the centre of a cell of the next finer one, interpolated linearly. */
static double between(const double *cells, int edge, int x, int y, int z)
{
    double sum = 0;
    for (int corner = 0; corner < 8; corner++) {
        bool own[3] = {corner & 1, corner & 2, corner & 4};
        double weight = (own[0] ? 0.75 : 0.25) * (own[1] ? 0.75 : 0.25) * (own[2] ? 0.75 : 0.25);
        sum += weight * nearest(cells, edge,
                                x / 2 + (own[0]  ? 0
                                         : x % 2 ? 1
                                                 : -1),
                                y / 2 + (own[1]  ? 0
                                         : y % 2 ? 1
                                                 : -1),
                                z / 2 + (own[2]  ? 0
                                         : z % 2 ? 1
                                                 : -1));
    }
    return sum;
}

static void add_levels_by_the_book(struct book *book)
{
    for (int level = LEVELS - 2; level >= 0; level--) {
        int edge = GRID >> level;
        for (int i = 0; i < edge * edge * edge; i++)
            book->levels[level][i] += between(book->levels[level + 1], edge / 2, i % edge,
                                              i / edge % edge, i / (edge * edge));
    }
}

/* All puffs of the scene, placed by the rows that a run has found. */
static void fill_by_the_book(const struct fixture *f, const float4 rows[3], struct book *book)
{
    static const double shadows[2] = {1, 0.5};
    const double pi = acos(-1.0);
    memset(book, 0, sizeof *book);
    book->cell =
        1 / (GRID *
             sqrt((double)(rows[0].x * rows[0].x + rows[0].y * rows[0].y + rows[0].z * rows[0].z)));
    for (uint32_t i = 0; i < 2; i++) {
        const struct kiln_appearance_system system = kiln_appearance_system(&f->moment, i);
        for (uint32_t slot = 0; slot < system.used; slot++) {
            struct kiln_appearance puff;
            if (!kiln_appearance_at(&system, slot, &puff) || !(puff.opacity > 0))
                continue;
            double at[3], radius = (double)puff.radius;
            for (int k = 0; k < 3; k++)
                at[k] = (double)(rows[k].x * puff.position.x + rows[k].y * puff.position.y +
                                 rows[k].z * puff.position.z + rows[k].w);
            double depth = -log(1 - 0.6 * (double)puff.opacity) * shadows[i];
            put_by_the_book(book, at, radius, depth * 15 / 16 * radius * radius * 32 * pi / 105);
        }
    }
    add_levels_by_the_book(book);
}

static void grids_are_those_of_the_book(void **state)
{
    (void)state;
    static struct result result;
    static struct book book;
    static const uint32_t amounts[][3] = {{60, 40, 0}, {30, 0, 0}, {0, 1, 0}, {1, 0, 0}};
    for (int a = 0; a < 4; a++) {
        struct fixture f;
        set_up(&f, amounts[a]);
        light(&f, 2, &result);
        assert_true(result.smoke);
        assert_int_equal(result.light_count, 0);
        for (int which = 0; which < KILN_MAX_SMOKE_GRIDS; which++) {
            fill_by_the_book(&f, result.rows[which], &book);
            double greatest = 0, worst = 0;
            for (int column = 0; column < GRID * GRID; column++) {
                double above = 0;
                for (int z = GRID - 1; z >= 0; z--) {
                    int cell = z * GRID * GRID + column;
                    double own = book.levels[0][cell] * book.cell;
                    double depth = (double)result.depth[which][cell];
                    assert_true(isfinite(depth));
                    worst = fmax(worst, fabs(depth - (above + 0.5 * own)));
                    above += own;
                }
                greatest = fmax(greatest, above);
            }
            assert_true(greatest > 0);
            if (worst > 1e-4 * greatest)
                fail_msg("amount %d, grid %d: off by %g of %g", a, which, worst, greatest);
        }
        tear_down(&f);
    }
}

static void nothing_alive_is_no_light_and_no_smoke(void **state)
{
    (void)state;
    static struct result result;
    static const uint32_t none[3] = {0, 0, 0}, some[3] = {5000, 10, 5000};
    struct fixture f;
    set_up(&f, none);
    light(&f, 2, &result);
    assert_false(result.smoke);
    assert_int_equal(result.light_count, 0);
    tear_down(&f);

    set_up(&f, some);
    for (uint32_t i = 0; i < f.pool.slot_count; i++)
        f.records[i].velocity_birth.w &= ~(uint32_t)KILN_PARTICLE_ALIVE;
    light(&f, 2, &result);
    assert_false(result.smoke);
    assert_int_equal(result.light_count, 0);
    tear_down(&f);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_make_no_difference),
        cmocka_unit_test(grids_are_those_of_the_book),
        cmocka_unit_test(nothing_alive_is_no_light_and_no_smoke),
    };
    return cmocka_run_group_tests_name("lighting threads", tests, NULL, NULL);
}
