/* Writes a golden-image test of a small scene into the working directory, runs it, updates its
 * goldens, and changes its files, for tests of lib/suite. */
#include "support/suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/image/image.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/folders.h"
#include "support/pictures.h"

/* Text of the scene: a few sparks, drawn in 48 x 32 pixels. */
static const char spark_scene[] = "kiln: 1\n"
                                  "seed: 7\n"
                                  "output: {size: [48, 32], fps: 30, frames: 8}\n"
                                  "camera: {position: [0, 1, 4], target: [0, 1, 0], fov: 45 deg}\n"
                                  "systems:\n"
                                  "  sparks:\n"
                                  "    emit:\n"
                                  "      rate: 200\n"
                                  "      life: 1 s\n"
                                  "      from: {sphere: {origin: [0, 1, 0], radius: 0.5}}\n"
                                  "      speed: [0.5, 1]\n"
                                  "    look: {atlas: \"builtin:spark\", blend: add, size: 0.2}\n";

/* Text of the golden test. It names the scene by a path relative to its own folder. */
#define SPARK_TEST "kiln_test: 1\nscene: spark.yaml\nframes: [3, 5]\n"

void spark_write(const char *more)
{
    char text[1024];
    snprintf(text, sizeof text, SPARK_TEST "%s", more);
    test_write_file("spark.test.yaml", text);
    test_write_file("spark.yaml", spark_scene);
}

struct kiln_suite *spark_suite(void)
{
    static const char *const paths[] = {"spark.test.yaml"};
    struct kiln_suite_params params = kiln_suite_defaults();
    struct kiln_error error = {0};
    params.paths = paths;
    params.path_count = 1;
    struct kiln_suite *suite = kiln_suite_load(&params, &error);
    if (!suite)
        fail_msg("%s", error.message);
    return suite;
}

struct kiln_test_params spark_params(void)
{
    struct kiln_test_params params = kiln_test_defaults();
    params.device = getenv("KILN_TEST_DEVICE");
    params.threads = 2;
    params.log.write = test_log;
    return params;
}

struct spark_run spark_run(const struct kiln_test_params *params)
{
    const struct kiln_test_params usual = spark_params();
    struct spark_run run = {.arena = kiln_arena_create(), .suite = spark_suite()};
    run.ok = kiln_suite_begin(run.suite, &run.error) &&
             kiln_test_run(run.suite, 0, params ? params : &usual, &run.summary, &run.error);
    if (!run.ok)
        return run;
    const struct kiln_result_place place = {"out/test", "spark"};
    run.result = kiln_result_read(run.arena, &place, &run.error);
    if (!run.result)
        fail_msg("%s", run.error.message);
    assert_int_equal(run.result->status, run.summary.status);
    assert_int_equal(run.result->code, run.summary.code);
    return run;
}

void spark_end(struct spark_run *run)
{
    kiln_suite_destroy(&run->suite);
    kiln_arena_destroy(&run->arena);
}

bool spark_has_note(const struct spark_run *run, const char *format, ...)
{
    char note[KILN_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(note, sizeof note, format, args);
    va_end(args);
    for (size_t i = 0; i < run->result->note_count; i++) {
        if (strcmp(run->result->notes[i], note) == 0)
            return true;
    }
    for (size_t i = 0; i < run->result->note_count; i++)
        print_error("note: %s\n", run->result->notes[i]);
    return false;
}

size_t spark_expect(const struct kiln_test_params *params, enum kiln_test_status status,
                    enum kiln_judged_by judged_by)
{
    struct spark_run run = spark_run(params);
    assert_true(run.ok);
    if (run.result->status != status)
        fail_msg("%s: %s", kiln_test_status_name(run.result->status), run.result->message);
    assert_int_equal(run.result->frame_count, 2);
    for (size_t i = 0; i < 2; i++)
        assert_string_equal(kiln_judged_by_name(run.result->frames[i].judged_by),
                            kiln_judged_by_name(judged_by));
    size_t notes = run.result->note_count;
    spark_end(&run);
    return notes;
}

void spark_update(enum kiln_update update)
{
    struct kiln_test_params params = spark_params();
    params.update = update;
    struct spark_run run = spark_run(&params);
    assert_true(run.ok);
    if (run.result->status != KILN_TEST_PASS)
        fail_msg("%s: %s", kiln_test_status_name(run.result->status), run.result->message);
    spark_end(&run);
}

void spark_paint(const char *path, uint32_t x0, uint32_t y0, uint32_t width, uint32_t height,
                 int levels)
{
    struct kiln_error error = {0};
    struct kiln_asset_image *image = kiln_asset_image_load(NULL, path, &error);
    if (!image) {
        fail_msg("%s", error.message);
        return;
    }
    assert_int_equal(image->type, KILN_IMAGE_U8);
    const struct kiln_frame_range range = {0, 0};
    struct kiln_output_params params = test_output_params(path, &range);
    params.width = image->width;
    params.height = image->height;
    params.overwrite = true;
    struct kiln_output *output = kiln_output_open(&params, &error);
    assert_non_null(output);
    struct kiln_picture *picture = test_picture(output, &params, 0);
    uint8_t *to = picture->display;
    memcpy(to, image->pixels, (size_t)image->width * image->height * 4);
    for (uint32_t y = y0; y < y0 + height; y++) {
        for (uint32_t x = x0; x < x0 + width; x++) {
            for (size_t c = 0; c < 3; c++) {
                uint8_t *value = &to[4 * ((size_t)y * image->width + x) + c];
                int sum = *value + levels;
                *value = (uint8_t)(sum > 255 ? *value - levels : sum);
            }
        }
    }
    assert_true(kiln_output_write(output, picture, &error));
    assert_true(kiln_output_finish(output, &error));
    kiln_output_close(&output);
    kiln_asset_image_destroy(&image);
}

void spark_replace(const char *path, const char *from, const char *to)
{
    char *text = test_read_file(path);
    char *place = strstr(text, from);
    if (!place)
        fail_msg("%s has no '%s':\n%s", path, from, text);
    size_t size = strlen(text) + strlen(to) + 1;
    char *changed = malloc(size);
    assert_non_null(changed);
    snprintf(changed, size, "%.*s%s%s", (int)(place - text), text, to, place + strlen(from));
    test_write_file(path, changed);
    free(changed);
    free(text);
}

int spark_needs_device(void **state)
{
    void *device = NULL;
    (void)state;
    test_device_open(&device);
    return test_device_close(&device);
}
