/* MP4 files read back by FFmpeg: frames, rate, size, tags, colours, metadata, order of the parts.
 */
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "base/ffmpeg.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

/* Plays an FFmpeg that was built without. */
static const AVCodec *find_no_encoder(const char *name)
{
    (void)name;
    return NULL;
}

struct decoded {
    AVFormatContext *container;
    AVCodecContext *codec;
    AVStream *stream;
    uint32_t frames;
    double error_sum, bias[3]; /* |difference|, and difference by channel, in 8-bit steps */
    double pixels;
};

/* A chroma sample at a place of the luma grid: sited left in x and between the rows in y. */
static double chroma_at(const AVFrame *frame, int plane, int x, int y)
{
    int columns = (frame->width + 1) / 2, rows = (frame->height + 1) / 2;
    double cx = x / 2.0, cy = (y - 0.5) / 2.0;
    cy = cy < 0 ? 0 : cy;
    int x0 = (int)cx, y0 = (int)cy;
    int x1 = x0 + 1 < columns ? x0 + 1 : x0, y1 = y0 + 1 < rows ? y0 + 1 : y0;
    const uint8_t *row0 = frame->data[plane] + (ptrdiff_t)y0 * frame->linesize[plane];
    const uint8_t *row1 = frame->data[plane] + (ptrdiff_t)y1 * frame->linesize[plane];
    double top = row0[x0] + (cx - x0) * (row0[x1] - row0[x0]);
    double bottom = row1[x0] + (cx - x0) * (row1[x1] - row1[x0]);
    return (top + (cy - y0) * (bottom - top) - 128) / 224;
}

/* Back to RGB by the definition of BT.709, in limited range, which is what the tags say. */
static void compare(struct decoded *decoded, const AVFrame *frame, uint32_t number)
{
    const double red_weight = 0.2126, blue_weight = 0.0722;
    assert_int_equal(frame->colorspace, AVCOL_SPC_BT709);
    assert_int_equal(frame->color_range, AVCOL_RANGE_MPEG);
    for (int y = 0; y < frame->height; y++) {
        for (int x = 0; x < frame->width; x++) {
            double luma = (frame->data[0][y * frame->linesize[0] + x] - 16) / 219.0;
            double rgb[3] = {luma + chroma_at(frame, 2, x, y) * 2 * (1 - red_weight), 0,
                             luma + chroma_at(frame, 1, x, y) * 2 * (1 - blue_weight)};
            rgb[1] = (luma - red_weight * rgb[0] - blue_weight * rgb[2]) /
                     (1 - red_weight - blue_weight);
            for (int c = 0; c < 3; c++) {
                double difference = rgb[c] * 255 - test_level(number, (uint32_t)frame->width,
                                                              (uint32_t)x, (uint32_t)y, c);
                decoded->error_sum += fabs(difference);
                decoded->bias[c] += difference;
            }
            decoded->pixels++;
        }
    }
}

static void open_video(struct decoded *decoded, const char *path)
{
    *decoded = (struct decoded){0};
    assert_int_equal(avformat_open_input(&decoded->container, path, NULL, NULL), 0);
    assert_true(avformat_find_stream_info(decoded->container, NULL) >= 0);
    assert_int_equal(decoded->container->nb_streams, 1);
    decoded->stream = decoded->container->streams[0];
    decoded->codec =
        avcodec_alloc_context3(avcodec_find_decoder(decoded->stream->codecpar->codec_id));
    avcodec_parameters_to_context(decoded->codec, decoded->stream->codecpar);
    assert_int_equal(avcodec_open2(decoded->codec, NULL, NULL), 0);
}

/* Decodes every frame; first is the number that the first one has in the scene. */
static void read_video(struct decoded *decoded, uint32_t first)
{
    AVPacket *packet = av_packet_alloc();
    AVFrame *frame = av_frame_alloc();
    bool more = true;
    while (more) {
        more = av_read_frame(decoded->container, packet) >= 0;
        assert_int_equal(avcodec_send_packet(decoded->codec, more ? packet : NULL), 0);
        av_packet_unref(packet);
        while (avcodec_receive_frame(decoded->codec, frame) >= 0) {
            AVRational frame_time = av_inv_q(decoded->stream->avg_frame_rate);
            assert_int_equal(
                av_rescale_q(frame->best_effort_timestamp, decoded->stream->time_base, frame_time),
                decoded->frames);
            compare(decoded, frame, first + decoded->frames);
            decoded->frames++;
        }
    }
    av_frame_free(&frame);
    av_packet_free(&packet);
}

static void close_video(struct decoded *decoded)
{
    avcodec_free_context(&decoded->codec);
    avformat_close_input(&decoded->container);
}

static void frames_and_colours_come_back(void **state)
{
    (void)state;
    static const struct {
        uint32_t first, last, width, height, fps_num, fps_den;
    } cases[] = {
        {0, 29, 128, 72, 30, 1}, {100, 144, 64, 36, 30000, 1001}, {7, 7, 16, 2, 24, 1},
        {0, 1, 2, 2, 1, 3},      {0, 9, 640, 360, 120, 1},
    };
    char folder[32], path[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/x.mp4", folder);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct kiln_frame_range range = {cases[i].first, cases[i].last};
        struct kiln_output_params params = test_output_params(path, &range);
        params.width = cases[i].width;
        params.height = cases[i].height;
        params.fps_num = cases[i].fps_num;
        params.fps_den = cases[i].fps_den;
        params.quality = 95;
        params.overwrite = true;
        struct kiln_error error = {0};
        bool good = test_write_all(&params, &error);
        assert_string_equal(error.message, "");
        assert_true(good);

        struct decoded decoded;
        open_video(&decoded, path);
        read_video(&decoded, range.first);
        assert_int_equal(decoded.frames, range.last - range.first + 1);
        assert_int_equal(decoded.codec->width, params.width);
        assert_int_equal(decoded.codec->height, params.height);
        AVRational rate = {(int)params.fps_num, (int)params.fps_den};
        assert_int_equal(av_cmp_q(decoded.stream->avg_frame_rate, rate), 0);
        double mean_error = decoded.error_sum / (3 * decoded.pixels);
        print_message("%ux%u: mean error %.3f of 255\n", params.width, params.height, mean_error);
        for (int c = 0; c < 3 && params.width >= 64; c++) {
            assert_true(mean_error < 1.5);
            assert_true(fabs(decoded.bias[c]) / decoded.pixels < 0.5);
        }
        close_video(&decoded);
    }
    test_remove_folder(folder);
}

static void tags_say_what_the_pixels_are(void **state)
{
    (void)state;
    char folder[32], path[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/x.mp4", folder);
    const struct kiln_frame_range range = {3, 8};
    struct kiln_output_params params = test_output_params(path, &range);
    struct kiln_error error = {0};
    assert_true(test_write_all(&params, &error));

    struct decoded decoded;
    open_video(&decoded, path);
    const AVCodecParameters *tags = decoded.stream->codecpar; /* from the container */
    assert_int_equal(tags->codec_id, AV_CODEC_ID_H264);
    assert_int_equal(tags->format, AV_PIX_FMT_YUV420P);
    assert_int_equal(tags->color_primaries, AVCOL_PRI_BT709);
    assert_int_equal(tags->color_trc, AVCOL_TRC_IEC61966_2_1);
    assert_int_equal(tags->color_space, AVCOL_SPC_BT709);
    assert_int_equal(tags->color_range, AVCOL_RANGE_MPEG);
    assert_int_equal(tags->chroma_location, AVCHROMA_LOC_LEFT);
    const AVDictionaryEntry *comment = av_dict_get(decoded.container->metadata, "comment", NULL, 0);
    assert_non_null(comment);
    assert_string_equal(comment->value,
                        "kiln:version=" KILN_VERSION " kiln:scene=0123456789abcdef0123456789abcdef"
                        "0123456789abcdef0123456789abcdef"
                        " kiln:seed=4000000007 kiln:frames=3-8");
    close_video(&decoded);
    test_remove_folder(folder);
}

static size_t read_bytes(const char *path, uint8_t **bytes)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    size_t size = (size_t)ftell(file);
    rewind(file);
    *bytes = malloc(size);
    assert_int_equal(fread(*bytes, 1, size, file), size);
    fclose(file);
    return size;
}

static void bytes_depend_on_the_frames_alone(void **state)
{
    (void)state;
    char folder[32], path[64];
    test_make_folder(folder);
    const struct kiln_frame_range range = {0, 39};
    const struct kiln_frame_range split[] = {{0, 12}, {13, 39}};
    uint8_t *bytes[2] = {NULL};
    size_t size[2] = {0};
    for (size_t i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/%zu.mp4", folder, i);
        struct kiln_output_params params = test_output_params(path, i ? split : &range);
        params.range_count = i ? 2 : 1;
        params.threads = i ? 7 : 1;
        params.width = 320;
        params.height = 180;
        struct kiln_error error = {0};
        assert_true(test_write_all(&params, &error));
        size[i] = read_bytes(path, &bytes[i]);
    }
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(bytes[0], bytes[1], size[0]);
    /* The index stands before the pictures. */
    const uint8_t *moov = memmem(bytes[0], size[0], "moov", 4);
    const uint8_t *mdat = memmem(bytes[0], size[0], "mdat", 4);
    assert_true(moov && mdat && moov < mdat);
    free(bytes[0]);
    free(bytes[1]);
    test_remove_folder(folder);
}

static void quality_sets_the_size(void **state)
{
    (void)state;
    char folder[32], path[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/x.mp4", folder);
    const struct kiln_frame_range range = {0, 9};
    size_t before = 0;
    for (uint32_t quality = 0; quality <= 100; quality += 50) {
        struct kiln_output_params params = test_output_params(path, &range);
        params.width = 320;
        params.height = 180;
        params.quality = quality;
        params.overwrite = true;
        struct kiln_error error = {0};
        assert_true(test_write_all(&params, &error));
        uint8_t *bytes = NULL;
        size_t size = read_bytes(path, &bytes);
        free(bytes);
        assert_true(size > before);
        before = size;
    }
    test_remove_folder(folder);
}

static void refuse(struct kiln_output_params params, enum kiln_code code, const char *message)
{
    struct kiln_error error = {0};
    assert_null(kiln_output_open(&params, &error));
    expect_error(&error, code, "%s: %s", params.path, message);
}

static void impossible_videos_are_refused(void **state)
{
    (void)state;
    char folder[32], path[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/x.mp4", folder);
    const struct kiln_frame_range gap[] = {{0, 9}, {11, 19}};
    const struct kiln_output_params good = test_output_params(path, gap);
    struct kiln_output_params params = good;
    params.width = 63;
    params.height = 35;
    refuse(params, KILN_USAGE,
           "the video would have 63 x 35 pixels; H.264 needs even sizes, the nearest is 64x36");
    params = good;
    params.range_count = 2;
    refuse(params, KILN_USAGE,
           "a clip cannot leave out frames, but frame 10 would be missing; write images, or one "
           "range");
    params = good;
    params.alpha = true;
    refuse(params, KILN_USAGE,
           "the backdrop is transparent, but an MP4 video has no alpha; write images, a .webm or a "
           ".mov, or make the backdrop opaque");
    params = good;
    params.quality = 101;
    refuse(params, KILN_USAGE, "found quality 101; allowed are 0 to 100");
    params = good;
    params.fps_den = 0;
    refuse(params, KILN_USAGE, "found 30/0 frames a second, which is not a frame rate for a video");
    params = good;
    params.path = "x_%04d.mp4";
    refuse(params, KILN_USAGE,
           "a video or flipbook is one file, so its name cannot have a frame number");
    params = good;
    params.width = 40000;
    refuse(params, KILN_USAGE,
           "the video would have 40000 x 36 pixels; H.264 allows at most 16384 a side");
    kiln_ff.avcodec_find_encoder_by_name = find_no_encoder;
    refuse(good, KILN_IO,
           "this FFmpeg has no encoder libx264; install one that was built with it (on Debian, "
           "libavcodec59 and libx264-164)");
    assert_int_equal(test_count_files(folder), 0);
    test_remove_folder(folder);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_and_colours_come_back),
        cmocka_unit_test(tags_say_what_the_pixels_are),
        cmocka_unit_test(bytes_depend_on_the_frames_alone),
        cmocka_unit_test(quality_sets_the_size),
        cmocka_unit_test(impossible_videos_are_refused),
    };
    return cmocka_run_group_tests_name("video", tests, NULL, NULL);
}
