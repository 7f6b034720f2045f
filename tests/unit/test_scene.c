/* lib/scene: good scenes mean what they say, and print as themselves. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene.h"
#include "scene/work.h"
#include "support/cmocka.h"
#include "support/scenes.h"

#define GOOD KILN_SOURCE_DIR "/tests/fuzz/corpus/scene/good/"

static const float pi = 3.14159265358979323846f;

static void example_loads(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene_file(GOOD "example.yaml");
    assert_int_equal(scene->seed, 7);
    assert_int_equal(scene->width, 1280);
    assert_int_equal(scene->height, 720);
    assert_int_equal(scene->steps_per_frame, 2);
    assert_int_equal(scene->warmup_steps, 120);
    assert_true(scene->dt_s == 1.0f / 60.0f);
    assert_true(scene->camera.fov.constant == pi / 4);

    assert_int_equal(scene->system_count, 2);
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
    assert_true(smoke->forces[1].pull.constant == 0.2f);
    assert_int_equal(smoke->forces[2].kind, KILN_FORCE_CURL);
    assert_true(smoke->forces[2].strength.constant == 0.6f);
    assert_true(smoke->collide.enabled && smoke->collide.randomness.constant == 0.4f);
    assert_string_equal(smoke->look.atlas[0], "builtin:smoke");
    assert_int_equal(VALUE_CLOCK(smoke->look.size.how), KILN_CLOCK_LIFE);

    const struct kiln_system *fire = &scene->systems[1];
    assert_false(fire->collide.enabled);
    assert_int_equal(fire->look.blend, KILN_BLEND_ADD);
    assert_int_equal(VALUE_CLOCK(fire->emit.rate.how), KILN_CLOCK_TIME);
    assert_int_equal(scene->backdrop.object_count, 1);
    assert_true(scene->backdrop.floor_enabled);
    assert_int_equal(scene->post.tonemap, KILN_TONEMAP_AGX);
    kiln_scene_destroy(&scene);
    assert_null(scene);
    kiln_scene_destroy(&scene);
}

/* Each field that everything.yaml sets has arrived, in SI. */
static void every_key_of_the_clip_arrives(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene_file(GOOD "everything.yaml");
    assert_int_equal(scene->seed, UINT32_MAX);
    assert_int_equal(scene->fps.num, 30000);
    assert_int_equal(scene->fps.den, 1001);
    assert_int_equal(scene->rate.num, 120000);
    assert_int_equal(scene->rate.den, 1001);
    assert_int_equal(scene->steps_per_frame, 4);
    assert_int_equal(scene->warmup_steps, 60); /* 59.94 */
    assert_int_equal(scene->integration, KILN_INTEGRATE_POSITION_FIRST);
    assert_true(scene->bounds.enabled && scene->bounds.min[2] == -10 && scene->bounds.max[2] == 10);
    assert_true(scene->camera.near_plane.constant == 0.01f);
    assert_true(scene->camera.target.x.constant == 2 && scene->camera.target.y.count == 2);
    assert_true(scene->camera.roll.constant == -pi / 60);
    assert_int_equal(scene->camera.attach.node, 1);

    assert_int_equal(scene->node_count, 2);
    const struct kiln_scene_node *hub = &scene->nodes[0], *arm = &scene->nodes[1];
    assert_true(!hub->parent.name && hub->position.value.y.count == 2);
    assert_true(hub->rotation.y.count == 2 && hub->scale.count == 2);
    assert_true(arm->parent.name && arm->parent.node == 0);
    const struct kiln_path *path = &arm->position.path;
    assert_true(path->points.count == 3 && path->points.at[1][1] == 0.5f);
    assert_true(path->over.max.constant == 1.5f && path->ease == VALUE_SMOOTH && path->closed);
    assert_true(arm->heading == KILN_HEADING_PATH && arm->ahead == KILN_AHEAD_MINUS_X);
    kiln_scene_destroy(&scene);
}

static void every_key_of_the_backdrop_arrives(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene_file(GOOD "everything.yaml");
    const struct kiln_backdrop *backdrop = &scene->backdrop;
    assert_true(backdrop->transparent && !backdrop->floor_collide);
    assert_true(backdrop->sky_top.z.constant == 0.01f);
    assert_true(backdrop->floor_checker.constant == 0.25f);
    assert_true(backdrop->haze.constant == 0.5f);
    assert_int_equal(backdrop->object_count, 6);
    assert_true(backdrop->objects[0].size.z.constant == 0.5f && !backdrop->objects[0].collide);
    assert_true(backdrop->objects[1].size.z.constant == 1 && backdrop->objects[1].collide);
    assert_true(backdrop->objects[2].rotation.y.count == 2 &&
                backdrop->objects[2].restitution.constant == 0.5f);
    assert_true(backdrop->objects[3].axis.y.count == 2 &&
                backdrop->objects[3].friction.constant == 1);
    assert_true(!backdrop->objects[4].visible && backdrop->objects[4].axis.x.constant == 0.1f);
    assert_true(backdrop->objects[5].axis.y.count == 2 &&
                backdrop->objects[5].height.constant == 0.5f);
    assert_int_equal(backdrop->light_count, 3);
    const struct kiln_light *spot = &backdrop->lights[1], *rectangle = &backdrop->lights[2];
    assert_int_equal(backdrop->lights[0].kind, KILN_LIGHT_POINT);
    assert_true(backdrop->lights[0].radius.constant == 0.05f && spot->shadow);
    assert_int_equal(spot->kind, KILN_LIGHT_SPOT);
    assert_true(spot->direction.x.count == 2 && spot->angle.constant == 0.5f);
    assert_true(spot->softness.constant == 0.5f && spot->radius.constant == 0.2f);
    assert_int_equal(rectangle->kind, KILN_LIGHT_RECTANGLE);
    assert_true(rectangle->position.y.constant == 3 && rectangle->width.constant == 0.5f);
    assert_true(rectangle->height.count == 2 && rectangle->up.x.constant == 1);
    assert_true(rectangle->direction.y.constant == -1 && !rectangle->shadow);

    assert_int_equal(scene->post.compose, KILN_COMPOSE_SEPARATE);
    assert_int_equal(scene->post.bloom, KILN_BLOOM_NONE);
    assert_int_equal(scene->post.tonemap, KILN_TONEMAP_ACES);
    assert_false(scene->post.dither);
    kiln_scene_destroy(&scene);
}

static void every_key_of_a_system_arrives(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene_file(GOOD "everything.yaml");
    const struct kiln_system *point = &scene->systems[0];
    assert_false(point->enabled);
    assert_int_equal(point->capacity, 1);
    assert_int_equal(point->emit.burst_count, 3);
    assert_true(point->emit.bursts[2].time_s == 0.5 && point->emit.bursts[1].count[0] == 100);
    assert_true(point->emit.angle.constant == 1 && point->emit.inherit.constant == 0.5f);
    static const enum kiln_force_kind kinds[] = {
        KILN_FORCE_GRAVITY, KILN_FORCE_GRAVITY, KILN_FORCE_DRAG, KILN_FORCE_DRAG,
        KILN_FORCE_DRAG,    KILN_FORCE_WIND,    KILN_FORCE_WIND, KILN_FORCE_CURL,
        KILN_FORCE_CURL,    KILN_FORCE_CURL,    KILN_FORCE_DRAG, KILN_FORCE_ATTRACT,
        KILN_FORCE_VORTEX,  KILN_FORCE_VORTEX,  KILN_FORCE_BAKED};
    assert_int_equal(point->force_count, sizeof kinds / sizeof *kinds);
    for (uint32_t i = 0; i < point->force_count; i++)
        assert_int_equal(point->forces[i].kind, kinds[i]);
    assert_true(point->forces[5].vector.z.constant == 2);
    assert_true(point->forces[6].pull.constant == 2);
    assert_true(point->forces[7].scale.constant == 0.1f && point->forces[7].octaves == 4);
    assert_int_equal(VALUE_CLOCK(point->forces[7].pull.how), KILN_CLOCK_LIFE);
    assert_int_equal(point->forces[9].mode, KILN_WIND_ADD);
    assert_true(point->forces[10].quadratic.constant == 2);
    assert_true(point->forces[11].vector.x.count == 2 && point->forces[11].strength.constant == -3);
    assert_int_equal(point->forces[11].falloff, KILN_FALLOFF_LINEAR);
    assert_int_equal(point->forces[12].profile, KILN_VORTEX_LAMB_OSEEN);
    assert_true(point->forces[12].axis.z.constant == 1 && point->forces[12].radius.constant == 3);
    assert_true(point->forces[12].inward.constant == 1 && point->forces[12].lift.count == 2);
    assert_true(point->forces[13].strength.constant == 5);
    const struct kiln_force *baked = &point->forces[14];
    assert_true(baked->box_size.y.constant == 2 && baked->box_center.y.constant == 1);
    assert_true(baked->cells == 6 && baked->every == 3 && baked->of.count == 3);
    assert_true(baked->of.at[0].octaves == 2 && baked->of.at[1].air.x.count == 2);
    assert_int_equal(baked->of.at[2].kind, KILN_FORCE_DRAG);
    assert_string_equal(baked->of.at[0].attach.name, "hub");
    assert_int_equal(point->collide.mode, KILN_COLLIDE_CLAMP);
    assert_true(point->collide.slowdown.constant == 0.9f);
    assert_int_equal(VALUE_CLOCK(point->collide.restitution.how), KILN_CLOCK_LIFE);
    assert_int_equal(point->collide.friction.count, 2);
    assert_int_equal(point->demitter_count, 2);
    assert_true(point->demitters[1].box.enabled && point->demitters[1].box.max[0] == 3);
    assert_true(point->bounds.enabled && point->bounds.max[0] == 5);
    kiln_scene_destroy(&scene);
}

static void every_key_of_looks_and_shapes_arrives(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene_file(GOOD "everything.yaml");
    const struct kiln_look *look = &scene->systems[0].look;
    assert_int_equal(look->columns, 4);
    assert_int_equal(look->rows, 16);
    assert_true(look->stretch.constant == 0.02f && look->spin.max.constant == 1);
    assert_true(look->stretch_dims);
    assert_int_equal(look->shape, KILN_SHAPE_LINE);
    assert_int_equal(look->facing.way, KILN_FACING_AXIAL);
    assert_true(look->axis.y.count == 2 && look->axis.z.constant == -1);
    assert_true(look->point_size.count == 2 && !look->point_round);
    assert_int_equal(look->line_to, KILN_LINE_PREVIOUS);
    assert_true(VALUE_CLOCK(look->line_width.how) == KILN_CLOCK_LIFE);
    assert_true(look->rotation.min.constant == -pi / 2);
    assert_true(look->random_start && look->soft_formula == KILN_SOFT_LITERAL);
    assert_true(look->fade_in.constant == 0.25f && look->fade_out.constant == 0.5f);
    assert_true(look->lit.constant == 0.75f && look->bloom.y.count == 2);

    const struct kiln_system *sphere = &scene->systems[1];
    assert_int_equal(sphere->look.shape, KILN_SHAPE_SPHERE);
    assert_int_equal(sphere->look.facing.way, KILN_FACING_SCREEN);
    assert_true(sphere->look.point_round && sphere->look.line_width.constant == 1.5f);
    assert_int_equal(sphere->emit.shape, KILN_EMITTER_SPHERE);
    assert_true(sphere->emit.surface && sphere->emit.outward);
    assert_true(sphere->bounds.enabled && sphere->bounds.max[1] == 20); /* the scene's */
    assert_int_equal(scene->systems[2].emit.shape, KILN_EMITTER_BOX);
    assert_true(scene->systems[2].emit.size.z.constant == 3);
    assert_int_equal(scene->systems[3].emit.shape, KILN_EMITTER_DISC);
    assert_int_equal(scene->systems[4].emit.shape, KILN_EMITTER_CONE);
    assert_int_equal(scene->systems[5].emit.shape, KILN_EMITTER_LINE);
    assert_int_equal(scene->systems[5].emit.nozzles, 24);
    kiln_scene_destroy(&scene);
}

static void take_attach(struct kiln_attach *left, const struct kiln_attach *right)
{
    assert_true((left->name != NULL) == (right->name != NULL));
    if (left->name)
        assert_string_equal(left->name, right->name);
    left->name = right->name;
}

static void take_force(struct kiln_force *left, const struct kiln_force *right)
{
    take_attach(&left->attach, &right->attach);
    take_attach(&left->region.attach, &right->region.attach);
    if (left->kind != KILN_FORCE_BAKED)
        return;
    assert_int_equal(left->of.count, right->of.count);
    for (uint32_t i = 0; i < left->of.count; i++)
        take_force(&left->of.at[i], &right->of.at[i]);
    assert_memory_equal(left->of.at, right->of.at, left->of.count * sizeof *left->of.at);
    left->of = right->of;
}

/* Compares the texts and points of nodes, and gives the left scene those of the right one. */
static void take_nodes(struct kiln_scene *left, const struct kiln_scene *right)
{
    take_attach(&left->camera.attach, &right->camera.attach);
    for (uint32_t i = 0; i < left->node_count; i++) {
        struct kiln_scene_node *node = &left->nodes[i];
        const struct kiln_path *path = &right->nodes[i].position.path;
        assert_string_equal(node->name, right->nodes[i].name);
        node->name = right->nodes[i].name;
        take_attach(&node->parent, &right->nodes[i].parent);
        assert_int_equal(node->position.path.points.count, path->points.count);
        if (path->points.count > 0) {
            assert_memory_equal(node->position.path.points.at, path->points.at,
                                path->points.count * sizeof *path->points.at);
            assert_true(kiln_path_length(&node->position.path) == kiln_path_length(path));
        }
        node->position.path.points.at = path->points.at;
        node->position.path.table = path->table;
        assert_string_equal(node->animation.clip, right->nodes[i].animation.clip);
        node->animation.clip = right->nodes[i].animation.clip;
    }
    for (uint32_t i = 0; i < left->system_count; i++) {
        take_attach(&left->systems[i].emit.attach, &right->systems[i].emit.attach);
        for (uint32_t k = 0; k < left->systems[i].force_count; k++)
            take_force(&left->systems[i].forces[k], &right->systems[i].forces[k]);
        for (uint32_t k = 0; k < left->systems[i].demitter_count; k++)
            take_attach(&left->systems[i].demitters[k].attach,
                        &right->systems[i].demitters[k].attach);
    }
    for (uint32_t i = 0; i < left->backdrop.object_count; i++)
        take_attach(&left->backdrop.objects[i].attach, &right->backdrop.objects[i].attach);
    for (uint32_t i = 0; i < left->backdrop.light_count; i++)
        take_attach(&left->backdrop.lights[i].attach, &right->backdrop.lights[i].attach);
}

/* All that a run reads, compared bit by bit; pointers and the name aside. */
static void assert_same_scene(const struct kiln_scene *a, const struct kiln_scene *b)
{
    struct kiln_scene left = *a, right = *b;
    take_nodes(&left, &right);
    assert_int_equal(left.key_count, right.key_count);
    if (left.key_count)
        assert_memory_equal(left.keys, right.keys, left.key_count * sizeof *left.keys);
    for (uint32_t i = 0; i < left.system_count; i++) {
        assert_string_equal(left.systems[i].name, right.systems[i].name);
        assert_int_equal(left.systems[i].look.atlas_count, right.systems[i].look.atlas_count);
        for (uint32_t k = 0; k < left.systems[i].look.atlas_count; k++)
            assert_string_equal(left.systems[i].look.atlas[k], right.systems[i].look.atlas[k]);
        assert_string_equal(left.systems[i].look.motion, right.systems[i].look.motion);
        left.systems[i].name = right.systems[i].name;
        memcpy(left.systems[i].look.atlas, right.systems[i].look.atlas,
               sizeof left.systems[i].look.atlas);
        left.systems[i].look.motion = right.systems[i].look.motion;
        for (uint32_t k = 0; k < left.systems[i].interaction_count; k++) {
            struct kiln_interaction *entry = &left.systems[i].interactions[k];
            const char *of = right.systems[i].interactions[k].of;
            assert_int_equal(entry->of != NULL, of != NULL);
            if (of)
                assert_string_equal(entry->of, of);
            entry->of = of;
        }
    }
    left.node_cache = right.node_cache;
    left.meshes = right.meshes;
    left.loader = right.loader;
    left.arena = right.arena;
    left.name = right.name;
    left.asset_root = right.asset_root;
    left.keys = right.keys;
    left.files = right.files;
    left.params = right.params;
    left.loading_cpu_s = right.loading_cpu_s;
    left.memory_bytes = right.memory_bytes; /* a part of it is that of the text */
    assert_memory_equal(&left, &right, sizeof left);
}

static void printed_scenes_load_to_themselves(void **state)
{
    (void)state;
    static const char *const files[] = {GOOD "minimal.yaml", GOOD "example.yaml",
                                        GOOD "everything.yaml",
                                        KILN_SOURCE_DIR "/scenes/fire_beam.yaml"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        struct kiln_scene *scene = load_scene_file(files[i]);
        char *text = print_scene(scene);
        struct kiln_scene *again = load_scene(text, NULL);
        char *text_again = print_scene(again);
        assert_string_equal(text, text_again);
        assert_same_scene(scene, again);
        free(text);
        free(text_again);
        kiln_scene_destroy(&scene);
        kiln_scene_destroy(&again);
    }
}

static void defaults_are_whole(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene("kiln: 1\n", NULL);
    assert_int_equal(scene->width, 1280);
    assert_int_equal(scene->frames, 150);
    assert_int_equal(scene->system_count, 0);
    assert_int_equal(scene->key_count, 0);
    assert_non_null(scene->keys);
    struct kiln_scene_info info = kiln_scene_facts(scene);
    assert_int_equal(info.particle_capacity, 0);
    assert_int_equal(info.fps_num, 30);
    assert_string_equal(info.hash, scene->hash);
    assert_int_equal(strlen(info.hash), 64);
    kiln_scene_destroy(&scene);
}

/* The rate that is chosen, and its steps. */
static void rates_follow_the_frames(void **state)
{
    (void)state;
    static const struct {
        const char *fps;
        uint32_t num, den, steps_per_frame;
    } cases[] = {
        {"30", 60, 1, 2},
        {"24", 72, 1, 3},
        {"25", 75, 1, 3},
        {"60", 60, 1, 1},
        {"61", 61, 1, 1},
        {"1000", 1000, 1, 1},
        {"1", 60, 1, 60},
        {"7", 63, 1, 9},
        {"30000/1001", 90000, 1001, 3},
        {"29.97", 90000, 1001, 3},
        {"23.976", 72000, 1001, 3},
        {"59.94", 120000, 1001, 2},
        {"29.98", 4497, 50, 3},
        {"24000/1001", 72000, 1001, 3},
        {"12.5", 125, 2, 5},
        {"60/2", 60, 1, 2},
        {"30.0", 60, 1, 2},
        {"999999/1000000", 0, 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[64];
        snprintf(text, sizeof text, "kiln: 1\noutput: {fps: %s}\n", cases[i].fps);
        struct kiln_error error = {0};
        struct kiln_scene *scene = try_scene(text, NULL, &error);
        if (cases[i].num == 0) {
            assert_null(scene);
            continue;
        }
        assert_non_null(scene);
        assert_int_equal(scene->rate.num, cases[i].num);
        assert_int_equal(scene->rate.den, cases[i].den);
        assert_int_equal(scene->steps_per_frame, cases[i].steps_per_frame);
        kiln_scene_destroy(&scene);
    }
}

static void capacity_holds_the_living(void **state)
{
    (void)state;
    static const struct {
        const char *emit;
        uint32_t least, most;
    } cases[] = {
        {"{}", 1, 1},
        {"{rate: 600, life: 2 s}", 1200, 1220},
        {"{rate: 600, life: [1, 2]}", 1200, 1220},
        {"{rate: 600, life: 100 s}", 2980, 2980}, /* all births of the run */
        {"{bursts: {0 s: 1000, 3 s: 10}, life: 1 s}", 1000, 1000},
        {"{bursts: {0 s: 1000, 500 ms: 10}, life: 1 s}", 1010, 1010},
        {"{bursts: {-1 s: 1000, 1000 s: 10}, life: 1 s}", 1, 1}, /* outside the run */
        {"{rate: {keys: {0: 0, 1: 6000, 2: 0}}, life: 1 s}", 4500, 4650},
        {"{rate: {keys: {0: 6000, 1: 0}}, life: {keys: {0: 1, 1: 9}}}", 3000, 3001},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[256];
        snprintf(text, sizeof text, "kiln: 1\nsystems: {a: {emit: %s}}\n", cases[i].emit);
        struct kiln_scene *scene = load_scene(text, NULL);
        assert_in_range(scene->systems[0].capacity, cases[i].least, cases[i].most);
        kiln_scene_destroy(&scene);
    }
}

/* Both are also judged from outside: see schema.ajv. */
static void reference_and_schema_name_every_key(void **state)
{
    (void)state;
    bool (*const writers[])(FILE *) = {kiln_scene_write_reference, kiln_scene_write_schema};
    static const char *const names[] = {"frames",  "warmup",    "sphere", "outward", "octaves",
                                        "builtin", "demitters", "fade",   "exposure"};
    for (size_t w = 0; w < 2; w++) {
        char *text = NULL;
        size_t size = 0;
        FILE *out = open_memstream(&text, &size);
        assert_true(writers[w](out));
        fclose(out);
        for (size_t i = 0; i < sizeof names / sizeof *names; i++)
            assert_non_null(strstr(text, names[i]));
        free(text);

        FILE *full = fopen("/dev/full", "w");
        if (full) {
            assert_false(writers[w](full));
            fclose(full);
        }
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(example_loads),
        cmocka_unit_test(every_key_of_the_clip_arrives),
        cmocka_unit_test(every_key_of_the_backdrop_arrives),
        cmocka_unit_test(every_key_of_a_system_arrives),
        cmocka_unit_test(every_key_of_looks_and_shapes_arrives),
        cmocka_unit_test(printed_scenes_load_to_themselves),
        cmocka_unit_test(defaults_are_whole),
        cmocka_unit_test(rates_follow_the_frames),
        cmocka_unit_test(capacity_holds_the_living),
        cmocka_unit_test(reference_and_schema_name_every_key),
    };
    return cmocka_run_group_tests_name("scene", tests, NULL, NULL);
}
