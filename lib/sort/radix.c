/* This file sorts pairs in compute by a radix sort, least significant digit first. Each pass counts
 * the digits of every tile of pairs, computes prefix sums of the counts by (digit, tile), and moves
 * each pair to the place that the sums give. No work group waits for another, and no atomic
 * operation decides an order. The number of passes is even, so that the last pass reads the buffer
 * `alternate` and its list overwrites the pairs. */
#include "sort/radix.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/error.h"
#include "gpu/program.h"
#include "shared/sort_layout.h"
#include "sort/alive.h"

enum { KEY_BITS = 32, PAIR_BYTES = 8, MAX_SHARED_BYTES = 32768 };

/* Describes how the work is divided, which does not change the result. One counter for each digit
 * of each invocation must fit in 32 KiB of shared memory. */
struct shape {
    uint32_t bits;       /* width of a digit */
    uint32_t group_size; /* invocations of a work group */
    uint32_t items;      /* pairs that an invocation processes */
};

/* Both widths divide a key into an even number of digits. Few passes and long stretches are faster
 * on software devices, many invocations on GPUs. */
static const struct shape FOR_SOFTWARE = {8, 16, 256}, FOR_GPUS = {6, 64, 32};

struct kiln_radix {
    struct kiln_device *device;
    struct shape shape;
    struct kiln_alive alive;
    struct kiln_scan scan;
    GLuint count_program, scatter_program, last_program;
    struct kiln_buffer alternate; /* passes alternate between the buffer of pairs and this one */
    struct kiln_buffer counts;    /* ordered by digit, then by tile */
};

static GLuint create_program(struct kiln_radix *radix, const char *file, const char *extra_defines,
                             struct kiln_error *error)
{
    char defines[256];
    const struct shape *shape = &radix->shape;
    snprintf(defines, sizeof defines,
             "#define RADIX_BITS %u\n#define RADIX_GROUP_SIZE %u\n#define RADIX_ITEMS %u\n%s",
             shape->bits, shape->group_size, shape->items, extra_defines);
    const struct kiln_program_params params = {.compute = file, .defines = defines};
    return kiln_program_create(radix->device, &params, error);
}

static bool create_programs(struct kiln_radix *radix, struct kiln_error *error)
{
    radix->count_program = create_program(radix, "sort/radix_count.comp", "", error);
    if (!radix->count_program)
        return false;
    radix->scatter_program = create_program(radix, "sort/radix_scatter.comp", "", error);
    if (!radix->scatter_program)
        return false;
    radix->last_program =
        create_program(radix, "sort/radix_scatter.comp", "#define LAST 1\n", error);
    return radix->last_program != 0;
}

/* Returns whether a key has an even number of digits of `bits` bits. */
static bool is_even(uint32_t bits)
{
    return (KEY_BITS + bits - 1) / bits % 2 == 0;
}

/* Chooses the shape for the device. If the user sets the size of work groups, a tile keeps its size
 * and is divided among more or fewer invocations; digits are then as wide as shared memory has room
 * for their counters. */
static struct shape choose_shape(const struct kiln_device *device)
{
    struct shape shape = device->info.software ? FOR_SOFTWARE : FOR_GPUS;
    if (device->work_group_size == 0)
        return shape;
    uint32_t tile = shape.group_size * shape.items;
    shape.group_size = kiln_device_group_size(device, shape.group_size, tile);
    shape.items = tile / shape.group_size;
    while ((shape.group_size + 1) * sizeof(uint32_t) << shape.bits > MAX_SHARED_BYTES ||
           !is_even(shape.bits))
        shape.bits--;
    return shape;
}

struct kiln_radix *kiln_radix_create(struct kiln_device *device, struct kiln_error *error)
{
    struct kiln_radix *radix = calloc(1, sizeof *radix);
    if (!radix) {
        kiln_error_no_memory(error, "the sort");
        return NULL;
    }
    radix->device = device;
    radix->shape = choose_shape(device);
    kiln_buffer_init(&radix->alternate, device, 0, "other sort pairs");
    kiln_buffer_init(&radix->counts, device, 0, "counts of digits");
    if (!kiln_alive_init(&radix->alive, device, KILN_ALIVE_ENTRIES, error) ||
        !kiln_scan_init(&radix->scan, device, error) || !create_programs(radix, error))
        kiln_radix_destroy(&radix);
    return radix;
}

void kiln_radix_destroy(struct kiln_radix **radix)
{
    if (!*radix)
        return;
    kiln_alive_finish(&(*radix)->alive);
    kiln_scan_finish(&(*radix)->scan);
    kiln_buffer_finish(&(*radix)->alternate);
    kiln_buffer_finish(&(*radix)->counts);
    glDeleteProgram((*radix)->count_program);
    glDeleteProgram((*radix)->scatter_program);
    glDeleteProgram((*radix)->last_program);
    free(*radix);
    *radix = NULL;
}

/* Describes a pass and the buffers that it reads and writes. */
struct pass {
    uint32_t count, tiles, shift;
    bool reverse;    /* the last pass writes the list from its end */
    GLuint from, to; /* `to` gets pairs, and draw entries in the last pass */
    GLuint counts;
};

static uint32_t tile_size(const struct kiln_radix *radix)
{
    return radix->shape.group_size * radix->shape.items;
}

static void dispatch(struct kiln_radix *radix, GLuint program, const struct pass *pass)
{
    glUseProgram(program);
    glUniform1ui(SORT_AT_COUNT, pass->count);
    glUniform1ui(SORT_AT_SHIFT, pass->shift);
    glUniform1ui(SORT_AT_TILES, pass->tiles);
    if (program == radix->last_program)
        glUniform1ui(SORT_AT_REVERSE, pass->reverse);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_PAIRS, pass->from);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_COUNTS, pass->counts);
    kiln_device_dispatch(radix->device, pass->count, tile_size(radix));
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

static bool run_pass(struct kiln_radix *radix, const struct pass *pass, bool last,
                     struct kiln_error *error)
{
    dispatch(radix, radix->count_program, pass);
    if (!kiln_scan_run(&radix->scan, pass->counts, pass->tiles << radix->shape.bits, error))
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, last ? SORT_BIND_ENTRIES : SORT_BIND_PAIRS_OUT,
                     pass->to);
    dispatch(radix, last ? radix->last_program : radix->scatter_program, pass);
    return true;
}

bool kiln_radix_pairs(struct kiln_radix *radix, struct kiln_buffer *pairs, uint32_t count,
                      bool reverse, struct kiln_error *error)
{
    if (count == 0)
        return true;
    struct pass pass = {
        .count = count, .tiles = (count - 1) / tile_size(radix) + 1, .reverse = reverse};
    kiln_buffer_reserve(&radix->alternate, pairs->size);
    kiln_buffer_reserve(&radix->counts,
                        ((size_t)pass.tiles << radix->shape.bits) * sizeof(uint32_t));
    pass.from = kiln_buffer_gl(pairs, KILN_READ_WRITE, error);
    pass.to = pass.from ? kiln_buffer_gl(&radix->alternate, KILN_OVERWRITE, error) : 0;
    pass.counts = pass.to ? kiln_buffer_gl(&radix->counts, KILN_OVERWRITE, error) : 0;
    if (!pass.counts)
        return false;
    const uint32_t bits = radix->shape.bits;
    for (pass.shift = 0; pass.shift < KEY_BITS; pass.shift += bits) {
        if (!run_pass(radix, &pass, pass.shift + bits >= KEY_BITS, error))
            return false;
        const GLuint from = pass.from;
        pass.from = pass.to;
        pass.to = from;
    }
    return kiln_device_check(radix->device, "sort: radix", error);
}

static void *create(const struct kiln_sort_setup *setup, struct kiln_error *error)
{
    return kiln_radix_create(setup->device, error);
}

static void destroy(void *technique)
{
    struct kiln_radix *radix = technique;
    kiln_radix_destroy(&radix);
}

static bool run(void *technique, struct kiln_pool *pool, const struct kiln_sort_params *params,
                struct kiln_buffer *entries, uint32_t *count, struct kiln_error *error)
{
    struct kiln_radix *radix = technique;
    if (params->order == KILN_SORT_BY_SERIAL)
        return kiln_alive_run(&radix->alive, pool, params, entries, NULL, count, error);
    kiln_buffer_reserve(entries, (size_t)pool->slot_count * PAIR_BYTES);
    return kiln_alive_run(&radix->alive, pool, params, NULL, entries, count, error) &&
           kiln_radix_pairs(radix, entries, *count, params->order == KILN_SORT_FRONT_TO_BACK,
                            error);
}

/* The pairs lie in memory twice; the list overwrites one of the copies. */
static uint64_t bytes(uint32_t slots)
{
    return (uint64_t)slots * PAIR_BYTES * 2;
}

const struct kiln_sort_row kiln_sort_radix_row = {
    .in_gl = true, .create = create, .destroy = destroy, .run = run, .bytes = bytes};
