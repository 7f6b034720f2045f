/* lib/job/export.c: which files an export writes, and what it refuses. If this fails, files of gas
 * have wrong names, replace others, or say a wrong frame. What stands in the files is checked by
 * test_vdb.c. */
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "kiln_program.h"
#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/vdb_file.h"

static const char text[] = "kiln: 1\n"
                           "output: {size: [16, 16], fps: 10, frames: 8}\n"
                           "nodes: {cart: {position: {keys: {0 s: [0, 0, 0], 1 s: [10, 0, 0]}}}}\n";

static struct kiln_scene *parse(void)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_scene *scene =
        kiln_scene_parse(text, strlen(text), "scenes/fire.yaml", NULL, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

/* Adds a domain to a scene, without gas in it. */
static struct kiln_gas_domain *add_domain(struct kiln_scene *scene, const char *name, float cell)
{
    struct kiln_gas_domain *domain = &scene->gas[scene->gas_count++];
    *domain = (struct kiln_gas_domain){
        .name = name,
        .enabled = true,
        .shape = {.cells = {16, 32, 16}, .cell = cell, .corner = FLOAT3(1.0f, 2.0f, 3.0f)},
    };
    domain->look.kelvin[0].constant = 300;
    domain->look.kelvin[1].constant = 1300;
    domain->look.extinction.constant = 5;
    return domain;
}

static struct kiln_device *open_cpu(void)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_device_params cpu = kiln_device_defaults();
    cpu.wanted = KILN_DEVICE_CPU;
    struct kiln_device *device = kiln_device_open(&cpu, &error);
    if (!device)
        fail_msg("%s", error.message);
    return device;
}

/* What an export told of its files. */
struct told {
    uint32_t count;
    char last[KILN_PATH_SIZE];
};

static void tell(void *user, const struct kiln_exported *file)
{
    struct told *told = user;
    struct stat status;
    told->count++;
    snprintf(told->last, sizeof told->last, "%s of %s", file->file, file->gas);
    assert_int_equal(file->done, told->count);
    assert_int_equal(stat(file->file, &status), 0); /* it is whole */
    assert_true((uint64_t)status.st_size == file->bytes);
}

static bool export(const struct kiln_scene *scene, const struct kiln_export_params *params,
                   struct kiln_export_stats *stats, struct kiln_error *error)
{
    struct kiln_device *device = open_cpu();
    const bool ok = kiln_export(device, scene, params, stats, error);
    kiln_device_close(&device);
    return ok;
}

static void one_file_for_each_frame(void **state)
{
    (void)state;
    static const struct kiln_frame_range ranges[] = {{2, 3}, {7, 7}};
    struct kiln_scene *scene = parse();
    struct kiln_error error = kiln_error_empty();
    struct kiln_export_params params = kiln_export_defaults();
    struct kiln_export_stats stats = kiln_export_stats_empty();
    struct told told = {0};
    struct vdb_file vdb;
    add_domain(scene, "fire", 0.5f);
    params.output = "out/gas_####.vdb";
    params.ranges = ranges;
    params.range_count = 2;
    params.exported = tell;
    params.user = &told;
    if (!export(scene, &params, &stats, &error))
        fail_msg("%s", error.message);
    assert_true(stats.frames == 3 && stats.files == 3 && told.count == 3);
    assert_string_equal(stats.first_file, "out/gas_0002.vdb");
    assert_string_equal(told.last, "out/gas_0007.vdb of fire");
    assert_int_equal(access("out/gas_0003.vdb", F_OK), 0);
    vdb_file_read(&vdb, "out/gas_0007.vdb");
    char expected[512];
    snprintf(expected, sizeof expected,
             "creator=kiln %s;scene=fire.yaml;scene_hash=%s;gas=fire;frame=7;time=0.7;fps=10;up=y;"
             "length=m;",
             KILN_VERSION, scene->hash);
    expect_message(vdb.metas, "%s", expected);
    vdb_file_free(&vdb);
    kiln_scene_destroy(&scene);
}

/* Two files of one frame differ in what UUIDs are for: to tell files apart. */
static void uuids_tell_files_apart(void **state)
{
    (void)state;
    static const struct kiln_frame_range first = {0, 0}, second = {1, 1};
    struct kiln_scene *scene = parse();
    struct kiln_error error = kiln_error_empty();
    struct kiln_export_params params = kiln_export_defaults();
    struct vdb_file vdb[4];
    add_domain(scene, "fire", 0.5f);
    params.range_count = 1;
    for (int i = 0; i < 4; i++) {
        params.output = (const char *[]){"a.vdb", "b.vdb", "c.vdb", "d.vdb"}[i];
        params.ranges = i == 1 ? &second : &first;
        params.half = i == 2;
        assert_true(export(scene, &params, NULL, &error));
        vdb_file_read(&vdb[i], params.output);
    }
    for (int i = 0; i < 4; i++) {
        assert_true(vdb[i].uuid[14] == '8' && vdb[i].uuid[19] == '8' && vdb[i].uuid[8] == '-');
        for (int k = 0; k < i; k++)
            assert_true((strcmp(vdb[i].uuid, vdb[k].uuid) == 0) == (i == 3 && k == 0));
        vdb_file_free(&vdb[i]);
    }
    kiln_scene_destroy(&scene);
}

/* A domain that is attached lies where its node is at the time of the frame: at 5 m. */
static void a_node_moves_a_domain(void **state)
{
    (void)state;
    static const struct kiln_frame_range frame = {5, 5};
    struct kiln_scene *scene = parse();
    struct kiln_error error = kiln_error_empty();
    struct kiln_export_params params = kiln_export_defaults();
    struct vdb_file vdb;
    add_domain(scene, "fire", 0.5f)->attach = (struct kiln_attach){"cart", 0};
    params.output = "x.vdb";
    params.ranges = &frame;
    params.range_count = 1;
    if (!export(scene, &params, NULL, &error))
        fail_msg("%s", error.message);
    vdb_file_read(&vdb, "x.vdb");
    assert_string_equal(vdb.grids[0].map, "UniformScaleTranslateMap");
    assert_true(vdb.grids[0].origin[0] > 6.2499 && vdb.grids[0].origin[0] < 6.2501);
    assert_true(vdb.grids[0].origin[1] == 2.25 && vdb.grids[0].origin[2] == 3.25);
    vdb_file_free(&vdb);
    kiln_scene_destroy(&scene);
}

static void each_domain_has_files(void **state)
{
    (void)state;
    static const struct kiln_frame_range frames = {0, 1};
    struct kiln_scene *scene = parse();
    struct kiln_error error = kiln_error_empty();
    struct kiln_export_params params = kiln_export_defaults();
    struct kiln_export_stats stats = kiln_export_stats_empty();
    struct vdb_file vdb;
    add_domain(scene, "fire", 0.5f);
    add_domain(scene, "plume_2", 0.25f);
    add_domain(scene, "off", 0.125f)->enabled = false;
    params.output = "out/{gas}/{gas}_##.vdb";
    params.ranges = &frames;
    params.range_count = 1;
    if (!export(scene, &params, &stats, &error))
        fail_msg("%s", error.message);
    assert_true(stats.frames == 2 && stats.files == 4);
    assert_int_equal(access("out/off", F_OK), -1);
    vdb_file_read(&vdb, "out/fire/fire_01.vdb");
    assert_true(vdb.grids[0].axes[0][0] == 0.5);
    vdb_file_free(&vdb);
    vdb_file_read(&vdb, "out/plume_2/plume_2_01.vdb");
    assert_true(vdb.grids[0].axes[0][0] == 0.25);
    vdb_file_free(&vdb);

    params.gas = "fire"; /* one alone needs no name in the files' */
    params.output = "alone.vdb";
    assert_true(export(scene, &params, &stats, &error));
    assert_int_equal(stats.files, 2);
    assert_string_equal(stats.first_file, "alone_0000.vdb"); /* as for frames of pictures */
    kiln_scene_destroy(&scene);
}

static void expect_refused(const struct kiln_scene *scene, const struct kiln_export_params *params,
                           const char *message)
{
    struct kiln_error error = kiln_error_empty();
    assert_false(export(scene, params, NULL, &error));
    expect_error(&error, KILN_USAGE, "%s", message);
}

static void mistakes_are_refused_before_the_first_step(void **state)
{
    (void)state;
    static const struct kiln_frame_range beyond = {3, 8};
    struct kiln_scene *scene = parse();
    struct kiln_export_params params = kiln_export_defaults();
    params.output = "gas_####.vdb";
    expect_refused(scene, &params,
                   "scenes/fire.yaml: the scene has no gas to export (see 'kiln help scene gas')");
    add_domain(scene, "fire", 0.5f)->enabled = false;
    expect_refused(scene, &params, "scenes/fire.yaml: the gas of the scene is not enabled");
    scene->gas[0].enabled = true;
    add_domain(scene, "plume", 0.5f);
    params.gas = "flames";
    expect_refused(scene, &params,
                   "scenes/fire.yaml: the scene has no gas 'flames'; it has fire, plume");
    params.gas = NULL;
    expect_refused(scene, &params,
                   "gas_####.vdb: the scene has 2 domains of gas, which need {gas} for their names "
                   "in the name of the files, as in gas_{gas}_####.vdb");
    params.gas = "fire";
    params.output = "gas.png";
    expect_refused(scene, &params, "gas.png: gas is exported to files with the suffix .vdb");
    params.output = "gas_##_##.vdb";
    expect_refused(scene, &params, "gas_##_##.vdb: the file name has two frame numbers");
    params.output = "gas_##.vdb";
    params.ranges = &beyond;
    params.range_count = 1;
    expect_refused(scene, &params, "frames 3-8: expected ascending ranges within 0-7");
    params.range_count = 0;
    test_write_file("gas_05.vdb", "mine");
    expect_refused(scene, &params, "gas_05.vdb: the file exists (--force replaces it)");
    assert_int_equal(access("gas_00.vdb", F_OK), -1);
    params.overwrite = true;
    struct kiln_error error = kiln_error_empty();
    assert_true(export(scene, &params, NULL, &error));
    kiln_scene_destroy(&scene);
}

static bool stop_after(void *user)
{
    const struct told *told = user;
    return told->count >= 2;
}

static void a_stopped_export_keeps_whole_files(void **state)
{
    (void)state;
    struct kiln_scene *scene = parse();
    struct kiln_error error = kiln_error_empty();
    struct kiln_export_params params = kiln_export_defaults();
    struct kiln_export_stats stats = kiln_export_stats_empty();
    struct told told = {0};
    add_domain(scene, "fire", 0.5f);
    params.output = "gas_#.vdb";
    params.exported = tell;
    params.stop = stop_after;
    params.user = &told;
    assert_false(export(scene, &params, &stats, &error));
    expect_error(&error, KILN_INTERRUPTED, "stopped");
    assert_true(told.count == 2 && stats.files == 2);
    assert_int_equal(access("gas_1.vdb", F_OK), 0);
    assert_int_equal(access("gas_2.vdb", F_OK), -1);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)
        IN_FOLDER(one_file_for_each_frame),
        IN_FOLDER(uuids_tell_files_apart),
        IN_FOLDER(a_node_moves_a_domain),
        IN_FOLDER(each_domain_has_files),
        IN_FOLDER(mistakes_are_refused_before_the_first_step),
        IN_FOLDER(a_stopped_export_keeps_whole_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
