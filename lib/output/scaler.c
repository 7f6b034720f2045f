/* Opens FFmpeg's scaler with all settings that decide about its result. */
#include "output/scaler.h"

bool kiln_pixels_are_rgb(enum AVPixelFormat format)
{
    return kiln_ff.av_pix_fmt_desc_get(format)->flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL);
}

int kiln_scaler_open(struct SwsContext **scaler, uint32_t width, uint32_t height, uint32_t bits,
                     enum AVPixelFormat format)
{
    struct SwsContext *s = *scaler = kiln_ff.sws_alloc_context();
    if (!s)
        return AVERROR(ENOMEM);
    const bool rgb = kiln_pixels_are_rgb(format);
    kiln_ff.av_opt_set_int(s, "srcw", width, 0);
    kiln_ff.av_opt_set_int(s, "srch", height, 0);
    kiln_ff.av_opt_set_int(s, "src_format", bits > 8 ? AV_PIX_FMT_RGBA64 : AV_PIX_FMT_RGBA, 0);
    kiln_ff.av_opt_set_int(s, "src_range", 1, 0);
    kiln_ff.av_opt_set_int(s, "dstw", width, 0);
    kiln_ff.av_opt_set_int(s, "dsth", height, 0);
    kiln_ff.av_opt_set_int(s, "dst_format", format, 0);
    kiln_ff.av_opt_set_int(s, "dst_range", rgb, 0);
    kiln_ff.av_opt_set_int(s, "dst_h_chr_pos", 0, 0);
    kiln_ff.av_opt_set_int(s, "dst_v_chr_pos", 128, 0);
    kiln_ff.av_opt_set_int(s, "sws_flags",
                           SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP | SWS_BITEXACT, 0);
    int status = kiln_ff.sws_init_context(s, NULL, NULL);
    if (status < 0 || rgb)
        return status;
    const int *bt709 = kiln_ff.sws_getCoefficients(SWS_CS_ITU709);
    status = kiln_ff.sws_setColorspaceDetails(s, bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
    return status < 0 ? AVERROR(EINVAL) : 0;
}
