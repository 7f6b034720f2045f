/* This file sorts pairs in compute by Batcher's odd-even merges (Heinz 2019, 2.4.1), which take
 * more passes than bitonic sorting, but fewer comparisons. Merges within a block run as one kernel
 * in shared memory. A longer merge compares pairs across every block's edge even at short
 * distances, so each of its passes goes through the buffer. */
#include "sort/papers/oddeven.h"

#include <stdlib.h>

#include "base/error.h"
#include "shared/papers/sort_layout.h"
#include "sort/papers/papers.h"

struct kiln_oddeven {
    struct kiln_device *device;
    struct kiln_network network;
    uint32_t group_size, block; /* invocations of a work group; pairs in its shared memory */
    GLuint block_program, far_program;
};

uint32_t kiln_oddeven_passes(uint32_t padded)
{
    uint32_t stages = 0;
    while (1u << stages < padded)
        stages++;
    return stages * (stages + 1) / 2;
}

static void run_far(struct kiln_oddeven *oddeven, uint32_t padded, uint32_t stage,
                    uint32_t distance)
{
    const struct kiln_network_uniform uniforms[] = {
        {SORT_AT_COUNT, padded}, {SORT_AT_STAGE, stage}, {SORT_AT_DISTANCE, distance}};
    kiln_network_dispatch(oddeven->device, oddeven->far_program, uniforms, 3, padded / 2,
                          oddeven->group_size);
}

void kiln_oddeven_run_passes(struct kiln_oddeven *oddeven, uint32_t padded, uint32_t first,
                             uint32_t end)
{
    const uint32_t in_blocks = kiln_oddeven_passes(oddeven->block);
    if (first < end && first < in_blocks) {
        const struct kiln_network_uniform uniforms[] = {
            {SORT_AT_COUNT, padded}, {SORT_AT_FIRST_PASS, first}, {SORT_AT_END_PASS, end}};
        kiln_network_dispatch(oddeven->device, oddeven->block_program, uniforms, 3, padded,
                              oddeven->block);
    }
    uint32_t pass = 0;
    for (uint32_t stage = 0; pass < end; stage++)
        for (uint32_t distance = 1u << stage; distance > 0 && pass < end; distance /= 2, pass++)
            if (pass >= first && pass >= in_blocks)
                run_far(oddeven, padded, stage, distance);
}

static bool sort_padded(void *context, struct kiln_buffer *pairs, uint32_t padded,
                        struct kiln_error *error)
{
    (void)pairs;
    (void)error;
    kiln_oddeven_run_passes(context, padded, 0, kiln_oddeven_passes(padded));
    return true;
}

struct kiln_oddeven *kiln_oddeven_create(struct kiln_device *device, struct kiln_error *error)
{
    struct kiln_oddeven *oddeven = calloc(1, sizeof *oddeven);
    if (!oddeven) {
        kiln_error_no_memory(error, "the sort");
        return NULL;
    }
    oddeven->device = device;
    oddeven->group_size = kiln_network_group_size(device);
    oddeven->block = oddeven->group_size * NETWORK_ITEMS;
    const struct kiln_network_kernel kernels[] = {
        {"sort/papers/oddeven_block.comp", NULL, &oddeven->block_program},
        {"sort/papers/oddeven_far.comp", NULL, &oddeven->far_program},
    };
    if (!kiln_network_init(&oddeven->network, device, sort_padded, oddeven, error) ||
        !kiln_network_programs(device, kernels, sizeof kernels / sizeof *kernels, error))
        kiln_oddeven_destroy(&oddeven);
    return oddeven;
}

void kiln_oddeven_destroy(struct kiln_oddeven **oddeven)
{
    if (!*oddeven)
        return;
    kiln_network_finish(&(*oddeven)->network);
    glDeleteProgram((*oddeven)->block_program);
    glDeleteProgram((*oddeven)->far_program);
    free(*oddeven);
    *oddeven = NULL;
}

struct kiln_network *kiln_oddeven_network(struct kiln_oddeven *oddeven)
{
    return &oddeven->network;
}

static void *create(const struct kiln_sort_setup *setup, struct kiln_error *error)
{
    return kiln_oddeven_create(setup->device, error);
}

static void destroy(void *technique)
{
    struct kiln_oddeven *oddeven = technique;
    kiln_oddeven_destroy(&oddeven);
}

static bool run(void *technique, struct kiln_pool *pool, const struct kiln_sort_params *params,
                struct kiln_buffer *entries, uint32_t *count, struct kiln_error *error)
{
    return kiln_network_run(kiln_oddeven_network(technique), pool, params, entries, count, error);
}

const struct kiln_sort_row kiln_sort_oddeven_row = {
    .in_gl = true, .create = create, .destroy = destroy, .run = run, .bytes = kiln_network_bytes};
