/* Draws frames of a scene whose gas is set by hand, instead of being simulated. */
#include "support/gas_frame.h"

#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/gas_fixture.h"
#include "support/pools.h"
#include "support/scenes.h"
#include "support/stages.h"

static void add_gas(struct kiln_scene *scene, struct kiln_pool *pool, const struct gas_frame *frame)
{
    struct kiln_gas *gas = &pool->gas[0];
    gas_fixture_full(gas, 32, 2.0f / 32.0f, frame->smoke, frame->flame > 0.0f ? 1.0f : 0.0f,
                     frame->flame);
    pool->gas_count = scene->gas_count = 1;
    scene->gas[0] =
        (struct kiln_gas_domain){.name = "fire",
                                 .enabled = true,
                                 .shape = gas->shape,
                                 .detail = 1,
                                 .look = {.extinction = {.constant = 0.5f},
                                          .kelvin = {{.constant = 900.0f}, {.constant = 2250.0f}},
                                          .intensity = {.constant = 2.0f},
                                          .bloom = {.constant = 0.25f}}};
}

/* Draws all moments of frame 0. */
static void draw_moments(struct kiln_stages *stages, struct kiln_pool *pool, uint32_t step)
{
    struct kiln_error error = {0};
    uint32_t drawn;
    for (uint32_t i = 0; i < kiln_scene_moment_count(stages->scene); i++)
        if (!kiln_stages_draw(stages, NULL, pool, kiln_instant_at_step(step), i, &drawn, &error))
            fail_msg("%s", error.message);
}

struct kiln_picture *gas_frame_draw(struct kiln_device *device, const struct gas_frame *frame)
{
    struct kiln_error error = {0};
    const char *overrides[5] = {NULL};
    for (size_t i = 0; i < frame->count; i++)
        overrides[i] = frame->overrides[i];
    struct kiln_scene *scene = load_scene(frame->text, overrides);
    struct kiln_threads *threads = kiln_threads_create(2);
    const char *names[KILN_MAX_LAYERS];
    uint32_t channels[KILN_MAX_LAYERS];
    const uint32_t count = kiln_stages_layers(frame->domain, names, channels);
    struct kiln_picture *picture =
        kiln_picture_create(scene->width, scene->height, 8, names, channels, count, &error);
    struct kiln_pool pool = {0};
    struct kiln_stages stages;
    struct kiln_simulate *simulate;
    pool_init_of(&pool, device, scene);
    if (frame->domain)
        add_gas(scene, &pool, frame);
    stages_open(&stages, &simulate, device, scene, &frame->techniques, true, threads, &pool);
    for (uint32_t step = 1; step <= frame->steps; step++)
        assert_true(kiln_simulate_step(simulate, &pool, step, &error));
    draw_moments(&stages, &pool, frame->steps);
    if (!kiln_stages_compose(&stages, 0, &error) || !kiln_stages_read(&stages, picture, &error))
        fail_msg("%s", error.message);
    stages_close(&stages, &simulate);
    if (frame->domain)
        kiln_gas_finish(&pool.gas[0]);
    kiln_pool_finish(&pool);
    kiln_threads_destroy(&threads);
    kiln_scene_destroy(&scene);
    return picture;
}
