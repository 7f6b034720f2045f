/* H.264 in MP4 by FFmpeg. The pixels are converted with BT.709's matrix to limited range, and the
 * tags say just that: primaries and matrix of BT.709, and sRGB's transfer function, since that is
 * what the frames are encoded with. Players that honour the tag show the PNG's colours, and those
 * that ignore it take the pixels as they are, which on an sRGB screen is the same.
 *
 * The same frames give the same bytes on every machine: x264's result depends on its number of
 * threads, so that is fixed, and nothing of the time or the place is written. */
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/avstring.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
#include <limits.h>
#include <stdlib.h>

#include "asset/avlog.h"
#include "base/error.h"
#include "output/formats.h"

#define ENCODER_NAME "libx264"

enum {
    ENCODER_THREADS = 4,
    IO_BUFFER_SIZE = 1 << 17,
    MAX_EDGE = 16384,
    KEYFRAME_SECONDS = 2, /* so that seeking stays quick */
};

struct video_encoder {
    const struct kiln_output_params *params;
    struct kiln_temporary *file;
    struct kiln_avlog avlog;
    AVFormatContext *container;
    AVIOContext *io;
    AVStream *stream; /* the container's */
    AVCodecContext *codec;
    AVFrame *frame;
    AVPacket *packet;
    struct SwsContext *scaler;
    int64_t frames;
};

static struct kiln_output_needs needs(const struct kiln_output_params *params)
{
    (void)params;
    return (struct kiln_output_needs){.bits = 8};
}

static bool check(const struct kiln_output_params *params, struct kiln_error *error)
{
    if (params->width % 2 || params->height % 2)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: a video of %u x %u pixels; H.264 needs even sizes, the nearest "
                              "is %ux%u",
                              params->path, params->width, params->height,
                              params->width + params->width % 2,
                              params->height + params->height % 2);
    if (params->width > MAX_EDGE || params->height > MAX_EDGE)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: a video of %u x %u pixels; H.264 allows at most %d a side",
                              params->path, params->width, params->height, MAX_EDGE);
    if (params->alpha)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: the backdrop is transparent, but an MP4 video has no alpha; "
                              "write images, or make the backdrop opaque",
                              params->path);
    if (params->quality > 100)
        return kiln_error_set(error, KILN_USAGE, "%s: quality %u; allowed are 0 to 100",
                              params->path, params->quality);
    if (params->fps_num == 0 || params->fps_den == 0 || params->fps_num > INT_MAX ||
        params->fps_den > INT_MAX)
        return kiln_error_set(error, KILN_USAGE, "%s: %u/%u is no frame rate for a video",
                              params->path, params->fps_num, params->fps_den);
    if (!avcodec_find_encoder_by_name(ENCODER_NAME))
        return kiln_error_set(error, KILN_IO,
                              "%s: this FFmpeg has no encoder " ENCODER_NAME "; install a "
                              "libavcodec that was built with it (on Debian, libavcodec59 and "
                              "libx264-164)",
                              params->path);
    return true;
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

/* quality 100 is a rate factor of 10, beyond what eyes can tell; 80 is 18, 50 is 30, 0 is 50. */
static double rate_factor(uint32_t quality)
{
    return 50.0 - 0.4 * quality;
}

static int open_codec(struct video_encoder *encoder)
{
    const struct kiln_output_params *params = encoder->params;
    const AVCodec *x264 = avcodec_find_encoder_by_name(ENCODER_NAME);
    AVCodecContext *codec = encoder->codec = avcodec_alloc_context3(x264);
    if (!codec)
        return AVERROR(ENOMEM);
    codec->width = (int)params->width;
    codec->height = (int)params->height;
    codec->pix_fmt = AV_PIX_FMT_YUV420P;
    codec->framerate = (AVRational){(int)params->fps_num, (int)params->fps_den};
    codec->time_base = av_inv_q(codec->framerate);
    uint64_t keyframe = (uint64_t)params->fps_num * KEYFRAME_SECONDS / params->fps_den;
    codec->gop_size = keyframe < 1 ? 1 : keyframe > 600 ? 600 : (int)keyframe;
    codec->color_primaries = AVCOL_PRI_BT709;
    codec->color_trc = AVCOL_TRC_IEC61966_2_1;
    codec->colorspace = AVCOL_SPC_BT709;
    codec->color_range = AVCOL_RANGE_MPEG;
    codec->chroma_sample_location = AVCHROMA_LOC_LEFT;
    codec->thread_count = ENCODER_THREADS;
    codec->flags |= AV_CODEC_FLAG_BITEXACT | AV_CODEC_FLAG_GLOBAL_HEADER;
    /* Within 0.1 dB of "medium" at the same rate factor, in 60 % of the time and less memory. */
    av_opt_set(codec->priv_data, "preset", "faster", 0);
    av_opt_set(codec->priv_data, "aq-mode", "3", 0); /* bits for dark gradients: night and smoke */
    av_opt_set_double(codec->priv_data, "crf", rate_factor(params->quality), 0);
    return avcodec_open2(codec, x264, NULL);
}

static int open_scaler(struct video_encoder *encoder)
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
    int status = av_frame_get_buffer(frame, 0);
    if (status < 0)
        return status;

    struct SwsContext *scaler = encoder->scaler = sws_alloc_context();
    if (!scaler)
        return AVERROR(ENOMEM);
    av_opt_set_int(scaler, "srcw", frame->width, 0);
    av_opt_set_int(scaler, "srch", frame->height, 0);
    av_opt_set_int(scaler, "src_format", AV_PIX_FMT_RGBA, 0);
    av_opt_set_int(scaler, "src_range", 1, 0);
    av_opt_set_int(scaler, "dstw", frame->width, 0);
    av_opt_set_int(scaler, "dsth", frame->height, 0);
    av_opt_set_int(scaler, "dst_format", AV_PIX_FMT_YUV420P, 0);
    av_opt_set_int(scaler, "dst_range", 0, 0);
    av_opt_set_int(scaler, "dst_h_chr_pos", 0, 0); /* left, as tagged */
    av_opt_set_int(scaler, "dst_v_chr_pos", 128, 0);
    av_opt_set_int(scaler, "sws_flags",
                   SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP | SWS_BITEXACT, 0);
    status = sws_init_context(scaler, NULL, NULL);
    if (status < 0)
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

/* The index goes to the front, so that a player can start before it has the whole file; for that
 * FFmpeg opens the temporary file once more, by its url. */
static int open_container(struct video_encoder *encoder)
{
    int status = avformat_alloc_output_context2(&encoder->container, NULL, "mp4", NULL);
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
    if (status < 0)
        return status;
    char comment[256];
    describe(encoder->params, comment, sizeof comment);
    av_dict_set(&container->metadata, "comment", comment, 0);
    AVDictionary *options = NULL;
    av_dict_set(&options, "movflags", "+faststart", 0);
    status = avformat_write_header(container, &options);
    av_dict_free(&options);
    return status;
}

static void close_encoder(void *opaque)
{
    struct video_encoder *encoder = opaque;
    kiln_avlog_begin(&encoder->avlog);
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

static void *open_encoder(const struct kiln_output_params *params, struct kiln_temporary *file,
                          struct kiln_error *error)
{
    struct video_encoder *encoder = calloc(1, sizeof *encoder);
    if (!encoder) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: no memory for the video", params->path);
        return NULL;
    }
    encoder->params = params;
    encoder->file = file;
    encoder->avlog.log = &params->log;
    kiln_avlog_begin(&encoder->avlog);
    int status = open_codec(encoder);
    if (status >= 0)
        status = open_scaler(encoder);
    if (status >= 0)
        status = open_container(encoder);
    kiln_avlog_end(&encoder->avlog);
    if (status >= 0)
        return encoder;
    fail(encoder, status, "the video encoder does not start", error);
    close_encoder(encoder);
    return NULL;
}

/* ---- Frames ------------------------------------------------------------------------------- */

/* Gives the codec a frame (NULL: no more come) and the container all packets it has ready. */
static int push(struct video_encoder *encoder, const AVFrame *frame)
{
    int status = avcodec_send_frame(encoder->codec, frame);
    while (status >= 0) {
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

static bool encode(void *opaque, const struct kiln_picture *picture, struct kiln_error *error)
{
    struct video_encoder *encoder = opaque;
    kiln_avlog_begin(&encoder->avlog);
    AVFrame *frame = encoder->frame;
    int status = av_frame_make_writable(frame);
    if (status >= 0) {
        const uint8_t *rows[4] = {picture->display};
        int strides[4] = {frame->width * 4};
        status = sws_scale(encoder->scaler, rows, strides, 0, frame->height, frame->data,
                           frame->linesize);
    }
    if (status >= 0) {
        frame->pts = encoder->frames++;
        status = push(encoder, frame);
    }
    kiln_avlog_end(&encoder->avlog);
    return status >= 0 || fail(encoder, status, "a frame cannot be encoded", error);
}

static bool finish(void *opaque, struct kiln_error *error)
{
    struct video_encoder *encoder = opaque;
    kiln_avlog_begin(&encoder->avlog);
    int status = push(encoder, NULL);
    if (status >= 0)
        status = av_write_trailer(encoder->container);
    avio_flush(encoder->io);
    kiln_avlog_end(&encoder->avlog);
    return (status >= 0 && !encoder->file->failure) ||
           fail(encoder, status, "the video cannot be completed", error);
}

const struct kiln_format kiln_format_mp4 = {
    .suffix = ".mp4",
    .name = "H.264 video",
    .help = "even sizes, no alpha; quality 0 to 100 (visually lossless)",
    .one_file = true,
    .needs = needs,
    .check = check,
    .open = open_encoder,
    .encode = encode,
    .finish = finish,
    .close = close_encoder,
};
