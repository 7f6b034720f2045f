/* lib/asset/video_in: the frames that kiln writes come back, and no damage passes. */
#include <libavformat/avformat.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "asset/image/video_in.h"
#include "base/file_in.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

enum { FRAMES = 12 };

struct clip {
    char folder[32], path[64];
};

static struct clip make_clip_named(const char *name)
{
    struct clip clip;
    test_make_folder(clip.folder);
    snprintf(clip.path, sizeof clip.path, "%s/%s", clip.folder, name);
    const struct kiln_frame_range range = {0, FRAMES - 1};
    struct kiln_output_params params = test_output_params(clip.path, &range);
    params.quality = 95;
    struct kiln_error error = {0};
    assert_true(test_write_all(&params, &error));
    return clip;
}

static struct clip make_clip(void)
{
    return make_clip_named("x.mp4");
}

/* The frames that can be read; -1 when that ends with an error. */
static int count_frames(const char *path, struct kiln_error *error)
{
    struct kiln_video_in *video = kiln_video_in_open(NULL, path, error);
    struct kiln_asset_image *image = NULL;
    int frames = 0;
    bool good = video != NULL;
    while (good && (good = kiln_video_in_read(video, &image, error)) && image) {
        kiln_asset_image_destroy(&image);
        frames++;
    }
    kiln_video_in_close(&video);
    return good ? frames : -1;
}

static void come_back(const char *name)
{
    struct clip clip = make_clip_named(name);
    struct kiln_error error = {0};
    struct kiln_video_in *video = kiln_video_in_open(NULL, clip.path, &error);
    assert_non_null(video);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        struct kiln_asset_image *image = NULL;
        assert_true(kiln_video_in_read(video, &image, &error));
        assert_non_null(image);
        assert_int_equal(image->width, 64);
        assert_int_equal(image->height, 36);
        assert_int_equal(image->channels, 3);
        double sum = 0;
        const uint8_t *pixel = image->pixels;
        for (uint32_t i = 0; i < 64 * 36; i++, pixel += 4) {
            for (int c = 0; c < 3; c++)
                sum += fabs((double)pixel[c] - test_level(frame, 64, i % 64, i / 64, c));
        }
        assert_true(sum / (64.0 * 36 * 3) < 2.0);
        kiln_asset_image_destroy(&image);
    }
    struct kiln_asset_image *none = NULL;
    assert_true(kiln_video_in_read(video, &none, &error));
    assert_null(none);
    kiln_video_in_close(&video);
    test_remove_folder(clip.folder);
}

static void frames_and_colours_come_back(void **state)
{
    (void)state;
    come_back("x.mp4");
    come_back("x.apng");
    come_back("x.webp");
}

static void write_bytes(const char *path, const unsigned char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* Finds where the first frame of a clip starts in its file, and where frames end; returns how many
 * there are. */
static size_t find_ends(const char *path, size_t *start, size_t ends[FRAMES])
{
    AVFormatContext *container = NULL;
    AVPacket *packet = av_packet_alloc();
    assert_int_equal(avformat_open_input(&container, path, NULL, NULL), 0);
    size_t count = 0;
    while (av_read_frame(container, packet) >= 0) {
        assert_true(count < FRAMES);
        if (count == 0)
            *start = (size_t)packet->pos;
        ends[count++] = (size_t)packet->pos + (size_t)packet->size;
        av_packet_unref(packet);
    }
    av_packet_free(&packet);
    avformat_close_input(&container);
    return count;
}

#define ALLOWED "allowed are MP4, MOV, Matroska, WebM, AVI, GIF, APNG or animated WebP files"
#define UNKNOWN "the file is not a video; " ALLOWED

/* Checks that a clip is not read that was cut to a length. start: of its frames. Within its header,
 * FFmpeg decides whether it is known as a video. */
static void expect_cut(const char *path, size_t length, size_t start)
{
    struct kiln_error error = {0};
    assert_int_equal(count_frames(path, &error), -1);
    const char *text = length > 0 ? "the video is cut short" : "the video file is empty";
    if (length < start && strstr(error.message, "not a video")) /* partly: to know which of two */
        text = UNKNOWN;
    expect_error_decoding(&error, KILN_INVALID_INPUT, "%s: %s", path, text);
}

static void a_file_that_was_cut_short_is_refused(void **state)
{
    (void)state;
    struct clip clip = make_clip();
    struct kiln_error error = {0};
    size_t size = 0;
    unsigned char *bytes = kiln_file_read(clip.path, "video", "MP4", 1 << 24, &size, &error);
    assert_non_null(bytes);
    assert_int_equal(count_frames(clip.path, &error), FRAMES);
    size_t ends[FRAMES], start = 0;
    assert_int_equal(find_ends(clip.path, &start, ends), FRAMES);
    for (size_t length = 0; length < size; length += 1 + size / 40) {
        write_bytes(clip.path, bytes, length);
        expect_cut(clip.path, length, start);
    }
    /* Also between two frames, where nothing is damaged. */
    for (size_t i = 0; i < FRAMES; i++) {
        for (size_t length = ends[i] - 1; length <= ends[i] + 1 && length < size; length++) {
            write_bytes(clip.path, bytes, length);
            expect_cut(clip.path, length, start);
        }
    }
    free(bytes);
    test_remove_folder(clip.folder);
}

/* A playlist would make FFmpeg open what it names. */
static void what_is_no_video_is_refused(void **state)
{
    (void)state;
    struct clip clip = make_clip();
    struct kiln_error error = {0};
    char list[128], path[64];
    snprintf(list, sizeof list, "ffconcat version 1.0\nfile '%s'\n", clip.path);
    snprintf(path, sizeof path, "%s/list.mp4", clip.folder);
    write_bytes(path, (const unsigned char *)list, strlen(list));
    assert_int_equal(count_frames(path, &error), -1);
    expect_error_decoding(&error, KILN_INVALID_INPUT, "%s: " UNKNOWN, path);
    snprintf(list, sizeof list, "#EXTM3U\n#EXTINF:1,\n%s\n#EXT-X-ENDLIST\n", clip.path);
    write_bytes(path, (const unsigned char *)list, strlen(list));
    assert_int_equal(count_frames(path, &error), -1);
    expect_error_decoding(&error, KILN_INVALID_INPUT, "%s: " UNKNOWN, path);
    assert_int_equal(count_frames(clip.folder, &error), -1);
    expect_error(&error, KILN_INVALID_INPUT, "%s: the path is not a file but a folder; " ALLOWED,
                 clip.folder);
    snprintf(path, sizeof path, "%s/fifo.mp4", clip.folder);
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_int_equal(count_frames(path, &error), -1);
    expect_error(&error, KILN_INVALID_INPUT,
                 "%s: the path is not a file but a device or pipe; " ALLOWED, path);
    test_remove_folder(clip.folder);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_and_colours_come_back),
        cmocka_unit_test(a_file_that_was_cut_short_is_refused),
        cmocka_unit_test(what_is_no_video_is_refused),
    };
    return cmocka_run_group_tests_name("video_in", tests, NULL, NULL);
}
