/* This file prepares cells of flipbooks for the CPU rasteriser: it lays their texels out for
 * sampling, finds the hulls of their visible texels, and mixes the requested cells between two
 * adjacent ones. Mixed cells are stored as bytes, like the atlas. Mixing follows the cells' motion
 * at each texel, where the shader follows it at each pixel. */
#include "draw/sprites/cells.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "draw/sprites/cell_pool.h"
#include "shared/exact.h"

enum {
    MIXED_EDGE = KILN_ATLAS_CELL >> KILN_CELL_MIXED_LEVEL,
};

/* Holds the parts of a kiln_cell_name that do not follow from the slot's number. */
struct mix_source {
    uint32_t next_layer;
    float motion;
};

struct kiln_cells {
    const struct kiln_atlas *atlas;
    struct mix_source *sources;      /* by layer, phase and level */
    atomic_bool *requested;          /* by slot: the slot's cell was requested */
    struct kiln_cell_texels *texels; /* by slot */
    uint32_t slot_count;
    /* the texels of each form: those that are sampled together share the processor's caches */
    struct kiln_cell_pool pools[KILN_CELL_FORMS];
    uint32_t *missing;            /* numbers of the slots to be made now */
    struct kiln_cell_hull *hulls; /* by layer and level */
    uint8_t *moves;               /* motion of all layers, laid out; NULL: no cell moves */
};

/* Lays `count` channels of RGBA out for sampling, from `channel` on: beside each channel of a texel
 * is that of the texel below it. Values are stored less 128. */
static void lay_out(const uint8_t *from, uint32_t edge, uint32_t channel, uint32_t count,
                    uint8_t *to)
{
    for (uint32_t y = 0; y <= edge; y++) {
        const uint8_t *row = from + 4 * (size_t)(y > 0 ? y - 1 : 0) * edge;
        const uint8_t *below = from + 4 * (size_t)(y < edge ? y : edge - 1) * edge;
        for (uint32_t x = 0; x < edge + KILN_CELL_MARGIN; x++) {
            size_t column = x == 0 ? 0 : x <= edge ? x - 1 : edge - 1;
            for (size_t c = channel; c < channel + count; c++) {
                *to++ = row[4 * column + c] ^ 0x80;
                *to++ = below[4 * column + c] ^ 0x80;
            }
        }
    }
}

/* Returns the texels of a layer of the atlas at a level. `strip` has room for a cell whose columns
 * are all the layer's strip. */
static const uint8_t *cell_texels(const struct kiln_atlas *atlas, uint32_t layer, uint32_t level,
                                  uint8_t strip[4 * KILN_ATLAS_STRIP * KILN_ATLAS_STRIP])
{
    const uint8_t *texels = kiln_atlas_level(atlas, layer, level);
    if (level != KILN_STRIP_LEVEL)
        return texels;
    for (size_t i = 0; i < (size_t)KILN_ATLAS_STRIP * KILN_ATLAS_STRIP; i++)
        memcpy(strip + 4 * i, texels + i / KILN_ATLAS_STRIP * 4, 4);
    return strip;
}

/* Lays all forms of a cell out. */
static void lay_out_cell(const uint8_t *from, uint32_t edge, const struct kiln_cell_texels *to)
{
    for (enum kiln_cell_form form = 0; form < KILN_CELL_FORMS; form++) {
        const uint32_t channels = kiln_cell_channels(form);
        lay_out(from, edge, 4 - channels, channels, to->forms[form]);
    }
}

/* Lays the atlas's motion of a layer out for sampling. */
static void lay_out_moves(const int8_t *from, uint8_t *to)
{
    uint8_t texels[4 * KILN_ATLAS_MOTION * KILN_ATLAS_MOTION] = {0};
    for (size_t i = 0; i < (size_t)KILN_ATLAS_MOTION * KILN_ATLAS_MOTION; i++) {
        texels[4 * i] = (uint8_t)(128 + from[2 * i]);
        texels[4 * i + 1] = (uint8_t)(128 + from[2 * i + 1]);
    }
    lay_out(texels, KILN_ATLAS_MOTION, 0, 2, to);
}

static bool make_moves(struct kiln_cells *cells)
{
    const struct kiln_atlas *atlas = cells->atlas;
    if (!atlas->moves)
        return true;
    size_t bytes = KILN_CELL_PAIR * kiln_cells_texels(KILN_ATLAS_MOTION);
    cells->moves = kiln_cell_pool_alloc(&cells->pools[KILN_CELL_HEAT_ALPHA], atlas->layers * bytes);
    for (uint32_t i = 0; cells->moves && i < atlas->layers; i++)
        lay_out_moves(atlas->moves + (size_t)i * KILN_ATLAS_MOVES_BYTES, cells->moves + i * bytes);
    return cells->moves != NULL;
}

/* ---- hulls ----------------------------------------------------------------------------------- */

/* Holds the least and greatest x, y, x + y and x - y of the visible texels. */
struct extent {
    int least[4], most[4];
};

/* Returns a mask over RGBA in memory: a texel is visible if it has one of these bits. */
static uint32_t visible_bits(uint32_t kind)
{
    const uint8_t any = kind == KILN_CELL_COLOR ? 0xff : 0, bytes[4] = {any, any, any, 0xff};
    uint32_t bits;
    memcpy(&bits, bytes, sizeof bits);
    return bits;
}

static bool is_visible(const uint8_t *texel, uint32_t bits)
{
    uint32_t rgba;
    memcpy(&rgba, texel, sizeof rgba);
    return (rgba & bits) != 0;
}

static bool row_is_visible(const uint8_t *texels, int edge, uint32_t bits)
{
    uint32_t any = 0;
    for (int x = 0; x < edge; x++) {
        uint32_t rgba;
        memcpy(&rgba, texels + 4 * (size_t)x, sizeof rgba);
        any |= rgba;
    }
    return (any & bits) != 0;
}

static void extend_to(struct extent *extent, int x, int y)
{
    const int at[4] = {x, y, x + y, x - y};
    for (int i = 0; i < 4; i++) {
        extent->least[i] = at[i] < extent->least[i] ? at[i] : extent->least[i];
        extent->most[i] = at[i] > extent->most[i] ? at[i] : extent->most[i];
    }
}

/* Measures the extent of the visible texels. It looks only at the first and the last visible texel
 * of each row, since the texels between them cannot extend it. */
static struct extent measure(const uint8_t *texels, int edge, uint32_t kind)
{
    struct extent extent = {{INT_MAX, INT_MAX, INT_MAX, INT_MAX},
                            {INT_MIN, INT_MIN, INT_MIN, INT_MIN}};
    const uint32_t bits = visible_bits(kind);
    for (int y = 0; y < edge; y++, texels += 4 * (size_t)edge) {
        int first = 0, last = edge - 1;
        if (!row_is_visible(texels, edge, bits))
            continue;
        while (!is_visible(texels + 4 * (size_t)first, bits))
            first++;
        while (!is_visible(texels + 4 * (size_t)last, bits))
            last--;
        extend_to(&extent, first, y);
        extend_to(&extent, last, y);
    }
    return extent;
}

static struct extent around_both(const struct extent *a, const struct extent *b)
{
    struct extent both = *a;
    for (int i = 0; i < 4; i++) {
        both.least[i] = b->least[i] < a->least[i] ? b->least[i] : a->least[i];
        both.most[i] = b->most[i] > a->most[i] ? b->most[i] : a->most[i];
    }
    return both;
}

/* Returns the hull of an extent. Sampling shows a texel up to one texel from its centre, and mixing
 * spreads it by one more; the hull also grows by the motion. */
static struct kiln_cell_hull hull_of(const struct extent *extent, float motion, int edge)
{
    static const float middle[4] = {0.5f, 0.5f, 1.0f, 0.0f};
    struct kiln_cell_hull hull = {{0}, {0}};
    if (extent->least[0] > extent->most[0])
        return hull;
    float reach = 2.0f + motion * (float)edge;
    for (int i = 0; i < 4; i++) {
        float around = i < 2 ? reach : 2.0f * reach;
        hull.from[i] = ((float)extent->least[i] + middle[i] - around) / (float)edge;
        hull.to[i] = ((float)extent->most[i] + middle[i] + around) / (float)edge;
    }
    for (int i = 0; i < 2; i++) {
        hull.from[i] = hull.from[i] > 0.0f ? hull.from[i] : 0.0f;
        hull.to[i] = hull.to[i] < 1.0f ? hull.to[i] : 1.0f;
    }
    return hull;
}

/* Makes the hulls of a texture's cells at a level. Each cell is drawn together with the next one,
 * so a hull contains both. */
static void make_hulls_of(struct kiln_cells *cells, const struct kiln_atlas_range *range,
                          uint32_t level)
{
    const int edge = (int)kiln_cell_edge(level);
    uint8_t strip[4 * KILN_ATLAS_STRIP * KILN_ATLAS_STRIP];
    struct kiln_cell_hull *hulls =
        cells->hulls + (size_t)range->first_layer * KILN_CELL_LEVELS + level;
    struct extent first = {{0}, {0}}, cell = first;
    for (uint32_t i = 0; i <= range->cells; i++) {
        const struct extent next =
            i < range->cells
                ? measure(cell_texels(cells->atlas, range->first_layer + i, level, strip), edge,
                          range->kind)
                : first;
        const struct extent both = around_both(&cell, &next);
        if (i == 0)
            first = next;
        else
            hulls[(size_t)(i - 1) * KILN_CELL_LEVELS] = hull_of(&both, range->motion, edge);
        cell = next;
    }
}

static void make_hulls(struct kiln_cells *cells)
{
    for (uint32_t i = 0; i < KILN_MAX_SYSTEMS; i++) {
        const struct kiln_atlas_textures *textures = &cells->atlas->systems[i];
        for (uint32_t t = 0; t < textures->count * KILN_CELL_LEVELS; t++)
            make_hulls_of(cells, &textures->textures[t / KILN_CELL_LEVELS], t % KILN_CELL_LEVELS);
    }
}

struct kiln_cells *kiln_cells_create(const struct kiln_atlas *atlas, struct kiln_error *error)
{
    struct kiln_cells *cells = calloc(1, sizeof *cells);
    if (cells) {
        cells->atlas = atlas;
        cells->slot_count = (atlas->layers ? atlas->layers : 1) * KILN_CELL_NUMBERS;
        cells->sources = calloc(cells->slot_count, sizeof *cells->sources);
        cells->requested = calloc(cells->slot_count, sizeof *cells->requested);
        cells->texels = calloc(cells->slot_count, sizeof *cells->texels);
        cells->missing = calloc(cells->slot_count, sizeof *cells->missing);
        cells->hulls = calloc(cells->slot_count / KILN_CELL_PHASES, sizeof *cells->hulls);
    }
    if (!cells || !cells->sources || !cells->requested || !cells->texels || !cells->missing ||
        !cells->hulls || !make_moves(cells)) {
        kiln_error_no_memory(error, "the cells");
        kiln_cells_destroy(&cells);
        return NULL;
    }
    make_hulls(cells);
    return cells;
}

void kiln_cells_footprint(uint64_t layers, bool mixed, struct kiln_footprint *footprint)
{
    const struct kiln_cells *c = NULL;
    uint64_t texels = 0, channels = 0;
    for (uint32_t level = 0; level < KILN_CELL_LEVELS; level++) {
        const bool is_mixed = mixed && level >= KILN_CELL_MIXED_LEVEL;
        texels += (is_mixed ? KILN_CELL_PHASES : 1) * kiln_cells_texels(kiln_cell_edge(level));
    }
    for (enum kiln_cell_form form = 0; form < KILN_CELL_FORMS; form++)
        channels += kiln_cell_channels(form);
    const uint64_t of_slot = sizeof *c->sources + sizeof *c->requested + sizeof *c->texels +
                             sizeof *c->missing + sizeof *c->hulls / KILN_CELL_PHASES;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_TEXTURES, layers * KILN_CELL_NUMBERS, of_slot);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_TEXTURES, layers, 2 * channels * texels);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_TEXTURES, layers,
                       KILN_CELL_PAIR * kiln_cells_texels(KILN_ATLAS_MOTION));
}

void kiln_cells_destroy(struct kiln_cells **cells)
{
    struct kiln_cells *c = *cells;
    if (!c)
        return;
    for (enum kiln_cell_form form = 0; form < KILN_CELL_FORMS; form++)
        kiln_cell_pool_finish(&c->pools[form]);
    free(c->sources);
    free(c->requested);
    free(c->texels);
    free(c->missing);
    free(c->hulls);
    free(c);
    *cells = NULL;
}

uint32_t kiln_cells_request(struct kiln_cells *cells, const struct kiln_cell_name *name)
{
    uint32_t number =
        (name->layer * KILN_CELL_PHASES + name->phase) * KILN_CELL_LEVELS + name->level;
    atomic_bool *requested = &cells->requested[number];
    /* Only the first thread that wants the cell writes the slot; any would write the same. */
    if (!atomic_load_explicit(requested, memory_order_relaxed) &&
        !atomic_exchange_explicit(requested, true, memory_order_relaxed))
        cells->sources[number] = (struct mix_source){name->next_layer, name->motion};
    return number;
}

struct kiln_cells_content kiln_cells_content(const struct kiln_cells *cells)
{
    return (struct kiln_cells_content){.texels = cells->texels,
                                       .requested = cells->requested,
                                       .hulls = cells->hulls,
                                       .moves = cells->moves,
                                       .move_bytes =
                                           KILN_CELL_PAIR * kiln_cells_texels(KILN_ATLAS_MOTION)};
}

/* Describes a bilinear read of a grid, clamped at the edges; the first element of each member is
 * for columns, the second for rows. */
struct bilinear {
    uint32_t from[2], to[2]; /* the two texels */
    float part[2];           /* weight of the second texel */
};

static float clamp(float x, float low, float high)
{
    return x < low ? low : x > high ? high : x;
}

/* Returns the read at a place; x, y: in edges of the grid. */
static struct bilinear place(float x, float y, uint32_t edge)
{
    struct bilinear at;
    const float position[2] = {x, y};
    for (int i = 0; i < 2; i++) {
        float texel = clamp(position[i] * (float)edge - 0.5f, 0.0f, (float)(edge - 1));
        at.from[i] = exact_uint(texel);
        at.to[i] = at.from[i] + 1 < edge ? at.from[i] + 1 : at.from[i];
        at.part[i] = texel - (float)at.from[i];
    }
    return at;
}

/* Interpolates bilinearly between four values. */
static float between(float upper_left, float upper_right, float lower_left, float lower_right,
                     const float part[2])
{
    float upper = upper_left + (upper_right - upper_left) * part[0];
    float lower = lower_left + (lower_right - lower_left) * part[0];
    return upper + (lower - upper) * part[1];
}

/* Computes the weights of four texels for a place between the middle two: cubic convolution (Keys
 * 1981) with a = -1/4, which comes closest to the shader's picture. */
static void weigh_four(float part, float weights[4])
{
    float square = part * part, cube = square * part;
    weights[0] = 0.5f * square - 0.25f * (part + cube);
    weights[1] = 1.0f - 2.75f * square + 1.75f * cube;
    weights[2] = 0.25f * part + 2.5f * square - 1.75f * cube;
    weights[3] = 0.25f * (cube - square);
}

/* Reads RGBA at a place by cubic convolution. Linear interpolation would blur too much, since the
 * result becomes texels, which are interpolated again. */
static void read_texel(const uint8_t *texels, uint32_t edge, float x, float y, float rgba[4])
{
    const struct bilinear at = place(x, y, edge);
    float across[4], down[4];
    weigh_four(at.part[0], across);
    weigh_four(at.part[1], down);
    for (uint32_t c = 0; c < 4; c++)
        rgba[c] = 0.0f;
    for (uint32_t i = 0; i < 16; i++) {
        uint32_t column = at.from[0] + i % 4, row = at.from[1] + i / 4;
        column = column > 0 ? column - 1 : 0;
        row = row > 0 ? row - 1 : 0;
        column = column < edge ? column : edge - 1;
        row = row < edge ? row : edge - 1;
        const uint8_t *texel = texels + 4 * ((size_t)row * edge + column);
        for (uint32_t c = 0; c < 4; c++)
            rgba[c] += (float)texel[c] * (across[i % 4] * down[i / 4]);
    }
}

/* Reads the motion at a place, 127 for a full move right or down. */
static void read_move(const int8_t *moves, float x, float y, float way[2])
{
    struct bilinear at = place(x, y, KILN_ATLAS_MOTION);
    const int8_t *upper = moves + 2 * (size_t)at.from[1] * KILN_ATLAS_MOTION;
    const int8_t *lower = moves + 2 * (size_t)at.to[1] * KILN_ATLAS_MOTION;
    for (uint32_t c = 0; c < 2; c++)
        way[c] = between(upper[2 * at.from[0] + c], upper[2 * at.to[0] + c],
                         lower[2 * at.from[0] + c], lower[2 * at.to[0] + c], at.part);
}

/* Mixes the cell of a slot. It computes each texel as cell_between() of
 * shaders/draw/sprites/shade.glsl computes a pixel. */
static void mix(const struct kiln_cells *cells, uint32_t number)
{
    uint8_t texels[4 * MIXED_EDGE * MIXED_EDGE] = {0}, *texel = texels;
    const struct mix_source *source = &cells->sources[number];
    const struct kiln_atlas *atlas = cells->atlas;
    uint32_t layer = number / KILN_CELL_NUMBERS, level = number % KILN_CELL_LEVELS;
    uint32_t phase = number / KILN_CELL_LEVELS % KILN_CELL_PHASES;
    uint32_t edge = kiln_cell_edge(level);
    uint8_t strips[2][4 * KILN_ATLAS_STRIP * KILN_ATLAS_STRIP];
    const uint8_t *from = cell_texels(atlas, layer, level, strips[0]);
    const uint8_t *to = cell_texels(atlas, source->next_layer, level, strips[1]);
    const int8_t *moves = atlas->moves && source->motion > 0.0f
                              ? atlas->moves + (size_t)layer * KILN_ATLAS_MOVES_BYTES
                              : NULL;
    const float part = (float)phase / (float)KILN_CELL_PHASES, left = 1.0f - part;
    const float scale = source->motion / 127.0f;
    for (uint32_t y = 0; y < edge; y++) {
        for (uint32_t x = 0; x < edge; x++, texel += 4) {
            float u = ((float)x + 0.5f) / (float)edge, v = ((float)y + 0.5f) / (float)edge;
            float way[2] = {0}, first[4], second[4];
            if (moves)
                read_move(moves, u, v, way);
            float x_way = way[0] * scale, y_way = way[1] * scale;
            read_texel(from, edge, u - part * x_way, v - part * y_way, first);
            read_texel(to, edge, u + left * x_way, v + left * y_way, second);
            for (int c = 0; c < 4; c++)
                texel[c] = (uint8_t)exact_int(
                    clamp(first[c] + (second[c] - first[c]) * part, 0.0f, 255.0f) + 0.5f);
        }
    }
    lay_out_cell(texels, edge, &cells->texels[number]);
}

/* Lays a layer of the atlas out as the cell of a slot with phase 0. */
static void copy(const struct kiln_cells *cells, uint32_t number)
{
    uint32_t layer = number / KILN_CELL_NUMBERS, level = number % KILN_CELL_LEVELS;
    uint8_t strip[4 * KILN_ATLAS_STRIP * KILN_ATLAS_STRIP];
    lay_out_cell(cell_texels(cells->atlas, layer, level, strip), kiln_cell_edge(level),
                 &cells->texels[number]);
}

static void mix_missing(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_cells *cells = context;
    for (size_t i = begin; i < end; i++) {
        uint32_t number = cells->missing[i];
        bool itself = number / KILN_CELL_LEVELS % KILN_CELL_PHASES == 0;
        (itself ? copy : mix)(cells, number);
    }
}

/* Allocates the forms of a slot's cell. */
static bool allocate(struct kiln_cells *cells, uint32_t number)
{
    const size_t texels = kiln_cells_texels(kiln_cell_edge(number % KILN_CELL_LEVELS));
    struct kiln_cell_texels made;
    for (enum kiln_cell_form form = 0; form < KILN_CELL_FORMS; form++) {
        made.forms[form] = kiln_cell_pool_alloc(&cells->pools[form],
                                                2 * (size_t)kiln_cell_channels(form) * texels);
        if (!made.forms[form])
            return false;
    }
    cells->texels[number] = made;
    return true;
}

bool kiln_cells_mix(struct kiln_cells *cells, struct kiln_threads *threads,
                    struct kiln_error *error)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < cells->slot_count; i++) {
        if (cells->texels[i].forms[0] ||
            !atomic_load_explicit(&cells->requested[i], memory_order_relaxed))
            continue;
        if (!allocate(cells, i))
            return kiln_error_no_memory(error, "the cells");
        cells->missing[count++] = i;
    }
    kiln_threads_for(threads, count, 1, mix_missing, cells);
    return true;
}
