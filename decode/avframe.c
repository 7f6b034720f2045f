/* This file converts decoded frames of FFmpeg to pictures. Integer frames go through swscale; float
 * frames are only reordered. */
#include "avframe.h"

#include <math.h>
#include <stdlib.h>

#include "decode.h"

struct conversion {
    const AVFrame *frame;
    struct kiln_asset_image *image;
    const char *problem;
};

static enum kiln_code fail(struct conversion *conversion, enum kiln_code code, const char *problem)
{
    conversion->problem = problem;
    return code;
}

static const float *float_row(const AVFrame *frame, int plane, uint32_t y)
{
    return (const float *)(const void *)(frame->data[plane] +
                                         (ptrdiff_t)y * frame->linesize[plane]);
}

/* Interleaves the planes of a float frame, which FFmpeg orders green, blue, red, alpha. */
static enum kiln_code interleave_float(struct conversion *conversion)
{
    static const int planes[2][3] = {{0, 0, 0}, {2, 0, 1}};
    const AVFrame *frame = conversion->frame;
    const struct kiln_asset_image *image = conversion->image;
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
    return finite ? KILN_OK
                  : fail(conversion, KILN_INVALID_INPUT,
                         "the image is cut short, or has pixels that are not finite numbers");
}

/* Sets the colour matrix and range of a frame that is not RGB. */
static void set_colors(struct SwsContext *scaler, const AVFrame *frame)
{
    const AVPixFmtDescriptor *layout = kiln_ff.av_pix_fmt_desc_get(frame->format);
    bool full = frame->color_range == AVCOL_RANGE_JPEG;
    bool known = frame->colorspace != AVCOL_SPC_UNSPECIFIED && frame->colorspace != AVCOL_SPC_RGB;
    if (!full && (!known || (layout->flags & AV_PIX_FMT_FLAG_RGB)))
        return;
    kiln_ff.sws_setColorspaceDetails(
        scaler, kiln_ff.sws_getCoefficients(known ? (int)frame->colorspace : SWS_CS_DEFAULT), full,
        kiln_ff.sws_getCoefficients(SWS_CS_DEFAULT), 1, 0, 1 << 16, 1 << 16);
}

static enum kiln_code convert_integer(struct conversion *conversion)
{
    const AVFrame *frame = conversion->frame;
    const struct kiln_asset_image *image = conversion->image;
    bool deep = image->type == KILN_IMAGE_U16;
    enum AVPixelFormat format = deep ? AV_PIX_FMT_RGBA64 : AV_PIX_FMT_RGBA;
    int width = (int)image->width, height = (int)image->height;
    struct SwsContext *scaler = kiln_ff.sws_getContext(
        width, height, frame->format, width, height, format,
        SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_BITEXACT, NULL, NULL, NULL);
    if (!scaler && kiln_ff.sws_isSupportedInput(frame->format))
        return fail(conversion, KILN_DEVICE_FAILED, "out of memory for decoding the image");
    if (!scaler)
        return fail(conversion, KILN_INVALID_INPUT, "the image's pixel format cannot be read");
    set_colors(scaler, frame);
    uint8_t *rows[4] = {image->pixels};
    int strides[4] = {width * (deep ? 8 : 4)};
    int done = kiln_ff.sws_scale(scaler, (const uint8_t *const *)frame->data, frame->linesize, 0,
                                 height, rows, strides);
    kiln_ff.sws_freeContext(scaler);
    return done == height ? KILN_OK
                          : fail(conversion, KILN_INVALID_INPUT, "the image cannot be converted");
}

static enum kiln_code convert(struct conversion *conversion)
{
    const AVFrame *frame = conversion->frame;
    const AVPixFmtDescriptor *layout = kiln_ff.av_pix_fmt_desc_get(frame->format);
    struct kiln_asset_image *image = calloc(1, sizeof *image);
    conversion->image = image;
    if (!layout || !image)
        return fail(conversion, KILN_DEVICE_FAILED, "out of memory for decoding the image");
    bool is_float = frame->format == AV_PIX_FMT_GBRPF32 || frame->format == AV_PIX_FMT_GBRAPF32 ||
                    frame->format == AV_PIX_FMT_GRAYF32;
    image->width = (uint32_t)frame->width;
    image->height = (uint32_t)frame->height;
    image->type = is_float                    ? KILN_IMAGE_F32
                  : layout->comp[0].depth > 8 ? KILN_IMAGE_U16
                                              : KILN_IMAGE_U8;
    image->srgb = !is_float && frame->color_trc != AVCOL_TRC_LINEAR;
    image->premultiplied = frame->format == AV_PIX_FMT_GBRAPF32;
    /* swscale may write whole vectors past the last row's end. */
    enum { SLACK = 64 };
    image->pixels = malloc(kiln_asset_image_bytes(image) + SLACK);
    if (!image->pixels)
        return fail(conversion, KILN_DEVICE_FAILED, "out of memory for decoding the image");
    enum kiln_code code = is_float ? interleave_float(conversion) : convert_integer(conversion);
    image->channels = layout->nb_components;
    if (code == KILN_OK && (layout->flags & AV_PIX_FMT_FLAG_PAL))
        decode_find_alpha(image);
    return code;
}

enum kiln_code decode_avframe(const AVFrame *frame, struct kiln_asset_image **image,
                              const char **problem)
{
    struct conversion conversion = {.frame = frame};
    enum kiln_code code = convert(&conversion);
    if (code != KILN_OK)
        kiln_asset_image_destroy(&conversion.image);
    *image = conversion.image;
    *problem = conversion.problem;
    return code;
}

/* Without these settings, the fast transforms of JPEG and MPEG round differently on each kind of
 * processor. */
void decode_same_everywhere(AVCodecContext *decoder)
{
    decoder->flags |= AV_CODEC_FLAG_BITEXACT;
    decoder->idct_algo = FF_IDCT_SIMPLE;
}
