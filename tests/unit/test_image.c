/* lib/asset/image: every format is decoded, and what is no good image is refused by name. */
#include <libavcodec/avcodec.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asset/image/image.h"
#include "support/cmocka.h"
#include "support/errors.h"

enum { WIDTH = 29, HEIGHT = 13 };

#define NOT_FINITE "the image is cut short, or has pixels that are not finite numbers"
#define ALLOWED    "allowed are PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or HDR files"

static const struct source {
    const char *name; /* in messages */
    enum AVCodecID codec;
    enum AVPixelFormat pixels;
    enum kiln_image_type type;
    bool alpha;
    int tolerance; /* 8-bit steps */
} sources[] = {
    {"PNG", AV_CODEC_ID_PNG, AV_PIX_FMT_RGBA, KILN_IMAGE_U8, true, 0},
    {"PNG", AV_CODEC_ID_PNG, AV_PIX_FMT_RGB24, KILN_IMAGE_U8, false, 0},
    {"PNG", AV_CODEC_ID_PNG, AV_PIX_FMT_RGBA64BE, KILN_IMAGE_U16, true, 0},
    {"TIFF", AV_CODEC_ID_TIFF, AV_PIX_FMT_RGB24, KILN_IMAGE_U8, false, 0},
    {"BMP", AV_CODEC_ID_BMP, AV_PIX_FMT_BGR24, KILN_IMAGE_U8, false, 0},
    {"JPEG", AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ444P, KILN_IMAGE_U8, false, 8},
    {"WebP", AV_CODEC_ID_WEBP, AV_PIX_FMT_BGRA, KILN_IMAGE_U8, true, 0},
    {"EXR", AV_CODEC_ID_EXR, AV_PIX_FMT_GBRAPF32, KILN_IMAGE_F32, true, 1},
};

static uint8_t expected(int x, int y, int channel)
{
    int value[4] = {x * 8, y * 16, 255 - x * 4 - y * 8, 255 - x * 2};
    return (uint8_t)value[channel];
}

/* swscale's ways to these two layouts are not exact, so they are written by hand. */
static void fill_float(AVFrame *frame)
{
    static const int plane_of[4] = {2, 0, 1, 3};
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            for (int c = 0; c < 4; c++) {
                uint8_t *row = frame->data[plane_of[c]] + y * frame->linesize[plane_of[c]];
                float value = (float)expected(x, y, c) / 255.0f;
                memcpy(row + x * 4, &value, sizeof value);
            }
        }
    }
}

static void fill_deep(AVFrame *frame)
{
    for (int y = 0; y < HEIGHT; y++) {
        for (int i = 0; i < WIDTH * 4; i++)
            memset(frame->data[0] + y * frame->linesize[0] + i * 2, expected(i / 4, y, i % 4), 2);
    }
}

static AVFrame *make_frame(enum AVPixelFormat format)
{
    AVFrame *frame = av_frame_alloc();
    frame->width = WIDTH;
    frame->height = HEIGHT;
    frame->format = format;
    assert_int_equal(av_frame_get_buffer(frame, 0), 0);
    if (format == AV_PIX_FMT_GBRAPF32) {
        fill_float(frame);
        return frame;
    }
    if (format == AV_PIX_FMT_RGBA64BE) {
        fill_deep(frame);
        return frame;
    }
    uint8_t rgba[HEIGHT + 1][WIDTH][4];
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 4; c++)
                rgba[y][x][c] = expected(x, y, c);
    struct SwsContext *scaler =
        sws_getContext(WIDTH, HEIGHT, AV_PIX_FMT_RGBA, WIDTH, HEIGHT, format,
                       SWS_BICUBIC | SWS_ACCURATE_RND, NULL, NULL, NULL);
    const uint8_t *rows[4] = {rgba[0][0]};
    int strides[4] = {WIDTH * 4};
    sws_scale(scaler, rows, strides, 0, HEIGHT, frame->data, frame->linesize);
    sws_freeContext(scaler);
    return frame;
}

/* A file of the format in memory, or NULL when this FFmpeg cannot write it. */
static AVPacket *encode(const struct source *source)
{
    const AVCodec *codec = avcodec_find_encoder(source->codec);
    if (!codec)
        return NULL;
    AVFrame *frame = make_frame(source->pixels);
    AVCodecContext *encoder = avcodec_alloc_context3(codec);
    encoder->width = WIDTH;
    encoder->height = HEIGHT;
    encoder->pix_fmt = source->pixels;
    encoder->time_base = (AVRational){1, 1};
    encoder->flags = AV_CODEC_FLAG_QSCALE;
    encoder->global_quality = FF_QP2LAMBDA;
    av_opt_set(encoder, "lossless", "1", AV_OPT_SEARCH_CHILDREN); /* WebP has it */
    assert_int_equal(avcodec_open2(encoder, codec, NULL), 0);
    AVPacket *packet = av_packet_alloc();
    assert_int_equal(avcodec_send_frame(encoder, frame), 0);
    assert_int_equal(avcodec_send_frame(encoder, NULL), 0);
    assert_int_equal(avcodec_receive_packet(encoder, packet), 0);
    avcodec_free_context(&encoder);
    av_frame_free(&frame);
    return packet;
}

static int component(const struct kiln_asset_image *image, size_t index)
{
    if (image->type == KILN_IMAGE_U8)
        return ((const uint8_t *)image->pixels)[index];
    if (image->type == KILN_IMAGE_U16)
        return ((const uint16_t *)image->pixels)[index] / 257;
    return (int)lroundf(((const float *)image->pixels)[index] * 255.0f);
}

static void every_format_is_decoded(void **state)
{
    (void)state;
    av_log_set_level(AV_LOG_ERROR);
    for (size_t i = 0; i < sizeof sources / sizeof *sources; i++) {
        AVPacket *file = encode(&sources[i]);
        if (!file)
            continue;
        struct kiln_error error = {0};
        struct kiln_asset_image *image =
            kiln_asset_image_parse(file->data, (size_t)file->size, "test", &error);
        assert_string_equal(error.message, "");
        assert_non_null(image);
        assert_int_equal(image->width, WIDTH);
        assert_int_equal(image->height, HEIGHT);
        assert_int_equal(image->type, sources[i].type);
        assert_int_equal(image->srgb, image->type != KILN_IMAGE_F32);
        assert_int_equal(image->premultiplied, image->type == KILN_IMAGE_F32);
        for (int y = 0; y < HEIGHT; y++) {
            for (int x = 0; x < WIDTH; x++) {
                for (int c = 0; c < 4; c++) {
                    int wanted = c == 3 && !sources[i].alpha ? 255 : expected(x, y, c);
                    int found = component(image, (size_t)((y * WIDTH + x) * 4 + c));
                    assert_true(abs(found - wanted) <= sources[i].tolerance);
                }
            }
        }
        kiln_asset_image_destroy(&image);
        assert_null(image);
        av_packet_free(&file);
    }
}

/* A file that ends within its header is not known as an image, or its decoder says why it
 * cannot read the file. */
static void expect_cut(const struct source *source, size_t size, const struct kiln_error *error)
{
    enum { WEBP_SIGNATURE = 12 };
    if (size == 0)
        expect_error(error, KILN_INVALID_INPUT, "cut.img: the image file is empty");
    else if (source->codec == AV_CODEC_ID_WEBP && size < WEBP_SIGNATURE)
        expect_error(
            error, KILN_INVALID_INPUT,
            "cut.img: the file is not an image: it starts with the bytes 52 49 46 46; " ALLOWED);
    else
        expect_error_decoding(error, KILN_INVALID_INPUT,
                              "cut.img: the %s image is broken or cut short", source->name);
}

static void truncated_files_are_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof sources / sizeof *sources; i++) {
        AVPacket *file = encode(&sources[i]);
        if (!file)
            continue;
        size_t whole = (size_t)file->size;
        for (size_t size = 0; size < whole; size += 1 + whole / 20) {
            struct kiln_error error = {0};
            if (kiln_asset_image_parse(file->data, size, "cut.img", &error)) {
                printf("src %zu cut %zu of %zu\n", i, size, whole);
                continue;
            }
            expect_cut(&sources[i], size, &error);
        }
        av_packet_free(&file);
    }
}

static void put_be32(uint8_t *out, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        out[i] = (uint8_t)(value >> (24 - 8 * i));
}

static uint32_t png_crc(const uint8_t *bytes, size_t size)
{
    uint32_t crc = UINT32_MAX;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

/* A PNG whose header claims another size; the checksum is right. */
static void claimed_sizes_are_limited(void **state)
{
    (void)state;
    static const struct {
        uint32_t width, height;
    } claims[] = {{0, 0}, {100000, 1}, {1, 16385}, {100000, 100000}, {16384, 8192}};
    for (size_t i = 0; i < sizeof claims / sizeof *claims; i++) {
        AVPacket *file = encode(&sources[0]);
        assert_non_null(file);
        put_be32(file->data + 16, claims[i].width);
        put_be32(file->data + 20, claims[i].height);
        put_be32(file->data + 29, png_crc(file->data + 12, 17));
        struct kiln_error error = {0};
        assert_null(kiln_asset_image_parse(file->data, (size_t)file->size, "big.png", &error));
        if (claims[i].width == 0) /* libpng says so */
            expect_error_decoding(&error, KILN_INVALID_INPUT,
                                  "big.png: the PNG image is broken or cut short");
        else
            expect_error(&error, KILN_INVALID_INPUT,
                         "big.png: PNG image of %u x %u pixels; allowed are 1 to 16384 a side and "
                         "at most 67108864 in all",
                         claims[i].width, claims[i].height);
        av_packet_free(&file);
    }
}

static void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void files_are_told_from_other_things(void **state)
{
    (void)state;
    char folder[] = "/tmp/kiln-image-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/x.png", folder);

    struct kiln_error error = {0};
    assert_false(kiln_asset_image_check(NULL, path, &error));
    expect_error(&error, KILN_IO, "%s: the image cannot be opened: No such file or directory",
                 path);
    assert_false(kiln_asset_image_check(NULL, folder, &error));
    expect_error(&error, KILN_INVALID_INPUT, "%s: the path is not a file but a folder; " ALLOWED,
                 folder);
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_false(kiln_asset_image_check(NULL, path, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "%s: the path is not a file but a device or pipe; " ALLOWED, path);
    assert_int_equal(unlink(path), 0);
    assert_false(kiln_asset_image_check(NULL, "/proc/self/mem", &error)); /* nothing lies at 0 */
    expect_error(&error, KILN_IO,
                 "/proc/self/mem: the image file cannot be read: Input/output error");

    write_file(path, "", 0);
    assert_false(kiln_asset_image_check(NULL, path, &error));
    expect_error(&error, KILN_INVALID_INPUT, "%s: the image file is empty", path);
    write_file(path, "kiln: 1\n", 8);
    assert_false(kiln_asset_image_check(NULL, path, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "%s: the file is not an image: it starts with the bytes 6b 69 6c 6e; " ALLOWED,
                 path);
    assert_int_equal(truncate(path, (off_t)KILN_MAX_IMAGE_BYTES + 1), 0);
    assert_false(kiln_asset_image_check(NULL, path, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "%s: the image file has 268435457 bytes; allowed are at most 268435456", path);

    AVPacket *file = encode(&sources[0]);
    assert_non_null(file);
    write_file(path, file->data, (size_t)file->size);
    assert_true(kiln_asset_image_check(NULL, path, &error));
    av_packet_free(&file);
    unlink(path);
    rmdir(folder);
}

static void floats_must_be_finite(void **state)
{
    (void)state;
    AVPacket *file = encode(&sources[7]);
    assert_non_null(file);
    const float one_value = (float)expected(20, 10, 0) / 255.0f;
    const float infinite = INFINITY;
    bool found = false;
    for (int i = file->size - (int)sizeof one_value; i > 0 && !found; i--) {
        found = memcmp(file->data + i, &one_value, sizeof one_value) == 0;
        if (found)
            memcpy(file->data + i, &infinite, sizeof infinite);
    }
    assert_true(found);
    struct kiln_error error = {0};
    assert_null(kiln_asset_image_parse(file->data, (size_t)file->size, "inf.exr", &error));
    expect_error(&error, KILN_INVALID_INPUT, "inf.exr: " NOT_FINITE);
    av_packet_free(&file);
}

static void a_webp_without_frames_is_broken(void **state)
{
    (void)state;
    static const unsigned char bytes[32] = "RIFF\x18\0\0\0WEBPVP8X\x0a\0\0\0\x02";
    struct kiln_error error = {0};
    assert_null(kiln_asset_image_parse(bytes, sizeof bytes, "moving.webp", &error));
    expect_error(&error, KILN_INVALID_INPUT, "moving.webp: the WebP image is broken or cut short");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_webp_without_frames_is_broken),
        cmocka_unit_test(every_format_is_decoded),
        cmocka_unit_test(truncated_files_are_refused),
        cmocka_unit_test(claimed_sizes_are_limited),
        cmocka_unit_test(files_are_told_from_other_things),
        cmocka_unit_test(floats_must_be_finite),
    };
    return cmocka_run_group_tests_name("image", tests, NULL, NULL);
}
