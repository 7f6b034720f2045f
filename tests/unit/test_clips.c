/* Every format of clips, written and decoded again: frames, times, sizes, alpha, colours, tags; the
 * same bytes with any number of threads; and what cannot be held is refused or said. */
#include <libavformat/avformat.h>
#include <libavutil/pixdesc.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <unistd.h>

#include "asset/image/video_in.h"
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

static const struct clip_format {
    const char *suffix;
    enum AVCodecID codec;
    const char *pixels, *pixels_alpha; /* as decoded; NULL: none */
    bool lossless, deep;               /* deep: may have 16 bits a channel */
    bool given_deep;                   /* always is given them */
    double tolerance;                  /* mean error in 8-bit steps */
    double rate_error;                 /* relative */
} formats[] = {
    {"webm", AV_CODEC_ID_VP9, "yuv420p", "yuv420p", false, false, false, 2, 1e-6},
    {"mkv", AV_CODEC_ID_FFV1, "bgr0", "bgra", true, true, false, 0, 1e-6},
    {"mov", AV_CODEC_ID_PRORES, "yuv444p12le", "yuva444p12le", false, false, true, 0.6, 0},
    {"apng", AV_CODEC_ID_APNG, "rgb24", "rgba", true, true, false, 0, 0},
    {"gif", AV_CODEC_ID_GIF, "bgra", NULL, false, false, true, 4.0, 0.02},
};
enum { FORMAT_COUNT = sizeof formats / sizeof *formats };

static char folder[32];

static int make_folder(void **state)
{
    (void)state;
    test_make_folder(folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    test_remove_folder(folder);
    return 0;
}

static void keep_line(void *user, enum kiln_log_level level, const char *line)
{
    if (level == KILN_LOG_WARNING)
        snprintf(user, 256, "%s", line);
}

static void write_clip(const struct kiln_output_params *params)
{
    struct kiln_error error = {0};
    bool good = test_write_all(params, &error);
    assert_string_equal(error.message, "");
    assert_true(good);
    assert_int_equal(test_count_files(folder), 1);
}

/* The sample that test_picture gave the output, in 8-bit steps. */
static double wanted(const struct kiln_output_params *params, uint32_t frame, uint32_t x,
                     uint32_t y, int channel, bool deep)
{
    uint32_t level = test_level(frame, params->width, x, y, channel);
    if (channel == 3 && !params->alpha)
        return 255;
    return deep ? (double)(level * 256 + x) / 257 : level;
}

/* Decodes all frames; returns the mean error, colours by their alpha, in 8-bit steps. */
static double read_back(const struct kiln_output_params *params, bool deep)
{
    struct kiln_error error = {0};
    struct kiln_video_in *video = kiln_video_in_open(NULL, params->path, &error);
    assert_string_equal(error.message, "");
    double sum = 0, weights = 0;
    uint32_t frame = params->ranges[0].first;
    struct kiln_asset_image *image;
    for (;; frame++) {
        assert_true(kiln_video_in_read(video, &image, &error));
        if (!image)
            break;
        assert_int_equal(image->width, params->width);
        assert_int_equal(image->height, params->height);
        assert_int_equal(image->channels, params->alpha ? 4 : 3);
        bool wide = image->type == KILN_IMAGE_U16;
        for (uint32_t i = 0; i < image->width * image->height; i++) {
            uint32_t x = i % image->width, y = i / image->width;
            double alpha = wanted(params, frame, x, y, 3, deep) / 255;
            for (int c = 0; c < 4; c++) {
                size_t at = 4 * (size_t)i + (size_t)c;
                double found =
                    wide ? ((uint16_t *)image->pixels)[at] / 257.0 : ((uint8_t *)image->pixels)[at];
                double weight = c < 3 ? alpha : 1;
                sum += weight * fabs(found - wanted(params, frame, x, y, c, deep));
                weights += weight;
            }
        }
        kiln_asset_image_destroy(&image);
    }
    kiln_video_in_close(&video);
    assert_int_equal(frame, params->ranges[params->range_count - 1].last + 1);
    return sum / weights;
}

static void check_stream(const struct clip_format *format, const struct kiln_output_params *params)
{
    AVFormatContext *container = NULL;
    assert_int_equal(avformat_open_input(&container, params->path, NULL, NULL), 0);
    assert_true(avformat_find_stream_info(container, NULL) >= 0);
    assert_int_equal(container->nb_streams, 1);
    const AVStream *stream = container->streams[0];
    const AVCodecParameters *tags = stream->codecpar;
    assert_int_equal(tags->codec_id, format->codec);
    assert_int_equal(tags->width, params->width);
    assert_int_equal(tags->height, params->height);
    assert_string_equal(av_get_pix_fmt_name(tags->format),
                        params->alpha ? format->pixels_alpha : format->pixels);
    double rate = av_q2d(stream->avg_frame_rate) * params->fps_den / params->fps_num;
    assert_true(fabs(rate - 1) <= format->rate_error);
    const AVPixFmtDescriptor *layout = av_pix_fmt_desc_get(tags->format);
    if (!(layout->flags & AV_PIX_FMT_FLAG_RGB)) {
        assert_int_equal(tags->color_space, AVCOL_SPC_BT709);
        assert_int_equal(tags->color_range, AVCOL_RANGE_MPEG);
    }
    if (format->codec != AV_CODEC_ID_APNG && format->codec != AV_CODEC_ID_GIF) {
        assert_int_equal(tags->color_primaries, AVCOL_PRI_BT709);
        assert_int_equal(tags->color_trc, AVCOL_TRC_IEC61966_2_1);
        const AVDictionaryEntry *comment = av_dict_get(container->metadata, "comment", NULL, 0);
        assert_non_null(comment);
        assert_non_null(strstr(comment->value, " kiln:seed=4000000007 kiln:frames="));
    }
    avformat_close_input(&container);
}

static void clips_come_back(void **state)
{
    (void)state;
    static const struct {
        uint32_t first, last, width, height, fps_num, fps_den;
    } sizes[] = {{0, 11, 96, 64, 30, 1}, {100, 124, 65, 37, 30000, 1001}, {0, 5, 161, 48, 25, 2}};
    char path[64];
    for (size_t i = 0; i < 2 * FORMAT_COUNT * 3; i++) {
        const struct clip_format *format = &formats[i / 6];
        const bool alpha = i % 2 == 1;
        if (alpha && !format->pixels_alpha)
            continue;
        snprintf(path, sizeof path, "%s/clip.%s", folder, format->suffix);
        const struct kiln_frame_range range = {sizes[i / 2 % 3].first, sizes[i / 2 % 3].last};
        struct kiln_output_params params = test_output_params(path, &range);
        params.width = sizes[i / 2 % 3].width;
        params.height = sizes[i / 2 % 3].height;
        params.fps_num = sizes[i / 2 % 3].fps_num;
        params.fps_den = sizes[i / 2 % 3].fps_den;
        params.quality = 95;
        params.alpha = alpha;
        write_clip(&params);
        check_stream(format, &params);
        double error = read_back(&params, format->given_deep);
        print_message("%s %ux%u%s: mean error %.3f of 255\n", format->suffix, params.width,
                      params.height, alpha ? " with alpha" : "", error);
        assert_true(error <= format->tolerance);
        unlink(path);
    }
}

static void lossless_ones_hold_16_bits(void **state)
{
    (void)state;
    char path[64];
    const struct kiln_frame_range range = {3, 6};
    for (size_t i = 0; i < 2 * FORMAT_COUNT; i++) {
        if (!formats[i / 2].deep)
            continue;
        snprintf(path, sizeof path, "%s/clip.%s", folder, formats[i / 2].suffix);
        struct kiln_output_params params = test_output_params(path, &range);
        params.alpha = i % 2 == 1;
        params.png_bits = 16;
        write_clip(&params);
        assert_true(read_back(&params, true) <= 0);
        unlink(path);
    }
}

static void the_smallest_picture_alone_will_do(void **state)
{
    (void)state;
    char path[64];
    const struct kiln_frame_range range = {7, 7};
    for (size_t i = 0; i < FORMAT_COUNT; i++) {
        snprintf(path, sizeof path, "%s/clip.%s", folder, formats[i].suffix);
        struct kiln_output_params params = test_output_params(path, &range);
        params.width = params.height = 16;
        write_clip(&params);
        if (formats[i].codec != AV_CODEC_ID_APNG) /* one frame is a plain PNG */
            assert_true(read_back(&params, formats[i].given_deep) <= 8);
        unlink(path);
    }
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
    static const char *const suffixes[] = {"webm", "mkv", "mov", "apng", "gif", "webp"};
    static const char version[] = AV_STRINGIFY(LIBAVFORMAT_VERSION);
    const struct kiln_frame_range range = {0, 29}, split[] = {{0, 12}, {13, 29}};
    char path[64];
    for (size_t f = 0; f < sizeof suffixes / sizeof *suffixes; f++) {
        uint8_t *bytes[2] = {NULL};
        size_t size[2] = {0};
        snprintf(path, sizeof path, "%s/clip.%s", folder, suffixes[f]);
        for (size_t i = 0; i < 2; i++) {
            struct kiln_output_params params = test_output_params(path, i ? split : &range);
            params.range_count = i ? 2 : 1;
            params.threads = i ? 7 : 1;
            params.width = 640; /* several tiles of VP9 */
            params.height = 90;
            write_clip(&params);
            size[i] = read_bytes(path, &bytes[i]);
            unlink(path);
        }
        assert_int_equal(size[0], size[1]);
        assert_memory_equal(bytes[0], bytes[1], size[0]);
        assert_null(memmem(bytes[0], size[0], version, strlen(version)));
        assert_null(memmem(bytes[0], size[0], "Lavc", 4));
        free(bytes[0]);
        free(bytes[1]);
    }
}

/* ---- GIF ----------------------------------------------------------------------------------- */

/* Frames of a GIF and the sum of their delays in 1/100 s. */
static uint32_t gif_times(const char *path, int64_t *sum)
{
    AVFormatContext *container = NULL;
    AVPacket *packet = av_packet_alloc();
    assert_int_equal(avformat_open_input(&container, path, NULL, NULL), 0);
    uint32_t frames = 0;
    for (*sum = 0; av_read_frame(container, packet) >= 0; frames++) {
        assert_true(packet->duration >= 2);
        *sum += packet->duration;
        av_packet_unref(packet);
    }
    av_packet_free(&packet);
    avformat_close_input(&container);
    return frames;
}

static void gif_keeps_time_and_says_how(void **state)
{
    (void)state;
    static const struct {
        uint32_t fps_num, fps_den, last, frames;
        int64_t ticks;
        const char *line;
    } cases[] = {
        {25, 1, 24, 25, 100, ""},
        {50, 1, 9, 10, 20, ""},
        {30, 1, 29, 30, 100,
         "clip.gif: GIF counts times in 1/100 s; at 30 frames a second, frames last 0.03 or 0.04 "
         "s, on average 0.0333 s"},
        {60, 1, 30, 16, 52,
         "clip.gif: GIF plays at most 50 frames a second; of the 60 frames a second, 1 in 2 is "
         "written; frames last 0.03 or 0.04 s, on average 0.0333 s"},
        {100, 1, 9, 5, 10,
         "clip.gif: GIF plays at most 50 frames a second; of the 100 frames a second, 1 in 2 is "
         "written"},
        {100, 1, 8, 5, 10, /* the last frame alone would last 1/100 s */
         "clip.gif: GIF plays at most 50 frames a second; of the 100 frames a second, 1 in 2 is "
         "written"},
        {120, 1, 9, 4, 10, /* and here nothing */
         "clip.gif: GIF plays at most 50 frames a second; of the 120 frames a second, 1 in 3 is "
         "written; frames last 0.02 or 0.03 s, on average 0.0250 s"},
        {1, 3, 1, 2, 600, ""},
    };
    char path[64], line[256];
    snprintf(path, sizeof path, "%s/clip.gif", folder);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct kiln_frame_range range = {0, cases[i].last};
        struct kiln_output_params params = test_output_params(path, &range);
        params.fps_num = cases[i].fps_num;
        params.fps_den = cases[i].fps_den;
        params.log = (struct kiln_log){keep_line, line};
        line[0] = '\0';
        write_clip(&params);
        int64_t ticks;
        assert_int_equal(gif_times(path, &ticks), cases[i].frames);
        assert_int_equal(ticks, cases[i].ticks);
        assert_string_equal(*line ? line + strlen(folder) + 1 : line, cases[i].line);
        unlink(path);
    }
}

/* Writes a clip of three frames. Returns the last warning without its path, or "". */
static const char *warning_at(const char *name, uint32_t num, uint32_t den, char line[256])
{
    char path[64];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    const struct kiln_frame_range range = {0, 2};
    struct kiln_output_params params = test_output_params(path, &range);
    params.fps_num = num;
    params.fps_den = den;
    params.log = (struct kiln_log){keep_line, line};
    line[0] = '\0';
    write_clip(&params);
    unlink(path);
    return *line ? line + strlen(path) + 2 : line;
}

static void rates_that_do_not_fit_are_told(void **state)
{
    (void)state;
    char line[256];
    assert_string_equal(warning_at("clip.apng", 120000, 1001, line),
                        "APNG cannot hold 120000/1001 frames a second, so the file has 40999/342");
    assert_string_equal(warning_at("clip.webp", 90, 1, line), "");
    assert_string_equal(warning_at("clip.webp", 91, 1, line),
                        "browsers play WebP at 91 frames a second as slowly as at 10; they play at "
                        "most 90 as they should");
}

/* ---- WebP: FFmpeg cannot read what it writes ------------------------------------------------- */

static uint32_t little(const uint8_t *bytes, int count)
{
    uint32_t value = 0;
    for (int i = 0; i < count; i++)
        value |= (uint32_t)bytes[i] << (8 * i);
    return value;
}

struct webp {
    uint32_t frames, width, height, loops, duration_ms;
    bool alpha;
    double error, samples;
    uint8_t canvas[64 * 36 * 4];
};

/* A frame's data as an image file of its own, laid over the canvas. */
static void draw_webp_frame(struct webp *webp, const uint8_t *frame, uint32_t size)
{
    uint32_t left = 2 * little(frame, 3), top = 2 * little(frame + 3, 3);
    uint32_t width = little(frame + 6, 3) + 1, height = little(frame + 9, 3) + 1;
    webp->duration_ms += little(frame + 12, 3);
    bool blend = !(frame[15] & 2), dispose = frame[15] & 1;
    assert_false(dispose); /* libwebp's encoder could; it does not for such clips */

    bool has_alpha = memcmp(frame + 16, "ALPH", 4) == 0;
    uint32_t data = size - 16, header = has_alpha ? 30 : 12;
    uint8_t *file = calloc(1, header + data);
    memcpy(file, "RIFF\0\0\0\0WEBPVP8X\x0a\0\0\0\x10\0\0\0", header < 24 ? header : 24);
    for (int i = 0; i < 4; i++)
        file[4 + i] = (uint8_t)((header + data - 8) >> (8 * i));
    if (has_alpha) {
        memcpy(file + 24, frame + 6, 6);
    }
    memcpy(file + header, frame + 16, data);
    struct kiln_error error = {0};
    struct kiln_asset_image *image =
        kiln_asset_image_parse(file, header + data, "frame.webp", &error);
    assert_string_equal(error.message, "");
    assert_int_equal(image->width, width);
    assert_int_equal(image->height, height);
    for (uint32_t i = 0; i < width * height; i++) {
        const uint8_t *pixel = (uint8_t *)image->pixels + 4 * (size_t)i;
        uint32_t x = left + i % width, y = top + i / width;
        if (!blend || pixel[3] == 255)
            memcpy(webp->canvas + 4 * ((size_t)y * 64 + x), pixel, 4);
        else
            assert_int_equal(pixel[3], 0);
    }
    kiln_asset_image_destroy(&image);
    free(file);
}

static void compare_webp_frame(struct webp *webp, const struct kiln_output_params *params)
{
    for (uint32_t i = 0; i < params->width * params->height * 4; i++) {
        uint32_t pixel = i / 4, x = pixel % params->width, y = pixel / params->width;
        double value =
            wanted(params, params->ranges[0].first + webp->frames, x, y, (int)(i % 4), false);
        webp->error += fabs(webp->canvas[i] - value);
        webp->samples++;
    }
}

static void read_webp(struct webp *webp, const struct kiln_output_params *params)
{
    uint8_t *bytes;
    size_t size = read_bytes(params->path, &bytes);
    assert_memory_equal(bytes, "RIFF", 4);
    assert_int_equal(little(bytes + 4, 4) + 8, size);
    *webp = (struct webp){0};
    for (size_t at = 12; at < size;) {
        const uint8_t *chunk = bytes + at;
        uint32_t length = little(chunk + 4, 4);
        if (memcmp(chunk, "VP8X", 4) == 0) {
            webp->alpha = chunk[8] & 0x10;
            webp->width = little(chunk + 12, 3) + 1;
            webp->height = little(chunk + 15, 3) + 1;
        } else if (memcmp(chunk, "ANIM", 4) == 0) {
            webp->loops = little(chunk + 12, 2);
        } else if (memcmp(chunk, "ANMF", 4) == 0) {
            draw_webp_frame(webp, chunk + 8, length);
            compare_webp_frame(webp, params);
            webp->frames++;
        }
        at += 8 + length + (length & 1);
    }
    free(bytes);
}

static void webp_comes_back(void **state)
{
    (void)state;
    char path[64];
    snprintf(path, sizeof path, "%s/clip.webp", folder);
    for (int i = 0; i < 4; i++) {
        const struct kiln_frame_range range = {10, 39};
        struct kiln_output_params params = test_output_params(path, &range);
        bool lossless = i / 2 == 1;
        params.alpha = i % 2 == 1;
        params.quality = lossless ? 100 : 95;
        write_clip(&params);
        struct webp webp;
        read_webp(&webp, &params);
        assert_int_equal(webp.frames, 30);
        assert_int_equal(webp.width, 64);
        assert_int_equal(webp.height, 36);
        assert_int_equal(webp.loops, 0);
        assert_true(webp.alpha || !params.alpha); /* lossless frames may leave out what stays */
        assert_in_range(webp.duration_ms, 999, 1001);
        double error = webp.error / webp.samples;
        print_message("webp%s%s: mean error %.3f of 255\n", lossless ? ", lossless" : "",
                      params.alpha ? ", alpha" : "", error);
        assert_true(error <= (lossless ? 0 : 2));
        unlink(path);
    }
}

/* ---- What cannot be ------------------------------------------------------------------------- */

static void refuse(struct kiln_output_params params, const char *suffix, enum kiln_code code,
                   const char *message)
{
    char path[64];
    snprintf(path, sizeof path, "%s/x.%s", folder, suffix);
    params.path = path;
    struct kiln_error error = {0};
    assert_null(kiln_output_open(&params, &error));
    expect_error(&error, code, "%s: %s", path, message);
    assert_int_equal(test_count_files(folder), 0);
}

static void impossible_clips_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *suffix, *encoder, *packages;
    } encoders[] = {{"webm", "libvpx-vp9", "libavcodec59 and libvpx7"},
                    {"mkv", "ffv1", "libavcodec59"},
                    {"mov", "prores_ks", "libavcodec59"},
                    {"apng", "apng", "libavcodec59"},
                    {"gif", "gif", "libavcodec59"},
                    {"webp", "libwebp_anim", "libavcodec59, libwebp7 and libwebpmux3"}};
    const struct kiln_frame_range range = {0, 9};
    const struct kiln_output_params good = test_output_params("", &range);
    struct kiln_output_params params = good;
    params.alpha = true;
    refuse(params, "gif", KILN_USAGE,
           "the backdrop is transparent, but a GIF animation has no alpha; write images, a .webm "
           "or a .mov, or make the backdrop opaque");
    params = good;
    params.fps_num = 1;
    params.fps_den = 656;
    refuse(params, "gif", KILN_USAGE,
           "the rate is 1/656 frames a second, but GIF shows a frame for at most 655.35 s");
    params = good;
    params.width = 16384;
    refuse(params, "webp", KILN_USAGE,
           "the video would have 16384 x 36 pixels; WebP allows at most 16383 a side");
    params = good;
    params.quality = 101;
    refuse(params, "webm", KILN_USAGE, "found quality 101; allowed are 0 to 100");
    params = good;
    params.png_bits = 12;
    refuse(params, "mkv", KILN_USAGE, "found 12 bits a channel; allowed are 8 or 16");
    __typeof__(avcodec_find_encoder_by_name) *find = kiln_ff.avcodec_find_encoder_by_name;
    kiln_ff.avcodec_find_encoder_by_name = find_no_encoder;
    for (size_t i = 0; i < sizeof encoders / sizeof *encoders; i++) {
        char message[160];
        snprintf(
            message, sizeof message,
            "this FFmpeg has no encoder %s; install one that was built with it (on Debian, %s)",
            encoders[i].encoder, encoders[i].packages);
        refuse(good, encoders[i].suffix, KILN_IO, message);
    }
    kiln_ff.avcodec_find_encoder_by_name = find;
}

/* Ending early leaves nothing: neither the file nor the frames that wait for a palette. */
static void what_is_not_finished_is_removed(void **state)
{
    (void)state;
    static const char *const suffixes[] = {"webm", "mkv", "mov", "apng", "gif", "webp"};
    const struct kiln_frame_range range = {0, 9};
    char path[64];
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++) {
        snprintf(path, sizeof path, "%s/clip.%s", folder, suffixes[i]);
        const struct kiln_output_params params = test_output_params(path, &range);
        struct kiln_error error = {0};
        struct kiln_output *output = kiln_output_open(&params, &error);
        assert_non_null(output);
        for (uint32_t frame = 0; frame < 5; frame++)
            assert_true(kiln_output_write(output, test_picture(output, &params, frame), &error));
        assert_true(test_count_files(folder) > 0);
        kiln_output_close(&output);
        assert_int_equal(test_count_files(folder), 0);
    }
}

/* FFmpeg would take what is left; a comparison must not. */
static void what_was_cut_short_is_not_read(void **state)
{
    (void)state;
    static const char CUT[] = "the video is cut short",
                      BROKEN[] = "the video is broken or cut short",
                      GIF[] = "the GIF image is broken or cut short";
    static const char *const cases[][2] = {
        {"gif", GIF}, {"apng", CUT}, {"mkv", BROKEN}, {"webm", BROKEN}, {"mov", CUT}};
    const struct kiln_frame_range range = {0, 9};
    char path[64];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        snprintf(path, sizeof path, "%s/clip.%s", folder, cases[i][0]);
        const struct kiln_output_params params = test_output_params(path, &range);
        write_clip(&params);
        uint8_t *bytes;
        off_t size = (off_t)read_bytes(path, &bytes);
        free(bytes);
        assert_int_equal(truncate(path, size - size / 10), 0);
        struct kiln_error error = {0};
        struct kiln_video_in *video = kiln_video_in_open(NULL, path, &error);
        struct kiln_asset_image *image = NULL;
        bool good = video != NULL, more = good;
        while (more) {
            good = kiln_video_in_read(video, &image, &error);
            more = good && image;
            kiln_asset_image_destroy(&image);
        }
        assert_false(good);
        expect_error_decoding(&error, KILN_INVALID_INPUT, "%s: %s", path, cases[i][1]);
        kiln_video_in_close(&video);
        unlink(path);
    }
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_folder, remove_folder)

int main(void)
{
    static const struct CMUnitTest tests[] = {
        TEST(clips_come_back),
        TEST(lossless_ones_hold_16_bits),
        TEST(the_smallest_picture_alone_will_do),
        TEST(bytes_depend_on_the_frames_alone),
        TEST(gif_keeps_time_and_says_how),
        TEST(rates_that_do_not_fit_are_told),
        TEST(webp_comes_back),
        TEST(impossible_clips_are_refused),
        TEST(what_is_not_finished_is_removed),
        TEST(what_was_cut_short_is_not_read),
    };
    return cmocka_run_group_tests_name("clips", tests, NULL, NULL);
}
