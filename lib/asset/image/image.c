/* Texture images by FFmpeg's decoders. The whole file is one packet: a table of signatures names
 * the decoder, so nothing is probed by name and no demuxer runs. A decoder asks for memory through
 * get_buffer, which is where the size is judged, before a pixel of it exists. */
#include "asset/image/image.h"

#include <libavcodec/avcodec.h>
#include <stdlib.h>
#include <string.h>

#include "asset/image/avframe.h"
#include "asset/image/avlog.h"
#include "asset/image/exr_in.h"
#include "base/budget.h"
#include "base/error.h"
#include "base/file_in.h"

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
    struct kiln_budget *budget; /* NULL: without limits */
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
    if (!kiln_budget_take(decoding->budget, KILN_LIMIT_asset_pixels,
                          (uint64_t)frame->width * (uint64_t)frame->height, decoding->name,
                          decoding->error)) {
        decoding->reported = true;
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
    kiln_avframe_same_everywhere(decoding->decoder);
    decoding->decoder->thread_count = 1; /* the messages and the limits stay on this thread */
    decoding->decoder->max_pixels = KILN_MAX_IMAGE_PIXELS;
    decoding->decoder->err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER;
    if (id != AV_CODEC_ID_TIFF) /* there it would refuse every tag that FFmpeg does not know */
        decoding->decoder->err_recognition |= AV_EF_EXPLODE;
    const int status = avcodec_open2(decoding->decoder, codec, NULL);
    if (status == AVERROR(ENOMEM))
        return fail(decoding, KILN_DEVICE_FAILED, "out of memory while decoding the image");
    if (status < 0)
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

static struct kiln_asset_image *convert_frame(struct decoding *decoding)
{
    struct kiln_asset_image *image = NULL;
    const char *problem = NULL;
    enum kiln_code code = kiln_avframe_convert(decoding->frame, &image, &problem);
    if (code != KILN_OK)
        fail(decoding, code, problem);
    return image;
}

/* FFmpeg has no decoder for WebP's animations: the extended header says that one follows. */
static bool is_animated_webp(const unsigned char *bytes, size_t size)
{
    return size > 20 && memcmp(bytes + 12, "VP8X", 4) == 0 && (bytes[20] & 2) != 0;
}

static struct kiln_asset_image *parse(const void *bytes, size_t size, const char *name,
                                      struct kiln_budget *budget, struct kiln_error *error)
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
    if (signature->codec == AV_CODEC_ID_WEBP && is_animated_webp(bytes, size)) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: an animated WebP, which FFmpeg does not decode; use a video or APNG",
                       name);
        return NULL;
    }
    struct decoding decoding = {
        .name = name, .format = signature->name, .budget = budget, .error = error};
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

struct kiln_asset_image *kiln_asset_image_parse(const void *bytes, size_t size, const char *name,
                                                struct kiln_error *error)
{
    return parse(bytes, size, name, NULL, error);
}

static struct kiln_asset_image *load(const char *path, struct kiln_budget *budget,
                                     struct kiln_error *error)
{
    size_t size = 0;
    unsigned char *bytes =
        kiln_file_read(path, "image", ALLOWED, KILN_MAX_IMAGE_BYTES, &size, error);
    struct kiln_asset_image *image = NULL;
    if (bytes && kiln_budget_take(budget, KILN_LIMIT_asset_bytes, size, path, error))
        image = parse(bytes, size, path, budget, error);
    free(bytes);
    return image;
}

struct kiln_asset_image *kiln_asset_image_load(const char *path, struct kiln_error *error)
{
    return load(path, NULL, error);
}

struct kiln_asset_image *kiln_asset_image_load_layer(const char *path, const char *layer,
                                                     struct kiln_error *error)
{
    size_t size = 0;
    unsigned char *bytes =
        kiln_file_read(path, "image", ALLOWED, KILN_MAX_IMAGE_BYTES, &size, error);
    if (!bytes)
        return NULL;
    const struct signature *signature = find_signature(bytes, size);
    bool exr = signature && signature->codec == AV_CODEC_ID_EXR;
    bool beauty = strcmp(layer, "beauty") == 0;
    struct kiln_asset_image *image = NULL;
    if (exr && !(beauty && kiln_exr_is_tiled(bytes, size)))
        image = kiln_exr_parse(bytes, size, path, layer, error);
    else if (beauty || !signature)
        image = kiln_asset_image_parse(bytes, size, path, error);
    else
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: no layer '%s': %s images have no layers but 'beauty'", path, layer,
                       signature->name);
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

bool kiln_asset_image_check(const char *path, struct kiln_budget *budget, struct kiln_error *error)
{
    struct kiln_asset_image *image = load(path, budget, error);
    bool good = image != NULL;
    kiln_asset_image_destroy(&image);
    return good;
}
