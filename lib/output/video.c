/* Writes clips by FFmpeg: a sequence of parts, each encoded on its own (coder.c), in one container
 * (muxer.c). Formats differ by their settings alone. */
#include "output/video.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/ffmpeg.h"
#include "output/coder.h"
#include "output/muxer.h"

struct video_encoder {
    const struct kiln_output_params *params;
    const struct kiln_video_settings *settings;
    struct kiln_temporary *file;
    struct kiln_avlog avlog;
    struct kiln_coder coder; /* encoder of the present part */
    struct kiln_muxer muxer;
    AVPacket *packet;
    AVCodecParameters *codec; /* header of the first part */
    int64_t frames;           /* number of frames that were given */
    int64_t part_first;       /* number of the frame where the present part begins */
    int64_t part_packets;     /* number of packets of the present part */
};

struct kiln_output_needs kiln_video_needs(const struct kiln_output_params *params)
{
    uint32_t bits = params->format->video->bits;
    return (struct kiln_output_needs){.bits = bits ? bits : params->png_bits};
}

static bool check_size(const struct kiln_output_params *params, struct kiln_error *error)
{
    const struct kiln_video_settings *settings = params->format->video;
    if (settings->even_sizes && (params->width % 2 || params->height % 2))
        return kiln_error_set(
            error, KILN_USAGE,
            "%s: the video would have %u x %u pixels; %s needs even sizes, the nearest is %ux%u",
            params->path, params->width, params->height, settings->codec,
            params->width + params->width % 2, params->height + params->height % 2);
    return (params->width <= settings->max_edge && params->height <= settings->max_edge) ||
           kiln_error_set(error, KILN_USAGE,
                          "%s: the video would have %u x %u pixels; %s allows at most %u a side",
                          params->path, params->width, params->height, settings->codec,
                          settings->max_edge);
}

static bool refuse_build(const struct kiln_video_settings *settings, const char *what,
                         const char *name, struct kiln_error *error)
{
    return kiln_error_set(error, KILN_IO,
                          "this FFmpeg has no %s %s; install one that was built with it (on "
                          "Debian, %s)",
                          what, name, settings->packages);
}

static bool find_encoder(const struct kiln_video_settings *settings, struct kiln_error *error)
{
    return kiln_ffmpeg_open(KILN_FFMPEG_PICTURES, error) &&
           (kiln_ff.avcodec_find_encoder_by_name(settings->encoder) ||
            refuse_build(settings, "encoder", settings->encoder, error));
}

bool kiln_video_find(const struct kiln_video_settings *settings, struct kiln_error *error)
{
    return find_encoder(settings, error) && kiln_ffmpeg_open(KILN_FFMPEG_CLIPS, error) &&
           (kiln_ff.av_guess_format(settings->muxer, NULL, NULL) ||
            refuse_build(settings, "muxer", settings->muxer, error));
}

/* Finds the encoder, and also the muxer unless only a part is written. Opening the library for
 * containers takes a third of the time in which FFmpeg opens. */
static bool find(const struct kiln_output_params *params, struct kiln_error *error)
{
    struct kiln_error reason = {0};
    return (params->parts_alone ? find_encoder(params->format->video, &reason)
                                : kiln_video_find(params->format->video, &reason)) ||
           kiln_error_set(error, reason.code, "%s: %s", params->path, reason.message);
}

bool kiln_video_has_alpha(const struct kiln_output_params *params)
{
    struct kiln_output_params with_alpha = *params;
    with_alpha.alpha = true;
    return kiln_coder_pixels(&with_alpha) != AV_PIX_FMT_NONE;
}

bool kiln_video_check(const struct kiln_output_params *params, struct kiln_error *error)
{
    if (!check_size(params, error))
        return false;
    if (params->png_bits != 8 && params->png_bits != 16)
        return kiln_error_set(error, KILN_USAGE, "%s: found %u bits a channel; allowed are 8 or 16",
                              params->path, params->png_bits);
    if (kiln_coder_pixels(params) == AV_PIX_FMT_NONE)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: the backdrop is transparent, but %s has no alpha; write images, "
                              "a .webm or a .mov, or make the backdrop opaque",
                              params->path, params->format->video->kind);
    if (params->quality > 100)
        return kiln_error_set(error, KILN_USAGE, "%s: found quality %u; allowed are 0 to 100",
                              params->path, params->quality);
    if (params->fps_num == 0 || params->fps_den == 0 || params->fps_num > INT_MAX ||
        params->fps_den > INT_MAX)
        return kiln_error_set(
            error, KILN_USAGE,
            "%s: found %u/%u frames a second, which is not a frame rate for a video", params->path,
            params->fps_num, params->fps_den);
    return find(params, error);
}

bool kiln_video_fail(const struct kiln_output_params *params, const struct kiln_temporary *file,
                     const char *said, int status, const char *what, struct kiln_error *error)
{
    if (file->failure)
        return kiln_temporary_fail(file, error);
    if (status == AVERROR(ENOMEM))
        return kiln_error_no_memory(error, "the video encoder of %s", params->path);
    char reason[AV_ERROR_MAX_STRING_SIZE] = "";
    kiln_ff.av_strerror(status, reason, sizeof reason);
    return kiln_error_set(error, KILN_IO, "%s: %s: %s", params->path, what, *said ? said : reason);
}

static bool fail(const struct video_encoder *encoder, int status, const char *what,
                 struct kiln_error *error)
{
    return kiln_video_fail(encoder->params, encoder->file, encoder->avlog.first_error, status, what,
                           error);
}

/* ---- Parts -------------------------------------------------------------------------------- */

/* Returns whether a part's header is that of the first part: the clip has one header for all parts.
 */
static bool has_same_header(const AVCodecParameters *first, const uint8_t *header, size_t size)
{
    return (size_t)first->extradata_size == size &&
           (size == 0 || memcmp(first->extradata, header, size) == 0);
}

/* Starts the part of the next frame, and with the first part the container. */
static int open_part(struct video_encoder *encoder)
{
    const bool first = encoder->frames == 0;
    kiln_coder_close(&encoder->coder);
    int status = kiln_coder_open(&encoder->coder, encoder->params, first);
    if (status < 0)
        return status;
    encoder->part_first = encoder->frames;
    encoder->part_packets = 0;
    if (!first)
        return has_same_header(encoder->codec, encoder->coder.codec->extradata,
                               (size_t)encoder->coder.codec->extradata_size)
                   ? 0
                   : AVERROR_BUG;
    status = kiln_ff.avcodec_parameters_from_context(encoder->codec, encoder->coder.codec);
    return status < 0 ? status
                      : kiln_muxer_open(&encoder->muxer, encoder->params, encoder->codec,
                                        encoder->coder.codec->time_base, encoder->file);
}

void kiln_video_close(void *opaque)
{
    struct video_encoder *encoder = opaque;
    kiln_avlog_begin(&encoder->avlog);
    kiln_muxer_close(&encoder->muxer);
    kiln_coder_close(&encoder->coder);
    kiln_ff.av_packet_free(&encoder->packet);
    kiln_ff.avcodec_parameters_free(&encoder->codec);
    kiln_avlog_end(&encoder->avlog);
    free(encoder);
}

void *kiln_video_open(const struct kiln_output_params *params, struct kiln_temporary *file,
                      struct kiln_error *error)
{
    if (!find(params, error)) /* a run that only joins parts has not checked before */
        return NULL;
    struct video_encoder *encoder = calloc(1, sizeof *encoder);
    if (!encoder) {
        kiln_error_no_memory(error, "the video of %s", params->path);
        return NULL;
    }
    encoder->params = params;
    encoder->settings = params->format->video;
    encoder->file = file;
    encoder->avlog.log = &params->log;
    kiln_avlog_begin(&encoder->avlog);
    encoder->packet = kiln_ff.av_packet_alloc();
    encoder->codec = kiln_ff.avcodec_parameters_alloc();
    int status = encoder->packet && encoder->codec ? open_part(encoder) : AVERROR(ENOMEM);
    kiln_avlog_end(&encoder->avlog);
    if (status >= 0)
        return encoder;
    fail(encoder, status, "the video encoder does not start", error);
    kiln_video_close(encoder);
    return NULL;
}

/* ---- Frames ------------------------------------------------------------------------------- */

/* Writes a packet of the present part to the container. A part's decoding times are its frame
 * times, moved ahead by the number of frames that the encoder may reorder. They start at the
 * beginning of the part. */
static int add_packet(struct video_encoder *encoder, AVPacket *packet)
{
    packet->pts += encoder->part_first;
    packet->dts = encoder->part_first + encoder->part_packets++;
    if (encoder->settings->parts)
        packet->dts -= encoder->coder.codec->has_b_frames;
    else
        packet->dts = packet->pts; /* frames may be missing, but none are reordered */
    return kiln_muxer_add(&encoder->muxer, packet);
}

bool kiln_video_begin_part(void *opaque, int64_t first, const uint8_t *header, size_t size)
{
    struct video_encoder *encoder = opaque;
    encoder->part_first = first;
    encoder->part_packets = 0;
    return has_same_header(encoder->codec, header, size);
}

bool kiln_video_add_packet(void *opaque, AVPacket *packet, struct kiln_error *error)
{
    struct video_encoder *encoder = opaque;
    kiln_avlog_begin(&encoder->avlog);
    const int status = add_packet(encoder, packet);
    kiln_avlog_end(&encoder->avlog);
    return status >= 0 || fail(encoder, status, "the video cannot be written", error);
}

/* Writes all packets that are ready to the container. AVERROR_EXIT, with the caller's error, when
 * the caller wants no more. */
static int pass_packets(struct video_encoder *encoder, const struct kiln_caller *caller,
                        struct kiln_error *error)
{
    AVPacket *packet = encoder->packet;
    for (;;) {
        if (!kiln_may_go_on(caller, error))
            return AVERROR_EXIT;
        int status = kiln_coder_receive(&encoder->coder, packet);
        if (status == AVERROR(EAGAIN) || status == AVERROR_EOF)
            return 0;
        if (status < 0)
            return status;
        status = add_packet(encoder, packet);
        if (status < 0)
            return status;
    }
}

static int end_part(struct video_encoder *encoder, const struct kiln_caller *caller,
                    struct kiln_error *error)
{
    int status = kiln_coder_end(&encoder->coder);
    return status < 0 ? status : pass_packets(encoder, caller, error);
}

/* Begins a new part if this frame is the first of one. */
static int begin_frame(struct video_encoder *encoder, struct kiln_error *error)
{
    const struct kiln_output_params *params = encoder->params;
    const int64_t length = kiln_part_frames(params->fps_num, params->fps_den);
    if (!encoder->settings->parts || encoder->frames != encoder->part_first + length)
        return 0;
    int status = end_part(encoder, NULL, error);
    return status < 0 ? status : open_part(encoder);
}

/* Passes the frame to the encoder, unless making the frame failed. */
static bool push_frame(struct video_encoder *encoder, int status, int64_t number,
                       struct kiln_error *error)
{
    if (status >= 0)
        status = kiln_coder_send(&encoder->coder, number - encoder->part_first);
    if (status >= 0)
        status = pass_packets(encoder, NULL, error);
    kiln_avlog_end(&encoder->avlog);
    return status >= 0 || fail(encoder, status, "a frame cannot be encoded", error);
}

bool kiln_video_encode(void *opaque, const struct kiln_picture *picture, struct kiln_error *error)
{
    struct video_encoder *encoder = opaque;
    kiln_avlog_begin(&encoder->avlog);
    int status = begin_frame(encoder, error);
    if (status >= 0)
        status = kiln_coder_convert(&encoder->coder, picture);
    return push_frame(encoder, status, encoder->frames++, error);
}

bool kiln_video_encode_indices(void *opaque, const uint8_t *indices, const uint32_t palette[256],
                               int64_t number, struct kiln_error *error)
{
    struct video_encoder *encoder = opaque;
    AVFrame *frame = encoder->coder.frame;
    kiln_avlog_begin(&encoder->avlog);
    int status = kiln_ff.av_frame_make_writable(frame);
    if (status >= 0) {
        size_t width = (size_t)frame->width;
        for (int y = 0; y < frame->height; y++)
            memcpy(frame->data[0] + (ptrdiff_t)y * frame->linesize[0], indices + (size_t)y * width,
                   width);
        memcpy(frame->data[1], palette, 256 * sizeof *palette);
    }
    return push_frame(encoder, status, number, error);
}

/* Ends the clip. Codecs with a look-ahead still hold seconds of frames, and return them one by
 * one. */
bool kiln_video_finish(void *opaque, const struct kiln_caller *caller, struct kiln_error *error)
{
    struct video_encoder *encoder = opaque;
    kiln_avlog_begin(&encoder->avlog);
    int status = end_part(encoder, caller, error);
    if (status >= 0)
        status = kiln_muxer_finish(&encoder->muxer);
    kiln_avlog_end(&encoder->avlog);
    if (status == AVERROR_EXIT)
        return false;
    return (status >= 0 && !encoder->file->failure) ||
           fail(encoder, status, "the video cannot be completed", error);
}
