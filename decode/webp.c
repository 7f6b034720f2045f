/* This file decodes WebP pictures and animations by libwebp, whose integers are the same on every
 * processor. */
#include <stdlib.h>
#include <string.h>
#include <webp/decode.h>
#include <webp/demux.h>

#include "base/error.h"
#include "base/library.h"
#include "decode.h"

#define WEBP_FUNCTIONS(F)                                                                          \
    F(WebPGetFeaturesInternal)                                                                     \
    F(WebPDecodeRGBAInto)

#define DEMUX_FUNCTIONS(F)                                                                         \
    F(WebPDemuxInternal)                                                                           \
    F(WebPDemuxDelete)                                                                             \
    F(WebPDemuxGetI)                                                                               \
    F(WebPDemuxGetChunk)                                                                           \
    F(WebPDemuxReleaseChunkIterator)                                                               \
    F(WebPAnimDecoderOptionsInitInternal)                                                          \
    F(WebPAnimDecoderNewInternal)                                                                  \
    F(WebPAnimDecoderHasMoreFrames)                                                                \
    F(WebPAnimDecoderGetNext)                                                                      \
    F(WebPAnimDecoderDelete)

static struct {
    WEBP_FUNCTIONS(KILN_LIBRARY_POINTER)
    DEMUX_FUNCTIONS(KILN_LIBRARY_POINTER)
} webp;

bool decode_webp_begin(struct kiln_error *error)
{
#define FIND(function) {#function, &webp.function},
    static const struct kiln_library_function functions[] = {WEBP_FUNCTIONS(FIND)};
    static const struct kiln_library_function demux[] = {DEMUX_FUNCTIONS(FIND)};
#undef FIND
    return kiln_library_open("libwebp.so.7", "libwebp7", functions,
                             sizeof functions / sizeof *functions, error) &&
           kiln_library_open("libwebpdemux.so.2", "libwebpdemux2", demux,
                             sizeof demux / sizeof *demux, error);
}

static bool refuse(struct decode_picture *picture)
{
    return kiln_error_set(picture->error, KILN_INVALID_INPUT,
                          "the WebP image is broken or cut short");
}

/* ---- what the numbers mean ------------------------------------------------------------------- */

/* Finds a chunk of the file. NULL: there is none. The caller releases it. */
static const uint8_t *find_chunk(WebPDemuxer *file, const char *name, WebPChunkIterator *chunk)
{
    memset(chunk, 0, sizeof *chunk);
    return webp.WebPDemuxGetChunk(file, name, 1, chunk) ? chunk->chunk.bytes : NULL;
}

/* Makes the picture that is meant. A WebP is upright as it is stored: browsers do not look at its
 * Exif data. */
static bool show(struct decode_picture *picture, WebPDemuxer *file, struct kiln_asset_image *image)
{
    WebPChunkIterator profile;
    struct decode_meaning meaning = {.profile = find_chunk(file, "ICCP", &profile)};
    meaning.profile_size = profile.chunk.size;
    const bool ok = decode_show(picture, image, &meaning);
    webp.WebPDemuxReleaseChunkIterator(&profile);
    return ok;
}

/* ---- pictures -------------------------------------------------------------------------------- */

static struct kiln_asset_image *make_image(struct decode_picture *picture, uint32_t width,
                                           uint32_t height, bool alpha)
{
    if (!decode_allows_size(picture, "WebP", width, height))
        return NULL;
    struct kiln_asset_image *image = calloc(1, sizeof *image);
    if (image) {
        *image = (struct kiln_asset_image){.width = width,
                                           .height = height,
                                           .channels = alpha ? 4 : 3,
                                           .type = KILN_IMAGE_U8,
                                           .srgb = true};
        image->pixels = malloc(kiln_asset_image_bytes(image));
    }
    if (!image || !image->pixels) {
        kiln_asset_image_destroy(&image);
        decode_out_of_memory(picture->error);
    }
    return image;
}

static WebPDemuxer *open_file(struct decode_picture *picture)
{
    const WebPData data = {picture->bytes, picture->size};
    WebPDemuxer *file = webp.WebPDemuxInternal(&data, 0, NULL, WEBP_DEMUX_ABI_VERSION);
    if (!file)
        refuse(picture);
    return file;
}

static bool is_animated(WebPDemuxer *file)
{
    return (webp.WebPDemuxGetI(file, WEBP_FF_FORMAT_FLAGS) & ANIMATION_FLAG) != 0;
}

/* Decodes a file of one frame. */
static struct kiln_asset_image *decode_still(struct decode_picture *picture, WebPDemuxer *file)
{
    WebPBitstreamFeatures features;
    if (webp.WebPGetFeaturesInternal(picture->bytes, picture->size, &features,
                                     WEBP_DECODER_ABI_VERSION) != VP8_STATUS_OK) {
        refuse(picture);
        return NULL;
    }
    struct kiln_asset_image *image = make_image(picture, (uint32_t)features.width,
                                                (uint32_t)features.height, features.has_alpha != 0);
    if (!image)
        return NULL;
    const bool decoded =
        webp.WebPDecodeRGBAInto(picture->bytes, picture->size, image->pixels,
                                kiln_asset_image_bytes(image), features.width * 4) != NULL;
    if (decoded ? !show(picture, file, image) : !refuse(picture))
        kiln_asset_image_destroy(&image);
    return image;
}

/* ---- animations ------------------------------------------------------------------------------ */

/* Copies a frame, and looks whether it has alpha, since an animation says so for all frames. */
static struct kiln_asset_image *copy_frame(struct decode_picture *picture, const uint8_t *pixels,
                                           uint32_t width, uint32_t height)
{
    struct kiln_asset_image *image = make_image(picture, width, height, false);
    if (!image)
        return NULL;
    memcpy(image->pixels, pixels, kiln_asset_image_bytes(image));
    for (size_t i = 0; i < (size_t)width * height && image->channels == 3; i++)
        image->channels = pixels[4 * i + 3] != 255 ? 4 : 3;
    return image;
}

/* Shows the frames of an animation until `take` says that no more are wanted. False: a frame is
 * broken. */
static bool show_frames(struct decode_picture *picture, WebPDemuxer *file, WebPAnimDecoder *decoder,
                        decode_take *take, void *user)
{
    const uint32_t width = webp.WebPDemuxGetI(file, WEBP_FF_CANVAS_WIDTH);
    const uint32_t height = webp.WebPDemuxGetI(file, WEBP_FF_CANVAS_HEIGHT);
    const uint32_t frames = webp.WebPDemuxGetI(file, WEBP_FF_FRAME_COUNT);
    for (uint32_t i = 0; i < frames; i++) {
        uint8_t *pixels;
        int milliseconds;
        if (!webp.WebPAnimDecoderGetNext(decoder, &pixels, &milliseconds))
            return refuse(picture);
        struct kiln_asset_image *image = copy_frame(picture, pixels, width, height);
        if (!image || !show(picture, file, image)) {
            kiln_asset_image_destroy(&image);
            return false;
        }
        if (!take(user, image))
            break;
    }
    return frames > 0 || refuse(picture);
}

static bool decode_animation(struct decode_picture *picture, WebPDemuxer *file, decode_take *take,
                             void *user)
{
    const WebPData data = {picture->bytes, picture->size};
    WebPAnimDecoderOptions options;
    if (!decode_allows_size(picture, "WebP", webp.WebPDemuxGetI(file, WEBP_FF_CANVAS_WIDTH),
                            webp.WebPDemuxGetI(file, WEBP_FF_CANVAS_HEIGHT)) ||
        !webp.WebPAnimDecoderOptionsInitInternal(&options, WEBP_DEMUX_ABI_VERSION))
        return false;
    options.color_mode = MODE_RGBA;
    options.use_threads = 0;
    WebPAnimDecoder *decoder =
        webp.WebPAnimDecoderNewInternal(&data, &options, WEBP_DEMUX_ABI_VERSION);
    if (!decoder)
        return refuse(picture);
    const bool ok = show_frames(picture, file, decoder, take, user);
    webp.WebPAnimDecoderDelete(decoder);
    return ok;
}

/* ---- files ----------------------------------------------------------------------------------- */

bool decode_webp_frames(struct decode_picture *picture, decode_take *take, void *user)
{
    WebPDemuxer *file = open_file(picture);
    if (!file)
        return false;
    bool ok;
    if (is_animated(file)) {
        ok = decode_animation(picture, file, take, user);
    } else {
        struct kiln_asset_image *image = decode_still(picture, file);
        ok = image != NULL;
        if (image)
            take(user, image);
    }
    webp.WebPDemuxDelete(file);
    return ok;
}
