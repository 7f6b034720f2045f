/* lib/scene: good scenes mean what they say, and print as themselves. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene.h"

/* The example of the design document. */
static const char example[] =
    "kiln: 1\n"
    "seed: 7\n"
    "output: {size: [1280, 720], fps: 30, frames: 150}\n"
    "simulation: {rate: 60, warmup: 2 s}\n"
    "camera: {position: [7, 2.5, 9], target: [2, 1, 0], fov: 45 deg}\n"
    "backdrop:\n"
    "  floor: {color: [0.35, 0.34, 0.33]}\n"
    "  sky: {top: [0.02, 0.03, 0.05], horizon: [0.12, 0.13, 0.16]}\n"
    "  objects:\n"
    "    - box: {center: [4, 1, 0], size: [1, 2, 1], collide: true}\n"
    "systems:\n"
    "  smoke:\n"
    "    emit: {rate: 20000, life: [3 s, 4 s], from: {cone: {origin: [0, 1, 0],\n"
    "           direction: [1, 0.1, 0], angle: 8 deg}}, speed: [3, 4]}\n"
    "    forces: [{gravity: [0, 0.4, 0]}, {drag: 0.2}, {wind: {field: curl, strength: 0.6}}]\n"
    "    collide: {randomness: 0.4, slowdown: 0.5}\n"
    "    look: {atlas: \"builtin:smoke\", blend: alpha, size: {life: [0.1, 1.2]},\n"
    "           fade: {in: 0.2, out: 0.5}, soft: 2}\n"
    "  fire:\n"
    "    emit: {rate: {keys: {0 s: 20000, 3 s: 20000, 3.2 s: 0}}, life: [1 s, 1.4 s]}\n"
    "    look: {atlas: \"builtin:fire\", blend: add, temperature: {life: [1900, 1000]},\n"
    "           bloom: [1.0, 0.5, 0.25]}\n"
    "post: {compose: merged, bloom: {kind: gaussian, strength: 1}, tonemap: agx}\n";

static struct kiln_scene *load(const char *text, const char *const *overrides, size_t count)
{
    struct kiln_error error = {0};
    struct kiln_scene_params params = KILN_SCENE_DEFAULTS;
    params.overrides = overrides;
    params.override_count = count;
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "test.yaml", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

/* The caller frees it. */
static char *print(const struct kiln_scene *scene)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_true(kiln_scene_print(scene, out));
    fclose(out);
    return text;
}

static void example_loads(void **state)
{
    (void)state;
    struct kiln_scene *scene = load(example, NULL, 0);
    assert_int_equal(scene->seed, 7);
    assert_int_equal(scene->width, 1280);
    assert_int_equal(scene->height, 720);
    assert_int_equal(scene->steps_per_frame, 2);
    assert_int_equal(scene->warmup_steps, 120);
    assert_true(scene->dt_s == 1.0f / 60.0f);
    assert_int_equal(scene->system_count, 2);
    assert_true(scene->camera.fov.constant == (float)(45 * (3.14159265358979323846 / 180)));

    const struct kiln_system *smoke = &scene->systems[0];
    assert_string_equal(smoke->name, "smoke");
    assert_int_equal(smoke->emit.shape, KILN_EMITTER_CONE);
    assert_true(smoke->emit.rate.constant == 20000.0f);
    assert_true(smoke->emit.life.min.constant == 3.0f && smoke->emit.life.max.constant == 4.0f);
    assert_true(smoke->emit.direction.y.constant == 0.1f);
    assert_int_equal(smoke->force_count, 3);
    assert_int_equal(smoke->forces[0].kind, KILN_FORCE_GRAVITY);
    assert_true(smoke->forces[0].vector.y.constant == 0.4f);
    assert_int_equal(smoke->forces[1].kind, KILN_FORCE_DRAG);
    assert_true(smoke->forces[1].strength.constant == 0.2f);
    assert_int_equal(smoke->forces[2].kind, KILN_FORCE_CURL);
    assert_true(smoke->forces[2].strength.constant == 0.6f);
    assert_true(smoke->collide.enabled && smoke->collide.randomness.constant == 0.4f);
    assert_string_equal(smoke->look.atlas, "builtin:smoke");
    assert_int_equal(smoke->look.size.clock, KILN_CLOCK_LIFE);
    assert_true(value_at(scene->keys, smoke->look.size, 0, 0.0f) == 0.1f);
    assert_true(value_at(scene->keys, smoke->look.size, 0, 1.0f) == 1.2f);

    const struct kiln_system *fire = &scene->systems[1];
    assert_false(fire->collide.enabled);
    assert_int_equal(fire->look.blend, KILN_BLEND_ADD);
    assert_true(kiln_scene_value(scene, &fire->emit.rate, 3.1f) > 9900.0f);
    assert_true(kiln_scene_value(scene, &fire->emit.rate, 3.1f) < 10100.0f);
    assert_true(kiln_scene_value(scene, &fire->emit.rate, 9) == 0);
    assert_int_equal(scene->backdrop.box_count, 1);
    assert_true(scene->backdrop.floor_enabled);
    assert_int_equal(scene->post.tonemap, KILN_TONEMAP_AGX);
    kiln_scene_destroy(&scene);
    assert_null(scene);
    kiln_scene_destroy(&scene);
}

static void printed_scene_loads_to_itself(void **state)
{
    (void)state;
    struct kiln_scene *scene = load(example, NULL, 0);
    char *text = print(scene);
    struct kiln_scene *again = load(text, NULL, 0);
    char *text_again = print(again);
    assert_string_equal(text, text_again);
    assert_string_equal(scene->hash, again->hash);
    free(text);
    free(text_again);
    kiln_scene_destroy(&scene);
    kiln_scene_destroy(&again);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(example_loads),
        cmocka_unit_test(printed_scene_loads_to_itself),
    };
    return cmocka_run_group_tests_name("scene", tests, NULL, NULL);
}
