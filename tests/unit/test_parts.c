/* lib/output/part.c: a clip that is made of parts, whoever wrote which of them and when, has the
 * bytes of one that was written at once. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/ffmpeg.h"
#include "output/part.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/pictures.h"

static __typeof__(avcodec_open2) *open_codec; /* FFmpeg's own */

/* In place of FFmpeg's own function: x264 without vectors. */
static int open_without_vectors(AVCodecContext *codec, const AVCodec *which, AVDictionary **options)
{
    if (strcmp(which->name, "libx264") == 0)
        kiln_ff.av_opt_set(codec->priv_data, "x264-params", "cpu-independent=1:scenecut=0:asm=0",
                           0);
    return open_codec(codec, which, options);
}

static void choose_vectors(bool on)
{
    struct kiln_error error = {0};
    assert_true(kiln_ffmpeg_open(KILN_FFMPEG_CLIPS, &error));
    open_codec = open_codec ? open_codec : kiln_ff.avcodec_open2;
    kiln_ff.avcodec_open2 = on ? open_codec : open_without_vectors;
}

/* So many frames at a rate, in a format. */
static struct kiln_output_params params_of(const char *path, const struct kiln_frame_range *clip,
                                           uint32_t fps_num, uint32_t fps_den, bool alpha)
{
    struct kiln_output_params params = test_output_params(path, clip);
    params.fps_num = fps_num;
    params.fps_den = fps_den;
    params.alpha = alpha;
    if (strstr(path, ".png"))
        params.flipbook = (struct kiln_flipbook){.columns = 5, .rows = 5, .motion = true};
    params.overwrite = true;
    params.clip = clip;
    params.clip_count = 1;
    struct kiln_error error = {0};
    params = kiln_output_complete(&params, &error);
    assert_non_null(params.format);
    return params;
}

/* Writes some parts: each `step`th from `first` on. */
static void write_parts(struct kiln_output_params params, uint32_t first, uint32_t step)
{
    struct kiln_error error = {0};
    for (uint32_t part = first; part < kiln_parts_count(&params); part += step) {
        const struct kiln_frame_range range = kiln_part_range(&params, part);
        params.parts = "parts";
        params.ranges = &range;
        if (!test_write_all(&params, &error))
            fail_msg("%s: %s", params.path, error.message);
    }
}

static char *read_bytes(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        fail_msg("%s is not there", path);
    char *bytes = malloc(1 << 22);
    assert_non_null(bytes);
    *size = fread(bytes, 1, 1 << 22, file);
    fclose(file);
    return bytes;
}

static void assert_same_files(const char *a, const char *b)
{
    size_t size_a, size_b;
    char *bytes_a = read_bytes(a, &size_a), *bytes_b = read_bytes(b, &size_b);
    if (size_a != size_b || memcmp(bytes_a, bytes_b, size_a) != 0)
        fail_msg("%s: joined of parts it has other bytes (%zu, %zu)", a, size_a, size_b);
    assert_true(size_a > 100);
    free(bytes_a);
    free(bytes_b);
}

static void check_clip(const char *suffix, uint32_t frames, uint32_t fps_num, uint32_t fps_den,
                       bool alpha)
{
    char whole[32], joined[32];
    const struct kiln_frame_range clip = {3, 3 + frames - 1};
    struct kiln_error error = {0};
    snprintf(whole, sizeof whole, "whole.%s", suffix);
    snprintf(joined, sizeof joined, "joined.%s", suffix);
    const struct kiln_output_params straight = params_of(whole, &clip, fps_num, fps_den, alpha);
    if (!test_write_all(&straight, &error))
        fail_msg("%s: %s", suffix, error.message);
    struct kiln_output_params params = params_of(joined, &clip, fps_num, fps_den, alpha);
    write_parts(params, 1, 2); /* in any order, */
    write_parts(params, 0, 2);
    write_parts(params, 1, 3); /* and again */
    params.parts = "parts";
    for (uint32_t part = 0; part < kiln_parts_count(&params); part++) {
        if (!kiln_part_check(&params, part, &error))
            fail_msg("%s %u %s", suffix, frames, error.message);
    }
    if (!kiln_parts_join(&params, &error))
        fail_msg("%s: %s", suffix, error.message);
    assert_same_files(whole, joined);
    if (strcmp(suffix, "png") == 0)
        assert_same_files("whole_motion.png", "joined_motion.png");
}

static void joined_clips_are_the_same(void **state)
{
    (void)state;
    static const struct {
        const char *suffix;
        uint32_t frames, fps_num, fps_den;
        bool alpha;
    } cases[] = {
        {"mp4", 61, 10, 1, false},        /* a last part of one frame */
        {"mp4", 60, 10, 1, false},        /* whole parts alone */
        {"mp4", 100, 24000, 1001, false}, /* an odd rate */
        {"mp4", 5, 1, 4, false},          /* each frame a part */
        {"webm", 61, 10, 1, false},       {"webm", 61, 10, 1, true}, {"mkv", 43, 10, 1, false},
        {"mkv", 43, 10, 1, true},         {"mov", 43, 10, 1, true},  {"gif", 43, 10, 1, false},
        {"apng", 43, 10, 1, true},        {"webp", 43, 10, 1, true}, {"png", 25, 10, 1, true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check_clip(cases[i].suffix, cases[i].frames, cases[i].fps_num, cases[i].fps_den,
                   cases[i].alpha);
}

/* Machines with vectors of other widths make the same parts. */
static void vectors_of_any_width_make_the_same_parts(void **state)
{
    (void)state;
    const struct kiln_frame_range clip = {0, 60};
    struct kiln_error error = {0};
    const struct kiln_output_params straight = params_of("whole.mp4", &clip, 10, 1, false);
    assert_true(test_write_all(&straight, &error));
    struct kiln_output_params params = params_of("joined.mp4", &clip, 10, 1, false);
    choose_vectors(false);
    write_parts(params, 1, 2);
    choose_vectors(true);
    write_parts(params, 0, 2);
    params.parts = "parts";
    assert_true(kiln_parts_join(&params, &error));
    assert_same_files("whole.mp4", "joined.mp4");
}

static void refuse(const struct kiln_output_params *params, enum kiln_code code,
                   const char *message)
{
    struct kiln_error error = {0};
    assert_false(kiln_parts_join(params, &error));
    expect_error(&error, code, "%s", message);
    assert_int_equal(access(params->path, F_OK), -1);
    assert_int_equal(test_count_files("."), 1); /* the parts */
}

static void parts_that_do_not_fit_are_refused(void **state)
{
#define DAMAGED "parts/00001.part: the part of a clip is damaged"
    (void)state;
    const struct kiln_frame_range clip = {0, 40};
    struct kiln_output_params params = params_of("clip.webm", &clip, 10, 1, false);
    write_parts(params, 0, 1);
    params.parts = "parts";
    struct kiln_output_params other = params;
    other.quality = 79;
    refuse(&other, KILN_INVALID_INPUT,
           "parts/00000.part: the part belongs to another clip: of another scene, size, "
           "quality or other frames");
    other = params;
    other.scene_hash = "00";
    refuse(&other, KILN_INVALID_INPUT,
           "parts/00000.part: the part belongs to another clip: of another scene, size, "
           "quality or other frames");
    assert_int_equal(rename("parts/00001.part", "parts/00003.part"), 0);
    refuse(&params, KILN_IO,
           "parts/00001.part: the part of a clip cannot be opened: No such file or directory");
    assert_int_equal(rename("parts/00000.part", "parts/00001.part"), 0);
    assert_int_equal(rename("parts/00003.part", "parts/00000.part"), 0);
    refuse(&params, KILN_INVALID_INPUT, "parts/00000.part: the file is another part of the clip");
    assert_int_equal(rename("parts/00000.part", "parts/00003.part"), 0);
    assert_int_equal(rename("parts/00001.part", "parts/00000.part"), 0);
    assert_int_equal(rename("parts/00003.part", "parts/00001.part"), 0);

    size_t size;
    char *bytes = read_bytes("parts/00001.part", &size);
    struct kiln_error error = {0};
    for (size_t i = 0; i < size; i += 1 + i / 16) {
        const char before = bytes[i];
        bytes[i] = before == 'k' ? 'x' : 'k';
        FILE *file = fopen("parts/00001.part", "wb");
        assert_non_null(file);
        assert_int_equal(fwrite(bytes, 1, size, file), size);
        fclose(file);
        bytes[i] = before;
        if (kiln_part_check(&params, 1, &error))
            fail_msg("byte %zu is changed, and nobody sees it", i);
        expect_error(&error, KILN_INVALID_INPUT, DAMAGED);
        refuse(&params, KILN_INVALID_INPUT, DAMAGED);
    }
    free(bytes);
    assert_int_equal(truncate("parts/00001.part", 2), 0);
    refuse(&params, KILN_INVALID_INPUT, "parts/00001.part: the file is not a part of a clip");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(joined_clips_are_the_same, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(vectors_of_any_width_make_the_same_parts, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(parts_that_do_not_fit_are_refused, test_enter_folder,
                                        test_leave_folder),
    };
    return cmocka_run_group_tests_name("parts", tests, NULL, NULL);
}
