/* The words of gas in scene files: what domains, sources and winds of gas follow from them, and
 * what is refused. If this fails, a scene has another grid than its file says, or gas that the
 * solver cannot step, or an author gets a wrong reason. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/baked.h"
#include "scene/gas_shape.h"
#include "scene/source.h"
#include "sim/step/bakes.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pools.h"
#include "support/scenes.h"

#define CAMPFIRE                                                                                   \
    "kiln: 1\ngas: {fire: {box: {size: [1.5, 2.4, 1.5]}, sources: [{from: {disc: {radius: "        \
    "0.27}}}]}}\n"

static bool is_near(double a, double b)
{
    return fabs(a - b) < 1e-6 * fmax(1, fabs(b));
}

/* ---- grids ----------------------------------------------------------------------------------- */

/* Expects the cells of a domain whose keys are `keys`, its cell in metres, and the lowest y and x
 * of its box. */
static void expect_shape(const char *keys, int x, int y, int z, double cell, double low_x,
                         double low_y)
{
    char text[256];
    snprintf(text, sizeof text, "kiln: 1\ngas: {a: {%s, sources: [{}]}}\n", keys);
    struct kiln_scene *scene = load_scene(text, NULL);
    const struct kiln_gas_shape *shape = &scene->gas[0].shape;
    if (shape->cells.x != x || shape->cells.y != y || shape->cells.z != z)
        fail_msg("%s: %d x %d x %d cells", keys, shape->cells.x, shape->cells.y, shape->cells.z);
    if (!is_near((double)shape->cell, cell) || !is_near((double)shape->corner.x, low_x) ||
        !is_near((double)shape->corner.y, low_y))
        fail_msg("%s: cells of %.9g m from x %.9g, y %.9g", keys, (double)shape->cell,
                 (double)shape->corner.x, (double)shape->corner.y);
    kiln_scene_destroy(&scene);
}

/* A grid has multiples of 16 cells. What that adds to a box lies above it and on its sides alike.
 */
static void grids_hold_their_boxes(void **state)
{
    (void)state;
    expect_shape("box: {size: [1.6, 3.2, 1.6]}, cells: 128", 64, 128, 64, 0.025, -0.8, 0);
    expect_shape("box: {size: [1.6, 3.2, 1.6]}", 64, 128, 64, 0.025, -0.8, 0);
    expect_shape("box: {size: [1.6, 3.2, 1.6]}, cells: 113", 64, 128, 64, 0.025, -0.8, 0);
    expect_shape("box: {size: [1.5, 2.4, 1.5]}, cells: 176", 112, 176, 112, 2.4 / 176,
                 -56 * 2.4 / 176, 0);
    expect_shape("box: {center: [1, 2, 3], size: [2, 2, 2]}, cell: 0.1", 32, 32, 32, 0.1, 1 - 1.6,
                 1);
    expect_shape("box: {center: [-1, -1, -1], size: [2, 2, 2]}, cell: 0.0625", 32, 32, 32, 0.0625,
                 -2, -2);
    expect_shape("box: {size: [1, 1, 1]}, cell: 500", 16, 16, 16, 500, -4000, 0);
    expect_shape("box: {size: [1, 0.001, 1]}, cells: 1024", 1024, 16, 1024, 1.0 / 1024, -0.5, 0);
}

static void sides_are_in_their_order(void **state)
{
    (void)state;
    static const char *const names[] = {"left", "right", "bottom", "top", "back", "front"};
    for (int i = 0; i < 6; i++) {
        char text[256];
        snprintf(text, sizeof text,
                 "kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, sides: {bottom: open, %s: closed}, "
                 "sources: [{}]}}\n",
                 strcmp(names[i], "bottom") == 0 ? "top" : names[i]);
        struct kiln_scene *scene = load_scene(text, NULL);
        for (int k = 0; k < 6; k++)
            assert_int_equal(scene->gas[0].shape.closed[k], i == 2 ? k == 3 : k == i);
        kiln_scene_destroy(&scene);
    }
}

/* ---- defaults -------------------------------------------------------------------------------- */

/* A box and a source are enough for a fire. Sizes that the file does not give follow the box. */
static void a_box_and_a_source_burn(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(CAMPFIRE, NULL);
    const struct kiln_gas_domain *fire = &scene->gas[0];
    const struct kiln_gas_source *source = &fire->sources[0];
    assert_int_equal(scene->gas_count, 1);
    assert_string_equal(fire->name, "fire");
    assert_true(fire->enabled && fire->collide && fire->burn.enabled && !fire->attach.name);
    assert_true(fire->shape.closed[2] && !fire->shape.closed[3] && !fire->shape.closed[0]);
    assert_false(fire->shape.colored || fire->shape.detailed || source->blows);
    assert_int_equal(source->from, KILN_GAS_FROM_SHAPE);
    assert_int_equal(source->emit.shape, KILN_EMITTER_DISC);
    assert_true(source->fuel.constant == 1.0f && source->smoke.constant == 0.0f);
    assert_true(is_near((double)source->reach.constant, 0.15));
    assert_true(is_near((double)source->noise_size.constant, 0.15));
    assert_true(is_near((double)fire->turbulence.size.constant, 0.24));
    assert_true(fire->burn.ignition.constant < source->temperature.constant);
    assert_true(fire->look.kelvin[0].constant == 600.0f &&
                fire->look.kelvin[1].constant == 2050.0f);
    assert_int_equal(fire->substeps, 0);
    assert_int_equal(fire->cycles, 2);
    kiln_scene_destroy(&scene);
}

/* Of a coarse grid, a source reaches 1.5 cells. */
static void a_source_reaches_cells(void **state)
{
    (void)state;
    const char *const overrides[] = {"gas.fire.cells=16", NULL};
    struct kiln_scene *scene = load_scene(CAMPFIRE, overrides);
    assert_true(is_near((double)scene->gas[0].sources[0].reach.constant, 1.5 * 2.4 / 16));
    kiln_scene_destroy(&scene);
}

/* ---- sources --------------------------------------------------------------------------------- */

#define SOURCES                                                                                    \
    "kiln: 1\n"                                                                                    \
    "backdrop: {objects: {t: {mesh: {file: tests/mutation/tetrahedron.obj}}}}\n"                   \
    "systems: {a: {}, sparks: {emit: {rate: 9}}}\n"                                                \
    "nodes: {n: {position: [0, 0.1, 0]}}\n"                                                        \
    "gas:\n"                                                                                       \
    "  fire:\n"                                                                                    \
    "    box: {size: [2, 2, 2]}\n"                                                                 \
    "    cells: 16\n"                                                                              \
    "    sources:\n"                                                                               \
    "      - {from: {system: sparks}, outward: 2}\n"                                               \
    "      - {from: {mesh: {file: tests/mutation/tetrahedron.obj, on: volume}}, inherit: 1}\n"     \
    "      - {from: {mesh: {object: t}}, color: red}\n"                                            \
    "      - {from: {image: tests/mutation/disc.png}, attach: n}\n"                                \
    "      - {from: {path: {points: [[0, 0, 0], [1, 1, 0]]}}, fuel: {keys: {0: 0, 1 s: 1}}}\n"     \
    "      - {from: {line: {span: [1, 0, 0]}}, velocity: [0, 1, 0]}\n"                             \
    "      - {from: {ring: {radius: 0.3}}, smoke: {noise: [0, 1]}, fuel: 0}\n"                     \
    "      - {from: {box: {size: [1, 1, 1]}}, reach: 0 m}\n"

static void sources_are_of_all_kinds(void **state)
{
    (void)state;
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_error error = {0};
    params.asset_root = KILN_SOURCE_DIR;
    struct kiln_scene *scene =
        kiln_scene_parse(SOURCES, strlen(SOURCES), SCENE_NAME, &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    const struct kiln_gas_source *sources = scene->gas[0].sources;
    assert_int_equal(scene->gas[0].source_count, 8);
    assert_int_equal(sources[0].from, KILN_GAS_FROM_SYSTEM);
    assert_int_equal(sources[0].system, 1);
    for (int i = 1; i < 8; i++)
        assert_int_equal(sources[i].from, KILN_GAS_FROM_SHAPE);
    for (int i = 0; i < 8; i++) {
        const struct kiln_source *made = sources[i].emit.source.made;
        assert_int_equal(made != NULL, i >= 1 && i <= 4);
        assert_true(!made || made->cells > 0 || i == 4);
        assert_int_equal(kiln_gas_source_is_colored(&sources[i]), i == 2);
        assert_int_equal(sources[i].blows, i == 0 || i == 1 || i == 5);
    }
    assert_true(sources[2].emit.source.of_object && sources[2].emit.source.number == 0);
    assert_true(kiln_object_is_source(scene, &scene->backdrop.objects[0]));
    assert_string_equal(sources[3].emit.attach.name, "n");
    assert_true(scene->gas[0].shape.colored);
    assert_true(sources[7].reach.constant == 0.0f);
    assert_true(kiln_sources_sizes(scene).gas_words > 0);
    assert_true(kiln_sources_sizes(scene).words == 0);
    kiln_scene_destroy(&scene);
}

/* Values have the clock of time, and noise of a domain is not that of another, nor of a system. */
static void domains_have_noise_of_their_own(void **state)
{
    (void)state;
#define NOISY                                                                                      \
    "{box: {size: [1, 1, 1]}, sources: [{rate: {noise: [0, 1]}, fuel: {keys: {0 s: 0, 1 s: 1}}}]}"
    struct kiln_scene *scene =
        load_scene("kiln: 1\nsystems: {s: {}}\ngas: {a: " NOISY ", b: " NOISY "}\n", NULL);
    const struct kiln_value *rate = &scene->gas[0].sources[0].rate;
    const float a = kiln_scene_system_value(scene, KILN_SYSTEM_OF_GAS(0), rate, 0.3f);
    const float b =
        kiln_scene_system_value(scene, KILN_SYSTEM_OF_GAS(1), &scene->gas[1].sources[0].rate, 0.3f);
    assert_true(a != b && a != kiln_scene_system_value(scene, 0, rate, 0.3f) &&
                a != kiln_scene_value(scene, rate, 0.3f));
    assert_true(is_near((double)kiln_scene_system_value(scene, KILN_SYSTEM_OF_GAS(0),
                                                        &scene->gas[0].sources[0].fuel, 0.25f),
                        0.25));
    kiln_scene_destroy(&scene);
}

/* ---- winds of gas ---------------------------------------------------------------------------- */

#define RIDE                                                                                       \
    "kiln: 1\nnodes: {n: {position: [1, 0, 0]}}\n"                                                 \
    "gas: {other: {box: {size: [1, 1, 1]}, sources: [{}]},\n"                                      \
    "      fire: {attach: n, box: {size: [1, 2, 1]}, cells: 32, sources: [{}]}}\n"                 \
    "systems: {s: {emit: {rate: 60}, forces: [curl: 1, wind: {gas: fire, pull: 3, cells: 8}]}}\n"

/* The grid of a wind fills the box of its domain, in the domain's node, and is that of a baked wind
 * for kernels. */
static void winds_have_the_grid_of_their_domain(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(RIDE, NULL);
    const struct kiln_force *wind = &scene->systems[0].forces[1];
    struct kiln_error error = {0};
    struct kiln_sim_grids grids;
    uint32_t size[3];
    assert_int_equal(wind->kind, KILN_FORCE_GAS);
    assert_int_equal(kiln_force_number(wind), FORCE_BAKED);
    assert_int_equal(wind->domain, 1);
    assert_string_equal(wind->attach.name, "n");
    assert_true(wind->box_size.x.constant == 1.0f && wind->box_size.y.constant == 2.0f);
    assert_true(wind->box_center.x.constant == 0.0f && wind->box_center.y.constant == 1.0f);
    assert_true(wind->pull.constant == 3.0f);
    assert_int_equal(kiln_baked_samples(wind, size), 5 * 9 * 5);
    struct kiln_threads *threads = kiln_threads_create(1);
    assert_true(kiln_sim_grids_init(&grids, NULL, scene, threads, &error));
    const uint32_t number = kiln_sim_grids_find_baked(&grids, wind);
    assert_int_equal(number, 0);
    assert_true(grids.table[0].size.x == 5 && grids.table[0].size.y == 9);
    assert_true(grids.table[0].origin.x == -0.5f && grids.table[0].origin.y == 0.0f);
    kiln_sim_grids_finish(&grids);
    kiln_threads_destroy(&threads);
    kiln_scene_destroy(&scene);
}

/* `field` chooses the wind as well, and another domain has another place. */
static void winds_are_written_in_two_ways(void **state)
{
    (void)state;
    const char *const overrides[] = {"systems.s.forces=[wind: {field: gas, gas: other}]", NULL};
    struct kiln_scene *scene = load_scene(RIDE, overrides);
    const struct kiln_force *wind = &scene->systems[0].forces[0];
    assert_int_equal(wind->kind, KILN_FORCE_GAS);
    assert_int_equal(wind->domain, 0);
    assert_true(!wind->attach.name && wind->box_size.y.constant == 1.0f && wind->cells == 64);
    kiln_scene_destroy(&scene);
}

/* ---- printing -------------------------------------------------------------------------------- */

static void expect_same_when_printed(const char *text, const char *root)
{
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_error error = {0};
    params.asset_root = root;
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), SCENE_NAME, &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    char *printed = print_scene(scene);
    struct kiln_scene *again =
        kiln_scene_parse(printed, strlen(printed), SCENE_NAME, &params, &error);
    if (!again)
        fail_msg("%s\n%s", error.message, printed);
    char *printed_again = print_scene(again);
    assert_string_equal(printed, printed_again);
    assert_string_equal(scene->hash, again->hash);
    free(printed);
    free(printed_again);
    kiln_scene_destroy(&again);
    kiln_scene_destroy(&scene);
}

static void printed_scenes_are_the_same(void **state)
{
    (void)state;
    expect_same_when_printed(CAMPFIRE, NULL);
    expect_same_when_printed(SOURCES, KILN_SOURCE_DIR);
    expect_same_when_printed(RIDE, NULL);
    expect_same_when_printed(
        "kiln: 1\ngas: {a: {box: {center: [-1, 5, 0], size: [1, 1, 1]}, cell: 5 cm, burn: none, "
        "substeps: 2, forces: [curl: 1, wind: {velocity: {keys: {0 s: [0, 0, 0], 1 s: [1, 0, "
        "0]}}}], sources: [{from: {sphere: {origin: [-1, 5, 0]}}, color: {keys: {0 s: red, 1 s: "
        "blue}}}]}}\n",
        NULL);
}

/* A scene without gas prints nothing of it, so that its text and its hash are as before. */
static void scenes_without_gas_say_nothing(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene("kiln: 1\n", NULL);
    char *printed = print_scene(scene);
    assert_null(strstr(printed, "gas"));
    assert_string_equal(scene->hash,
                        "46c49439827079a86026d195f9f306c98cbe729875e1879d174d09510e1cd38f");
    free(printed);
    kiln_scene_destroy(&scene);
}

/* ---- memory and work ------------------------------------------------------------------------- */

static uint64_t bytes_of(const char *more)
{
    char text[512];
    struct kiln_footprint footprint = {.threads = 1};
    snprintf(
        text, sizeof text,
        "kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, cells: 64, buoyancy: 0, sources: [{}]%s}}\n",
        more);
    struct kiln_scene *scene = load_scene(text, NULL);
    kiln_scene_gas_footprint(scene, &footprint);
    kiln_scene_destroy(&scene);
    return footprint.bytes[KILN_FOOTPRINT_GAS];
}

/* Gas that does not rise counts as if it filled the domain. A cell takes 20 floats, half a brick's
 * share of its chunk aside, and 8 more for a colour. */
static void memory_is_that_of_all_cells(void **state)
{
    (void)state;
    const uint64_t plain = bytes_of(""), bricks = 8 * 8 * 8;
    const struct kiln_gas_place cells = {64, 64, 64};
    const struct kiln_gas_shape shape = {.cells = cells}, colored = {.colored = true};
    assert_true(plain == kiln_gas_window_bytes(cells) + bricks * kiln_gas_brick_bytes(&shape));
    assert_true(bytes_of(", enabled: false") == 0);
    assert_true(bytes_of(", detail: 2") - plain == (uint64_t)64 * 64 * 64 * 2 * 8 * 4);
    assert_true(kiln_gas_brick_bytes(&colored) - kiln_gas_brick_bytes(&shape) == 512 * 8 * 4);
}

static uint64_t work_of(const char *more)
{
    char text[512];
    snprintf(text, sizeof text,
             "kiln: 1\ngas: {a: {box: {size: [1, 1, 1]}, cells: 16, sources: [{}]%s}}\n", more);
    struct kiln_scene *scene = load_scene(text, NULL);
    const uint64_t work = kiln_gas_cell_steps(scene, 10);
    kiln_scene_destroy(&scene);
    return work;
}

static void work_counts_steps_of_gas(void **state)
{
    (void)state;
    assert_true(work_of("") == 10 * 4096);
    assert_true(work_of(", substeps: 3") == 3 * 10 * 4096);
    assert_true(work_of(", rate: 60") == 10 * 4096);
    assert_true(work_of(", rate: 61") == 2 * 10 * 4096);
    assert_true(work_of(", rate: 240, substeps: 2") == 4 * 10 * 4096);
    assert_true(work_of(", enabled: false") == 0);
}

/* ---- warnings -------------------------------------------------------------------------------- */

struct warnings {
    int count;
    char last[KILN_MESSAGE_SIZE];
};

static void keep_warning(void *user, enum kiln_log_level level, const char *line)
{
    struct warnings *warnings = user;
    assert_int_equal(level, KILN_LOG_WARNING);
    warnings->count++;
    snprintf(warnings->last, sizeof warnings->last, "%s", line);
}

/* Expects one warning, or none where the text is "". */
static void expect_warning(const char *text, const char *expected)
{
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_error error = {0};
    struct warnings warnings = {.count = 0};
    char whole[512];
    params.log = (struct kiln_log){keep_warning, &warnings};
    snprintf(whole, sizeof whole, "kiln: 1\n%s\n", text);
    struct kiln_scene *scene = kiln_scene_parse(whole, strlen(whole), "w.yaml", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    expect_message(warnings.last, "%s", expected);
    assert_int_equal(warnings.count, *expected != '\0');
    kiln_scene_destroy(&scene);
}

#define BOX          "box: {size: [1, 1, 1]}"
#define FROM(source) "gas: {a: {" BOX ", sources: [{from: {" source "}}]}}"
#define OUTSIDE                                                                                    \
    "w.yaml:2:52: gas.a.sources.0.from: the source lies outside of the box, from [-0.5, 0, -0.5] " \
    "m to [0.5, 1, 0.5] m, so nothing comes of it"

static void what_is_in_vain_is_said(void **state)
{
    (void)state;
    expect_warning("gas: {a: {" BOX "}}",
                   "w.yaml:2:10: gas.a.sources: the domain has no sources, so it stays empty");
    expect_warning("gas: {a: {" BOX ", enabled: false}}", "");
    expect_warning("systems: {s: {enabled: false}}\n" FROM("system: s"),
                   "w.yaml:3:61: gas.a.sources.0.from.system: systems.s is not enabled, so nothing "
                   "comes of this source");
    expect_warning("systems: {s: {forces: [wind: {gas: a}]}}\n"
                   "gas: {a: {" BOX ", enabled: false, sources: [{}]}}",
                   "w.yaml:2:36: systems.s.forces.0.wind.gas: gas.a is not enabled, so this wind "
                   "does nothing");
    expect_warning(FROM("point: {origin: [0, 5, 0]}"), OUTSIDE);
    expect_warning("systems: {s: {enabled: false}}\n"
                   "gas: {a: {" BOX ", enabled: false, sources: [{from: {system: s}}, "
                   "{from: {point: {origin: [0, 5, 0]}}}]}}",
                   "");
    expect_warning(FROM("sphere: {origin: [1.2, 0.5, 0], radius: 0.6 m}"), OUTSIDE);
    expect_warning(FROM("sphere: {origin: [1.2, 0.5, 0], radius: 0.75 m}"), "");
    expect_warning(FROM("line: {origin: [0, 0.5, 3], span: [9, 9, 1]}"), OUTSIDE);
    expect_warning(FROM("box: {origin: [0, 0.5, 3], size: [1, 1, 6]}"), "");
    expect_warning(FROM("point: {origin: {keys: {0 s: [0, 5, 0], 1 s: [0, 6, 0]}}}"), OUTSIDE);
    expect_warning(FROM("point: {origin: {keys: {0 s: [0, 5, 0], 1 s: [0, 0, 0]}}}"), "");
    expect_warning("nodes: {n: {position: [0, -5, 0]}}\ngas: {a: {" BOX
                   ", sources: [{attach: n, from: {point: {origin: [0, 5, 0]}}}]}}",
                   "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grids_hold_their_boxes),
        cmocka_unit_test(sides_are_in_their_order),
        cmocka_unit_test(a_box_and_a_source_burn),
        cmocka_unit_test(a_source_reaches_cells),
        cmocka_unit_test(sources_are_of_all_kinds),
        cmocka_unit_test(domains_have_noise_of_their_own),
        cmocka_unit_test(winds_have_the_grid_of_their_domain),
        cmocka_unit_test(winds_are_written_in_two_ways),
        cmocka_unit_test(printed_scenes_are_the_same),
        cmocka_unit_test(scenes_without_gas_say_nothing),
        cmocka_unit_test(memory_is_that_of_all_cells),
        cmocka_unit_test(work_counts_steps_of_gas),
        cmocka_unit_test(what_is_in_vain_is_said),
    };
    return cmocka_run_group_tests_name("gas_words", tests, NULL, NULL);
}
