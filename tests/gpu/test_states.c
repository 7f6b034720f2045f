/* Checks rendering from saved simulation states, which kiln_bake writes. States that one technique
 * saved must serve all techniques, and give the pictures of a simulation from the start, even with
 * another look (colours, camera, exposure). A sort that is spread over frames must continue with
 * the saved order. If this fails, a clip that starts from a state differs from one that does
 * not. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kiln.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/folders.h"
#include "support/scenes.h"

enum { WIDTH = 48, HEIGHT = 32, FIRST = 20, FRAMES = 3, PICTURE_BYTES = WIDTH * HEIGHT * 4 };

static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [48, 32], fps: 30, frames: 30}\n"
    "simulation: {warmup: 0.2 s}\n"
    "camera: {position: {keys: {0 s: [0, 1, 4], 1 s: [1, 1, 3.5]}}}\n"
    "nodes: {wheel: {rotation: {keys: {0 s: [0, 0, 0], 1 s: [0, 90 deg, 30 deg]}}}}\n"
    "systems:\n"
    "  fire:\n"
    "    space: wheel\n"
    "    emit: {rate: 200, life: [0.2 s, 0.7 s], speed: 2 m/s, from: {sphere: {radius: 0.5 m}}}\n"
    "    forces: [{gravity: [0, -2, 0]}, {curl: 1}]\n"
    "    collide: {}\n"
    "    look: {atlas: 'builtin:spark', blend: alpha, size: 0.4 m, opacity: 0.7}\n"
    "  sparks:\n"
    "    emit: {parent: {system: fire, on: {death: {count: 2}}}, life: 0.3 s, speed: 1 m/s}\n"
    "    look: {shape: point, size: 0.1 m}\n";

/* The pictures of a job, RGBA with 8 bits a channel, and the number of its warnings. */
struct pictures {
    uint8_t bytes[FRAMES][PICTURE_BYTES];
    uint32_t count;
    unsigned warnings;
};

static void take_picture(void *user, const struct kiln_frame_layer *view)
{
    struct pictures *pictures = user;
    assert_int_equal(view->frame, FIRST + pictures->count);
    memcpy(pictures->bytes[pictures->count++], view->pixels, PICTURE_BYTES);
}

static void count_warning(void *user, enum kiln_log_level level, const char *line)
{
    struct pictures *pictures = user;
    pictures->warnings += level == KILN_LOG_WARNING;
    if (level == KILN_LOG_WARNING)
        fprintf(stderr, "%s\n", line);
}

static struct kiln_render_stats draw(struct kiln_device *device, const struct kiln_scene *scene,
                                     const char *techniques, const char *states,
                                     struct pictures *pictures)
{
    static const struct kiln_frame_range range = {FIRST, FIRST + FRAMES - 1};
    struct kiln_error error = {0};
    struct kiln_render_stats stats = kiln_render_stats_empty();
    struct kiln_render_params params = kiln_render_defaults();
    *pictures = (struct pictures){.count = 0};
    params.ranges = &range;
    params.range_count = 1;
    params.techniques = &techniques;
    params.technique_count = 1;
    params.states = states;
    params.picture = take_picture;
    params.user = pictures;
    params.log = (struct kiln_log){count_warning, pictures};
    if (!kiln_render(device, scene, &params, &stats, &error))
        fail_msg("%s: %s", techniques, error.message);
    assert_int_equal(pictures->count, FRAMES);
    return stats;
}

static struct kiln_bake_stats bake(struct kiln_device *device, const struct kiln_scene *scene,
                                   const char *technique, uint32_t every)
{
    const struct kiln_bake_params params = {.size = sizeof params,
                                            .states = "states",
                                            .every = every,
                                            .techniques = &technique,
                                            .technique_count = 1,
                                            .overwrite = true};
    struct kiln_bake_stats stats = kiln_bake_stats_empty();
    struct kiln_error error = {0};
    if (!kiln_bake(device, scene, &params, &stats, &error))
        fail_msg("%s: %s", technique, error.message);
    return stats;
}

/* Checks that a job that starts from the saved states has the same pictures and final state as a
 * job that starts at time 0, and simulates only `steps` steps. */
static void compare(struct kiln_device *device, const struct kiln_scene *scene,
                    const char *technique, uint64_t steps)
{
    struct pictures *whole = malloc(sizeof *whole), *part = malloc(sizeof *part);
    assert_non_null(whole);
    assert_non_null(part);
    const struct kiln_render_stats a = draw(device, scene, technique, NULL, whole);
    const struct kiln_render_stats b = draw(device, scene, technique, "states", part);
    if (memcmp(&a.state, &b.state, sizeof a.state) != 0)
        fail_msg("%s: another state", technique);
    if (memcmp(whole->bytes, part->bytes, sizeof whole->bytes) != 0)
        fail_msg("%s: other pictures", technique);
    assert_int_equal(part->warnings, 0);
    assert_true(a.steps > steps);
    assert_int_equal(b.steps, steps);
    free(whole);
    free(part);
}

/* States that `cpu` saved serve jobs of every technique. */
static void states_serve_every_technique(void **state)
{
    (void)state;
    static const char *const techniques[] = {"simulate=cpu",      "simulate=inplace",
                                             "simulate=pingpong", "simulate=feedback",
                                             "simulate=texels",   "raster=instanced"};
    struct kiln_scene *scene = load_scene(SCENE, NULL);
    /* The warm-up takes 12 steps, and each frame 2 steps. States are saved for frames 0, 9, 18,
     * 27. */
    const struct kiln_bake_stats baked = bake(test_device(), scene, "simulate=cpu", 9);
    assert_int_equal(baked.states, 4);
    assert_int_equal(baked.steps, 12 + 27 * 2);
    for (size_t i = 0; i < sizeof techniques / sizeof *techniques; i++)
        compare(test_device(), scene, techniques[i], (FIRST + FRAMES - 1 - 18) * 2);
    kiln_scene_destroy(&scene);
}

/* States serve a scene that has another colour, camera and exposure than the saved scene. */
static void states_serve_other_looks(void **state)
{
    (void)state;
    static const char *const overrides[] = {"systems.fire.look.color=[1, 0, 0]",
                                            "camera.position=[0, 2, 5]", "post.exposure=1", NULL};
    struct kiln_scene *scene = load_scene(SCENE, NULL), *other = load_scene(SCENE, overrides);
    bake(test_device(), scene, "simulate=inplace", 15);
    compare(test_device(), other, "simulate=cpu", (FIRST + FRAMES - 1 - 15) * 2);
    kiln_scene_destroy(&scene);
    kiln_scene_destroy(&other);
}

/* A spread sort continues with the order that a state has; other sorts ignore the order. */
static void spread_sorts_continue_from_states(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(SCENE, NULL);
    bake(test_device(), scene, "sort=oddeven:5", 9);
    compare(test_device(), scene, "sort=oddeven:5", (FIRST + FRAMES - 1 - 18) * 2);
    compare(test_device(), scene, "sort=cpu", (FIRST + FRAMES - 1 - 18) * 2);
    /* A sort that is spread over six frames cannot continue with the order of a sort over five
     * frames. So the job starts at time 0, and warns. */
    struct pictures *pictures = malloc(sizeof *pictures);
    assert_non_null(pictures);
    const struct kiln_render_stats stats =
        draw(test_device(), scene, "sort=oddeven:6", "states", pictures);
    assert_int_equal(stats.steps, 12 + (FIRST + FRAMES - 1) * 2);
    assert_true(pictures->warnings > 0);
    free(pictures);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_in_folder_on_device(states_serve_every_technique),
        test_in_folder_on_device(states_serve_other_looks),
        test_in_folder_on_device(spread_sorts_continue_from_states),
    };
    return cmocka_run_group_tests_name("states", tests, test_device_open_alone, test_device_close);
}
