/* Creates and destroys the stages that draw a frame, and their timer, for tests that run stages one
 * by one. */
#include "support/stages.h"

#include "support/cmocka.h"

void stages_open(struct kiln_stages *stages, struct kiln_simulate **simulate,
                 struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_techniques *techniques, bool layers,
                 struct kiln_threads *threads, const struct kiln_pool *pool)
{
    struct kiln_error error = {0};
    const struct kiln_stages_params params = {
        .techniques = *techniques,
        .needs = {.bits = 8, .layers = layers ? KILN_LAYERS_ALL : KILN_LAYERS_NONE},
        .threads = threads,
        .timer = kiln_timer_create(device),
        .slot_count = pool->slot_count};
    assert_non_null(params.timer);
    if (!kiln_stages_init(stages, device, scene, &params, &error))
        fail_msg("%s", error.message);
    if (!simulate)
        return;
    *simulate =
        kiln_simulate_create(device, scene, techniques->simulate, techniques->gas, threads, &error);
    if (!*simulate)
        fail_msg("%s", error.message);
}

void stages_close(struct kiln_stages *stages, struct kiln_simulate **simulate)
{
    struct kiln_timer *timer = stages->timer;
    kiln_stages_finish(stages);
    kiln_timer_destroy(&timer);
    if (simulate)
        kiln_simulate_destroy(simulate);
}
