/* This file shows the frames of GIF files as browsers do. FFmpeg decodes each frame alone, and this
 * file puts it onto the frames before. FFmpeg's own frames fill what a frame leaves with the colour
 * of the background; browsers leave it transparent (GIF89a, 23: disposal). */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "decode.h"

enum {
    HEAD = 13, /* bytes of the header and of the description of the screen */
    EXTENSION = 0x21,
    CONTROL = 0xf9,
    IMAGE = 0x2c,
    TRAILER = 0x3b,
    TO_TRANSPARENT = 2, /* values of disposal */
    TO_BEFORE = 3,
};

struct gif {
    struct decode_picture *picture;
    size_t at;          /* of the next block */
    size_t palette;     /* bytes of the head and of the palette for all frames */
    uint8_t control[4]; /* flags, delay and transparent colour of the next frame */
    uint8_t *packet;    /* a file of one frame */
    size_t room;        /* bytes of the packet */
    struct kiln_asset_image *canvas;
    uint8_t *before; /* the canvas before a frame that is taken away */
};

static bool refuse(const struct gif *gif)
{
    return kiln_error_set(gif->picture->error, KILN_INVALID_INPUT,
                          "the GIF image is broken or cut short");
}

static size_t palette_bytes(uint8_t flags)
{
    return flags & 0x80 ? (size_t)3 << ((flags & 7) + 1) : 0;
}

/* Finds the end of a row of sub-blocks that begins at a place. False: the file ends before. */
static bool find_end(const struct gif *gif, size_t at, size_t *end)
{
    const uint8_t *bytes = gif->picture->bytes;
    while (at < gif->picture->size) {
        const uint8_t size = bytes[at];
        at += 1u + size;
        if (size == 0) {
            *end = at;
            return true;
        }
    }
    return false;
}

/* Reads blocks up to the next frame. *end: behind the frame's data; 0 behind the last frame. */
static bool find_frame(struct gif *gif, size_t *end)
{
    const struct decode_picture *picture = gif->picture;
    const uint8_t *bytes = picture->bytes;
    *end = 0;
    while (gif->at < picture->size) {
        const size_t left = picture->size - gif->at;
        const uint8_t *block = bytes + gif->at;
        if (*block == TRAILER)
            return true;
        if (*block == IMAGE && left > 10)
            return find_end(gif, gif->at + 10 + palette_bytes(block[9]) + 1, end) || refuse(gif);
        if (*block != EXTENSION || left < 3)
            return refuse(gif);
        if (block[1] == CONTROL && block[2] == 4 && left > 7)
            memcpy(gif->control, block + 3, sizeof gif->control);
        if (!find_end(gif, gif->at + 2, &gif->at))
            return refuse(gif);
    }
    return refuse(gif);
}

/* Makes a file of one frame, which is left as it is. */
static bool make_packet(struct gif *gif, size_t end, size_t *size)
{
    enum { KEEP = 1 << 2 };
    const uint8_t *control = gif->control;
    const uint8_t start[] = {EXTENSION,  CONTROL,    4,          (uint8_t)((control[0] & 1) | KEEP),
                             control[1], control[2], control[3], 0};
    const size_t frame = end - gif->at;
    *size = gif->palette + sizeof start + frame + 1;
    if (*size > gif->room) {
        free(gif->packet);
        gif->packet = malloc(*size);
        gif->room = gif->packet ? *size : 0;
    }
    if (!gif->packet)
        return decode_out_of_memory(gif->picture->error);
    memcpy(gif->packet, gif->picture->bytes, gif->palette);
    memcpy(gif->packet + gif->palette, start, sizeof start);
    memcpy(gif->packet + gif->palette + sizeof start, gif->picture->bytes + gif->at, frame);
    gif->packet[*size - 1] = TRAILER;
    return true;
}

static bool make_canvas(struct gif *gif, const struct kiln_asset_image *frame)
{
    struct kiln_asset_image *canvas = gif->canvas = calloc(1, sizeof *canvas);
    if (!canvas)
        return decode_out_of_memory(gif->picture->error);
    *canvas = *frame;
    canvas->pixels = calloc(kiln_asset_image_bytes(frame), 1);
    gif->before = malloc(kiln_asset_image_bytes(frame));
    return (canvas->pixels && gif->before) || decode_out_of_memory(gif->picture->error);
}

/* The part of the screen that a frame has. */
struct place {
    uint32_t left, top, right, bottom;
};

static struct place place_of(const struct gif *gif, const uint8_t *image)
{
    uint32_t n[4]; /* left, top, width, height */
    for (int i = 0; i < 4; i++)
        n[i] = (uint32_t)image[1 + 2 * i] | (uint32_t)image[2 + 2 * i] << 8;
    const uint32_t right = n[0] + n[2], bottom = n[1] + n[3];
    const uint32_t width = gif->canvas->width, height = gif->canvas->height;
    return (struct place){n[0] < width ? n[0] : width, n[1], right < width ? right : width,
                          bottom < height ? bottom : height};
}

/* Puts a frame onto the canvas where it is not transparent; without a frame, makes its place
 * transparent. FFmpeg fills what is outside of a frame's place. */
static void put(const struct gif *gif, struct place place, const struct kiln_asset_image *frame)
{
    uint8_t *canvas = gif->canvas->pixels;
    const uint8_t *pixels = frame ? frame->pixels : NULL;
    for (uint32_t y = place.top; y < place.bottom; y++) {
        for (uint32_t x = place.left; x < place.right; x++) {
            const size_t i = 4 * ((size_t)y * gif->canvas->width + x);
            if (!pixels)
                memset(canvas + i, 0, 4);
            else if (pixels[i + 3] != 0)
                memcpy(canvas + i, pixels + i, 4);
        }
    }
}

/* Decodes a frame, shows it on the canvas to `take`, and takes it away as it says. */
static bool show_frame(struct gif *gif, size_t end, decode_take *take, void *user, bool *more)
{
    size_t size;
    if (!make_packet(gif, end, &size))
        return false;
    struct decode_picture one = *gif->picture;
    one.bytes = gif->packet;
    one.size = size;
    struct kiln_asset_image *frame = decode_by_ffmpeg(&one);
    if (!frame || (!gif->canvas && !make_canvas(gif, frame)) ||
        (frame->width != gif->canvas->width || frame->height != gif->canvas->height)) {
        kiln_asset_image_destroy(&frame);
        return one.error->code != KILN_OK ? false : refuse(gif);
    }
    const size_t bytes = kiln_asset_image_bytes(frame);
    const int disposal = gif->control[0] >> 2 & 7;
    const struct place place = place_of(gif, gif->picture->bytes + gif->at);
    if (disposal == TO_BEFORE)
        memcpy(gif->before, gif->canvas->pixels, bytes);
    put(gif, place, frame);
    memcpy(frame->pixels, gif->canvas->pixels, bytes);
    decode_find_alpha(frame);
    if (disposal == TO_TRANSPARENT)
        put(gif, place, NULL);
    else if (disposal == TO_BEFORE)
        memcpy(gif->canvas->pixels, gif->before, bytes);
    memset(gif->control, 0, sizeof gif->control);
    gif->at = end;
    *more = take(user, frame);
    return true;
}

bool decode_gif_frames(struct decode_picture *picture, decode_take *take, void *user)
{
    struct gif gif = {.picture = picture};
    bool ok = picture->size > HEAD || refuse(&gif), more = true;
    if (ok)
        gif.palette = gif.at = HEAD + palette_bytes(picture->bytes[10]);
    ok = ok && (gif.at < picture->size || refuse(&gif));
    size_t end = 1, frames = 0;
    while (ok && end > 0) {
        ok = find_frame(&gif, &end);
        if (ok && end > 0 && more)
            ok = show_frame(&gif, end, take, user, &more);
        else if (end > 0)
            gif.at = end; /* frames that are not wanted must be there, too */
        frames += end > 0;
    }
    ok = ok && (frames > 0 || refuse(&gif));
    kiln_asset_image_destroy(&gif.canvas);
    free(gif.before);
    free(gif.packet);
    return ok;
}
