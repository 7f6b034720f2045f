/* This file converts decoded frames of FFmpeg to pictures. Frames of bytes of red, green and
 * blue are copied, others go through swscale. */
#include "avframe.h"

#include <stdlib.h>
#include <string.h>

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

/* Returns whether a pixel is bytes of red, green, blue (and alpha), or of grey, of up to 8 bits
 * each, or an index into a palette. */
static bool is_plain(const AVPixFmtDescriptor *layout)
{
    const uint64_t other =
        AV_PIX_FMT_FLAG_BITSTREAM | AV_PIX_FMT_FLAG_PLANAR | AV_PIX_FMT_FLAG_BAYER;
    const bool colored = (layout->flags & AV_PIX_FMT_FLAG_RGB) && layout->nb_components >= 3;
    return !(layout->flags & other) && layout->comp[0].depth <= 8 &&
           ((layout->flags & AV_PIX_FMT_FLAG_PAL) || colored);
}

/* Returns a component of a pixel, whose range is all of 8 bits however many the file has. swscale
 * would make 248 of white of 5 bits. */
static uint8_t component_at(const uint8_t *pixel, const AVPixFmtDescriptor *layout, int c)
{
    const AVComponentDescriptor *component = &layout->comp[c];
    const uint8_t *at = pixel + component->offset;
    const bool big = (layout->flags & AV_PIX_FMT_FLAG_BE) != 0;
    const bool one_byte = component->shift + component->depth <= 8;
    const uint32_t most = (1u << component->depth) - 1;
    const uint32_t word = one_byte ? at[big]
                          : big    ? (uint32_t)(at[0] << 8 | at[1])
                                   : (uint32_t)(at[1] << 8 | at[0]);
    const uint32_t value = word >> component->shift & most;
    return (uint8_t)((value * 255 + most / 2) / most);
}

static void copy_plain(const AVFrame *frame, const AVPixFmtDescriptor *layout,
                       const struct kiln_asset_image *image)
{
    uint8_t *out = image->pixels;
    for (uint32_t y = 0; y < image->height; y++) {
        const uint8_t *row = frame->data[0] + (ptrdiff_t)y * frame->linesize[0];
        for (uint32_t x = 0; x < image->width; x++, out += 4) {
            uint32_t color;
            if (layout->flags & AV_PIX_FMT_FLAG_PAL) {
                memcpy(&color, frame->data[1] + 4 * (size_t)row[x], sizeof color);
                for (int c = 0; c < 4; c++) /* the number is alpha, red, green, blue */
                    out[c] = (uint8_t)(color >> (c == 3 ? 24 : 16 - 8 * c));
                continue;
            }
            const uint8_t *pixel = row + (size_t)x * (size_t)layout->comp[0].step;
            for (int c = 0; c < 3; c++)
                out[c] = component_at(pixel, layout, c);
            out[3] = layout->nb_components > 3 ? component_at(pixel, layout, 3) : 255;
        }
    }
}

static enum kiln_code convert(struct conversion *conversion)
{
    const AVFrame *frame = conversion->frame;
    const AVPixFmtDescriptor *layout = kiln_ff.av_pix_fmt_desc_get(frame->format);
    struct kiln_asset_image *image = calloc(1, sizeof *image);
    conversion->image = image;
    if (!layout || !image)
        return fail(conversion, KILN_DEVICE_FAILED, "out of memory for decoding the image");
    if (layout->flags & AV_PIX_FMT_FLAG_FLOAT)
        return fail(conversion, KILN_INVALID_INPUT,
                    "its frames are floats, such as EXR, which kiln does not read from a video; "
                    "EXR files are read one for each frame");
    image->width = (uint32_t)frame->width;
    image->height = (uint32_t)frame->height;
    image->type = layout->comp[0].depth > 8 ? KILN_IMAGE_U16 : KILN_IMAGE_U8;
    image->srgb = frame->color_trc != AVCOL_TRC_LINEAR;
    /* swscale may write whole vectors past the last row's end. */
    enum { SLACK = 64 };
    image->pixels = malloc(kiln_asset_image_bytes(image) + SLACK);
    if (!image->pixels)
        return fail(conversion, KILN_DEVICE_FAILED, "out of memory for decoding the image");
    enum kiln_code code = KILN_OK;
    if (is_plain(layout))
        copy_plain(frame, layout, image);
    else
        code = convert_integer(conversion);
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
