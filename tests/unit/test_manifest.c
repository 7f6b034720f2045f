/* The manifest, read back as JSON. */
#include <libfyaml.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "job/manifest.h"
#include "scene/work.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

static const char scene_text[] = "kiln: 1\n"
                                 "seed: 4000000007\n"
                                 "output: {size: [320, 180], fps: 30000/1001, frames: 3}\n"
                                 "systems:\n"
                                 "  spray:\n"
                                 "    emit: {rate: 100, life: 1 s, speed: 1}\n";

static struct kiln_scene *make_scene(void)
{
    struct kiln_error error = {0};
    struct kiln_scene *scene =
        kiln_scene_parse(scene_text, strlen(scene_text), "a \"b\".yaml", NULL, &error);
    assert_string_equal(error.message, "");
    assert_non_null(scene);
    return scene;
}

/* Records of so many frames. */
static struct kiln_records make_records(const struct kiln_frame_range *clip, uint32_t frames)
{
    struct kiln_records records;
    assert_true(kiln_records_create(&records, clip, frames > 0));
    for (uint32_t frame = 0; frame < frames; frame++) {
        struct kiln_record *record = kiln_records_of(&records, frame);
        record->has_state = record->drawn = true;
        record->alive = 5000000000u + frame;
        record->state = (struct kiln_state_hash){{0x1234abcd, frame}};
        for (int i = 0; i < KILN_PASS_COUNT; i++)
            record->pass_ms[i] = (float)i + 0.25f;
    }
    if (frames > 2)
        records.items[1].drawn = false; /* by a run before */
    return records;
}

/* Lines and numbers of the file by their path, such as "/result/frames/0/alive". */
static void check_value(struct fy_document *json, const char *path, const char *expected)
{
    struct fy_node *node = fy_node_by_path(fy_document_root(json), path, FY_NT, FYNWF_DONT_FOLLOW);
    assert_non_null(node);
    const char *value = fy_node_get_scalar0(node);
    assert_non_null(value);
    assert_string_equal(value, expected);
}

static struct fy_document *read_json(const char *path)
{
    const struct fy_parse_cfg strict = {.flags = FYPCF_JSON_FORCE | FYPCF_QUIET};
    struct fy_document *json = fy_document_build_from_file(&strict, path);
    assert_non_null(json);
    return json;
}

static void write_manifest(const struct kiln_manifest_params *params, uint32_t frames,
                           const struct kiln_error *failure)
{
    struct kiln_error error = {0};
    struct kiln_manifest *manifest = kiln_manifest_open(params, &error);
    assert_string_equal(error.message, "");
    assert_non_null(manifest);
    const struct kiln_frame_range clip = {0, frames - 1};
    struct kiln_records records = make_records(&clip, frames);
    if (frames > 0) {
        const struct kiln_finished_file image = {
            .path = "x", .frames = {2, 2}, .bytes = 77, .sha256 = "abc"};
        const struct kiln_finished_file clip_file = {
            .path = "clip.mp4", .is_clip = true, .bytes = 78, .sha256 = "def"};
        kiln_records_take(&records, &image);
        kiln_records_take(&records, &clip_file);
    }
    const struct kiln_render_stats stats = {.frames = frames,
                                            .kept = 1,
                                            .steps = 12,
                                            .setup_s = 0.5,
                                            .total_s = 61.0625,
                                            .particle_bytes = 4096};
    assert_int_not_equal(access(params->path, F_OK), 0); /* not before it is whole */
    assert_true(kiln_manifest_finish(manifest, &records, &stats, failure, &error));
    kiln_manifest_close(&manifest);
    assert_null(manifest);
    kiln_records_free(&records);
}

/* A scene, and a folder that the manifest goes to. */
struct fixture {
    char folder[32], path[64];
    struct kiln_scene *scene;
    char *scene_json;
    struct kiln_attempt run;
    struct kiln_manifest_params params;
};

static int set_up(void **state)
{
    static struct fixture f;
    test_make_folder(f.folder);
    snprintf(f.path, sizeof f.path, "%s/new/run.json", f.folder);
    f.scene = make_scene();
    f.scene_json = kiln_manifest_scene(f.scene);
    f.run = (struct kiln_attempt){.techniques = ""};
    f.params = (struct kiln_manifest_params){.path = f.path, .scene = f.scene_json, .run = &f.run};
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    struct fixture *f = *state;
    kiln_scene_destroy(&f->scene);
    free(f->scene_json);
    test_remove_folder(f->folder);
    return 0;
}

/* The text in it is the scene. */
static void check_text(struct fy_document *json, const char *hash)
{
    struct fy_node *text =
        fy_node_by_path(fy_document_root(json), "/result/scene/text", FY_NT, FYNWF_DONT_FOLLOW);
    size_t length = 0;
    const char *printed = fy_node_get_scalar(text, &length);
    assert_non_null(printed);
    struct kiln_error error = {0};
    struct kiln_scene *again = kiln_scene_parse(printed, length, "again", NULL, &error);
    if (again)
        assert_string_equal(kiln_scene_facts(again).hash, hash);
    else
        fail_msg("the printed scene does not load: %s", error.message);
    kiln_scene_destroy(&again);
}

static void everything_is_in_it(void **state)
{
    struct fixture *f = *state;
    const struct kiln_device_info device = {
        .software = true, .name = "llvm\\pipe", .vendor = "Mesa", .gl_version = "4.5"};
    f->run.device = &device;
    f->run.techniques = "simulate=cpu sort=radix";
    f->params.output = "out/####.png";
    const char *const command[] = {"render", "a b.yaml"};
    f->run.command = command;
    f->run.command_count = 2;
    f->run.build = "0.2.0 (254e4dc)";
    const struct kiln_frame_range clip = {0, 2};
    struct kiln_output_params files = test_output_params("out/\xff####.png", &clip);
    struct kiln_error none = {0};
    files = kiln_output_complete(&files, &none);
    f->params.files = &files;
    write_manifest(&f->params, 3, NULL);

    struct fy_document *json = read_json(f->path);
    check_value(json, "/kiln", KILN_VERSION);
    check_value(json, "/result/scene/file", "a \"b\".yaml");
    check_value(json, "/result/scene/hash", kiln_scene_facts(f->scene).hash);
    check_value(json, "/result/scene/seed", "4000000007");
    check_value(json, "/result/scene/size/1", "180");
    check_value(json, "/result/scene/fps/0", "30000");
    check_value(json, "/run/device/name", "llvm\\pipe");
    check_value(json, "/run/device/software", "true");
    check_value(json, "/run/techniques/simulate", "cpu");
    check_value(json, "/run/techniques/sort", "radix");
    check_value(json, "/result/output", "out/####.png");
    check_value(json, "/result/frames/0/state", "1234abcd00000000");
    check_value(json, "/result/frames/2/frame", "2");
    check_value(json, "/result/frames/2/state", "1234abcd00000002");
    check_value(json, "/result/frames/2/alive", "5000000002");
    check_value(json, "/result/frames/2/file",
                "out/\xef\xbf\xbd"
                "0002.png");
    check_value(json, "/run/frames/1/ms/sort", "1.250");
    check_value(json, "/result/frames/2/bytes", "77");
    check_value(json, "/result/frames/2/sha256", "abc");
    check_value(json, "/result/files/0/file", "clip.mp4");
    check_value(json, "/run/frames/1/frame", "2");
    check_value(json, "/run/build", "0.2.0 (254e4dc)");
    check_value(json, "/run/command/1", "a b.yaml");
    check_value(json, "/run/kept", "1");
    check_value(json, "/run/error", "null");
    check_value(json, "/result/missing", "0");
    check_value(json, "/run/totals/frames", "3");
    check_value(json, "/run/totals/total_s", "61.063");
    check_value(json, "/run/totals/particle_bytes", "4096");

    check_text(json, kiln_scene_facts(f->scene).hash);
    fy_document_destroy(json);
}

static void little_is_enough(void **state)
{
    const struct fixture *f = *state;
    write_manifest(&f->params, 0, NULL);
    struct fy_document *json = read_json(f->path);
    check_value(json, "/run/device", "null");
    check_value(json, "/result/output", "null");
    check_value(json, "/run/totals/frames", "0");
    fy_document_destroy(json);
}

/* Of three frames the last one is whole. */
static void failed_runs_tell_how_far_they_came(void **state)
{
    struct fixture *f = *state;
    const struct kiln_error failure = {.code = KILN_OVER_LIMIT, .message = "too \"much\""};
    const struct kiln_frame_range clip = {0, 2};
    struct kiln_output_params files = test_output_params("%d.png", &clip);
    struct kiln_error error = {0};
    files = kiln_output_complete(&files, &error);
    f->params.files = &files;
    f->run.asked = 3;
    write_manifest(&f->params, 3, &failure);
    f->params.files = NULL;
    struct fy_document *json = read_json(f->path);
    check_value(json, "/result/frames/0/frame", "2");
    check_value(json, "/result/missing", "2");
    check_value(json, "/run/error/code", "8");
    check_value(json, "/run/error/message", "too \"much\"");
    check_value(json, "/run/totals/asked", "3");
    fy_document_destroy(json);
}

static void only_whole_manifests_stay(void **state)
{
    const struct fixture *f = *state;
    char parent[48];
    snprintf(parent, sizeof parent, "%s/new", f->folder);
    struct kiln_error error = {0};
    struct kiln_manifest *manifest = kiln_manifest_open(&f->params, &error);
    assert_non_null(manifest);
    assert_int_equal(test_count_files(parent), 1);
    kiln_manifest_close(&manifest);
    assert_int_equal(test_count_files(parent), 0);

    write_manifest(&f->params, 1, NULL);
    assert_null(kiln_manifest_open(&f->params, &error));
    expect_error(&error, KILN_USAGE, "%s/run.json: the file exists (--force replaces it)", parent);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(everything_is_in_it, set_up, tear_down),
        cmocka_unit_test_setup_teardown(little_is_enough, set_up, tear_down),
        cmocka_unit_test_setup_teardown(failed_runs_tell_how_far_they_came, set_up, tear_down),
        cmocka_unit_test_setup_teardown(only_whole_manifests_stay, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("manifest", tests, NULL, NULL);
}
