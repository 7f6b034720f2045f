/* This file sorts pairs (key, index) with compute shaders by a sorting network of bitonic merges
 * (Heinz 2019, 2.4.1 and 3.4; UberFlow, 4.3.2). The sort stage (sort.c) uses it for the technique
 * `bitonic`, in each frame.
 *
 * A merge makes bunches of `size` pairs, each in order, out of bunches of half as many. It consists
 * of passes: each compares pairs at one distance in the list, which is halved from pass to pass.
 * The number of pairs is padded to a power of two (network.c). A block is the pairs that a work
 * group has in shared memory; a shorter list is padded there. Passes whose distance is within a
 * block run as one kernel in shared memory. Passes of larger distances go through the buffer, up to
 * three in one dispatch. */
#include "sort/bitonic.h"

#include <stdlib.h>

#include "base/error.h"
#include "shared/sort_layout.h"

enum { MAX_LEVELS = 3 }; /* most passes in one dispatch of bitonic_far.comp */

struct kiln_bitonic {
    struct kiln_device *device;
    struct kiln_network network;
    uint32_t group_size;             /* invocations of a work group */
    uint32_t block;                  /* pairs in the shared memory of a work group */
    GLuint sort_program;             /* sorts each block from the start */
    GLuint merge_program;            /* makes the passes of a merge that are within a block */
    GLuint far_programs[MAX_LEVELS]; /* for 1, 2 and 3 passes in one dispatch */
};

/* Runs the first passes of a merge: those with distances from size / 2 down to a block. */
static void run_far(struct kiln_bitonic *bitonic, uint32_t padded, uint32_t size)
{
    uint32_t distance = size / 2;
    while (distance >= bitonic->block) {
        uint32_t levels = 1;
        while (levels < MAX_LEVELS && distance >> levels >= bitonic->block)
            levels++;
        uint32_t spacing = distance >> (levels - 1); /* the distance of the last of these passes */
        const struct kiln_network_uniform uniforms[] = {
            {SORT_AT_COUNT, padded}, {SORT_AT_BUNCH, size}, {SORT_AT_DISTANCE, spacing}};
        kiln_network_dispatch(bitonic->device, bitonic->far_programs[levels - 1], uniforms, 3,
                              padded >> levels, bitonic->group_size);
        distance = spacing / 2;
    }
}

static bool sort_padded(void *context, struct kiln_buffer *pairs, uint32_t padded,
                        struct kiln_error *error)
{
    (void)pairs; /* bound to SORT_BIND_PAIRS already (kiln_network_sort) */
    (void)error;
    struct kiln_bitonic *bitonic = context;
    struct kiln_network_uniform uniforms[] = {{SORT_AT_COUNT, padded}, {SORT_AT_BUNCH, 0}};
    kiln_network_dispatch(bitonic->device, bitonic->sort_program, uniforms, 1, padded,
                          bitonic->block);
    for (uint32_t size = bitonic->block * 2; size <= padded; size *= 2) {
        run_far(bitonic, padded, size);
        uniforms[1].value = size;
        kiln_network_dispatch(bitonic->device, bitonic->merge_program, uniforms, 2, padded,
                              bitonic->block);
    }
    return true;
}

struct kiln_bitonic *kiln_bitonic_create(struct kiln_device *device, struct kiln_error *error)
{
    struct kiln_bitonic *bitonic = calloc(1, sizeof *bitonic);
    if (!bitonic) {
        kiln_error_no_memory(error, "the sort");
        return NULL;
    }
    bitonic->device = device;
    bitonic->group_size = kiln_network_group_size(device);
    bitonic->block = bitonic->group_size * NETWORK_ITEMS;
    const struct kiln_network_kernel kernels[] = {
        {"sort/bitonic_block.comp", "#define FROM_START 1\n", &bitonic->sort_program},
        {"sort/bitonic_block.comp", NULL, &bitonic->merge_program},
        {"sort/bitonic_far.comp", "#define LEVELS 1\n", &bitonic->far_programs[0]},
        {"sort/bitonic_far.comp", "#define LEVELS 2\n", &bitonic->far_programs[1]},
        {"sort/bitonic_far.comp", "#define LEVELS 3\n", &bitonic->far_programs[2]},
    };
    if (!kiln_network_init(&bitonic->network, device, sort_padded, bitonic, error) ||
        !kiln_network_programs(device, kernels, sizeof kernels / sizeof *kernels, error))
        kiln_bitonic_destroy(&bitonic);
    return bitonic;
}

void kiln_bitonic_destroy(struct kiln_bitonic **bitonic)
{
    if (!*bitonic)
        return;
    kiln_network_finish(&(*bitonic)->network);
    glDeleteProgram((*bitonic)->sort_program);
    glDeleteProgram((*bitonic)->merge_program);
    for (int i = 0; i < MAX_LEVELS; i++)
        glDeleteProgram((*bitonic)->far_programs[i]);
    free(*bitonic);
    *bitonic = NULL;
}

struct kiln_network *kiln_bitonic_network(struct kiln_bitonic *bitonic)
{
    return &bitonic->network;
}

static void *create(const struct kiln_sort_setup *setup, struct kiln_error *error)
{
    return kiln_bitonic_create(setup->device, error);
}

static void destroy(void *technique)
{
    struct kiln_bitonic *bitonic = technique;
    kiln_bitonic_destroy(&bitonic);
}

static bool run(void *technique, struct kiln_pool *pool, const struct kiln_sort_params *params,
                struct kiln_buffer *entries, uint32_t *count, struct kiln_error *error)
{
    return kiln_network_run(kiln_bitonic_network(technique), pool, params, entries, count, error);
}

const struct kiln_sort_row kiln_sort_bitonic_row = {
    .in_gl = true, .create = create, .destroy = destroy, .run = run, .bytes = kiln_network_bytes};
