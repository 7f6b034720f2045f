/* This file loads tiles from the images of a pass and stores them there. It transposes planes of
 * channels into pixels of four channels, and writes those past the processor's caches. */
#include "draw/sprites/tile_target.h"

#include <string.h>

#include "draw/sprites/stream.h"

/* Empties a row of a tile and loads the scene's depth into it; at: the row's first pixel. */
static void begin_row(const struct kiln_tile_target *target, struct kiln_tile *tile, int y,
                      size_t at)
{
    float(*planes)[KILN_TILE_PITCH] = tile->pixels[y];
    memcpy(planes[KILN_TILE_DEPTH], target->depth + at, (size_t)tile->width * sizeof(float));
    memset(planes, 0, KILN_TILE_DEPTH * sizeof *planes);
    if (target->added)
        memset(tile->added[y], 0, KILN_TILE_ALPHA * sizeof *tile->added[y]);
}

/* Transposes four channels of four pixels into four pixels of four channels, or back. */
static inline void transpose(four c[4])
{
    four low = __builtin_shufflevector(c[0], c[1], 0, 4, 1, 5);
    four high = __builtin_shufflevector(c[0], c[1], 2, 6, 3, 7);
    four low2 = __builtin_shufflevector(c[2], c[3], 0, 4, 1, 5);
    four high2 = __builtin_shufflevector(c[2], c[3], 2, 6, 3, 7);
    c[0] = __builtin_shufflevector(low, low2, 0, 1, 4, 5);
    c[1] = __builtin_shufflevector(low, low2, 2, 3, 6, 7);
    c[2] = __builtin_shufflevector(high, high2, 0, 1, 4, 5);
    c[3] = __builtin_shufflevector(high, high2, 2, 3, 6, 7);
}

/* Writes up to four pixels to `to`; keep: blends them over the pixels there. passed: the part of
 * each pixel there that stays. */
static inline void blend_pixels(const four drawn[4], const float passed[4], bool keep, float *to,
                                size_t count)
{
    for (size_t i = 0; i < count; i++) {
        four_unaligned *pixel = (four_unaligned *)(to + 4 * i);
        if (keep)
            *pixel = drawn[i] + *pixel * passed[i];
        else
            stream_four(to + 4 * i, drawn[i]);
    }
}

/* Blends a row of a tile over the result of earlier pieces, and its glow over the bloom of an
 * earlier pass, too, if that is kept. */
static void store_row(const struct kiln_tile_target *target, const struct kiln_tile *tile, int y,
                      size_t at)
{
    const float(*planes)[KILN_TILE_PITCH] = (const float(*)[KILN_TILE_PITCH])tile->pixels[y];
    for (size_t x = 0; x < (size_t)tile->width; x += 4) {
        four color[4], glow[4], covering[4];
        float passed[4];
        for (int c = 0; c < 3; c++) {
            memcpy(&color[c], &planes[KILN_TILE_RED + c][x], sizeof color[c]);
            memcpy(&glow[c], &planes[KILN_TILE_GLOW_RED + c][x], sizeof glow[c]);
            covering[c] = color[c];
            if (target->glow == KILN_TILE_GLOW_APART) {
                color[c] += glow[c];
                glow[c] *= target->weights[c];
            }
        }
        four alpha;
        memcpy(&alpha, &planes[KILN_TILE_ALPHA][x], sizeof alpha);
        const four left = 1.0f - (target->sum ? (four){0} : alpha);
        memcpy(passed, &left, sizeof passed);
        color[3] = glow[3] = covering[3] = alpha;
        transpose(color);
        transpose(glow);
        size_t count = (size_t)tile->width - x < 4 ? (size_t)tile->width - x : 4;
        blend_pixels(color, passed, !target->first, target->color + 4 * (at + x), count);
        if (target->bloom)
            blend_pixels(glow, passed, !target->first || target->keep_bloom,
                         target->bloom + 4 * (at + x), count);
        if (target->covering) {
            transpose(covering);
            blend_pixels(covering, passed, !target->first, target->covering + 4 * (at + x), count);
        }
    }
}

/* Adds a row of the light of additive sprites alone to the result of earlier pieces. */
static void store_added(const struct kiln_tile_target *target, const struct kiln_tile *tile, int y,
                        size_t at)
{
    static const float all[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    const float(*planes)[KILN_TILE_PITCH] = (const float(*)[KILN_TILE_PITCH])tile->added[y];
    for (size_t x = 0; x < (size_t)tile->width; x += 4) {
        four color[4] = {{0}};
        for (int c = 0; c < 3; c++)
            memcpy(&color[c], &planes[KILN_TILE_RED + c][x], sizeof color[c]);
        transpose(color);
        size_t count = (size_t)tile->width - x < 4 ? (size_t)tile->width - x : 4;
        blend_pixels(color, all, !target->first, target->added + 4 * (at + x), count);
    }
}

void kiln_tile_begin(const struct kiln_tile_target *target, struct kiln_tile *tile, uint32_t x,
                     uint32_t y)
{
    const uint32_t width = target->width - x, height = target->height - y;
    tile->x = (int)x;
    tile->y = (int)y;
    tile->width = width < KILN_TILE_WIDTH ? (int)width : KILN_TILE_WIDTH;
    tile->height = height < KILN_TILE_HEIGHT ? (int)height : KILN_TILE_HEIGHT;
    tile->glow = target->glow;
    tile->adds_apart = target->added != NULL;
    tile->gas = NULL;
    tile->over = !target->sum && !target->by_fragment;
    for (int row = 0; row < tile->height; row++)
        begin_row(target, tile, row, (size_t)(y + (uint32_t)row) * target->width + x);
}

void kiln_tile_end(const struct kiln_tile_target *target, const struct kiln_tile *tile)
{
    const uint32_t x = (uint32_t)tile->x, y = (uint32_t)tile->y;
    for (int row = 0; row < tile->height; row++)
        store_row(target, tile, row, (size_t)(y + (uint32_t)row) * target->width + x);
    for (int row = 0; row < tile->height && target->added; row++)
        store_added(target, tile, row, (size_t)(y + (uint32_t)row) * target->width + x);
    stream_end();
}

void kiln_tile_skip(const struct kiln_tile_target *target, uint32_t x, uint32_t y)
{
    const uint32_t width = target->width - x, height = target->height - y;
    const size_t bytes = 4 * sizeof(float) * (width < KILN_TILE_WIDTH ? width : KILN_TILE_WIDTH);
    for (uint32_t row = 0; row < height && row < KILN_TILE_HEIGHT && target->first; row++) {
        const size_t place = 4 * ((size_t)(y + row) * target->width + x);
        memset(target->color + place, 0, bytes);
        if (target->bloom && !target->keep_bloom)
            memset(target->bloom + place, 0, bytes);
        if (target->covering)
            memset(target->covering + place, 0, bytes);
        if (target->added)
            memset(target->added + place, 0, bytes);
    }
}
