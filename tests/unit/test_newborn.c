/* Bursts at 0 s are in frame 0, in every chunk, in flipbooks and after a warm-up, and the states
 * after it are those of steps alone. */
#include <stdio.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/folders.h"
#include "support/simulation.h"

enum { WIDTH = 48, HEIGHT = 32, FRAMES = 4, BORN = 30 + 6 };

/* Sparks, and balls that hit each other and spin; some sparks are born at a rate and later. */
static const char scene_text[] =
    "kiln: 1\n"
    "output: {size: [48, 32], fps: 30, frames: 4}\n"
    "simulation: {rate: 120}\n"
    "camera: {position: [0, 1, 6], target: [0, 1, 0], fov: 40 deg}\n"
    "backdrop: {transparent: true, floor: none}\n"
    "systems:\n"
    "  sparks:\n"
    "    emit: {bursts: {-0.02 s: 4, 0 s: 30, 0.04 s: 7}, rate: 100, life: [0.5 s, 1 s],\n"
    "           speed: [2, 4], from: {sphere: {origin: [0, 1, 0], radius: 0.3}}}\n"
    "    look: {atlas: \"builtin:spark\", blend: add, temperature: 1700, size: 0.2 m,\n"
    "           fade: {in: 0, out: 0}}\n"
    "  balls:\n"
    "    emit: {bursts: {0 s: 6}, life: 3 s, speed: [0, 1],\n"
    "           from: {box: {origin: [0, 1, 0], size: [0.8, 0.4, 0.4]}}}\n"
    "    interact: [{collide: {as_drawn: true, spin: true, turning: [1 rad/s, 3 rad/s]}}]\n"
    "    look: {shape: sphere, size: 0.3 m, fade: {in: 0, out: 0}}\n"
    "    demitters: [{min: [-9, -9, -9], max: [-8, -8, -8]}]\n";

struct seen {
    uint8_t pixels[FRAMES][WIDTH * HEIGHT * 4];
    struct kiln_state_hash states[FRAMES];
    uint64_t alive[FRAMES];
};

static struct kiln_device *device;
static struct seen whole, other;

static void keep(void *user, const struct kiln_frame_layer *layer)
{
    struct seen *seen = user;
    memcpy(seen->pixels[layer->frame], layer->pixels, sizeof seen->pixels[0]);
}

static void note(void *user, const struct kiln_progress *progress)
{
    struct seen *seen = user;
    seen->states[progress->frame] = progress->state;
    seen->alive[progress->frame] = progress->alive;
}

static struct kiln_scene *load(const char *override)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = &override;
    params.override_count = override ? 1 : 0;
    struct kiln_scene *scene = kiln_scene_load("scene.yaml", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

static void render(const struct kiln_scene *scene, uint32_t first, uint32_t last, struct seen *seen)
{
    struct kiln_error error = kiln_error_empty();
    const struct kiln_frame_range range = {first, last};
    struct kiln_render_params params = kiln_render_defaults();
    *seen = (struct seen){.alive = {0}};
    params.ranges = &range;
    params.range_count = 1;
    params.state_hash = true;
    params.picture = keep;
    params.progress = note;
    params.user = seen;
    if (!kiln_render(device, scene, &params, NULL, &error))
        fail_msg("%s", error.message);
}

static bool is_empty(const uint8_t *pixels)
{
    for (size_t i = 3; i < (size_t)WIDTH * HEIGHT * 4; i += 4) {
        if (pixels[i] != 0)
            return false;
    }
    return true;
}

static int set_up(void **state)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_device_params cpu = kiln_device_defaults();
    cpu.wanted = KILN_DEVICE_CPU;
    device = kiln_device_open(&cpu, &error);
    if (!device || test_enter_folder(state) != 0)
        return 1;
    test_write_file("scene.yaml", scene_text);
    test_write_file("card.obj", "v -1 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
    return 0;
}

static int tear_down(void **state)
{
    kiln_device_close(&device);
    return test_leave_folder(state);
}

/* The states of all frames but the first one are those of a simulation that shows nothing. */
static void check_states(const struct kiln_scene *scene, const struct seen *seen)
{
    struct simulation run;
    simulation_start(&run, scene, NULL, 1);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        uint64_t alive;
        simulation_run(&run, kiln_scene_frame_step(scene, frame) - run.step);
        const struct kiln_state_hash state = simulation_hash(&run, &alive);
        const bool same = memcmp(&state, &seen->states[frame], sizeof state) == 0;
        assert_true(same == (frame > 0));
        assert_int_equal(seen->alive[frame] - alive, frame > 0 ? 0 : BORN);
    }
    simulation_end(&run);
}

static void bursts_are_in_frame_0(void **state)
{
    (void)state;
    static const char *const overrides[] = {NULL, "simulation.warmup=0.1 s",
                                            "camera.shutter={samples: 2}",
                                            "systems.*.emit.from={mesh: {file: card.obj}}"};
    for (size_t i = 0; i < sizeof overrides / sizeof *overrides; i++) {
        struct kiln_scene *scene = load(overrides[i]);
        render(scene, 0, FRAMES - 1, &whole);
        assert_false(is_empty(whole.pixels[0]));
        check_states(scene, &whole);
        /* In chunks, too, and neither does frame 0 change those that follow it. */
        render(scene, 0, 0, &other);
        assert_memory_equal(other.pixels[0], whole.pixels[0], sizeof whole.pixels[0]);
        assert_memory_equal(&other.states[0], &whole.states[0], sizeof whole.states[0]);
        render(scene, 1, FRAMES - 1, &other);
        assert_memory_equal(other.pixels[1], whole.pixels[1], sizeof whole.pixels[1]);
        assert_memory_equal(&other.states[1], &whole.states[1], sizeof whole.states[1]);
        kiln_scene_destroy(&scene);
    }
}

/* A clip of one frame has the same frame, although no step is run for it. */
static void a_clip_may_be_frame_0_alone(void **state)
{
    (void)state;
    struct kiln_scene *scene = load(NULL), *one = load("output.frames=1");
    render(scene, 0, 0, &whole);
    render(one, 0, 0, &other);
    assert_int_equal(other.alive[0], BORN);
    assert_memory_equal(other.pixels[0], whole.pixels[0], sizeof whole.pixels[0]);
    assert_memory_equal(&other.states[0], &whole.states[0], sizeof whole.states[0]);
    kiln_scene_destroy(&scene);
    kiln_scene_destroy(&one);
}

static void others_are_not_in_frame_0(void **state)
{
    (void)state;
    struct kiln_scene *scene = load("systems.*.emit.bursts={0.02 s: 9}");
    render(scene, 0, 1, &whole);
    assert_true(is_empty(whole.pixels[0]) && whole.alive[0] == 0 && whole.alive[1] > 9);
    kiln_scene_destroy(&scene);
    scene = load("systems.*.emit.bursts={}"); /* the rate's first birth is at 0 s, and not in it */
    render(scene, 0, 1, &whole);
    assert_true(whole.alive[0] == 0 && whole.alive[1] > 0);
    kiln_scene_destroy(&scene);
}

/* One that is born where the next step would remove it is not shown. */
static void removed_births_are_not_shown(void **state)
{
    (void)state;
    struct kiln_scene *scene =
        load("systems.balls.demitters=[{min: [-9, -9, -9], max: [9, 9, 9]}]");
    render(scene, 0, 1, &whole);
    assert_int_equal(whole.alive[0], 30);
    kiln_scene_destroy(&scene);
}

static void the_first_cell_of_a_flipbook_shows_them(void **state)
{
    (void)state;
    struct kiln_error error = kiln_error_empty();
    struct kiln_scene *scene = load(NULL);
    struct kiln_flipbook flipbook = kiln_flipbook_empty();
    flipbook.columns = flipbook.rows = 2;
    const struct kiln_frame_range all = {0, FRAMES - 1};
    struct kiln_frame_range cells[FRAMES];
    assert_true(kiln_flipbook_sample(&flipbook, &all, 1, cells, &error));
    struct kiln_render_params params = kiln_render_defaults();
    whole = (struct seen){.alive = {0}};
    params.output = "book.png";
    params.flipbook = &flipbook;
    params.ranges = cells;
    params.range_count = FRAMES;
    params.picture = keep;
    params.user = &whole;
    if (!kiln_render(device, scene, &params, NULL, &error))
        fail_msg("%s", error.message);
    assert_false(is_empty(whole.pixels[0]));
    kiln_scene_destroy(&scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(bursts_are_in_frame_0),
        cmocka_unit_test(a_clip_may_be_frame_0_alone),
        cmocka_unit_test(others_are_not_in_frame_0),
        cmocka_unit_test(removed_births_are_not_shown),
        cmocka_unit_test(the_first_cell_of_a_flipbook_shows_them),
    };
    return cmocka_run_group_tests_name("newborn", tests, set_up, tear_down);
}
