/* What is mixed stays as bytes, like the atlas. Samples of samples are a little softer than those
 * of the shader, which follows the motion at each pixel. */
#include "draw/cells.h"

#include "base/error.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { PHASE_LEVELS = KILN_CELL_PHASES * KILN_ATLAS_LEVELS };

struct slot {
    atomic_bool wanted;
    uint32_t next_layer;
    float motion;
};

struct kiln_cells {
    const struct kiln_atlas *atlas;
    struct slot *slots; /* by layer, phase and level */
    uint8_t **texels;   /* of each; NULL: not mixed yet */
    uint32_t slot_count;
    uint32_t *missing; /* numbers of slots to be mixed */
    uint8_t *moves;    /* MOVES_BYTES a layer; NULL: none moves */
};

enum { MOVES_PITCH = KILN_ATLAS_MOTION + 1, MOVES_BYTES = 4 * MOVES_PITCH * MOVES_PITCH };

/* Copies the atlas's motion of a layer, with its last column and row twice. */
static void spread_moves(const int8_t *from, uint8_t *to)
{
    for (uint32_t y = 0; y < MOVES_PITCH; y++) {
        for (uint32_t x = 0; x < MOVES_PITCH; x++, to += 4) {
            uint32_t row = y < KILN_ATLAS_MOTION ? y : KILN_ATLAS_MOTION - 1;
            uint32_t column = x < KILN_ATLAS_MOTION ? x : KILN_ATLAS_MOTION - 1;
            const int8_t *pair = from + 2 * (size_t)(row * KILN_ATLAS_MOTION + column);
            to[0] = (uint8_t)(128 + pair[0]);
            to[1] = (uint8_t)(128 + pair[1]);
        }
    }
}

static bool make_moves(struct kiln_cells *cells)
{
    const struct kiln_atlas *atlas = cells->atlas;
    if (!atlas->moves)
        return true;
    cells->moves = calloc((size_t)atlas->layers + 1, MOVES_BYTES); /* none: not NULL */
    for (uint32_t i = 0; cells->moves && i < atlas->layers; i++)
        spread_moves(atlas->moves + (size_t)i * KILN_ATLAS_MOVES_BYTES,
                     cells->moves + (size_t)i * MOVES_BYTES);
    return cells->moves != NULL;
}

const uint8_t *kiln_cells_moves(const struct kiln_cells *cells, uint32_t layer)
{
    return cells->moves ? cells->moves + (size_t)layer * MOVES_BYTES : NULL;
}

struct kiln_cells *kiln_cells_create(const struct kiln_atlas *atlas, struct kiln_error *error)
{
    struct kiln_cells *cells = calloc(1, sizeof *cells);
    if (cells) {
        cells->atlas = atlas;
        cells->slot_count = (atlas->layers ? atlas->layers : 1) * PHASE_LEVELS;
        cells->slots = calloc(cells->slot_count, sizeof *cells->slots);
        cells->texels = calloc(cells->slot_count, sizeof *cells->texels);
        cells->missing = calloc(cells->slot_count, sizeof *cells->missing);
    }
    if (!cells || !cells->slots || !cells->texels || !cells->missing || !make_moves(cells)) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "cells: out of memory");
        kiln_cells_destroy(&cells);
        return NULL;
    }
    return cells;
}

void kiln_cells_destroy(struct kiln_cells **cells)
{
    struct kiln_cells *c = *cells;
    if (!c)
        return;
    for (uint32_t i = 0; c->texels && i < c->slot_count; i++)
        free(c->texels[i]);
    free(c->slots);
    free(c->texels);
    free(c->missing);
    free(c->moves);
    free(c);
    *cells = NULL;
}

uint32_t kiln_cells_want(struct kiln_cells *cells, const struct kiln_cell_name *name)
{
    uint32_t number =
        (name->layer * KILN_CELL_PHASES + name->phase) * KILN_ATLAS_LEVELS + name->level;
    struct slot *slot = &cells->slots[number];
    /* Whoever comes first writes; all would write the same. */
    if (!atomic_load_explicit(&slot->wanted, memory_order_relaxed) &&
        !atomic_exchange_explicit(&slot->wanted, true, memory_order_relaxed)) {
        slot->next_layer = name->next_layer;
        slot->motion = name->motion;
    }
    return number;
}

uint32_t kiln_cells_pitch(uint32_t level)
{
    return ((uint32_t)KILN_ATLAS_CELL >> level) + 1;
}

const uint8_t *const *kiln_cells_texels(const struct kiln_cells *cells)
{
    return (const uint8_t *const *)cells->texels;
}

/* A grid of `channels` a texel, read between its texels and clamped at its edge. */
struct bilinear {
    uint32_t from[2], to[2]; /* columns, rows */
    float part[2];
};

static float clamp(float x, float low, float high)
{
    return x < low ? low : x > high ? high : x;
}

/* x, y: in edges of the grid. */
static struct bilinear place(float x, float y, uint32_t edge)
{
    struct bilinear at;
    const float position[2] = {x, y};
    for (int i = 0; i < 2; i++) {
        float texel = clamp(position[i] * (float)edge - 0.5f, 0.0f, (float)(edge - 1));
        at.from[i] = (uint32_t)texel;
        at.to[i] = at.from[i] + 1 < edge ? at.from[i] + 1 : at.from[i];
        at.part[i] = texel - (float)at.from[i];
    }
    return at;
}

static float between(float upper_left, float upper_right, float lower_left, float lower_right,
                     const float part[2])
{
    float upper = upper_left + (upper_right - upper_left) * part[0];
    float lower = lower_left + (lower_right - lower_left) * part[0];
    return upper + (lower - upper) * part[1];
}

static void read_texel(const uint8_t *texels, uint32_t edge, float x, float y, float rgba[4])
{
    struct bilinear at = place(x, y, edge);
    const uint8_t *upper = texels + 4 * (size_t)at.from[1] * edge;
    const uint8_t *lower = texels + 4 * (size_t)at.to[1] * edge;
    for (uint32_t c = 0; c < 4; c++)
        rgba[c] = between(upper[4 * at.from[0] + c], upper[4 * at.to[0] + c],
                          lower[4 * at.from[0] + c], lower[4 * at.to[0] + c], at.part);
}

static void read_move(const int8_t *moves, float x, float y, float way[2])
{
    struct bilinear at = place(x, y, KILN_ATLAS_MOTION);
    const int8_t *upper = moves + 2 * (size_t)at.from[1] * KILN_ATLAS_MOTION;
    const int8_t *lower = moves + 2 * (size_t)at.to[1] * KILN_ATLAS_MOTION;
    for (uint32_t c = 0; c < 2; c++)
        way[c] = between(upper[2 * at.from[0] + c], upper[2 * at.to[0] + c],
                         lower[2 * at.from[0] + c], lower[2 * at.to[0] + c], at.part);
}

/* As cell_between() of shaders/draw/shade.glsl, at each texel. */
static void mix(const struct kiln_cells *cells, uint32_t number)
{
    const struct slot *slot = &cells->slots[number];
    const struct kiln_atlas *atlas = cells->atlas;
    uint32_t layer = number / PHASE_LEVELS, level = number % KILN_ATLAS_LEVELS;
    uint32_t phase = number / KILN_ATLAS_LEVELS % KILN_CELL_PHASES;
    uint32_t edge = (uint32_t)KILN_ATLAS_CELL >> level, pitch = kiln_cells_pitch(level);
    const uint8_t *from = kiln_atlas_level(atlas, layer, level);
    const uint8_t *to = kiln_atlas_level(atlas, slot->next_layer, level);
    const int8_t *moves = atlas->moves && slot->motion > 0.0f
                              ? atlas->moves + (size_t)layer * KILN_ATLAS_MOVES_BYTES
                              : NULL;
    const float part = (float)phase / (float)KILN_CELL_PHASES, left = 1.0f - part;
    const float scale = slot->motion / 127.0f;
    uint8_t *texel = cells->texels[number];
    for (uint32_t y = 0; y < pitch; y++) {
        for (uint32_t x = 0; x < pitch; x++, texel += 4) {
            float u = ((float)(x < edge ? x : edge - 1) + 0.5f) / (float)edge;
            float v = ((float)(y < edge ? y : edge - 1) + 0.5f) / (float)edge;
            float way[2] = {0}, first[4], second[4];
            if (moves)
                read_move(moves, u, v, way);
            float x_way = way[0] * scale, y_way = way[1] * scale;
            read_texel(from, edge, u - part * x_way, v - part * y_way, first);
            read_texel(to, edge, u + left * x_way, v + left * y_way, second);
            for (int c = 0; c < 4; c++)
                texel[c] = (uint8_t)(first[c] + (second[c] - first[c]) * part + 0.5f);
        }
    }
}

/* A layer itself, with its last column and row twice. */
static void copy(const struct kiln_cells *cells, uint32_t number)
{
    uint32_t layer = number / PHASE_LEVELS, level = number % KILN_ATLAS_LEVELS;
    uint32_t edge = (uint32_t)KILN_ATLAS_CELL >> level, pitch = kiln_cells_pitch(level);
    const uint8_t *from = kiln_atlas_level(cells->atlas, layer, level);
    uint8_t *to = cells->texels[number];
    for (uint32_t y = 0; y < pitch; y++) {
        const uint8_t *row = from + 4 * (size_t)(y < edge ? y : edge - 1) * edge;
        memcpy(to, row, 4 * (size_t)edge);
        memcpy(to + 4 * (size_t)edge, row + 4 * (size_t)(edge - 1), 4);
        to += 4 * (size_t)pitch;
    }
}

static void mix_missing(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_cells *cells = context;
    for (size_t i = begin; i < end; i++) {
        uint32_t number = cells->missing[i];
        bool itself = number / KILN_ATLAS_LEVELS % KILN_CELL_PHASES == 0;
        (itself ? copy : mix)(cells, number);
    }
}

bool kiln_cells_mix(struct kiln_cells *cells, struct kiln_threads *threads,
                    struct kiln_error *error)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < cells->slot_count; i++) {
        if (cells->texels[i] ||
            !atomic_load_explicit(&cells->slots[i].wanted, memory_order_relaxed))
            continue;
        size_t pitch = kiln_cells_pitch(i % KILN_ATLAS_LEVELS);
        cells->texels[i] = malloc(pitch * pitch * 4);
        if (!cells->texels[i])
            return kiln_error_set(error, KILN_DEVICE_FAILED, "cells: out of memory");
        cells->missing[count++] = i;
    }
    kiln_threads_for(threads, count, 1, mix_missing, cells);
    return true;
}
