/* lib/draw/sprites/sprite_simd.c: the sprites are the same bytes for every width of vectors, and
 * whichever particles share a vector. lib/draw/vector/particle_math.h: the same bits as
 * shaders/shared. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "draw/moment/looks.h"
#include "draw/sprites/sprite.h"
#include "draw/vector/particle_math.h"
#include "support/cmocka.h"
#include "support/raster.h"
#include "support/scenes.h"

enum {
    COUNT = 1511,
    STEP = 90,
    GRID = KILN_SMOKE_GRID * KILN_SMOKE_GRID * KILN_SMOKE_GRID,
    LAMPS = 5,
    PLANE = (COUNT + KILN_SUN_SHADE_ROW - 1) / KILN_SUN_SHADE_ROW * KILN_SUN_SHADE_ROW,
};

/* Any bits: numbers of all sizes, and what is none. */
static uint32_t random_bits32(void)
{
    return (uint32_t)rand() << 16 ^ (uint32_t)rand();
}

/* ---- mathematics ----------------------------------------------------------------------------- */

static void vectors_divide_as_one_number(void **state)
{
    (void)state;
    static const uint32_t odd[] = {0,          0x80000000u, 0x7f800000u,     0xff800000u,
                                   0x7fc00000, 1,           EXACT_TINY_BITS, EXACT_VAST_BITS};
    srand(1);
    for (int i = 0; i < 20000; i++) {
        uint32_t bits[LANES];
        vf x;
        for (int k = 0; k < LANES; k++)
            bits[k] = i < 8 ? odd[(i + k) % 8] : random_bits32();
        memcpy(&x, bits, sizeof x);
        vf y = vf_rcp(x);
        for (int k = 0; k < LANES; k++)
            assert_true(FLOAT_BITS(y[k]) == FLOAT_BITS(exact_rcp(x[k])));
    }
}

static void vectors_draw_the_same_random_numbers(void **state)
{
    (void)state;
    srand(2);
    for (int i = 0; i < 5000; i++) {
        vu streams;
        for (int k = 0; k < LANES; k++)
            streams[k] = random_bits32();
        uint32_t purpose = (uint32_t)i % 16;
        float low = raster_random(-2.0f, 2.0f), high = raster_random(-2.0f, 2.0f);
        vf unit = vu_unit(streams, purpose);
        vf between = vf_lerp_clamped(vf_all(low), vf_all(high), unit);
        for (int k = 0; k < LANES; k++) {
            assert_true(unit[k] == random_unit(streams[k], purpose));
            assert_true(between[k] == random_between(streams[k], purpose, low, high));
        }
    }
}

static void vectors_live_as_long(void **state)
{
    (void)state;
    static const float4 keys[] = {{0.0f, 1.0f, 0.5f, 0.0f}, {2.0f, 2.0f, 0.0f, 3.0f}};
    const struct kiln_derived_params params = {
        .random_key = 77,
        .warmup_steps = 30,
        .dt_s = 1.0f / 60.0f,
        .life = {.min = {.constant = 0.5f}, .max = {.count = 2, .how = KILN_CLOCK_TIME}}};
    struct kiln_particle records[LANES];
    srand(3);
    for (int i = 0; i < 500; i++) {
        vi slots;
        for (int k = 0; k < LANES; k++) {
            for (uint32_t word = 0; word < 8; word++)
                ((uint32_t *)&records[k])[word] = random_bits32();
            records[k].velocity_birth.w = (1u + (uint32_t)rand() % 200) << KILN_BIRTH_STEP_SHIFT |
                                          (uint32_t)rand() % (1u << KILN_BIRTH_STEP_SHIFT);
            slots[k] = LANES - 1 - k;
        }
        const struct vf_particles p = read_records(records, slots);
        vu stream = vu_mix(p.serial + params.random_key);
        vf age = vf_age(p.birth, 250, 0.25f, params.dt_s);
        vf turned = vf_turned(&p, age, params.dt_s);
        vf life = vf_life(keys, &params, stream, p.birth), progress = vf_progress(age, life);
        for (int k = 0; k < LANES; k++) {
            const struct kiln_particle one = records[slots[k]];
            float age_s = particle_age_before(one, 250, 0.25f, params.dt_s);
            float life_s = particle_life_s(keys, params, one);
            assert_true(FLOAT_BITS(p.position.y[k]) == one.position_serial.y);
            assert_true(FLOAT_BITS(p.velocity.z[k]) == FLOAT_BITS(particle_velocity(one).z));
            assert_true(turned[k] == particle_turned_s(one, age_s, params.dt_s));
            assert_true(stream[k] == particle_stream(params, one));
            assert_true(age[k] == age_s && life[k] == life_s);
            assert_true(progress[k] == particle_progress(age_s, life_s));
        }
    }
}

/* ---- sprites --------------------------------------------------------------------------------- */

struct fixture {
    struct raster raster;
    struct kiln_cells *cells;
    struct kiln_lighting lighting;
    float depth[GRID], sunlit[COUNT];
    float lamp_smoke[LAMPS * KILN_LAMP_SMOKE_MAP];
    uint32_t lamplit[2 * PLANE]; /* four lamps a plane */
    struct kiln_particle records[COUNT];
    uint32_t entries[COUNT];
    struct kiln_sprite_pass pass;
};

/* Around where the camera looks, and some behind it. */
static void place_particles(struct fixture *f)
{
    srand(7);
    const struct kiln_view *view = &f->raster.moment.view;
    const float3 forward = kiln_view_forward(view);
    for (uint32_t i = 0; i < COUNT; i++) {
        float far = raster_random(-1.0f, 12.0f);
        float x = view->eye.x + far * forward.x + raster_random(-3.0f, 3.0f);
        float y = view->eye.y + far * forward.y + raster_random(-2.0f, 2.0f);
        float z = view->eye.z + far * forward.z + raster_random(-3.0f, 3.0f);
        f->records[i] = raster_random_particle(x, y, z, i, view->clock_step.x);
        f->entries[i] = KILN_ENTRY((uint32_t)rand() % f->raster.scene->system_count, i);
        f->sunlit[i] = raster_random(0.0f, 1.0f);
    }
    for (uint32_t i = 0; i < GRID; i++)
        f->depth[i] = raster_random(0.0f, 2.0f);
    for (uint32_t i = 0; i < LAMPS * KILN_LAMP_SMOKE_MAP; i++)
        f->lamp_smoke[i] = raster_random(0.0f, 2.0f);
    for (uint32_t i = 0; i < 2 * PLANE; i++)
        f->lamplit[i] = random_bits32();
}

static void light_particles(struct fixture *f)
{
    static const float4 to_grid[3] = {
        {0.1f, 0.0f, 0.0f, 0.4f}, {0.0f, 0.2f, 0.1f, 0.2f}, {0.0f, 0.0f, 0.1f, 0.5f}};
    raster_add_lamps(&f->raster, LAMPS);
    for (uint32_t i = 0; i < LAMPS; i++) {
        struct kiln_draw_light *lamp = &f->raster.light.lights[i];
        lamp->casters.z = i % 3; /* maps 1 and 2; 0: none */
        lamp->maps = (float4){0.0f, 0.3f, 5.0f, 0.0f};
    }
    f->lighting = (struct kiln_lighting){.smoke = true,
                                         .sky_depth = f->depth,
                                         .sun_depth = f->depth,
                                         .sunlit = f->sunlit,
                                         .lamp_smoke = f->lamp_smoke,
                                         .lamplit = f->lamplit,
                                         .slot_count = COUNT};
    memcpy(f->lighting.sky_to_grid, to_grid, sizeof to_grid);
    memcpy(f->lighting.sun_to_grid, to_grid, sizeof to_grid);
}

static struct fixture *open_scene(const char *path, bool coarse)
{
    struct kiln_error error = {0};
    struct fixture *f = aligned_alloc(64, (sizeof *f + 63) / 64 * 64);
    assert_non_null(f);
    memset(f, 0, sizeof *f);
    struct raster *raster = &f->raster;
    raster_open(raster, load_scene_file(path), 4, 2, STEP);
    f->cells = kiln_cells_create(&raster->atlas, &error);
    assert_non_null(f->cells);
    if (coarse)
        raster->moment.view = kiln_view_coarse(&raster->moment.view, 2);
    place_particles(f);
    light_particles(f);
    f->pass = (struct kiln_sprite_pass){.scene = raster->scene,
                                        .looks = raster->moment.looks,
                                        .table = raster->moment.look_table,
                                        .programs = raster->moment.look_programs,
                                        .records = f->records,
                                        .view = &raster->moment.view,
                                        .backdrop = &raster->light,
                                        .lighting = &f->lighting,
                                        .cells = f->cells,
                                        .content = kiln_cells_content(f->cells)};
    return f;
}

static void close_scene(struct fixture *f)
{
    kiln_cells_destroy(&f->cells);
    raster_close(&f->raster);
    free(f);
}

static struct kiln_sprites alloc_sprites(void)
{
    struct kiln_sprites sprites = {aligned_alloc(64, COUNT * sizeof *sprites.sprites),
                                   aligned_alloc(64, COUNT * sizeof *sprites.extras)};
    assert_true(sprites.sprites && sprites.extras);
    return sprites;
}

/* Fills sprites with bits that none of them has. */
static void spoil(struct kiln_sprites sprites)
{
    memset(sprites.sprites, 0xff, COUNT * sizeof *sprites.sprites);
    memset(sprites.extras, 0xff, COUNT * sizeof *sprites.extras);
}

static void free_sprites(struct kiln_sprites sprites)
{
    free(sprites.sprites);
    free(sprites.extras);
}

/* A sprite of which nothing is seen may have any data, as may an extra that its sprite does not
 * need. */
static void assert_same(struct kiln_sprites a, struct kiln_sprites b)
{
    for (size_t i = 0; i < COUNT; i++) {
        const struct kiln_sprite *one = &a.sprites[i], *other = &b.sprites[i];
        bool seen = one->x_from < one->x_to;
        assert_true(seen == (other->x_from < other->x_to));
        if (seen)
            assert_memory_equal(one, other, sizeof *one);
        if (seen && kiln_sprite_has_extra(one))
            assert_memory_equal(&a.extras[i], &b.extras[i], sizeof *a.extras);
    }
}

static void compare_levels(struct fixture *f)
{
    const struct kiln_sprites plain = alloc_sprites(), other = alloc_sprites();
    KILN_SIMD_PICK(kiln_sprites_make, kiln_simd_narrowest())
    (&f->pass, f->entries, NULL, COUNT, plain);
    size_t seen = 0;
    for (size_t i = 0; i < COUNT; i++)
        seen += plain.sprites[i].x_from < plain.sprites[i].x_to;
    assert_true(seen > COUNT / 8 && seen < COUNT);
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd)) {
            print_message("no %s here\n", kiln_simd_name(simd));
            continue;
        }
        kiln_sprites_make *make = KILN_SIMD_PICK(kiln_sprites_make, simd);
        spoil(other);
        make(&f->pass, f->entries, NULL, COUNT, other);
        assert_same(plain, other);
        spoil(other);
        for (size_t i = 0; i < COUNT; i += 1 + i % 23) /* other particles beside them */
            make(&f->pass, f->entries + i, NULL, COUNT - i < 23 ? COUNT - i : 1 + i % 23,
                 kiln_sprites_from(other, i));
        assert_same(plain, other);
    }
    free_sprites(plain);
    free_sprites(other);
}

static void every_width_makes_the_same_sprites(void **state)
{
    (void)state;
    static const char *const scenes[] = {"billboards", "fire_beam", "fireworks", "rain"};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        char path[512];
        snprintf(path, sizeof path, KILN_SOURCE_DIR "/scenes/%s.yaml", scenes[i]);
        struct fixture *f = open_scene(path, i == 1);
        compare_levels(f);
        close_scene(f);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(vectors_divide_as_one_number),
        cmocka_unit_test(vectors_draw_the_same_random_numbers),
        cmocka_unit_test(vectors_live_as_long),
        cmocka_unit_test(every_width_makes_the_same_sprites),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
