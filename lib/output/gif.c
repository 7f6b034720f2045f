/* Writes GIF clips with one palette: 255 colours for the whole clip, and one index for "unchanged".
 * The colours must be known before the first frame is written, so the frames wait in a temporary
 * file. FFmpeg's own way, palettegen and paletteuse, would hold them in memory, and make a whole
 * graph of filters a dependency. */
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>

#include "base/error.h"
#include "base/log.h"
#include "base/ranges.h"
#include "output/palette.h"
#include "output/video.h"

enum {
    TICKS_PER_S = 100,
    MAX_RATE = 50, /* browsers play faster clips at only 10 frames a second */
    MIN_DELAY = TICKS_PER_S / MAX_RATE,
    MAX_DELAY = 65535,
    TRANSPARENT = 255,
};

struct gif_encoder {
    const struct kiln_output_params *params;
    struct kiln_temporary *file;
    struct kiln_temporary waiting; /* frames that wait for the palette, three bytes a pixel */
    struct kiln_histogram *histogram;
    uint8_t *rgb; /* pixels of one frame */
    uint8_t *indices;
    uint32_t stride; /* every stride-th frame is written */
    uint64_t frames; /* number of frames that were given */
};

static uint32_t choose_stride(const struct kiln_output_params *params)
{
    uint64_t most = (uint64_t)MAX_RATE * params->fps_den;
    return (uint32_t)((params->fps_num + most - 1) / most);
}

/* Returns the time at which a frame begins, in hundredths of a second, as FFmpeg rounds it. */
static int64_t tick(const struct kiln_output_params *params, uint64_t frame)
{
    return kiln_ff.av_rescale((int64_t)frame, (int64_t)params->fps_den * TICKS_PER_S,
                              params->fps_num);
}

/* Sets the duration of the last frame. Without it, that frame would last as long as the one before.
 * It is never shorter than MAX_RATE allows, because browsers show such a frame for a tenth of a
 * second. */
static int prepare(const struct kiln_output_params *params, AVDictionary **options)
{
    uint64_t length = kiln_ranges_count(params->clip, params->clip_count),
             stride = choose_stride(params);
    uint64_t last = (length - 1) / stride * stride;
    int64_t delay = tick(params, length) - tick(params, last);
    return kiln_ff.av_dict_set_int(options, "final_delay", delay < MIN_DELAY ? MIN_DELAY : delay,
                                   0);
}

static bool check(const struct kiln_output_params *params, struct kiln_error *error)
{
    if (!kiln_video_check(params, error))
        return false;
    return (uint64_t)params->fps_den * TICKS_PER_S <= (uint64_t)params->fps_num * MAX_DELAY ||
           kiln_error_set(
               error, KILN_USAGE,
               "%s: the rate is %u/%u frames a second, but GIF shows a frame for at most 655.35 s",
               params->path, params->fps_num, params->fps_den);
}

static void warn_of_times(const struct gif_encoder *encoder)
{
    const struct kiln_output_params *params = encoder->params;
    uint64_t ticks = (uint64_t)encoder->stride * params->fps_den * TICKS_PER_S;
    double rate = (double)params->fps_num / params->fps_den;
    char times[96] = "";
    if (ticks % params->fps_num != 0)
        snprintf(times, sizeof times, "frames last %.2f or %.2f s, on average %.4f s",
                 (double)(ticks / params->fps_num) / TICKS_PER_S,
                 (double)(ticks / params->fps_num + 1) / TICKS_PER_S, encoder->stride / rate);
    if (encoder->stride > 1)
        kiln_log_write(&params->log, KILN_LOG_WARNING,
                       "%s: GIF plays at most %d frames a second; of the %.6g frames a second, 1 "
                       "in %u is written%s%s",
                       params->path, MAX_RATE, rate, encoder->stride, *times ? "; " : "", times);
    else if (*times)
        kiln_log_write(&params->log, KILN_LOG_WARNING,
                       "%s: GIF counts times in 1/100 s; at %.6g frames a second, %s", params->path,
                       rate, times);
}

static void close_encoder(void *opaque)
{
    struct gif_encoder *encoder = opaque;
    kiln_temporary_discard(&encoder->waiting);
    kiln_histogram_destroy(&encoder->histogram);
    free(encoder->rgb);
    free(encoder->indices);
    free(encoder);
}

static void *open_encoder(const struct kiln_output_params *params, struct kiln_temporary *file,
                          struct kiln_error *error)
{
    size_t pixels = (size_t)params->width * params->height;
    struct gif_encoder *encoder = calloc(1, sizeof *encoder);
    if (encoder) {
        encoder->params = params;
        encoder->file = file;
        encoder->stride = choose_stride(params);
        encoder->histogram = kiln_histogram_create();
        encoder->rgb = malloc(3 * pixels);
        encoder->indices = malloc(pixels);
    }
    if (!encoder || !encoder->histogram || !encoder->rgb || !encoder->indices) {
        kiln_error_no_memory(error, "the GIF encoder of %s", params->path);
    } else if (kiln_temporary_open(&encoder->waiting, file->target, error)) {
        warn_of_times(encoder);
        return encoder;
    }
    if (encoder)
        close_encoder(encoder);
    return NULL;
}

static bool encode(void *opaque, const struct kiln_picture *picture, struct kiln_error *error)
{
    struct gif_encoder *encoder = opaque;
    if (encoder->frames++ % encoder->stride != 0)
        return true;
    size_t pixels = (size_t)picture->width * picture->height;
    const uint16_t *display = picture->display;
    for (size_t i = 0; i < pixels; i++) {
        for (size_t c = 0; c < 3; c++)
            encoder->rgb[3 * i + c] = (uint8_t)((display[4 * i + c] + 128) / 257);
    }
    kiln_histogram_add(encoder->histogram, encoder->rgb, pixels);
    return kiln_temporary_write(&encoder->waiting, encoder->rgb, 3 * pixels) ||
           kiln_temporary_fail(&encoder->waiting, error);
}

static bool write_frames(struct gif_encoder *encoder, FILE *waiting, void *video,
                         const struct kiln_palette *palette, struct kiln_dither *dither,
                         const struct kiln_caller *caller, struct kiln_error *error)
{
    const struct kiln_output_params *params = encoder->params;
    size_t width = params->width, row_size = 3 * width, size = row_size * params->height;
    uint32_t colors[KILN_MAX_PALETTE];
    for (uint32_t i = 0; i < KILN_MAX_PALETTE; i++) {
        const uint8_t *color = palette->colors[i < palette->count ? i : 0];
        colors[i] = 0xff000000u | (uint32_t)color[0] << 16 | (uint32_t)color[1] << 8 | color[2];
    }
    colors[TRANSPARENT] = 0;
    for (uint64_t frame = 0; frame < encoder->frames; frame += encoder->stride) {
        if (fread(encoder->rgb, 1, size, waiting) != size)
            return kiln_error_set_errno(error, KILN_IO, ferror(waiting) ? errno : EIO,
                                        "%s: frames that wait for the palette cannot be read",
                                        params->path);
        for (uint32_t y = 0; y < params->height; y++) {
            if (!kiln_may_go_on(caller, error))
                return false;
            kiln_dither_row(dither, y, encoder->rgb + y * row_size, params->width,
                            encoder->indices + y * width);
        }
        if (!kiln_video_encode_indices(video, encoder->indices, colors, (int64_t)frame, error))
            return false;
    }
    return true;
}

static bool finish(void *opaque, const struct kiln_caller *caller, struct kiln_error *error)
{
    struct gif_encoder *encoder = opaque;
    struct kiln_palette palette;
    if (!kiln_palette_make(&palette, encoder->histogram, TRANSPARENT, caller, error))
        return false;
    struct kiln_dither *dither = kiln_dither_create(&palette);
    if (!dither)
        return kiln_error_no_memory(error, "the palette of %s", encoder->params->path);
    bool good = false;
    FILE *waiting = fopen(kiln_temporary_path(&encoder->waiting), "rb");
    if (!waiting)
        kiln_error_set_errno(error, KILN_IO, errno, "%s: frames that wait for the palette are gone",
                             encoder->params->path);
    void *video = waiting ? kiln_video_open(encoder->params, encoder->file, error) : NULL;
    if (video) {
        good = write_frames(encoder, waiting, video, &palette, dither, caller, error) &&
               kiln_video_finish(video, caller, error);
        kiln_video_close(video);
    }
    if (waiting)
        fclose(waiting);
    kiln_dither_destroy(&dither);
    return good;
}

static const struct kiln_video_settings settings = {
    .muxer = "gif",
    .encoder = "gif",
    .codec = "GIF",
    .kind = "a GIF animation",
    .packages = "libavcodec59",
    /* 8-bit frames are dithered with other noise in each frame, so still pixels would flicker */
    .bits = 16,
    .pixels = {{AV_PIX_FMT_NONE, AV_PIX_FMT_PAL8}, {AV_PIX_FMT_NONE, AV_PIX_FMT_NONE}},
    .max_edge = 16384,
    .muxer_options = "loop=0",
    .prepare = prepare,
};

const struct kiln_format kiln_format_gif = {
    .suffix = ".gif",
    .name = "GIF animation",
    .help = "255 colours a clip, no alpha, at most 50 frames a second; plays forever",
    .one_file = true,
    .video = &settings,
    .needs = kiln_video_needs,
    .check = check,
    .open = open_encoder,
    .encode = encode,
    .finish = finish,
    .close = close_encoder,
};
