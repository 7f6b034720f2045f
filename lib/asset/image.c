/* Texture images by FFmpeg's decoders. The whole file is one packet: a table of signatures names
 * the decoder, so nothing is probed by name and no demuxer runs. A decoder asks for memory through
 * get_buffer, which is where the size is judged, before a pixel of it exists. */
#include "asset/image.h"

#include <errno.h>
#include <fcntl.h>
#include <libavcodec/avcodec.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asset/avlog.h"
#include "base/error.h"

#define ALLOWED "PNG, JPEG, WebP, TIFF, BMP or EXR"

/* '?' stands for any byte. */
static const struct signature {
    const char *bytes;
    size_t length;
    enum AVCodecID codec;
    const char *name;
} signatures[] = {
    {"\x89PNG\r\n\x1a\n", 8, AV_CODEC_ID_PNG, "PNG"},
    {"\xff\xd8\xff", 3, AV_CODEC_ID_MJPEG, "JPEG"},
    {"RIFF????WEBP", 12, AV_CODEC_ID_WEBP, "WebP"},
    {"II*\0", 4, AV_CODEC_ID_TIFF, "TIFF"},
    {"MM\0*", 4, AV_CODEC_ID_TIFF, "TIFF"},
    {"BM", 2, AV_CODEC_ID_BMP, "BMP"},
    {"v/1\x01", 4, AV_CODEC_ID_EXR, "EXR"},
};

/* What one decoding needs to know; the decoder's get_buffer finds it in its opaque pointer. */
struct decoding {
    const char *name; /* of the file, for messages */
    const char *format;
    struct kiln_error *error;
    bool reported; /* the error is filled */
    struct kiln_avlog avlog;
    AVCodecContext *decoder;
    AVPacket *packet;
    AVFrame *frame;
};

static bool fail(struct decoding *decoding, enum kiln_code code, const char *what)
{
    if (decoding->reported)
        return false;
    decoding->reported = true;
    const char *detail = decoding->avlog.first_error;
    return kiln_error_set(decoding->error, code, "%s: %s%s%s%s", decoding->name, what,
                          *detail ? " (" : "", detail, *detail ? ")" : "");
}

static const struct signature *find_signature(const unsigned char *bytes, size_t size)
{
    for (size_t i = 0; i < sizeof signatures / sizeof *signatures; i++) {
        const struct signature *s = &signatures[i];
        bool same = size >= s->length;
        for (size_t j = 0; same && j < s->length; j++)
            same = s->bytes[j] == '?' || (unsigned char)s->bytes[j] == bytes[j];
        if (same)
            return s;
    }
    return NULL;
}

static bool unknown_format(const unsigned char *bytes, size_t size, const char *name,
                           struct kiln_error *error)
{
    if (size == 0)
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: the image file is empty", name);
    char found[16] = "";
    for (size_t i = 0; i < 4 && i < size; i++)
        snprintf(found + 3 * i, sizeof found - 3 * i, " %02x", bytes[i]);
    return kiln_error_set(
        error, KILN_INVALID_INPUT,
        "%s: not an image: it starts with the bytes%s; allowed are " ALLOWED " files", name, found);
}

/* Called by the decoder once it knows the size and before it takes memory for the pixels. */
static int get_buffer(AVCodecContext *decoder, AVFrame *frame, int flags)
{
    struct decoding *decoding = decoder->opaque;
    if (frame->width < 1 || frame->height < 1 || frame->width > KILN_MAX_IMAGE_EDGE ||
        frame->height > KILN_MAX_IMAGE_EDGE ||
        (int64_t)frame->width * frame->height > KILN_MAX_IMAGE_PIXELS) {
        decoding->reported = true;
        kiln_error_set(decoding->error, KILN_INVALID_INPUT,
                       "%s: %s image of %d x %d pixels; allowed are 1 to %d a side and at most %d "
                       "in all",
                       decoding->name, decoding->format, frame->width, frame->height,
                       KILN_MAX_IMAGE_EDGE, KILN_MAX_IMAGE_PIXELS);
        return AVERROR(EINVAL);
    }
    int status = avcodec_default_get_buffer2(decoder, frame, flags);
    /* The EXR decoder passes over blocks that are missing or broken; filled with NaN, they show. */
    if (status >= 0 && decoder->codec_id == AV_CODEC_ID_EXR) {
        for (int i = 0; i < AV_NUM_DATA_POINTERS && frame->buf[i]; i++)
            memset(frame->buf[i]->data, 0xff, frame->buf[i]->size);
    }
    return status;
}

static bool open_decoder(struct decoding *decoding, enum AVCodecID id)
{
    const AVCodec *codec = avcodec_find_decoder(id);
    if (!codec) {
        decoding->reported = true;
        return kiln_error_set(decoding->error, KILN_IO,
                              "%s: this FFmpeg (libavcodec) has no decoder for %s images",
                              decoding->name, decoding->format);
    }
    decoding->decoder = avcodec_alloc_context3(codec);
    decoding->packet = av_packet_alloc();
    decoding->frame = av_frame_alloc();
    if (!decoding->decoder || !decoding->packet || !decoding->frame)
        return fail(decoding, KILN_DEVICE_FAILED, "out of memory while decoding the image");
    decoding->decoder->opaque = decoding;
    decoding->decoder->get_buffer2 = get_buffer;
    decoding->decoder->thread_count = 1; /* the messages and the limits stay on this thread */
    decoding->decoder->max_pixels = KILN_MAX_IMAGE_PIXELS;
    decoding->decoder->err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER;
    if (id != AV_CODEC_ID_TIFF) /* there it would refuse every tag that FFmpeg does not know */
        decoding->decoder->err_recognition |= AV_EF_EXPLODE;
    if (avcodec_open2(decoding->decoder, codec, NULL) < 0)
        return fail(decoding, KILN_IO, "the image decoder does not start");
    return true;
}

/* The JPEG decoder makes up what is missing at the end. Scan data holds neither marker, and an
 * embedded thumbnail comes before the scan. */
static bool jpeg_ends(const unsigned char *bytes, size_t size)
{
    for (size_t i = size; i >= 2; i--) {
        if (bytes[i - 2] == 0xff && (bytes[i - 1] == 0xd9 || bytes[i - 1] == 0xda))
            return bytes[i - 1] == 0xd9;
    }
    return false;
}

static bool decode_frame(struct decoding *decoding, const void *bytes, size_t size)
{
    if (av_new_packet(decoding->packet, (int)size) < 0)
        return fail(decoding, KILN_DEVICE_FAILED, "out of memory while reading the image");
    memcpy(decoding->packet->data, bytes, size);
    decoding->packet->flags |= AV_PKT_FLAG_KEY;

    int status = avcodec_send_packet(decoding->decoder, decoding->packet);
    if (status >= 0)
        status = avcodec_send_packet(decoding->decoder, NULL);
    if (status >= 0)
        status = avcodec_receive_frame(decoding->decoder, decoding->frame);
    if (status == AVERROR(ENOMEM))
        return fail(decoding, KILN_DEVICE_FAILED, "out of memory while decoding the image");
    /* A decoder that had to guess says so as an error and may still give a picture. */
    if (status < 0 || decoding->frame->decode_error_flags || decoding->avlog.first_error[0] ||
        (decoding->frame->flags & AV_FRAME_FLAG_CORRUPT) ||
        (decoding->decoder->codec_id == AV_CODEC_ID_MJPEG && !jpeg_ends(bytes, size))) {
        char what[64];
        snprintf(what, sizeof what, "the %s image is broken or cut short", decoding->format);
        return fail(decoding, KILN_INVALID_INPUT, what);
    }
    return true;
}

static const float *float_row(const AVFrame *frame, int plane, uint32_t y)
{
    return (const float *)(const void *)(frame->data[plane] +
                                         (ptrdiff_t)y * frame->linesize[plane]);
}

/* The planes of FFmpeg's float formats come as green, blue, red, alpha. */
static bool interleave_float(struct decoding *decoding, struct kiln_asset_image *image)
{
    static const int planes[2][3] = {{0, 0, 0}, {2, 0, 1}};
    const AVFrame *frame = decoding->frame;
    const int *plane = planes[frame->format != AV_PIX_FMT_GRAYF32];
    bool alpha = frame->format == AV_PIX_FMT_GBRAPF32, finite = true;
    float *out = image->pixels;
    for (uint32_t y = 0; y < image->height; y++) {
        for (uint32_t x = 0; x < image->width; x++, out += 4) {
            for (int c = 0; c < 3; c++)
                out[c] = float_row(frame, plane[c], y)[x];
            out[3] = alpha ? float_row(frame, 3, y)[x] : 1.0f;
            for (int c = 0; c < 4; c++)
                finite = finite && isfinite(out[c]);
        }
    }
    return finite || fail(decoding, KILN_INVALID_INPUT,
                          "the EXR image is cut short or has pixels that are not finite numbers");
}

static bool convert_integer(struct decoding *decoding, struct kiln_asset_image *image)
{
    const AVFrame *frame = decoding->frame;
    bool deep = image->type == KILN_IMAGE_U16;
    enum AVPixelFormat format = deep ? AV_PIX_FMT_RGBA64 : AV_PIX_FMT_RGBA;
    int width = (int)image->width, height = (int)image->height;
    struct SwsContext *scaler = sws_getContext(
        width, height, frame->format, width, height, format,
        SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_BITEXACT, NULL, NULL, NULL);
    if (!scaler)
        return fail(decoding, KILN_INVALID_INPUT, "the image's pixel format cannot be read");
    if (frame->color_range == AVCOL_RANGE_JPEG)
        sws_setColorspaceDetails(scaler, sws_getCoefficients(SWS_CS_DEFAULT), 1,
                                 sws_getCoefficients(SWS_CS_DEFAULT), 1, 0, 1 << 16, 1 << 16);
    uint8_t *rows[4] = {image->pixels};
    int strides[4] = {width * (deep ? 8 : 4)};
    int done = sws_scale(scaler, (const uint8_t *const *)frame->data, frame->linesize, 0, height,
                         rows, strides);
    sws_freeContext(scaler);
    return done == height || fail(decoding, KILN_INVALID_INPUT, "the image cannot be converted");
}

static struct kiln_asset_image *convert_frame(struct decoding *decoding)
{
    const AVFrame *frame = decoding->frame;
    const AVPixFmtDescriptor *layout = av_pix_fmt_desc_get(frame->format);
    bool is_float = frame->format == AV_PIX_FMT_GBRPF32 || frame->format == AV_PIX_FMT_GBRAPF32 ||
                    frame->format == AV_PIX_FMT_GRAYF32;
    struct kiln_asset_image *image = calloc(1, sizeof *image);
    if (!layout || !image) {
        fail(decoding, KILN_DEVICE_FAILED, "out of memory while decoding the image");
        free(image);
        return NULL;
    }
    image->width = (uint32_t)frame->width;
    image->height = (uint32_t)frame->height;
    image->type = is_float                    ? KILN_IMAGE_F32
                  : layout->comp[0].depth > 8 ? KILN_IMAGE_U16
                                              : KILN_IMAGE_U8;
    image->srgb = !is_float && frame->color_trc != AVCOL_TRC_LINEAR;
    image->premultiplied = frame->format == AV_PIX_FMT_GBRAPF32;
    static const size_t pixel_size[] = {
        [KILN_IMAGE_U8] = 4, [KILN_IMAGE_U16] = 8, [KILN_IMAGE_F32] = 16};
    /* swscale may write whole vectors past the last row's end. */
    enum { SLACK = 64 };
    image->pixels = malloc((size_t)image->width * image->height * pixel_size[image->type] + SLACK);
    bool converted = false;
    if (!image->pixels)
        fail(decoding, KILN_DEVICE_FAILED, "out of memory while decoding the image");
    else
        converted = is_float ? interleave_float(decoding, image) : convert_integer(decoding, image);
    if (!converted)
        kiln_asset_image_destroy(&image);
    return image;
}

struct kiln_asset_image *kiln_asset_image_parse(const void *bytes, size_t size, const char *name,
                                                struct kiln_error *error)
{
    const struct signature *signature = find_signature(bytes, size);
    if (!signature) {
        unknown_format(bytes, size, name, error);
        return NULL;
    }
    if (size > KILN_MAX_IMAGE_BYTES) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: the image file has %zu bytes; allowed are at most %d", name, size,
                       KILN_MAX_IMAGE_BYTES);
        return NULL;
    }
    struct decoding decoding = {.name = name, .format = signature->name, .error = error};
    kiln_avlog_begin(&decoding.avlog);
    struct kiln_asset_image *image = NULL;
    if (open_decoder(&decoding, signature->codec) && decode_frame(&decoding, bytes, size))
        image = convert_frame(&decoding);
    av_frame_free(&decoding.frame);
    av_packet_free(&decoding.packet);
    avcodec_free_context(&decoding.decoder);
    kiln_avlog_end(&decoding.avlog);
    return image;
}

static bool read_all(int file, unsigned char *bytes, size_t size)
{
    for (size_t done = 0; done < size;) {
        ssize_t got = read(file, bytes + done, size - done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        done += (size_t)got;
    }
    return true;
}

/* The file's bytes, or NULL with the error; a FIFO or device is refused without waiting for it. */
static unsigned char *read_file(const char *path, size_t *size, struct kiln_error *error)
{
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    struct stat status;
    if (file < 0 || fstat(file, &status) != 0) {
        kiln_error_set_errno(error, KILN_IO, errno, "%s: the image cannot be opened", path);
        if (file >= 0)
            close(file);
        return NULL;
    }
    unsigned char *bytes = NULL;
    if (!S_ISREG(status.st_mode)) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: not a file but a %s; allowed are " ALLOWED " files", path,
                       S_ISDIR(status.st_mode) ? "folder" : "device or pipe");
    } else if (status.st_size > KILN_MAX_IMAGE_BYTES) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: the image file has %jd bytes; allowed are at most %d", path,
                       (intmax_t)status.st_size, KILN_MAX_IMAGE_BYTES);
    } else if (!(bytes = malloc((size_t)status.st_size + 1))) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory while reading", path);
    } else if (!read_all(file, bytes, (size_t)status.st_size)) {
        kiln_error_set_errno(error, KILN_IO, errno, "%s: the image cannot be read", path);
        free(bytes);
        bytes = NULL;
    }
    *size = (size_t)status.st_size;
    close(file);
    return bytes;
}

struct kiln_asset_image *kiln_asset_image_load(const char *path, struct kiln_error *error)
{
    size_t size = 0;
    unsigned char *bytes = read_file(path, &size, error);
    if (!bytes)
        return NULL;
    struct kiln_asset_image *image = kiln_asset_image_parse(bytes, size, path, error);
    free(bytes);
    return image;
}

void kiln_asset_image_destroy(struct kiln_asset_image **image)
{
    if (!*image)
        return;
    free((*image)->pixels);
    free(*image);
    *image = NULL;
}

bool kiln_asset_image_check(const char *path, struct kiln_error *error)
{
    struct kiln_asset_image *image = kiln_asset_image_load(path, error);
    bool good = image != NULL;
    kiln_asset_image_destroy(&image);
    return good;
}
