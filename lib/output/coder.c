/* Encodes one part of a clip with an FFmpeg encoder of its own, so that a part's packets do not
 * depend on which process encodes the other parts.
 *
 * Pixels of luma and chroma are made with BT.709's matrix in limited range (scaler.c), and the tags
 * say just that: primaries and matrix of BT.709, and sRGB's transfer function, since that is what
 * the frames are encoded with. Players that honour the tag show the PNG's colours, and those that
 * ignore it take the pixels as they are, which on an sRGB screen is the same.
 *
 * The same frames give the same bytes on every machine: some encoders' results depend on their
 * number of threads, so that is fixed. */
#include "output/coder.h"

#include <string.h>

#include "output/bleed.h"

enum { ENCODER_THREADS = 4 };

enum AVPixelFormat kiln_coder_pixels(const struct kiln_output_params *params)
{
    return params->format->video->pixels[params->alpha][kiln_video_needs(params).bits > 8];
}

static void set_colors(AVCodecContext *codec)
{
    bool rgb = kiln_pixels_are_rgb(codec->pix_fmt);
    codec->color_primaries = AVCOL_PRI_BT709;
    codec->color_trc = AVCOL_TRC_IEC61966_2_1;
    codec->colorspace = rgb ? AVCOL_SPC_RGB : AVCOL_SPC_BT709;
    codec->color_range = rgb ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    codec->chroma_sample_location = rgb ? AVCHROMA_LOC_UNSPECIFIED : AVCHROMA_LOC_LEFT;
}

static int open_codec(struct kiln_coder *coder, const struct kiln_output_params *params)
{
    const AVCodec *found = kiln_ff.avcodec_find_encoder_by_name(coder->settings->encoder);
    AVCodecContext *codec = coder->codec = kiln_ff.avcodec_alloc_context3(found);
    if (!codec)
        return AVERROR(ENOMEM);
    codec->width = (int)params->width;
    codec->height = (int)params->height;
    codec->pix_fmt = kiln_coder_pixels(params);
    codec->framerate = (AVRational){(int)params->fps_num, (int)params->fps_den};
    codec->time_base = av_inv_q(codec->framerate);
    codec->gop_size =
        coder->settings->intra ? 1 : (int)kiln_part_frames(params->fps_num, params->fps_den);
    set_colors(codec);
    codec->thread_count = ENCODER_THREADS;
    codec->flags |= AV_CODEC_FLAG_BITEXACT | AV_CODEC_FLAG_GLOBAL_HEADER;
    if (coder->settings->tune && !coder->settings->tune(codec, params))
        return AVERROR(ENOMEM);
    return kiln_ff.avcodec_open2(codec, found, NULL);
}

static int open_frame(struct kiln_coder *coder)
{
    AVFrame *frame = coder->frame = kiln_ff.av_frame_alloc();
    if (!frame)
        return AVERROR(ENOMEM);
    const AVCodecContext *codec = coder->codec;
    frame->width = codec->width;
    frame->height = codec->height;
    frame->format = codec->pix_fmt;
    frame->color_primaries = codec->color_primaries;
    frame->color_trc = codec->color_trc;
    frame->colorspace = codec->colorspace;
    frame->color_range = codec->color_range;
    frame->chroma_location = codec->chroma_sample_location;
    frame->quality = codec->global_quality;
    return kiln_ff.av_frame_get_buffer(frame, 0);
}

/* Opens the filter that removes from a part's packets the data that the first part's packets
 * already have. */
static int open_filter(struct kiln_coder *coder)
{
    int status = kiln_ff.av_bsf_list_parse_str(coder->settings->later_parts_filter, &coder->filter);
    if (status >= 0)
        status = kiln_ff.avcodec_parameters_from_context(coder->filter->par_in, coder->codec);
    if (status < 0)
        return status;
    coder->filter->time_base_in = coder->codec->time_base;
    return kiln_ff.av_bsf_init(coder->filter);
}

int kiln_coder_open(struct kiln_coder *coder, const struct kiln_output_params *params, bool first)
{
    *coder = (struct kiln_coder){.settings = params->format->video};
    int status = open_codec(coder, params);
    if (status >= 0)
        status = open_frame(coder);
    if (status >= 0 && coder->frame->format != AV_PIX_FMT_PAL8)
        status = kiln_scaler_open(&coder->scaler, params->width, params->height,
                                  kiln_video_needs(params).bits, coder->frame->format);
    if (status >= 0 && !first && coder->settings->later_parts_filter)
        status = open_filter(coder);
    return status;
}

void kiln_coder_close(struct kiln_coder *coder)
{
    kiln_ff.sws_freeContext(coder->scaler);
    kiln_ff.av_frame_free(&coder->frame);
    kiln_ff.av_bsf_free(&coder->filter);
    kiln_ff.avcodec_free_context(&coder->codec);
    *coder = (struct kiln_coder){.settings = NULL};
}

int kiln_coder_convert(struct kiln_coder *coder, const struct kiln_picture *picture)
{
    AVFrame *frame = coder->frame;
    struct kiln_error error = {0};
    /* A lossy codec mixes the colours of transparent pixels into their neighbours. */
    if (picture->has_alpha && !kiln_pixels_are_rgb(coder->codec->pix_fmt) &&
        !kiln_bleed_colors(picture, &error))
        return AVERROR(ENOMEM);
    int status = kiln_ff.av_frame_make_writable(frame);
    if (status < 0)
        return status;
    const uint8_t *rows[4] = {picture->display};
    int strides[4] = {frame->width * (int)(picture->bits / 2)};
    return kiln_ff.sws_scale(coder->scaler, rows, strides, 0, frame->height, frame->data,
                             frame->linesize);
}

int kiln_coder_send(struct kiln_coder *coder, int64_t number)
{
    coder->frame->pts = number;
    return kiln_ff.avcodec_send_frame(coder->codec, coder->frame);
}

int kiln_coder_end(struct kiln_coder *coder)
{
    return kiln_ff.avcodec_send_frame(coder->codec, NULL);
}

int kiln_coder_receive(struct kiln_coder *coder, AVPacket *packet)
{
    int status = kiln_ff.avcodec_receive_packet(coder->codec, packet);
    if (status < 0 || !coder->filter)
        return status;
    status = kiln_ff.av_bsf_send_packet(coder->filter, packet);
    return status < 0 ? status : kiln_ff.av_bsf_receive_packet(coder->filter, packet);
}
