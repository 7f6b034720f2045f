/* lib/draw/sprites/fragments.c and what particles_cpu.c does with it: more fragments than a thread
 * has room for, and more sprites than are made at a time, give the picture all the same, in bounded
 * memory. Every width of vectors gives the same bytes.
 */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "base/simd.h"
#include "support/cmocka.h"
#include "support/parts.h"
#include "support/raster.h"
#include "support/scenes.h"

enum { STEP = 40, PLACES = 1024 };

/* More than twice what is made at a time. */
#ifdef __SANITIZE_ADDRESS__ /* slow, and does not look at the memory */
enum { MANY = 600000 };
#else
enum { MANY = 1400000 };
#endif

/* Cards parallel to the picture, in which pixels sort as particles do. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [128, 32], fps: 60, frames: 100}\n"
    "camera: {position: [0, 1, 3], target: [0, 1, 0], fov: 60 deg, near: 0.05 m}\n"
    "systems:\n"
    "  cards:\n"
    "    emit: {rate: 1, life: 2 s, from: {point: {}}}\n"
    "    look: {atlas: 'builtin:spark', fade: {in: 0, out: 0}, color: [0.5, 0.4, 0.3], lit: 1,\n"
    "           thickness: 0, motion: none}\n"
    "post: {compose: oit}\n";

/* Particles at PLACES depths, over and over, farthest first, and in a picture of this size. */
static void set_up(struct raster *r, const char *look, uint32_t width, uint32_t height,
                   uint32_t count)
{
    char size[64];
    snprintf(size, sizeof size, "output.size=[%u, %u]", width, height);
    const char *const overrides[] = {look, size, NULL};
    raster_open(r, load_scene(SCENE, overrides), 2, 1, STEP);
    raster_add_targets(r);
    struct kiln_particle *records;
    uint32_t *entries;
    raster_add_particles(r, PLACES, count, &records, &entries);
    for (uint32_t i = 0; i < PLACES; i++) {
        float away = (float)i / PLACES, side = (float)(i * 29 % PLACES) / PLACES - 0.5f;
        float up = (float)(i * 517 % PLACES) / PLACES - 0.5f;
        records[i] = (struct kiln_particle){
            {FLOAT_BITS(4.0f * side), FLOAT_BITS(1.0f + 1.2f * up), FLOAT_BITS(away), i},
            {0, 0, 0, 1u << KILN_BIRTH_STEP_SHIFT | KILN_PARTICLE_ALIVE}};
    }
    for (uint32_t i = 0; i < count; i++)
        entries[i] = KILN_ENTRY(0, (uint32_t)((uint64_t)i * PLACES / count));
}

static void draw(struct raster *r, bool by_fragment)
{
    struct kiln_particles_draw job = raster_job(r);
    job.by_fragment = by_fragment;
    raster_draw(r, &job, 2);
}

static long peak_kib(void)
{
    struct rusage usage;
    assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
    return usage.ru_maxrss;
}

/* The picture of lists is that of particles in order, and takes no more memory than this besides.
 */
static void expect_picture(struct raster *r, long most_mib)
{
    const size_t floats = (size_t)r->scene->width * r->scene->height * 4;
    float *merged = malloc(floats * sizeof *merged);
    assert_non_null(merged);
    draw(r, false);
    memcpy(merged, r->color.host, floats * sizeof *merged);
    const long before = peak_kib();
    draw(r, true);
    const long grown_mib = (peak_kib() - before) / 1024;
    double covered = 0.0, off = 0.0;
    for (size_t i = 0; i < floats; i++) {
        off = fmax(off, (double)fabsf(merged[i] - r->color.host[i]));
        covered += i % 4 == 3 ? (double)merged[i] : 0.0;
    }
    print_message("%ld MiB more, %.2g off\n", grown_mib, off);
    assert_true(off < 4e-3); /* sums of thousands of faint layers */
    assert_true(covered > 0.05 * (double)r->scene->width * r->scene->height);
#ifndef __SANITIZE_ADDRESS__ /* which keeps what was freed */
    assert_true(grown_mib < most_mib);
#else
    (void)most_mib;
#endif
    free(merged);
}

/* A row of 64 pixels gets over half a million fragments, for which 48 bytes each are kept; twice as
 * many of round billboards, whose near sheets all lie at the eye. */
static void long_lists_are_drawn_in_turns(void **state)
{
    (void)state;
    static const char *const looks[] = {
        "systems.cards.look={size: 12 m, opacity: 0.0003}",
        "systems.cards.look={size: 12 m, opacity: 0.0003, thickness: 1, lit: 0}",
    };
    for (int i = 0; i < 2; i++) {
        struct raster r;
        set_up(&r, looks[i], 64, 16, 9000);
        expect_picture(&r, 40);
        raster_close(&r);
    }
}

/* Of 192 bytes each; the lists of sprites take 4 more for each tile. */
static void many_sprites_are_made_for_some_tiles_at_a_time(void **state)
{
    (void)state;
    struct raster r;
    set_up(&r, "systems.cards.look={size: 0.1 m, opacity: 0.002}", 256, 64, MANY);
    expect_picture(&r, 180);
    raster_close(&r);
}

/* Draws round puffs, whose sheets cross each other, with two particles at each depth. */
static void draw_puffs(float *drawn, size_t floats, uint32_t count)
{
    struct raster r;
    set_up(&r, "systems.cards.look={atlas: 'builtin:puff', size: 0.7 m, thickness: 1, bloom: 0.3}",
           120, 48, count);
    assert_int_equal(floats, (size_t)r.scene->width * r.scene->height * 8);
    draw(&r, true);
    memcpy(drawn, r.color.host, floats / 2 * sizeof *drawn);
    memcpy(drawn + floats / 2, r.bloom.host, floats / 2 * sizeof *drawn);
    raster_close(&r);
}

/* Lists of one puff, of a few, and of up to hundreds. */
static void every_width_of_vectors_sorts_alike(void **state)
{
    (void)state;
    static const uint32_t counts[] = {1, 40, 2 * PLACES};
    enum { FLOATS = 120 * 48 * 8 };
    float *expected = malloc(FLOATS * sizeof *expected), *drawn = malloc(FLOATS * sizeof *drawn);
    assert_true(expected && drawn);
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        setenv("KILN_SIMD", kiln_simd_name(kiln_simd_narrowest()), 1);
        draw_puffs(expected, FLOATS, counts[i]);
        for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
            if (!kiln_simd_has(simd))
                continue;
            setenv("KILN_SIMD", kiln_simd_name(simd), 1);
            draw_puffs(drawn, FLOATS, counts[i]);
            assert_memory_equal(drawn, expected, FLOATS * sizeof *drawn);
        }
    }
    unsetenv("KILN_SIMD");
    free(expected);
    free(drawn);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(long_lists_are_drawn_in_turns),
        cmocka_unit_test(every_width_of_vectors_sorts_alike),
    };
    static const struct CMUnitTest full[] = {
        cmocka_unit_test(many_sprites_are_made_for_some_tiles_at_a_time),
    };
    struct test_list list = {.count = 0};
    test_list_add(&list, tests, sizeof tests / sizeof *tests);
    test_list_add_full(&list, full, sizeof full / sizeof *full);
    return test_list_run(&list, "fragments", argc, argv, NULL, NULL);
}
