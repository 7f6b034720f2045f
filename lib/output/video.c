/* Clips by FFmpeg: conversion, encoding, muxing. Formats differ by their settings alone.
 *
 * Pixels of luma and chroma are made with BT.709's matrix in limited range, and the tags say just
 * that: primaries and matrix of BT.709, and sRGB's transfer function, since that is what the frames
 * are encoded with. Players that honour the tag show the PNG's colours, and those that ignore it
 * take the pixels as they are, which on an sRGB screen is the same.
 *
 * The same frames give the same bytes on every machine: some encoders' results depend on their
 * number of threads, so that is fixed, and nothing of the time or the place is written. */
#include "output/video.h"

#include <libavformat/avformat.h>
#include <libavutil/avstring.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "asset/image/avlog.h"
#include "base/error.h"
#include "output/bleed.h"

enum {
    ENCODER_THREADS = 4,
    IO_BUFFER_SIZE = 1 << 17,
};

struct video_encoder {
    const struct kiln_output_params *params;
    const struct kiln_video_settings *settings;
    struct kiln_temporary *file;
    struct kiln_avlog avlog;
    AVFormatContext *container;
    AVIOContext *io;
    AVStream *stream; /* the container's */
    AVCodecContext *codec;
    AVFrame *frame;
    AVPacket *packet;
    struct SwsContext *scaler; /* NULL for palettes */
    int64_t frames;
    bool begun; /* the container waits for its end */
};

struct kiln_output_needs kiln_video_needs(const struct kiln_output_params *params)
{
    uint32_t bits = params->format->video->bits;
    return (struct kiln_output_needs){.bits = bits ? bits : params->png_bits};
}

static enum AVPixelFormat pixel_format(const struct kiln_output_params *params)
{
    return params->format->video->pixels[params->alpha][kiln_video_needs(params).bits > 8];
}

static bool is_rgb(enum AVPixelFormat format)
{
    return av_pix_fmt_desc_get(format)->flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL);
}

static bool check_size(const struct kiln_output_params *params, struct kiln_error *error)
{
    const struct kiln_video_settings *settings = params->format->video;
    if (settings->even_sizes && (params->width % 2 || params->height % 2))
        return kiln_error_set(error, KILN_USAGE,
                              "%s: a video of %u x %u pixels; %s needs even sizes, the nearest is "
                              "%ux%u",
                              params->path, params->width, params->height, settings->codec,
                              params->width + params->width % 2,
                              params->height + params->height % 2);
    return (params->width <= settings->max_edge && params->height <= settings->max_edge) ||
           kiln_error_set(
               error, KILN_USAGE, "%s: a video of %u x %u pixels; %s allows at most %u a side",
               params->path, params->width, params->height, settings->codec, settings->max_edge);
}

void kiln_video_missing(const struct kiln_video_settings *settings, char missing[64])
{
    missing[0] = '\0';
    if (!avcodec_find_encoder_by_name(settings->encoder))
        snprintf(missing, 64, "encoder %s", settings->encoder);
    else if (!av_guess_format(settings->muxer, NULL, NULL))
        snprintf(missing, 64, "muxer %s", settings->muxer);
}

static bool check_parts(const struct kiln_output_params *params, struct kiln_error *error)
{
    char missing[64];
    kiln_video_missing(params->format->video, missing);
    return !*missing || kiln_error_set(error, KILN_IO,
                                       "%s: this FFmpeg has no %s; install one that was built with "
                                       "it (on Debian, %s)",
                                       params->path, missing, params->format->video->packages);
}

bool kiln_video_check(const struct kiln_output_params *params, struct kiln_error *error)
{
    if (!check_size(params, error))
        return false;
    if (params->png_bits != 8 && params->png_bits != 16)
        return kiln_error_set(error, KILN_USAGE, "%s: %u bits a channel; allowed are 8 or 16",
                              params->path, params->png_bits);
    if (pixel_format(params) == AV_PIX_FMT_NONE)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: the backdrop is transparent, but %s has no alpha; write images, "
                              "a .webm or a .mov, or make the backdrop opaque",
                              params->path, params->format->video->kind);
    if (params->quality > 100)
        return kiln_error_set(error, KILN_USAGE, "%s: quality %u; allowed are 0 to 100",
                              params->path, params->quality);
    if (params->fps_num == 0 || params->fps_den == 0 || params->fps_num > INT_MAX ||
        params->fps_den > INT_MAX)
        return kiln_error_set(error, KILN_USAGE, "%s: %u/%u is no frame rate for a video",
                              params->path, params->fps_num, params->fps_den);
    return check_parts(params, error);
}

/* Reports what went wrong: the disk's answer if it gave one, else FFmpeg's. */
static bool fail(const struct video_encoder *encoder, int status, const char *what,
                 struct kiln_error *error)
{
    if (encoder->file->failure)
        return kiln_error_set_errno(error, KILN_IO, encoder->file->failure,
                                    "%s: the file cannot be written", encoder->params->path);
    if (status == AVERROR(ENOMEM))
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: no memory for the video encoder",
                              encoder->params->path);
    char reason[AV_ERROR_MAX_STRING_SIZE] = "";
    av_strerror(status, reason, sizeof reason);
    const char *detail = encoder->avlog.first_error;
    return kiln_error_set(error, KILN_IO, "%s: %s: %s", encoder->params->path, what,
                          *detail ? detail : reason);
}

/* ---- Setting up --------------------------------------------------------------------------- */

static int write_bytes(void *opaque, uint8_t *bytes, int size)
{
    struct video_encoder *encoder = opaque;
    return kiln_temporary_write(encoder->file, bytes, (size_t)size)
               ? size
               : AVERROR(encoder->file->failure);
}

static int64_t seek_bytes(void *opaque, int64_t offset, int whence)
{
    struct video_encoder *encoder = opaque;
    if (whence != SEEK_SET)
        return AVERROR(ENOSYS);
    return kiln_temporary_seek(encoder->file, offset) ? offset : AVERROR(encoder->file->failure);
}

static void set_colors(AVCodecContext *codec)
{
    bool rgb = is_rgb(codec->pix_fmt);
    codec->color_primaries = AVCOL_PRI_BT709;
    codec->color_trc = AVCOL_TRC_IEC61966_2_1;
    codec->colorspace = rgb ? AVCOL_SPC_RGB : AVCOL_SPC_BT709;
    codec->color_range = rgb ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    codec->chroma_sample_location = rgb ? AVCHROMA_LOC_UNSPECIFIED : AVCHROMA_LOC_LEFT;
}

static int open_codec(struct video_encoder *encoder)
{
    const struct kiln_output_params *params = encoder->params;
    const AVCodec *found = avcodec_find_encoder_by_name(encoder->settings->encoder);
    AVCodecContext *codec = encoder->codec = avcodec_alloc_context3(found);
    if (!codec)
        return AVERROR(ENOMEM);
    codec->width = (int)params->width;
    codec->height = (int)params->height;
    codec->pix_fmt = pixel_format(params);
    codec->framerate = (AVRational){(int)params->fps_num, (int)params->fps_den};
    codec->time_base = av_inv_q(codec->framerate);
    codec->gop_size = (int)kiln_part_frames(params->fps_num, params->fps_den);
    if (encoder->settings->intra)
        codec->gop_size = 1;
    set_colors(codec);
    codec->thread_count = ENCODER_THREADS;
    codec->flags |= AV_CODEC_FLAG_BITEXACT | AV_CODEC_FLAG_GLOBAL_HEADER;
    if (encoder->settings->tune)
        encoder->settings->tune(codec, params);
    return avcodec_open2(codec, found, NULL);
}

static int open_frame(struct video_encoder *encoder)
{
    AVFrame *frame = encoder->frame = av_frame_alloc();
    encoder->packet = av_packet_alloc();
    if (!frame || !encoder->packet)
        return AVERROR(ENOMEM);
    const AVCodecContext *codec = encoder->codec;
    frame->width = codec->width;
    frame->height = codec->height;
    frame->format = codec->pix_fmt;
    frame->color_primaries = codec->color_primaries;
    frame->color_trc = codec->color_trc;
    frame->colorspace = codec->colorspace;
    frame->color_range = codec->color_range;
    frame->chroma_location = codec->chroma_sample_location;
    frame->quality = codec->global_quality;
    return av_frame_get_buffer(frame, 0);
}

static int open_scaler(struct video_encoder *encoder)
{
    const AVFrame *frame = encoder->frame;
    if (frame->format == AV_PIX_FMT_PAL8)
        return 0;
    struct SwsContext *scaler = encoder->scaler = sws_alloc_context();
    if (!scaler)
        return AVERROR(ENOMEM);
    bool deep = kiln_video_needs(encoder->params).bits > 8, rgb = is_rgb(frame->format);
    av_opt_set_int(scaler, "srcw", frame->width, 0);
    av_opt_set_int(scaler, "srch", frame->height, 0);
    av_opt_set_int(scaler, "src_format", deep ? AV_PIX_FMT_RGBA64 : AV_PIX_FMT_RGBA, 0);
    av_opt_set_int(scaler, "src_range", 1, 0);
    av_opt_set_int(scaler, "dstw", frame->width, 0);
    av_opt_set_int(scaler, "dsth", frame->height, 0);
    av_opt_set_int(scaler, "dst_format", frame->format, 0);
    av_opt_set_int(scaler, "dst_range", rgb, 0);
    av_opt_set_int(scaler, "dst_h_chr_pos", 0, 0); /* left, as tagged */
    av_opt_set_int(scaler, "dst_v_chr_pos", 128, 0);
    av_opt_set_int(scaler, "sws_flags",
                   SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP | SWS_BITEXACT, 0);
    int status = sws_init_context(scaler, NULL, NULL);
    if (status < 0 || rgb)
        return status;
    const int *bt709 = sws_getCoefficients(SWS_CS_ITU709);
    status = sws_setColorspaceDetails(scaler, bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
    return status < 0 ? AVERROR(EINVAL) : 0;
}

static void describe(const struct kiln_output_params *params, char *out, size_t size)
{
    snprintf(out, size, "kiln:version=%s kiln:scene=%s kiln:seed=%u kiln:frames=%u-%u",
             KILN_VERSION, params->scene_hash, params->seed, params->ranges[0].first,
             params->ranges[params->range_count - 1].last);
}

static int write_header(struct video_encoder *encoder)
{
    AVFormatContext *container = encoder->container;
    const struct kiln_video_settings *settings = encoder->settings;
    char comment[256];
    describe(encoder->params, comment, sizeof comment);
    av_dict_set(&container->metadata, "comment", comment, 0);
    if (encoder->codec->pix_fmt == AV_PIX_FMT_YUVA420P) /* alpha as a second stream: tell WebM */
        av_dict_set(&encoder->stream->metadata, "alpha_mode", "1", 0);
    AVDictionary *options = NULL;
    if (settings->muxer_options)
        av_dict_parse_string(&options, settings->muxer_options, "=", ":", 0);
    if (settings->prepare)
        settings->prepare(encoder->params, &options);
    int status = avformat_write_header(container, &options);
    av_dict_free(&options);
    encoder->begun = status >= 0;
    return status;
}

/* The index of MP4 and MOV goes to the front, so that a player can start before it has the whole
 * file; for that FFmpeg opens the temporary file once more, by its url. */
static int open_container(struct video_encoder *encoder)
{
    int status =
        avformat_alloc_output_context2(&encoder->container, NULL, encoder->settings->muxer, NULL);
    if (status < 0)
        return status;
    AVFormatContext *container = encoder->container;
    uint8_t *buffer = av_malloc(IO_BUFFER_SIZE);
    encoder->io = buffer ? avio_alloc_context(buffer, IO_BUFFER_SIZE, 1, encoder, NULL, write_bytes,
                                              seek_bytes)
                         : NULL;
    encoder->stream = avformat_new_stream(container, NULL);
    container->url = av_asprintf("file:%s", kiln_temporary_path(encoder->file));
    if (!encoder->io || !encoder->stream || !container->url) {
        if (!encoder->io)
            av_free(buffer);
        return AVERROR(ENOMEM);
    }
    container->pb = encoder->io;
    container->flags |= AVFMT_FLAG_BITEXACT;
    encoder->stream->time_base = encoder->codec->time_base;
    encoder->stream->avg_frame_rate = encoder->codec->framerate;
    status = avcodec_parameters_from_context(encoder->stream->codecpar, encoder->codec);
    return status < 0 ? status : write_header(encoder);
}

/* FFmpeg's GIF writer keeps a packet, which only the end of the file frees: ends it in memory. */
static void abandon(struct video_encoder *encoder)
{
    AVIOContext *nowhere = NULL;
    if (strcmp(encoder->container->oformat->name, "gif") != 0 || avio_open_dyn_buf(&nowhere) < 0)
        return;
    encoder->container->pb = nowhere;
    av_write_trailer(encoder->container);
    uint8_t *bytes = NULL;
    avio_close_dyn_buf(nowhere, &bytes);
    av_free(bytes);
    encoder->container->pb = encoder->io;
}

void kiln_video_close(void *opaque)
{
    struct video_encoder *encoder = opaque;
    kiln_avlog_begin(&encoder->avlog);
    if (encoder->begun)
        abandon(encoder);
    sws_freeContext(encoder->scaler);
    av_packet_free(&encoder->packet);
    av_frame_free(&encoder->frame);
    avcodec_free_context(&encoder->codec);
    avformat_free_context(encoder->container);
    if (encoder->io)
        av_freep(&encoder->io->buffer);
    avio_context_free(&encoder->io);
    kiln_avlog_end(&encoder->avlog);
    free(encoder);
}

void *kiln_video_open(const struct kiln_output_params *params, struct kiln_temporary *file,
                      struct kiln_error *error)
{
    struct video_encoder *encoder = calloc(1, sizeof *encoder);
    if (!encoder) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: no memory for the video", params->path);
        return NULL;
    }
    encoder->params = params;
    encoder->settings = params->format->video;
    encoder->file = file;
    encoder->avlog.log = &params->log;
    kiln_avlog_begin(&encoder->avlog);
    int status = open_codec(encoder);
    if (status >= 0)
        status = open_frame(encoder);
    if (status >= 0)
        status = open_scaler(encoder);
    if (status >= 0)
        status = open_container(encoder);
    kiln_avlog_end(&encoder->avlog);
    if (status >= 0)
        return encoder;
    fail(encoder, status, "the video encoder does not start", error);
    kiln_video_close(encoder);
    return NULL;
}

/* ---- Frames ------------------------------------------------------------------------------- */

/* Gives the codec a frame (NULL: no more come) and the container all packets it has ready.
 * AVERROR_EXIT when the caller wants no more, with its error. */
static int push(struct video_encoder *encoder, const AVFrame *frame,
                const struct kiln_output_caller *caller, struct kiln_error *error)
{
    int status = avcodec_send_frame(encoder->codec, frame);
    while (status >= 0) {
        if (!kiln_output_may_go_on(caller, error))
            return AVERROR_EXIT;
        status = avcodec_receive_packet(encoder->codec, encoder->packet);
        if (status == AVERROR(EAGAIN) || status == AVERROR_EOF)
            return 0;
        if (status < 0)
            return status;
        encoder->packet->duration = 1;
        av_packet_rescale_ts(encoder->packet, encoder->codec->time_base,
                             encoder->stream->time_base);
        status = av_interleaved_write_frame(encoder->container, encoder->packet);
    }
    return status;
}

/* Gives the codec the encoder's frame, unless making it failed. */
static bool push_frame(struct video_encoder *encoder, int status, int64_t number,
                       struct kiln_error *error)
{
    if (status >= 0) {
        encoder->frame->pts = number;
        status = push(encoder, encoder->frame, NULL, error);
    }
    kiln_avlog_end(&encoder->avlog);
    return status >= 0 || fail(encoder, status, "a frame cannot be encoded", error);
}

bool kiln_video_encode(void *opaque, const struct kiln_picture *picture, struct kiln_error *error)
{
    struct video_encoder *encoder = opaque;
    AVFrame *frame = encoder->frame;
    /* Lossy codecs smear the colours of pixels that nobody sees into those beside them. */
    if (picture->has_alpha && !is_rgb(frame->format) && !kiln_bleed_colors(picture, error))
        return false;
    kiln_avlog_begin(&encoder->avlog);
    int status = av_frame_make_writable(frame);
    if (status >= 0) {
        const uint8_t *rows[4] = {picture->display};
        int strides[4] = {frame->width * (int)(picture->bits / 2)};
        status = sws_scale(encoder->scaler, rows, strides, 0, frame->height, frame->data,
                           frame->linesize);
    }
    return push_frame(encoder, status, encoder->frames++, error);
}

bool kiln_video_encode_indices(void *opaque, const uint8_t *indices, const uint32_t palette[256],
                               int64_t number, struct kiln_error *error)
{
    struct video_encoder *encoder = opaque;
    AVFrame *frame = encoder->frame;
    kiln_avlog_begin(&encoder->avlog);
    int status = av_frame_make_writable(frame);
    if (status >= 0) {
        size_t width = (size_t)frame->width;
        for (int y = 0; y < frame->height; y++)
            memcpy(frame->data[0] + (ptrdiff_t)y * frame->linesize[0], indices + (size_t)y * width,
                   width);
        memcpy(frame->data[1], palette, 256 * sizeof *palette);
    }
    return push_frame(encoder, status, number, error);
}

/* Codecs that look ahead still have seconds of frames, and give one at a time. */
bool kiln_video_finish(void *opaque, const struct kiln_output_caller *caller,
                       struct kiln_error *error)
{
    struct video_encoder *encoder = opaque;
    kiln_avlog_begin(&encoder->avlog);
    int status = push(encoder, NULL, caller, error);
    if (status >= 0) {
        status = av_write_trailer(encoder->container);
        encoder->begun = false;
    }
    avio_flush(encoder->io);
    kiln_avlog_end(&encoder->avlog);
    if (status == AVERROR_EXIT)
        return false;
    return (status >= 0 && !encoder->file->failure) ||
           fail(encoder, status, "the video cannot be completed", error);
}
