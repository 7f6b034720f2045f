/* Has the formats that FFmpeg writes: for each, a row of the table in formats.c, and the settings
 * of its encoder and muxer for video.c. coder.c calls the `tune` functions on each new encoder. The
 * same frames must give the same bytes on every machine. So every setting that changes the bytes is
 * fixed: the settings of single formats here, and the number of threads and the distance of key
 * frames in coder.c. A part is a run of frames that one encoder encodes (part.h). */
#include "base/log.h"
#include "output/video.h"

enum { MAX_EDGE = 16384, MAX_WEBP_EDGE = 16383, MAX_APNG_DELAY = 65535 };

#define VIDEO_FORMAT(settings)                                                                     \
    .one_file = true, .video = &(settings), .needs = kiln_video_needs, .check = kiln_video_check,  \
    .open = kiln_video_open, .encode = kiln_video_encode, .finish = kiln_video_finish,             \
    .close = kiln_video_close

/* Sets an option of the encoder. False when memory is short. An option that this FFmpeg does not
 * have is ignored, since the file is right without it; its bytes may then be others. */
static bool set_option(AVCodecContext *codec, const char *key, const char *value)
{
    return kiln_ff.av_opt_set(codec->priv_data, key, value, 0) != AVERROR(ENOMEM);
}

/* ---- MP4 ---------------------------------------------------------------------------------- */

/* Sets the CRF (constant rate factor): quality 100 is 10, at which no eye sees a loss; 80 is 18, 50
 * is 30, 0 is 50. */
static bool tune_h264(AVCodecContext *codec, const struct kiln_output_params *params)
{
    kiln_ff.av_opt_set_double(codec->priv_data, "crf", 50.0 - 0.4 * params->quality, 0);
    /* The PSNR of "faster" is within 0.1 dB of that of "medium" at the same CRF, in 60 % of the
     * time and less memory. aq-mode=3 gives more bits to dark gradients, such as night and smoke.
     * cpu-independent makes the bytes independent of the CPU's SIMD instructions. scenecut=0 makes
     * no key frames at changes of scene, so a part has only that at its start. */
    return set_option(codec, "preset", "faster") && set_option(codec, "aq-mode", "3") &&
           set_option(codec, "x264-params", "cpu-independent=1:scenecut=0");
}

static const struct kiln_video_settings mp4 = {
    .muxer = "mp4",
    .encoder = "libx264",
    .codec = "H.264",
    .kind = "an MP4 video",
    .packages = "libavcodec59 and libx264-164",
    .bits = 8,
    .pixels = {{AV_PIX_FMT_YUV420P, AV_PIX_FMT_NONE}, {AV_PIX_FMT_NONE, AV_PIX_FMT_NONE}},
    .even_sizes = true,
    .max_edge = MAX_EDGE,
    .parts = true,
    /* SEI messages have x264's version and options; those of the first part are enough */
    .later_parts_filter = "filter_units=remove_types=6",
    .muxer_options = "movflags=+faststart",
    .tune = tune_h264,
};

const struct kiln_format kiln_format_mp4 = {
    .suffix = ".mp4",
    .name = "H.264 video",
    .help = "even sizes, no alpha; quality 0 to 100; 100 is visually lossless",
    .uses = KILN_USES_QUALITY,
    VIDEO_FORMAT(mp4),
};

/* ---- WebM --------------------------------------------------------------------------------- */

/* Sets the CRF: quality 100 is 8, 80 is 19, 0 is 63. Threads encode up to four columns of tiles
 * (2^2) in parallel, which does not change the bytes. Encoding rows of blocks in parallel (row-mt)
 * would. */
static bool tune_vp9(AVCodecContext *codec, const struct kiln_output_params *params)
{
    kiln_ff.av_opt_set_int(codec->priv_data, "crf", 63 - (55 * (int)params->quality + 50) / 100, 0);
    codec->bit_rate = 0; /* no limit: the CRF alone decides the quality */
    /* With alpha, hidden reference frames (alt-ref frames) are turned off, so that the colour and
     * the alpha stream have the same frames. */
    return set_option(codec, "deadline", "good") && set_option(codec, "cpu-used", "4") &&
           set_option(codec, "row-mt", "0") && set_option(codec, "tile-columns", "2") &&
           (!params->alpha || set_option(codec, "auto-alt-ref", "0"));
}

static const struct kiln_video_settings webm = {
    .muxer = "webm",
    .encoder = "libvpx-vp9",
    .codec = "VP9",
    .kind = "a WebM video",
    .packages = "libavcodec59 and libvpx7",
    .bits = 8,
    .pixels = {{AV_PIX_FMT_YUV420P, AV_PIX_FMT_NONE}, {AV_PIX_FMT_YUVA420P, AV_PIX_FMT_NONE}},
    .max_edge = MAX_EDGE,
    .parts = true,
    .tune = tune_vp9,
};

const struct kiln_format kiln_format_webm = {
    .suffix = ".webm",
    .name = "VP9 video",
    .help = "for the web, with alpha; quality 0 to 100; frame times in whole ms",
    .uses = KILN_USES_QUALITY,
    VIDEO_FORMAT(webm),
};

/* ---- Matroska ------------------------------------------------------------------------------ */

static bool tune_ffv1(AVCodecContext *codec, const struct kiln_output_params *params)
{
    (void)params;
    codec->level = 3; /* the version of FFV1 that has slices and their checksums */
    codec->slices = 4;
    return set_option(codec, "slicecrc", "1");
}

static const struct kiln_video_settings mkv = {
    .muxer = "matroska",
    .encoder = "ffv1",
    .codec = "FFV1",
    .kind = "an MKV video",
    .packages = "libavcodec59",
    .pixels = {{AV_PIX_FMT_BGR0, AV_PIX_FMT_RGB48}, {AV_PIX_FMT_BGRA, AV_PIX_FMT_RGBA64}},
    .max_edge = MAX_EDGE,
    .intra = true,
    .parts = true,
    .tune = tune_ffv1,
};

const struct kiln_format kiln_format_mkv = {
    .suffix = ".mkv",
    .name = "FFV1 video",
    .help = "lossless, 8 or 16 bits (--png-bits), with alpha; frame times in whole ms",
    .uses = KILN_USES_PNG_BITS,
    VIDEO_FORMAT(mkv),
};

/* ---- QuickTime ----------------------------------------------------------------------------- */

/* Sets a fixed quantiser: 1 at quality 100, 3 at 80, 11 at 0. */
static bool tune_prores(AVCodecContext *codec, const struct kiln_output_params *params)
{
    codec->flags |= AV_CODEC_FLAG_QSCALE;
    codec->global_quality = FF_QP2LAMBDA * (11 - (int)params->quality / 10);
    /* Some programs open only files of this vendor. */
    return set_option(codec, "profile", "4444") && set_option(codec, "vendor", "apl0") &&
           set_option(codec, "alpha_bits", params->alpha ? "16" : "0");
}

static const struct kiln_video_settings mov = {
    .muxer = "mov",
    .encoder = "prores_ks",
    .codec = "ProRes",
    .kind = "a MOV video",
    .packages = "libavcodec59",
    .bits = 16,
    .pixels = {{AV_PIX_FMT_NONE, AV_PIX_FMT_YUV444P10}, {AV_PIX_FMT_NONE, AV_PIX_FMT_YUVA444P10}},
    .max_edge = MAX_EDGE,
    .intra = true,
    .parts = true,
    .muxer_options = "movflags=+faststart",
    .tune = tune_prores,
};

const struct kiln_format kiln_format_mov = {
    .suffix = ".mov",
    .name = "ProRes 4444 video",
    .help = "for editing, 10 bits, with alpha; quality 0 to 100",
    .uses = KILN_USES_QUALITY,
    VIDEO_FORMAT(mov),
};

/* ---- Animated PNG -------------------------------------------------------------------------- */

static bool tune_apng(AVCodecContext *codec, const struct kiln_output_params *params)
{
    (void)params;
    codec->compression_level = 3;
    /* If this were not set, the encoder would write an aspect ratio of 0. */
    codec->sample_aspect_ratio = (AVRational){1, 1};
    return set_option(codec, "pred", "sub"); /* the fastest filter that helps */
}

/* Warns of frames that browsers show for a tenth of a second: those of less than 11 ms. */
static void warn_of_browsers(const struct kiln_output_params *params, const char *format)
{
    enum { SHORTEST_MS = 11 };
    if ((uint64_t)params->fps_den * 1000 < (uint64_t)params->fps_num * SHORTEST_MS)
        kiln_log_write(&params->log, KILN_LOG_WARNING,
                       "%s: browsers play %s at %.6g frames a second as slowly as at 10; they play "
                       "at most %d as they should",
                       params->path, format, (double)params->fps_num / params->fps_den,
                       1000 / SHORTEST_MS);
}

/* Sets the delay after the last frame, since the muxer knows only those between frames. APNG stores
 * delays as fractions of 16-bit numbers; the muxer rounds the others in the same way. */
static int prepare_apng(const struct kiln_output_params *params, AVDictionary **options)
{
    AVRational delay;
    warn_of_browsers(params, "APNG");
    if (!kiln_ff.av_reduce(&delay.num, &delay.den, params->fps_den, params->fps_num,
                           MAX_APNG_DELAY))
        kiln_log_write(&params->log, KILN_LOG_WARNING,
                       "%s: APNG cannot hold %u/%u frames a second, so the file has %d/%d",
                       params->path, params->fps_num, params->fps_den, delay.den, delay.num);
    char text[32];
    snprintf(text, sizeof text, "%d/%d", delay.num, delay.den);
    return kiln_ff.av_dict_set(options, "final_delay", text, 0);
}

static const struct kiln_video_settings apng = {
    .muxer = "apng",
    .encoder = "apng",
    .codec = "APNG",
    .kind = "an APNG animation",
    .packages = "libavcodec59",
    .pixels = {{AV_PIX_FMT_RGB24, AV_PIX_FMT_RGB48BE}, {AV_PIX_FMT_RGBA, AV_PIX_FMT_RGBA64BE}},
    .max_edge = MAX_EDGE,
    .muxer_options = "plays=0",
    .tune = tune_apng,
    .prepare = prepare_apng,
};

const struct kiln_format kiln_format_apng = {
    .suffix = ".apng",
    .name = "animated PNG",
    .help = "lossless, 8 or 16 bits (--png-bits), with alpha; plays forever",
    .uses = KILN_USES_PNG_BITS,
    VIDEO_FORMAT(apng),
};

/* ---- Animated WebP ------------------------------------------------------------------------- */

static bool tune_webp(AVCodecContext *codec, const struct kiln_output_params *params)
{
    /* libwebp takes "quality" as the effort where it encodes without loss. */
    kiln_ff.av_opt_set_double(codec->priv_data, "quality",
                              params->quality == 100 ? 50 : params->quality, 0);
    return set_option(codec, "lossless", params->quality == 100 ? "1" : "0");
}

static int prepare_webp(const struct kiln_output_params *params, AVDictionary **options)
{
    (void)options;
    warn_of_browsers(params, "WebP");
    return 0;
}

static const struct kiln_video_settings webp = {
    .muxer = "webp",
    .encoder = "libwebp_anim",
    .codec = "WebP",
    .kind = "a WebP animation",
    .packages = "libavcodec59, libwebp7 and libwebpmux3",
    .bits = 8,
    .pixels = {{AV_PIX_FMT_BGRA, AV_PIX_FMT_NONE}, {AV_PIX_FMT_BGRA, AV_PIX_FMT_NONE}},
    .max_edge = MAX_WEBP_EDGE,
    .muxer_options = "loop=0",
    .tune = tune_webp,
    .prepare = prepare_webp,
};

const struct kiln_format kiln_format_webp = {
    .suffix = ".webp",
    .name = "animated WebP",
    .help = "with alpha; quality 0 to 100; 100 is lossless; frame times in whole ms; plays forever",
    .uses = KILN_USES_QUALITY,
    VIDEO_FORMAT(webp),
};
