/* Writes frames as a sequence of bytes into a pipe: as YUV4MPEG2, or as pixels without any header.
 */
#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/budget.h"
#include "base/error.h"
#include "output/formats.h"
#include "output/scaler.h"

struct stream {
    const struct kiln_output_params *params;
    uint8_t *bytes; /* bytes of one frame */
    size_t size;
    size_t header;             /* number of bytes before the pixels of a frame */
    struct SwsContext *scaler; /* only for Y4M, else NULL */
    uint8_t *planes[4];
    int strides[4];
    uint32_t frames; /* number of frames that were written */
};

static const char FRAME_HEADER[] = "FRAME\n";

/* ---- the pixels of each kind --------------------------------------------------------------- */

/* Packs the four bytes of each pixel into three. */
static void pack_rgb(struct stream *stream, const struct kiln_picture *picture)
{
    const uint8_t *from = picture->display;
    const size_t pixels = (size_t)picture->width * picture->height;
    for (size_t i = 0; i < pixels; i++)
        memcpy(stream->bytes + 3 * i, from + 4 * i, 3);
}

static void pack_rgba(struct stream *stream, const struct kiln_picture *picture)
{
    memcpy(stream->bytes, picture->display, stream->size);
    for (size_t i = 3; i < stream->size && !picture->has_alpha; i += 4)
        stream->bytes[i] = UINT8_MAX;
}

static void pack_floats(struct stream *stream, const struct kiln_picture *picture)
{
    const float *from = picture->layers[0].pixels;
    for (size_t i = 0; i < stream->size / sizeof *from; i++) {
        uint32_t bits;
        memcpy(&bits, from + i, sizeof bits);
        for (size_t byte = 0; byte < sizeof bits; byte++)
            stream->bytes[sizeof bits * i + byte] = (uint8_t)(bits >> 8 * byte);
    }
}

static void pack_y4m(struct stream *stream, const struct kiln_picture *picture)
{
    const uint8_t *rows[4] = {picture->display};
    const int strides[4] = {(int)picture->width * 4};
    kiln_ff.sws_scale(stream->scaler, rows, strides, 0, (int)picture->height, stream->planes,
                      stream->strides);
}

static const struct kind {
    const char *name;
    struct kiln_output_needs needs;
    size_t pixel_bytes; /* 0: the planes of Y4M */
    bool alpha;
    void (*pack)(struct stream *stream, const struct kiln_picture *picture);
} kinds[] = {
    [KILN_STREAM_Y4M] = {"y4m", {.bits = 8}, 0, false, pack_y4m},
    [KILN_STREAM_RGB24] = {"rgb24", {.bits = 8}, 3, false, pack_rgb},
    [KILN_STREAM_RGBA] = {"rgba", {.bits = 8}, 4, true, pack_rgba},
    [KILN_STREAM_RGBAF32] = {"rgbaf32", {.layers = KILN_LAYERS_BEAUTY}, 16, true, pack_floats},
};

static const struct kind *kind_of(const struct kiln_output_params *params)
{
    return &kinds[params->stream.format];
}

/* ---- writing -------------------------------------------------------------------------------- */

/* Writes all bytes, and waits for a slow reader without a limit. */
static bool write_all(const struct stream *stream, const void *bytes, size_t size,
                      struct kiln_error *error)
{
    const int descriptor = stream->params->stream.descriptor;
    if (!kiln_budget_take(stream->params->budget, KILN_LIMIT_output, size, stream->params->path,
                          error))
        return false;
    for (const char *at = bytes; size > 0;) {
        const ssize_t written = write(descriptor, at, size);
        if (written >= 0) {
            at += written;
            size -= (size_t)written;
        } else if (errno == EAGAIN) {
            poll(&(struct pollfd){.fd = descriptor, .events = POLLOUT}, 1, -1);
        } else if (errno == EPIPE) {
            return kiln_error_set(error, KILN_READER_GONE,
                                  "%s: the reader went away after %u frames", stream->params->path,
                                  stream->frames);
        } else if (errno != EINTR) {
            return kiln_error_set_errno(error, KILN_IO, errno, "%s: cannot be written",
                                        stream->params->path);
        }
    }
    return true;
}

static bool write_y4m_header(const struct stream *stream, struct kiln_error *error)
{
    const struct kiln_output_params *params = stream->params;
    char line[160];
    snprintf(line, sizeof line,
             "YUV4MPEG2 W%u H%u F%u:%u Ip A1:1 C420mpeg2 XYSCSS=420MPEG2 XCOLORRANGE=LIMITED\n",
             params->width, params->height, params->fps_num, params->fps_den);
    return write_all(stream, line, strlen(line), error);
}

/* ---- the format ----------------------------------------------------------------------------- */

static struct kiln_output_needs needs(const struct kiln_output_params *params)
{
    return kind_of(params)->needs;
}

static bool check(const struct kiln_output_params *params, struct kiln_error *error)
{
    const struct kind *kind = kind_of(params);
    if (params->alpha && !kind->alpha)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: the backdrop is transparent, but %s has no alpha; write rgba or "
                              "rgbaf32, or make the backdrop opaque",
                              params->path, kind->name);
    return kind->pixel_bytes > 0 || kiln_ffmpeg_open(KILN_FFMPEG_PICTURES, error);
}

static void close_stream(void *opaque)
{
    struct stream *stream = opaque;
    if (stream->scaler)
        kiln_ff.sws_freeContext(stream->scaler);
    free(stream->bytes);
    free(stream);
}

/* Places the planes behind the header of a frame. */
static bool open_planes(struct stream *stream)
{
    const int width = (int)stream->params->width, height = (int)stream->params->height;
    const int size = kiln_ff.av_image_get_buffer_size(AV_PIX_FMT_YUV420P, width, height, 1);
    if (size < 0 || kiln_scaler_open(&stream->scaler, stream->params->width, stream->params->height,
                                     8, AV_PIX_FMT_YUV420P) < 0)
        return false;
    stream->header = sizeof FRAME_HEADER - 1;
    stream->size = stream->header + (size_t)size;
    enum { SLACK = 64 }; /* swscale may write whole vectors past the last row's end */
    stream->bytes = malloc(stream->size + SLACK);
    if (!stream->bytes)
        return false;
    memcpy(stream->bytes, FRAME_HEADER, stream->header);
    return kiln_ff.av_image_fill_arrays(stream->planes, stream->strides,
                                        stream->bytes + stream->header, AV_PIX_FMT_YUV420P, width,
                                        height, 1) >= 0;
}

static bool open_pixels(struct stream *stream, size_t pixel_bytes)
{
    stream->size = (size_t)stream->params->width * stream->params->height * pixel_bytes;
    stream->bytes = malloc(stream->size);
    return stream->bytes != NULL;
}

static void *open_stream(const struct kiln_output_params *params, struct kiln_temporary *file,
                         struct kiln_error *error)
{
    (void)file;
    struct stream *stream = calloc(1, sizeof *stream);
    const size_t pixel_bytes = kind_of(params)->pixel_bytes;
    if (stream)
        stream->params = params;
    if (stream && (pixel_bytes ? open_pixels(stream, pixel_bytes) : open_planes(stream))) {
        if (pixel_bytes || write_y4m_header(stream, error))
            return stream;
    } else {
        kiln_error_no_memory(error, "frames of %u x %u pixels for %s", params->width,
                             params->height, params->path);
    }
    if (stream)
        close_stream(stream);
    return NULL;
}

static bool encode(void *opaque, const struct kiln_picture *picture, struct kiln_error *error)
{
    struct stream *stream = opaque;
    kind_of(stream->params)->pack(stream, picture);
    if (!write_all(stream, stream->bytes, stream->size, error))
        return false;
    stream->frames++;
    return true;
}

const struct kiln_format kiln_format_stream = {
    .suffix = "",
    .name = "a stream",
    .help = "",
    .one_file = true,
    .is_stream = true,
    .needs = needs,
    .check = check,
    .open = open_stream,
    .encode = encode,
    .close = close_stream,
};
