/* Draws domains of gas that tests fill, by the stage of gas alone. */
#include "support/gas_view.h"

#include <string.h>

#include "support/cmocka.h"
#include "support/scenes.h"

/* The camera looks along -z at the middle of domains of 2 m, 10 m away. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [65, 65], fps: 30}\n"
    "simulation: {rate: 30}\n"
    "camera: {position: [0, 1, 10], target: [0, 1, 0], fov: 15 deg}\n"
    "nodes: {cart: {position: [3, -2, 1], rotation: [0, 90 deg, 0], scale: 2}}\n";

struct kiln_value gas_view_value(float x)
{
    return (struct kiln_value){.constant = x};
}

struct kiln_value3 gas_view_value3(float x, float y, float z)
{
    return (struct kiln_value3){gas_view_value(x), gas_view_value(y), gas_view_value(z)};
}

void gas_view_open(struct gas_view *f)
{
    gas_view_open_on(f, NULL);
}

void gas_view_open_on(struct gas_view *f, struct kiln_device *device)
{
    struct kiln_error error = {0};
    *f = (struct gas_view){.device = device, .scene = load_scene(SCENE, NULL), .threads = 1};
    assert_true(kiln_moment_init(&f->moment, NULL, f->scene, NULL, &error));
    assert_true(kiln_moment_fill(&f->moment, NULL, kiln_instant_at_step(0), false, &error));
    kiln_image_init(&f->depth, device, GAS_VIEW_SIZE, GAS_VIEW_SIZE, GL_R32F, "depth");
    kiln_image_init(&f->picture, NULL, GAS_VIEW_SIZE, GAS_VIEW_SIZE, GL_RGBA32F, "picture");
    kiln_image_init(&f->halfway, NULL, GAS_VIEW_SIZE, GAS_VIEW_SIZE, GL_R32F, "halfway");
    kiln_image_init(&f->layer, NULL, GAS_VIEW_SIZE, GAS_VIEW_SIZE, GL_RGBA32F, "layer");
    float *depth = kiln_image_host(&f->depth, KILN_OVERWRITE, &error);
    for (int i = 0; i < GAS_VIEW_SIZE * GAS_VIEW_SIZE; i++)
        depth[i] = 1e9f;
}

void gas_view_close(struct gas_view *f)
{
    for (uint32_t i = 0; i < f->pool.gas_count; i++)
        kiln_gas_finish(&f->pool.gas[i]);
    kiln_image_finish(&f->depth);
    kiln_image_finish(&f->picture);
    kiln_image_finish(&f->halfway);
    kiln_image_finish(&f->layer);
    kiln_moment_finish(&f->moment);
    kiln_scene_destroy(&f->scene);
}

struct kiln_gas *gas_view_add(struct gas_view *f, struct kiln_gas_look look)
{
    struct kiln_gas_domain *d = &f->scene->gas[f->scene->gas_count++];
    look.kelvin[0] = gas_view_value(900.0f);
    look.kelvin[1] = gas_view_value(2250.0f);
    *d = (struct kiln_gas_domain){.name = "smoke", .enabled = true, .look = look, .detail = 1};
    return &f->pool.gas[f->pool.gas_count++];
}

const float *gas_view_draw(struct gas_view *f)
{
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(f->threads);
    for (uint32_t i = 0; i < f->pool.gas_count; i++)
        f->scene->gas[i].shape = f->pool.gas[i].shape;
    struct kiln_volume_stage *stage = kiln_volume_create(&f->moment, true, threads, &error);
    assert_non_null(stage);
    assert_true(!f->device || kiln_volume_use_gl(stage, f->device, &error));
    float *picture = kiln_image_host(&f->picture, KILN_OVERWRITE, &error);
    memset(picture, 0, GAS_VIEW_FLOATS * sizeof *picture);
    const struct kiln_volume_draw gas = {.moment = &f->moment,
                                         .pool = &f->pool,
                                         .backdrop = &f->light,
                                         .lighting = f->lighting,
                                         .depth = &f->depth,
                                         .halfway = f->layers ? &f->halfway : NULL};
    assert_true(kiln_volume_draw(stage, &gas, &error));
    assert_true(kiln_volume_put_under(stage, KILN_VOLUME_ALL, &f->picture, &error));
    assert_true(!f->layers || kiln_volume_write_layer(stage, &f->layer, &error));
    kiln_volume_destroy(&stage);
    kiln_threads_destroy(&threads);
    return picture;
}

void gas_view_assert_bits(struct gas_view *f)
{
    static float expected[GAS_VIEW_FLOATS];
    memcpy(expected, gas_view_draw(f), sizeof expected);
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd))
            continue;
        f->moment.simd = simd;
        for (f->threads = 1; f->threads <= 3; f->threads++)
            assert_memory_equal(gas_view_draw(f), expected, sizeof expected);
    }
}
