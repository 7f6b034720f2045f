/* This file draws particles in GL by compute kernels, in chunks of limited size, the nearest chunk
 * first, so that memory stays bounded. Each particle becomes a sprite, which sets its bit in the
 * mask of each bin (8 x 8 tiles) that it touches. Each bin's mask becomes a list of sprites, and
 * the sprites of the list set bits in the masks of the bin's tiles. Each tile then draws the
 * sprites of its mask from front to back in registers, and writes its pixels once. Bits keep the
 * order without sorting, and no sprite is dropped, however many lie in a tile. Where llvmpipe
 * limits the iterations of a loop (gpu/device.h), several dispatches draw a tile. */
#include "draw/sprites/particles_tiled.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/error.h"
#include "draw/volume/volume.h"
#include "gpu/program.h"
#include "shared/tiled_layout.h"

static_assert(sizeof(struct tiled_bin) == 20, "std430");

/* Describes how the work is divided, which changes no result beyond rounding. */
struct tiling {
    uint32_t edge;        /* edge of a tile, px */
    uint32_t rows;        /* rows of invocations in a tile */
    uint32_t chunk;       /* particles of a chunk, a power of two */
    uint32_t max_entries; /* entries of all lists of a chunk; an entry takes three words */
};

/* On software GL the cost of a tile is its pixels times its sprites, so tiles are small; GPUs need
 * many invocations in a work group. */
static const struct tiling FOR_SOFTWARE = {8, 2, 1 << 16, 1 << 18},
                           FOR_GPUS = {16, 16, 1 << 18, 1 << 23};

/* A chunk is smaller than the tiling says when the picture has so many bins that the masks would
 * take more than MAX_WORDS words, or when sprites touch so many bins that there would be too many
 * entries. A chunk of MIN_CHUNK particles or fewer is not made smaller. */
enum { MAX_WORDS = 1 << 24, MIN_CHUNK = 64 };

enum { SPRITE_BYTES = TILED_SPRITE_ROWS * sizeof(float4), MAX_GROUP_SIZE = 1024 };

/* Sprites may be left out of a pass where together they could add less than this to any channel of
 * a pixel. */
static const float NEGLIGIBLE = 1.0f / 2048.0f;

struct kiln_tiled {
    struct kiln_device *device;
    struct kiln_geometry *geometry;
    struct tiling tiling;
    uint32_t group_size; /* invocations of a work group that makes, counts or lists sprites */
    uint32_t max_words;  /* mask words that one dispatch draws, a multiple of TILED_ROUND_WORDS */
    uint32_t gas_steps;  /* loop iterations that find the gas before a pixel */
    GLuint make_program, count_program, list_program, mark_program, depth_program, draw_program;
    GLint additive_alpha; /* uniform of draw_program */
    GLuint sprite_texels; /* buffer texture of the sprites */
    struct kiln_buffer boxes, sprites, bin_masks, counts, bins, lists, masks, farthest, carry;
};

static GLuint create_program(struct kiln_tiled *tiled, const struct kiln_scene *scene,
                             const char *file, struct kiln_error *error)
{
    struct kiln_text defines = {0};
    kiln_geometry_defines(scene, &defines);
    kiln_text_add(&defines,
                  "#define TILED_EDGE %u\n#define TILED_ROWS %u\n#define TILED_GROUP_SIZE %u\n",
                  tiled->tiling.edge, tiled->tiling.rows, tiled->group_size);
    const struct kiln_program_params params = {.compute = file};
    return kiln_program_create_defined(tiled->device, &params, &defines, error);
}

static bool create_programs(struct kiln_tiled *tiled, const struct kiln_scene *scene,
                            struct kiln_error *error)
{
    const struct {
        const char *file;
        GLuint *program;
    } kernels[] = {
        {"draw/sprites/particles_tiled_make.comp", &tiled->make_program},
        {"draw/sprites/particles_tiled_count.comp", &tiled->count_program},
        {"draw/sprites/particles_tiled_list.comp", &tiled->list_program},
        {"draw/sprites/particles_tiled_mark.comp", &tiled->mark_program},
        {"draw/sprites/particles_tiled_depth.comp", &tiled->depth_program},
        {"draw/sprites/particles_tiled.comp", &tiled->draw_program},
    };
    for (size_t i = 0; i < sizeof kernels / sizeof *kernels; i++) {
        *kernels[i].program = create_program(tiled, scene, kernels[i].file, error);
        if (!*kernels[i].program)
            return false;
    }
    tiled->additive_alpha = glGetUniformLocation(tiled->draw_program, "additive_alpha");
    return true;
}

/* Chooses the tiling for the device. The size of a tile does not depend on the size of a work
 * group, so that the picture is the same: each invocation draws more or fewer rows of the tile, at
 * least one. */
static struct tiling choose_tiling(const struct kiln_device *device)
{
    struct tiling tiling = device->info.software ? FOR_SOFTWARE : FOR_GPUS;
    uint32_t usual = tiling.edge * tiling.rows, most = tiling.edge * tiling.edge;
    uint32_t size = kiln_device_group_size(device, usual, most);
    tiling.rows = size > tiling.edge ? size / tiling.edge : 1;
    return tiling;
}

/* ---- loop iterations on software GL ---------------------------------------------------------- */

/* Returns how many loop iterations an invocation runs that lists the sprites of a chunk: for each
 * of its words, those of the sum over its work group and of the word's bits. Other kernels run
 * fewer, except the one that draws (round_iterations). */
static uint32_t listing_iterations(uint32_t chunk, uint32_t group_size)
{
    enum { SUM = 12, BITS = 33 }; /* steps to sum 1024 words, bits of a word; one more each */
    return (chunk / 32 / group_size + 1) * (1 + SUM + BITS) + 1;
}

/* Returns how many loop iterations an invocation runs that draws a round of a tile's mask: over its
 * pixels, to see if anything is left to draw; over its share of the words, and for each over the
 * words before and over its bits; over all sprites, and for each over its pixels, and over the gas
 * of each pixel. The loops over pixels count even where the driver may unroll them. */
static uint32_t round_iterations(const struct tiling *tiling, uint32_t gas_steps)
{
    uint32_t pixels = tiling->edge / tiling->rows, group_size = tiling->edge * tiling->rows;
    uint32_t shares = TILED_ROUND_WORDS / group_size + 1, bits = 33;
    return 1 + pixels + 1 + shares * (2 + TILED_ROUND_WORDS + bits) + 2 +
           TILED_ROUND_WORDS * 32 * (1 + pixels * (1 + gas_steps) + 1) + 1;
}

/* On software GL, limits chunk and max_words so that no invocation runs too many iterations. */
static void limit_loops(struct kiln_tiled *tiled)
{
    struct tiling *tiling = &tiled->tiling;
    tiled->max_words = UINT32_MAX / TILED_ROUND_WORDS * TILED_ROUND_WORDS;
    if (!tiled->device->info.software)
        return;
    while (listing_iterations(tiling->chunk, tiled->group_size) > KILN_SOFTWARE_ITERATIONS)
        tiling->chunk /= 2;
    uint32_t pixels = tiling->edge / tiling->rows;
    uint32_t ends = 2 * (pixels + 1) + pixels * tiled->gas_steps + 1; /* opening, closing pixels */
    uint32_t rounds =
        (KILN_SOFTWARE_ITERATIONS - ends) / round_iterations(tiling, tiled->gas_steps);
    assert(rounds > 0 && tiling->chunk >= MIN_CHUNK);
    tiled->max_words = rounds * TILED_ROUND_WORDS;
}

/* ---- the stage ------------------------------------------------------------------------------- */

struct kiln_tiled *kiln_tiled_create(struct kiln_device *device, const struct kiln_scene *scene,
                                     struct kiln_geometry *geometry, struct kiln_error *error)
{
    struct kiln_tiled *tiled = calloc(1, sizeof *tiled);
    if (!tiled) {
        kiln_error_no_memory(error, "particles");
        return NULL;
    }
    const uint32_t domains = kiln_volume_domains(scene);
    *tiled = (struct kiln_tiled){
        .device = device,
        .geometry = geometry,
        .tiling = choose_tiling(device),
        .group_size = kiln_device_group_size(device, TILED_GROUP_SIZE, MAX_GROUP_SIZE),
        .gas_steps = domains > 0 ? domains + 1 : 0,
    };
    limit_loops(tiled);
    kiln_buffer_init(&tiled->boxes, device, 0, "boxes of sprites");
    kiln_buffer_init(&tiled->sprites, device, 0, "sprites");
    kiln_buffer_init(&tiled->bin_masks, device, 0, "masks of bins");
    kiln_buffer_init(&tiled->counts, device, 0, "sprites in bins");
    kiln_buffer_init(&tiled->bins, device, 0, "bins");
    kiln_buffer_init(&tiled->lists, device, 0, "lists of bins");
    kiln_buffer_init(&tiled->masks, device, 0, "masks of tiles");
    kiln_buffer_init(&tiled->farthest, device, 0, "depth of tiles");
    kiln_buffer_init(&tiled->carry, device, 0, "pixels between chunks");
    glGenTextures(1, &tiled->sprite_texels);
    if (!create_programs(tiled, scene, error))
        kiln_tiled_destroy(&tiled);
    return tiled;
}

void kiln_tiled_destroy(struct kiln_tiled **tiled)
{
    struct kiln_tiled *t = *tiled;
    if (!t)
        return;
    struct kiln_buffer *buffers[] = {&t->boxes, &t->sprites, &t->bin_masks, &t->counts, &t->bins,
                                     &t->lists, &t->masks,   &t->farthest,  &t->carry};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        kiln_buffer_finish(buffers[i]);
    const GLuint programs[] = {t->make_program, t->count_program, t->list_program,
                               t->mark_program, t->depth_program, t->draw_program};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        glDeleteProgram(programs[i]);
    glDeleteTextures(1, &t->sprite_texels);
    free(t);
    *tiled = NULL;
}

/* Holds the values of one call of kiln_tiled_run. */
struct run {
    const struct kiln_particles_draw *draw;
    uint32_t width, height; /* px */
    uint32_t tile_columns, tile_rows;
    uint32_t columns, rows, bins; /* bins along the picture's edges, and all bins */
    uint32_t items;               /* sprites of all particles */
    uint32_t first, count, chunk; /* particles of the chunk, from the nearest; most of a chunk */
    uint32_t entries;             /* entries of all lists, a multiple of TILED_PIECE */
    uint32_t longest;             /* sprites in the longest list */
    float additive_alpha;
};

static uint32_t divide_up(uint32_t a, uint32_t b)
{
    return a / b + (a % b != 0);
}

/* Computes the grids of tiles and bins, and the size of chunks. */
static void plan(const struct kiln_tiled *tiled, struct run *run)
{
    const struct kiln_image *color = run->draw->framebuffer->images[0];
    run->width = color->width;
    run->height = color->height;
    run->tile_columns = divide_up(run->width, tiled->tiling.edge);
    run->tile_rows = divide_up(run->height, tiled->tiling.edge);
    run->columns = divide_up(run->tile_columns, TILED_BIN_TILES);
    run->rows = divide_up(run->tile_rows, TILED_BIN_TILES);
    run->bins = run->columns * run->rows;
    GLint texels = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
    run->chunk = tiled->tiling.chunk;
    while (run->chunk > MIN_CHUNK && (run->chunk / 32 > MAX_WORDS / run->bins ||
                                      run->chunk > (uint32_t)texels / TILED_SPRITE_ROWS))
        run->chunk /= 2;
    run->additive_alpha = run->draw->sum_alpha || run->draw->fire_covers ? 1.0f : 0.0f;
}

/* Returns the number of words of a bin's mask. */
static uint32_t mask_words(const struct run *run)
{
    return divide_up(run->count, 32);
}

/* Binds a buffer of at least `size` bytes that a kernel will write. */
static bool bind_output(GLuint binding, struct kiln_buffer *buffer, size_t size,
                        struct kiln_error *error)
{
    kiln_buffer_reserve(buffer, size);
    GLuint gl = kiln_buffer_gl(buffer, KILN_OVERWRITE, error);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, gl);
    return gl != 0;
}

static void dispatch(uint32_t columns, uint32_t rows)
{
    glDispatchCompute(columns, rows, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

/* ---- sprites and bins ------------------------------------------------------------------------ */

static bool make_sprites(struct kiln_tiled *tiled, const struct run *run, struct kiln_error *error)
{
    static const GLuint zero = 0;
    uint32_t words = mask_words(run);
    if (!kiln_geometry_bind_draw(tiled->geometry, run->draw, error) ||
        !bind_output(TILED_BIND_BOXES, &tiled->boxes, (size_t)run->count * 2 * sizeof(uint32_t),
                     error) ||
        !bind_output(TILED_BIND_SPRITES, &tiled->sprites, (size_t)run->count * SPRITE_BYTES,
                     error) ||
        !bind_output(TILED_BIND_BIN_MASKS, &tiled->bin_masks,
                     (size_t)run->bins * words * sizeof(uint32_t), error))
        return false;
    glBindBuffer(GL_COPY_WRITE_BUFFER, tiled->bin_masks.gl);
    glClearBufferData(GL_COPY_WRITE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
    glUseProgram(tiled->make_program);
    glUniform1ui(TILED_AT_COUNT, run->count);
    glUniform1ui(TILED_AT_FIRST, run->first);
    glUniform1f(TILED_AT_ADDITIVE_ALPHA, run->additive_alpha);
    glUniform1ui(TILED_AT_BIN_COLUMNS, run->columns);
    glUniform1ui(TILED_AT_MASK_WORDS, words);
    kiln_device_dispatch(tiled->device, run->count, tiled->group_size);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return true;
}

/* Counts the sprites of each bin and gives each bin's list a place. */
static bool place_lists(struct kiln_tiled *tiled, struct run *run, struct kiln_error *error)
{
    kiln_buffer_reserve(&tiled->bins, run->bins * sizeof(struct tiled_bin));
    struct tiled_bin *bins = kiln_buffer_host(&tiled->bins, KILN_OVERWRITE, error);
    if (!bins ||
        !bind_output(TILED_BIND_COUNTS, &tiled->counts, run->bins * sizeof(uint32_t), error))
        return false;
    if (run->count > 0) {
        glUseProgram(tiled->count_program);
        glUniform1ui(TILED_AT_MASK_WORDS, mask_words(run));
        dispatch(run->columns, run->rows);
    }
    const uint32_t *counts = kiln_buffer_host(&tiled->counts, KILN_READ, error);
    if (!counts)
        return false;
    run->entries = run->longest = 0;
    for (uint32_t i = 0; i < run->bins; i++) {
        uint32_t count = run->count > 0 ? counts[i] : 0;
        bins[i] = (struct tiled_bin){.first = run->entries, .count = count};
        run->entries += divide_up(count, TILED_PIECE) * TILED_PIECE;
        run->longest = count > run->longest ? count : run->longest;
    }
    return true;
}

static bool fill_bins(struct kiln_tiled *tiled, const struct run *run, struct kiln_error *error)
{
    GLuint bins = kiln_buffer_gl(&tiled->bins, KILN_READ_WRITE, error);
    if (!bins ||
        !bind_output(TILED_BIND_LISTS, &tiled->lists, run->entries * sizeof(uint32_t), error) ||
        !bind_output(TILED_BIND_MASKS, &tiled->masks, (size_t)run->entries * (TILED_TILES / 8),
                     error))
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, TILED_BIND_BINS, bins);
    if (run->entries == 0)
        return true;
    glUseProgram(tiled->list_program);
    glUniform1ui(TILED_AT_MASK_WORDS, mask_words(run));
    dispatch(run->columns, run->rows);

    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, TILED_BIND_FARTHEST, tiled->farthest.gl);
    glUseProgram(tiled->mark_program);
    glUniform1ui(TILED_AT_PIECES, run->entries / TILED_PIECE);
    glUniform1ui(TILED_AT_BIN_COUNT, run->bins);
    glUniform1ui(TILED_AT_BIN_COLUMNS, run->columns);
    glUniform1ui(TILED_AT_TILE_COLUMNS, run->tile_columns);
    kiln_device_dispatch(tiled->device, run->entries, TILED_PIECE);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return true;
}

/* ---- pixels ---------------------------------------------------------------------------------- */

static bool measure_depth(struct kiln_tiled *tiled, const struct run *run, struct kiln_error *error)
{
    size_t tiles = (size_t)run->tile_columns * run->tile_rows;
    if (!bind_output(TILED_BIND_FARTHEST, &tiled->farthest, tiles * sizeof(uint32_t), error))
        return false;
    glUseProgram(tiled->depth_program);
    dispatch(run->tile_columns, run->tile_rows);
    return true;
}

static bool bind_images(const struct run *run, struct kiln_error *error)
{
    const struct kiln_framebuffer *framebuffer = run->draw->framebuffer;
    struct kiln_image *color = framebuffer->images[0];
    const bool keeps = run->draw->keep_bloom, glows = framebuffer->count > 1;
    GLuint to = kiln_image_gl(color, KILN_OVERWRITE, error), glow = 0;
    if (to && glows)
        glow =
            kiln_image_gl(framebuffer->images[1], keeps ? KILN_READ_WRITE : KILN_OVERWRITE, error);
    if (!to || (glows && !glow))
        return false;
    glBindImageTexture(TILED_IMAGE_COLOR, to, 0, GL_FALSE, 0, GL_WRITE_ONLY, color->gl_format);
    /* GL ignores stores to unit TILED_IMAGE_BLOOM where no image is bound. */
    glBindImageTexture(TILED_IMAGE_BLOOM, glow, 0, GL_FALSE, 0, GL_WRITE_ONLY, color->gl_format);
    glActiveTexture(GL_TEXTURE0 + TILED_UNIT_BEFORE);
    glBindTexture(GL_TEXTURE_2D, keeps ? glow : 0);
    return true;
}

/* Draws the tiles. A dispatch draws as many words of the tiles' masks as the driver's loop limit
 * allows. first, last: the chunk is the first or the last of the pass. */
static void draw_spans(const struct kiln_tiled *tiled, const struct run *run, bool first, bool last)
{
    uint32_t words = divide_up(run->longest, 32), from = 0;
    do {
        uint32_t until = words - from > tiled->max_words ? from + tiled->max_words : words;
        glUniform2i(TILED_AT_FIRST_LAST_RUN, first && from == 0, last && until == words);
        glUniform2ui(TILED_AT_SPAN, from, until);
        dispatch(run->tile_columns, run->tile_rows);
        from = until;
    } while (from < words);
}

static bool draw_tiles(struct kiln_tiled *tiled, const struct run *run, struct kiln_error *error)
{
    uint32_t all = run->items;
    bool first = run->first == 0, last = run->first + run->count == all;
    bool whole = first && last && divide_up(run->longest, 32) <= tiled->max_words;
    size_t pixels = whole ? 0 : (size_t)run->width * run->height;
    if (!kiln_buffer_gl(&tiled->sprites, KILN_READ, error) ||
        !bind_output(TILED_BIND_CARRY, &tiled->carry, pixels * TILED_CARRY_BYTES, error))
        return false;
    glActiveTexture(GL_TEXTURE0 + TILED_UNIT_SPRITES);
    glBindTexture(GL_TEXTURE_BUFFER, tiled->sprite_texels);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, tiled->sprites.gl);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    glUseProgram(tiled->draw_program);
    glUniform1f(tiled->additive_alpha, run->additive_alpha);
    glUniform1ui(TILED_AT_BIN_COLUMNS, run->columns);
    glUniform1i(TILED_AT_KEEP_GLOW, run->draw->keep_bloom);
    glUniform1f(TILED_AT_OCCLUDES, run->draw->sum_alpha ? 0.0f : 1.0f);
    glUniform1f(TILED_AT_MIN_LIGHT,
                all > 0 ? NEGLIGIBLE * ((float)run->count / (float)all) : NEGLIGIBLE);
    draw_spans(tiled, run, first, last);
    return true;
}

static bool draw_chunk(struct kiln_tiled *tiled, struct run *run, struct kiln_error *error)
{
    for (;;) {
        uint32_t left = run->items - run->first;
        run->count = left < run->chunk ? left : run->chunk;
        if ((run->count > 0 && !make_sprites(tiled, run, error)) || !place_lists(tiled, run, error))
            return false;
        if (run->entries <= tiled->tiling.max_entries || run->count <= MIN_CHUNK)
            break;
        run->chunk = run->count / 64 * 32;
    }
    return fill_bins(tiled, run, error) && draw_tiles(tiled, run, error);
}

bool kiln_tiled_run(struct kiln_tiled *tiled, const struct kiln_particles_draw *draw,
                    struct kiln_error *error)
{
    struct run run = {.draw = draw, .items = draw->count * kiln_geometry_items(tiled->geometry)};
    plan(tiled, &run);
    if (!kiln_geometry_bind_draw(tiled->geometry, draw, error) || !bind_images(&run, error) ||
        !measure_depth(tiled, &run, error))
        return false;
    do { /* at least once, to clear the picture if there are no particles */
        if (!draw_chunk(tiled, &run, error))
            return false;
        run.first += run.count;
    } while (run.first < run.items);
    /* Later stages draw over the images, sample them and read them back. */
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT);
    return kiln_device_check(tiled->device, "particles", error);
}
