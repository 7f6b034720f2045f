/* Encodes JPEG by FFmpeg: frames, and pictures in memory. All settings that decide about the bytes
 * are set here: the quantiser, full chroma (4:2:0 would smear lettering, coloured frames and the
 * edges of fire), arithmetic in integers, one thread. */
#include "output/jpeg.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/ffmpeg.h"
#include "output/formats.h"

/* Converts RGB to Rec. 601 with full range, as JFIF has it, in fixed point with 16 bits after the
 * point. */
static void fill_planes(const struct kiln_jpeg *jpeg, AVFrame *frame)
{
    static const int32_t weights[3][4] = {
        {19595, 38470, 7471, 0}, {-11059, -21709, 32768, 128}, {32768, -27439, -5329, 128}};
    for (uint32_t y = 0; y < jpeg->height; y++) {
        const uint8_t *rgba = jpeg->rgba + (size_t)4 * y * jpeg->width;
        for (uint32_t x = 0; x < jpeg->width; x++, rgba += 4) {
            for (int plane = 0; plane < 3; plane++) {
                const int32_t *w = weights[plane];
                int32_t value = w[0] * rgba[0] + w[1] * rgba[1] + w[2] * rgba[2];
                value = (value + (w[3] << 16) + 32768) >> 16;
                frame->data[plane][(ptrdiff_t)y * frame->linesize[plane] + x] =
                    (uint8_t)(value < 255 ? value : 255);
            }
        }
    }
}

struct encoding {
    AVCodecContext *encoder;
    AVFrame *frame;
    AVPacket *packet;
};

static bool open_encoder(struct encoding *encoding, const AVCodec *codec,
                         const struct kiln_jpeg *jpeg)
{
    AVCodecContext *encoder = encoding->encoder;
    encoder->width = (int)jpeg->width;
    encoder->height = (int)jpeg->height;
    encoder->pix_fmt = AV_PIX_FMT_YUVJ444P;
    encoder->color_range = AVCOL_RANGE_JPEG;
    encoder->time_base = (AVRational){1, 25}; /* the encoder needs one, any will do */
    /* without it, FFmpeg leaves out the JFIF header */
    encoder->sample_aspect_ratio = (AVRational){1, 1};
    encoder->thread_count = 1;
    encoder->dct_algo = FF_DCT_INT; /* other methods differ from processor to processor */
    encoder->flags |= AV_CODEC_FLAG_QSCALE | AV_CODEC_FLAG_BITEXACT;
    encoder->qmin = 1;
    encoder->global_quality = FF_QP2LAMBDA * (int)jpeg->quantiser;
    kiln_ff.av_opt_set(encoder->priv_data, "huffman", "optimal", 0);
    if (kiln_ff.avcodec_open2(encoder, codec, NULL) < 0)
        return false;
    encoding->frame->width = encoder->width;
    encoding->frame->height = encoder->height;
    encoding->frame->format = encoder->pix_fmt;
    encoding->frame->quality = encoder->global_quality;
    return kiln_ff.av_frame_get_buffer(encoding->frame, 0) >= 0;
}

/* The header of JFIF is the first segment: the start of the image, a marker, its length, "JFIF" and
 * the version; then the unit (1: an inch) and how many pixels it has across and down. */
enum { JFIF_UNIT = 13, JFIF_END = 20, MARKER_SIZE = 4, LONGEST_COMMENT = 65533 };

static bool has_jfif(const AVPacket *packet)
{
    return packet->size >= JFIF_END && memcmp(packet->data + 6, "JFIF", 5) == 0;
}

/* Copies the packet into new memory, with the density in its header and the comment as the segment
 * after it. */
static bool copy_out(const AVPacket *packet, const struct kiln_jpeg *jpeg, uint8_t **bytes,
                     size_t *size)
{
    const size_t all = (size_t)packet->size, before = has_jfif(packet) ? JFIF_END : 2;
    const size_t length = jpeg->comment ? strnlen(jpeg->comment, LONGEST_COMMENT) : 0;
    const size_t segment = length > 0 ? MARKER_SIZE + length : 0;
    if (before > all)
        return false;
    *size = all + segment;
    uint8_t *to = *bytes = malloc(*size);
    if (!to)
        return false;
    memcpy(to, packet->data, before);
    if (segment > 0) {
        const uint8_t head[MARKER_SIZE] = {0xff, 0xfe, (uint8_t)((length + 2) >> 8),
                                           (uint8_t)(length + 2)};
        memcpy(to + before, head, sizeof head);
        memcpy(to + before + sizeof head, jpeg->comment, length);
    }
    memcpy(to + before + segment, packet->data + before, all - before);
    if (jpeg->dpi > 0 && before == JFIF_END) {
        const uint8_t high = (uint8_t)(jpeg->dpi >> 8), low = (uint8_t)jpeg->dpi;
        memcpy(to + JFIF_UNIT, (const uint8_t[]){1, high, low, high, low}, 5);
    }
    return true;
}

static bool encode(struct encoding *encoding, const struct kiln_jpeg *jpeg, uint8_t **bytes,
                   size_t *size)
{
    fill_planes(jpeg, encoding->frame);
    return kiln_ff.avcodec_send_frame(encoding->encoder, encoding->frame) >= 0 &&
           kiln_ff.avcodec_send_frame(encoding->encoder, NULL) >= 0 &&
           kiln_ff.avcodec_receive_packet(encoding->encoder, encoding->packet) >= 0 &&
           copy_out(encoding->packet, jpeg, bytes, size);
}

static const AVCodec *find_codec(struct kiln_error *error)
{
    const AVCodec *codec = kiln_ffmpeg_open(KILN_FFMPEG_PICTURES, error)
                               ? kiln_ff.avcodec_find_encoder(AV_CODEC_ID_MJPEG)
                               : NULL;
    if (!codec && error->code == KILN_OK)
        kiln_error_set(error, KILN_IO, "this FFmpeg (libavcodec) has no encoder for JPEG images");
    return codec;
}

bool kiln_jpeg_encode(const struct kiln_jpeg *jpeg, uint8_t **bytes, size_t *size,
                      struct kiln_error *error)
{
    struct kiln_error reason = {0};
    const AVCodec *codec = find_codec(&reason);
    if (!codec)
        return kiln_error_set(error, reason.code, "%s", reason.message);
    struct kiln_avlog avlog = {0};
    kiln_avlog_begin(&avlog);
    struct encoding encoding = {kiln_ff.avcodec_alloc_context3(codec), kiln_ff.av_frame_alloc(),
                                kiln_ff.av_packet_alloc()};
    bool ok = encoding.encoder && encoding.frame && encoding.packet &&
              open_encoder(&encoding, codec, jpeg) && encode(&encoding, jpeg, bytes, size);
    kiln_ff.av_packet_free(&encoding.packet);
    kiln_ff.av_frame_free(&encoding.frame);
    kiln_ff.avcodec_free_context(&encoding.encoder);
    kiln_avlog_end(&avlog);
    if (!ok && !*avlog.first_error)
        return kiln_error_no_memory(error, "a JPEG of %u x %u pixels", jpeg->width, jpeg->height);
    return ok || kiln_error_set(error, KILN_DEVICE_FAILED, "a JPEG of %u x %u pixels: %s",
                                jpeg->width, jpeg->height, avlog.first_error);
}

/* ---- Frames ---------------------------------------------------------------------------------- */

struct jpeg_encoder {
    const struct kiln_output_params *params;
    struct kiln_temporary *file;
};

static struct kiln_output_needs needs(const struct kiln_output_params *params)
{
    (void)params;
    return (struct kiln_output_needs){.bits = 8};
}

static bool check(const struct kiln_output_params *params, struct kiln_error *error)
{
    struct kiln_error reason = {0};
    if (params->alpha)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: the backdrop is transparent, but a JPEG image has no alpha; "
                              "write .png or .exr, or make the backdrop opaque",
                              params->path);
    if (params->quality > 100)
        return kiln_error_set(error, KILN_USAGE, "%s: found quality %u; allowed are 0 to 100",
                              params->path, params->quality);
    return find_codec(&reason) ||
           kiln_error_set(error, reason.code, "%s: %s", params->path, reason.message);
}

static void *open_frame(const struct kiln_output_params *params, struct kiln_temporary *file,
                        struct kiln_error *error)
{
    struct jpeg_encoder *encoder = malloc(sizeof *encoder);
    if (encoder)
        *encoder = (struct jpeg_encoder){params, file};
    else
        kiln_error_no_memory(error, "the JPEG encoder of %s", file->target);
    return encoder;
}

/* Maps quality to a quantiser. From 50 up it is about that of other programs: 1 from quality 91 on,
 * 2 from 84, 3 at 80, 8 at 50. Below 50, the quantiser grows evenly to the worst, 31. */
static uint32_t quantiser_of(uint32_t quality)
{
    const uint32_t hundredths = quality >= 50 ? 1600 - 16 * quality : 3100 - 46 * quality;
    const uint32_t rounded = (hundredths + 50) / 100;
    return rounded > 1 ? rounded : 1;
}

static bool encode_frame(void *opaque, const struct kiln_picture *picture, struct kiln_error *error)
{
    const struct jpeg_encoder *encoder = opaque;
    const struct kiln_output_params *params = encoder->params;
    char comment[256];
    snprintf(comment, sizeof comment,
             "kiln:version=%s kiln:scene=%s kiln:seed=%u kiln:frame=%u kiln:fps=%u/%u "
             "kiln:quality=%u",
             KILN_VERSION, params->scene_hash, params->seed, picture->frame, params->fps_num,
             params->fps_den, params->quality);
    const struct kiln_jpeg jpeg = {.rgba = picture->display,
                                   .width = picture->width,
                                   .height = picture->height,
                                   .quantiser = quantiser_of(params->quality),
                                   .comment = comment};
    uint8_t *bytes = NULL;
    size_t size = 0;
    struct kiln_error reason = {0};
    if (!kiln_jpeg_encode(&jpeg, &bytes, &size, &reason))
        return kiln_error_set(error, reason.code, "%s: %s", encoder->file->target, reason.message);
    const bool written = kiln_temporary_write(encoder->file, bytes, size);
    free(bytes);
    return written || kiln_temporary_fail(encoder->file, error);
}

const struct kiln_format kiln_format_jpeg = {
    .suffix = ".jpg",
    .also = ".jpeg",
    .name = "JPEG images",
    .help =
        "8 bits, full chroma, no alpha; quality 0 to 100, from 91 on the best; .jpeg is the same",
    .uses = KILN_USES_QUALITY,
    .needs = needs,
    .check = check,
    .open = open_frame,
    .encode = encode_frame,
    .close = free,
};
