/* This file computes prefix sums on the device in three dispatches: the sums of blocks, the prefix
 * sums of these, and the prefix sums within each block. No work group waits for another, since some
 * drivers do not allow it. */
#include "sort/scan.h"

#include "gpu/program.h"
#include "shared/sort_layout.h"

bool kiln_scan_init(struct kiln_scan *scan, struct kiln_device *device, struct kiln_error *error)
{
    *scan = (struct kiln_scan){.device = device};
    kiln_buffer_init(&scan->sums, device, 0, "sums of blocks");
    kiln_buffer_init(&scan->total, device, sizeof(uint32_t), "total");
    const struct {
        const char *file;
        GLuint *program;
    } kernels[] = {{"sort/scan_sums.comp", &scan->sum_program},
                   {"sort/scan_top.comp", &scan->top_program},
                   {"sort/scan_blocks.comp", &scan->block_program}};
    for (size_t i = 0; i < sizeof kernels / sizeof *kernels; i++) {
        *kernels[i].program = kiln_program_create(
            device, &(struct kiln_program_params){.compute = kernels[i].file}, error);
        if (!*kernels[i].program)
            return false;
    }
    return true;
}

void kiln_scan_finish(struct kiln_scan *scan)
{
    kiln_buffer_finish(&scan->sums);
    kiln_buffer_finish(&scan->total);
    glDeleteProgram(scan->sum_program);
    glDeleteProgram(scan->top_program);
    glDeleteProgram(scan->block_program);
    *scan = (struct kiln_scan){.device = NULL};
}

static void run_top(struct kiln_scan *scan, GLuint words, uint32_t count)
{
    glUseProgram(scan->top_program);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_SUMS, words);
    glUniform1ui(SORT_AT_COUNT, count);
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

bool kiln_scan_run(struct kiln_scan *scan, GLuint words, uint32_t count, struct kiln_error *error)
{
    GLuint total = kiln_buffer_gl(&scan->total, KILN_OVERWRITE, error);
    if (!total)
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_TOTAL, total);
    if (count <= SORT_BLOCK) {
        run_top(scan, words, count);
        return true;
    }
    uint32_t blocks = (count - 1) / SORT_BLOCK + 1;
    kiln_buffer_reserve(&scan->sums, blocks * sizeof(uint32_t));
    GLuint sums = kiln_buffer_gl(&scan->sums, KILN_OVERWRITE, error);
    if (!sums)
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_COUNTS, words);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SORT_BIND_SUMS, sums);
    glUseProgram(scan->sum_program);
    glUniform1ui(SORT_AT_COUNT, count);
    kiln_device_dispatch(scan->device, count, SORT_BLOCK);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    run_top(scan, sums, blocks);
    glUseProgram(scan->block_program);
    glUniform1ui(SORT_AT_COUNT, count);
    kiln_device_dispatch(scan->device, count, SORT_BLOCK);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return true;
}

bool kiln_scan_total(struct kiln_scan *scan, uint32_t *total, struct kiln_error *error)
{
    const uint32_t *word = kiln_buffer_host(&scan->total, KILN_READ, error);
    if (!word)
        return false;
    *total = *word;
    return true;
}
