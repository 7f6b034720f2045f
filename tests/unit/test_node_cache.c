/* The frames of nodes that are remembered have the bits of those that are computed, in whatever
 * order and by however many threads they are asked for. If this fails, what is attached to a node
 * is where the node was at another time. */
#include <pthread.h>
#include <string.h>

#include "scene/node_cache.h"
#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/scenes.h"

enum { NODES = 4, TIMES = 50, THREADS = 4 };

static const char TEXT[] =
    "kiln: 1\n"
    "nodes:\n"
    "  a: {position: {path: {points: [[0, 0, 0], [1, 1, 0], [2, 0, 3]], over: [0 s, 4 s]}}, "
    "heading: path}\n"
    "  b: {parent: a, rotation: {keys: {0 s: [0, 0, 0], 1 s: [0, 360 deg, 0]}, repeat: loop}}\n"
    "  c: {parent: b, position: {noise: [[0, 0, 0], [1, 1, 1]]}, scale: 0.3}\n"
    "  d: {parent: c, position: [0, 1, 2]}\n";

static struct kiln_node_frame wanted[NODES][TIMES];

/* Asks for all frames, in an order that the number says; returns how many are wrong. */
static uint32_t count_wrong(const struct kiln_scene *scene, uint32_t number)
{
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < NODES * TIMES * 7; i++) {
        const uint32_t place = (i * (2 * number + 1) * 37) % (NODES * TIMES);
        const uint32_t node = place % NODES, time = place / NODES;
        const float time_s = 0.07f * (float)time;
        const struct kiln_node_frame frame = kiln_node_frame_at(scene, node, time_s, time_s);
        wrong += memcmp(&frame, &wanted[node][time], sizeof frame) != 0;
    }
    return wrong;
}

struct caller {
    const struct kiln_scene *scene;
    uint32_t number, wrong;
};

static void *ask(void *context)
{
    struct caller *caller = context;
    caller->wrong = count_wrong(caller->scene, caller->number);
    return NULL;
}

static void remembered_frames_have_the_same_bits(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(TEXT, NULL);
    struct kiln_node_cache *cache = scene->node_cache;
    pthread_t threads[THREADS];
    struct caller callers[THREADS];
    assert_non_null(cache);
    scene->node_cache = NULL;
    for (uint32_t node = 0; node < NODES; node++) {
        for (uint32_t time = 0; time < TIMES; time++)
            wanted[node][time] =
                kiln_node_frame_at(scene, node, 0.07f * (float)time, 0.07f * (float)time);
    }
    scene->node_cache = cache;
    assert_int_equal(count_wrong(scene, 0), 0);
    for (uint32_t i = 0; i < THREADS; i++) {
        callers[i] = (struct caller){.scene = scene, .number = i};
        assert_int_equal(pthread_create(&threads[i], NULL, ask, &callers[i]), 0);
    }
    for (uint32_t i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
        assert_int_equal(callers[i].wrong, 0);
    }
    kiln_scene_destroy(&scene);
}

static void a_frame_is_computed_once_a_moment(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(TEXT, NULL);
    struct kiln_node_frame frame;
    kiln_node_frame_at(scene, 3, 1, 1);
    kiln_node_frame_at(scene, 3, 2, 2);
    for (uint32_t node = 0; node < NODES; node++) {
        assert_true(
            kiln_node_cache_find(scene->node_cache, KILN_NODE_FRAME_OWN, node, 1, 1, &frame));
        assert_true(kiln_node_cache_find(scene->node_cache, KILN_NODE_FRAME_WORLD, node, 2, 2,
                                         &frame) == (node == 3));
    }
    assert_false(kiln_node_cache_find(scene->node_cache, KILN_NODE_FRAME_OWN, 3, 2, 1, &frame));
    kiln_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(remembered_frames_have_the_same_bits),
        cmocka_unit_test(a_frame_is_computed_once_a_moment),
    };
    return cmocka_run_group_tests_name("node_cache", tests, NULL, NULL);
}
