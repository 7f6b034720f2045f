/* Simulates a scene and draws one frame of it by all stages (frame_try, frame_draw), and measures
 * how much a layer of two pictures differs (frame_difference). */
#include "support/frame.h"

#include <math.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/pools.h"
#include "support/stages.h"

const struct kiln_techniques FRAME_CPU = {
    .raster = KILN_RASTER_CPU, .bloom = KILN_BLOOM_CPU, .composite = KILN_COMPOSITE_CPU};
const struct kiln_techniques FRAME_GL = {
    .raster = KILN_RASTER_GEOMETRY, .bloom = KILN_BLOOM_GL, .composite = KILN_COMPOSITE_GL};

/* Simulates `steps` steps of the scene and draws the last one into a picture. Returns false with an
 * error if drawing fails; an error of the simulation fails the test. */
static bool frame_stage(struct kiln_device *device, const struct kiln_scene *scene,
                        const struct frame_setting *setting, uint32_t steps,
                        struct kiln_threads *threads, struct kiln_picture *picture,
                        struct kiln_error *error)
{
    struct kiln_run run = {0};
    uint32_t drawn = 0;
    pool_init_of(&run.pool, device, scene);
    struct kiln_stages stages;
    struct kiln_simulate *simulate;
    stages_open(&stages, &simulate, device, scene, &setting->techniques, true, threads, &run.pool);
    for (uint32_t step = 1; step <= steps; step++)
        assert_true(kiln_simulate_step(simulate, &run.pool, step, error));
    bool drew =
        kiln_stages_draw(&stages, NULL, &run.pool, kiln_instant_at_step(steps), 0, &drawn, error) &&
        kiln_stages_compose(&stages, 0, error) && kiln_stages_read(&stages, picture, error);
    stages_close(&stages, &simulate);
    kiln_pool_finish(&run.pool);
    return drew;
}

struct kiln_picture *frame_try(struct kiln_device *device, const char *text, uint32_t steps,
                               const struct frame_setting *setting, struct kiln_error *result)
{
    struct kiln_error error = {0};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = setting->overrides;
    params.override_count = setting->count;
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "test", &params, &error);
    assert_string_equal(error.message, "");
    const char *names[KILN_MAX_LAYERS];
    uint32_t channels[KILN_MAX_LAYERS],
        count = kiln_stages_layers(kiln_volume_domains(scene) > 0, names, channels);
    struct kiln_picture *picture =
        kiln_picture_create(scene->width, scene->height, 8, names, channels, count, &error);
    assert_non_null(picture);
    struct kiln_threads *threads = kiln_threads_create(setting->threads ? setting->threads : 2);
    if (!frame_stage(device, scene, setting, steps, threads, picture, result))
        kiln_picture_destroy(&picture);
    kiln_threads_destroy(&threads);
    kiln_scene_destroy(&scene);
    return picture;
}

struct kiln_picture *frame_draw(struct kiln_device *device, const char *text, uint32_t steps,
                                const struct frame_setting *setting)
{
    struct kiln_error error = {0};
    struct kiln_picture *picture = frame_try(device, text, steps, setting, &error);
    if (!picture)
        fail_msg("%s", error.message);
    return picture;
}

double frame_difference(const struct kiln_picture *a, const struct kiln_picture *b, int layer)
{
    double sum = 1e-9, off = 0;
    size_t floats = (size_t)a->width * a->height * a->layers[layer].channels;
    for (size_t i = 0; i < floats; i++) {
        double one = (double)a->layers[layer].pixels[i], other = (double)b->layers[layer].pixels[i];
        assert_true(isfinite(other));
        sum += fabs(one);
        off += fabs(one - other);
    }
    return off / sum;
}
