/* This file decodes pictures by FFmpeg's decoders. The whole file is one packet, and the request
 * names the format, so FFmpeg probes nothing and no demuxer runs. A decoder asks for memory through
 * get_buffer, which checks the size before memory is taken for pixels. */
#include <stdlib.h>
#include <string.h>

#include "avframe.h"
#include "base/error.h"
#include "base/ffmpeg.h"
#include "decode.h"

struct codec {
    enum AVCodecID id;
    const char *name;
};

static const struct codec codecs[] = {
    [KILN_PICTURE_PNG] = {AV_CODEC_ID_PNG, "PNG"},
    [KILN_PICTURE_BMP] = {AV_CODEC_ID_BMP, "BMP"},
    [KILN_PICTURE_GIF] = {AV_CODEC_ID_GIF, "GIF"},
};

/* The state of one decoding, which the decoder's get_buffer finds in its opaque pointer. */
struct decoding {
    struct decode_picture *picture;
    const struct codec *codec;
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
    return kiln_error_set(decoding->picture->error, code, "%s%s%s%s", what, *detail ? " (" : "",
                          detail, *detail ? ")" : "");
}

static bool fail_memory(struct decoding *decoding)
{
    decoding->reported = true;
    return decode_out_of_memory(decoding->picture->error);
}

bool decode_allows_size(struct decode_picture *picture, const char *name, int64_t width,
                        int64_t height)
{
    if (width < 1 || height < 1 || width > KILN_MAX_IMAGE_EDGE || height > KILN_MAX_IMAGE_EDGE ||
        width * height > KILN_MAX_IMAGE_PIXELS)
        return kiln_error_set(picture->error, KILN_INVALID_INPUT,
                              "%s image of %lld x %lld pixels; allowed are 1 to %d a side and at "
                              "most %d in all",
                              name, (long long)width, (long long)height, KILN_MAX_IMAGE_EDGE,
                              KILN_MAX_IMAGE_PIXELS);
    picture->width = (uint32_t)width;
    picture->height = (uint32_t)height;
    return (uint64_t)(width * height) <= picture->most_pixels ||
           kiln_error_set(picture->error, KILN_OVER_LIMIT,
                          "the image has more pixels than the limit asset_pixels leaves");
}

/* Checks the size and takes the memory of the pixels. The decoder calls it once it knows the size.
 */
static int get_buffer(AVCodecContext *decoder, AVFrame *frame, int flags)
{
    struct decoding *decoding = decoder->opaque;
    if (!decode_allows_size(decoding->picture, decoding->codec->name, frame->width,
                            frame->height)) {
        decoding->reported = true;
        return AVERROR(EINVAL);
    }
    return kiln_ff.avcodec_default_get_buffer2(decoder, frame, flags);
}

static bool open_decoder(struct decoding *decoding)
{
    const enum AVCodecID id = decoding->codec->id;
    const AVCodec *codec = kiln_ff.avcodec_find_decoder(id);
    if (!codec) {
        decoding->reported = true;
        return kiln_error_set(decoding->picture->error, KILN_IO,
                              "this FFmpeg (libavcodec) has no decoder for %s images",
                              decoding->codec->name);
    }
    decoding->decoder = kiln_ff.avcodec_alloc_context3(codec);
    decoding->packet = kiln_ff.av_packet_alloc();
    decoding->frame = kiln_ff.av_frame_alloc();
    if (!decoding->decoder || !decoding->packet || !decoding->frame)
        return fail_memory(decoding);
    decoding->decoder->opaque = decoding;
    decoding->decoder->get_buffer2 = get_buffer;
    decode_same_everywhere(decoding->decoder);
    decoding->decoder->thread_count = 1; /* the messages and the limits stay on this thread */
    decoding->decoder->max_pixels = KILN_MAX_IMAGE_PIXELS;
    decoding->decoder->err_recognition =
        AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER | AV_EF_EXPLODE;
    const int status = kiln_ff.avcodec_open2(decoding->decoder, codec, NULL);
    if (status == AVERROR(ENOMEM))
        return fail_memory(decoding);
    if (status < 0)
        return fail(decoding, KILN_IO, "the image decoder does not start");
    return true;
}

static bool decode_frame(struct decoding *decoding)
{
    const unsigned char *bytes = decoding->picture->bytes;
    const size_t size = decoding->picture->size;
    if (kiln_ff.av_new_packet(decoding->packet, (int)size) < 0)
        return fail_memory(decoding);
    memcpy(decoding->packet->data, bytes, size);
    decoding->packet->flags |= AV_PKT_FLAG_KEY;

    int status = kiln_ff.avcodec_send_packet(decoding->decoder, decoding->packet);
    if (status >= 0)
        status = kiln_ff.avcodec_send_packet(decoding->decoder, NULL);
    if (status >= 0)
        status = kiln_ff.avcodec_receive_frame(decoding->decoder, decoding->frame);
    if (status == AVERROR(ENOMEM))
        return fail_memory(decoding);
    /* A decoder that had to guess pixels logs an error and may still give a picture. */
    if (status < 0 || decoding->frame->decode_error_flags || decoding->avlog.first_error[0] ||
        (decoding->frame->flags & AV_FRAME_FLAG_CORRUPT)) {
        char what[64];
        snprintf(what, sizeof what, "the %s image is broken or cut short", decoding->codec->name);
        return fail(decoding, KILN_INVALID_INPUT, what);
    }
    return true;
}

static struct kiln_asset_image *convert_frame(struct decoding *decoding)
{
    struct kiln_asset_image *image = NULL;
    const char *problem = NULL;
    const enum kiln_code code = decode_avframe(decoding->frame, &image, &problem);
    if (code == KILN_OK && decoding->codec->id == AV_CODEC_ID_GIF)
        decode_find_alpha(image); /* FFmpeg gives every GIF an alpha */
    if (code == KILN_DEVICE_FAILED)
        fail_memory(decoding);
    else if (code != KILN_OK)
        fail(decoding, code, problem);
    return image;
}

struct kiln_asset_image *decode_by_ffmpeg(struct decode_picture *picture)
{
    struct decoding decoding = {.picture = picture, .codec = &codecs[picture->format]};
    kiln_avlog_begin(&decoding.avlog);
    struct kiln_asset_image *image = NULL;
    if (open_decoder(&decoding) && decode_frame(&decoding))
        image = convert_frame(&decoding);
    kiln_ff.av_frame_free(&decoding.frame);
    kiln_ff.av_packet_free(&decoding.packet);
    kiln_ff.avcodec_free_context(&decoding.decoder);
    kiln_avlog_end(&decoding.avlog);
    return image;
}
