/* JPEG by FFmpeg. Everything that decides about the bytes is set here: the quantiser, full chroma
 * (4:2:0 would smear lettering, coloured frames and the edges of fire), arithmetic in integers, one
 * thread. */
#include "output/jpeg.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/ffmpeg.h"

/* Rec. 601 with full range, as JFIF has it; 16 bits after the point. */
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
    encoder->time_base = (AVRational){1, 25};          /* it wants one */
    encoder->sample_aspect_ratio = (AVRational){1, 1}; /* or it leaves the JFIF header out */
    encoder->thread_count = 1;
    encoder->dct_algo = FF_DCT_INT; /* others differ from processor to processor */
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

static bool encode(struct encoding *encoding, const struct kiln_jpeg *jpeg, uint8_t **bytes,
                   size_t *size)
{
    fill_planes(jpeg, encoding->frame);
    if (kiln_ff.avcodec_send_frame(encoding->encoder, encoding->frame) < 0 ||
        kiln_ff.avcodec_send_frame(encoding->encoder, NULL) < 0 ||
        kiln_ff.avcodec_receive_packet(encoding->encoder, encoding->packet) < 0)
        return false;
    *size = (size_t)encoding->packet->size;
    *bytes = malloc(*size);
    if (*bytes)
        memcpy(*bytes, encoding->packet->data, *size);
    return *bytes != NULL;
}

bool kiln_jpeg_encode(const struct kiln_jpeg *jpeg, uint8_t **bytes, size_t *size,
                      struct kiln_error *error)
{
    if (!kiln_ffmpeg_open(KILN_FFMPEG_PICTURES, error))
        return false;
    const AVCodec *codec = kiln_ff.avcodec_find_encoder(AV_CODEC_ID_MJPEG);
    if (!codec)
        return kiln_error_set(error, KILN_IO,
                              "this FFmpeg (libavcodec) has no encoder for JPEG images");
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
    return ok ||
           kiln_error_set(error, KILN_DEVICE_FAILED, "a JPEG of %u x %u pixels: %s", jpeg->width,
                          jpeg->height, *avlog.first_error ? avlog.first_error : "out of memory");
}
