/* Fuzzes the reader of saved simulation states: from any file it must read a state into a pool, or
 * report an error with a message, and never crash. If this fails, a job that resumes from a damaged
 * state crashes or writes outside the pool. The reader refuses a file with a wrong checksum before
 * it reads anything else, so the target first corrects the checksums of each input. */
#include "job/state.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

#include "fuzz.h"

enum { LINE = 13 }; /* bytes of the first line, "kiln state 1\n", before the head's size */

static uint32_t get_word(const uint8_t *bytes)
{
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void put_word(uint8_t *bytes, uint32_t word)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(word >> (8 * i));
}

/* Corrects the checksums of the head and of the blocks of particles that follow it. The states of
 * the corpus have few particles, so each of their tables is one block. The block's number, 0, is
 * part of its checksum. */
static void repair(uint8_t *data, size_t size)
{
    if (size < LINE + 4)
        return;
    const size_t head = get_word(data + LINE);
    if (head < LINE + 8 || head > size || head > KILN_STATE_MAX_HEAD)
        return;
    put_word(data + head - 4, (uint32_t)crc32_z(0, data, head - 4));
    for (size_t at = head; at + 8 < size;) {
        const size_t length = get_word(data + at);
        if (length > size - at - 8)
            return;
        uint8_t start[8];
        put_word(start, (uint32_t)length);
        put_word(start + 4, 0);
        const unsigned long crc = crc32_z(crc32_z(0, start, sizeof start), data + at + 8, length);
        put_word(data + at + 4, (uint32_t)crc);
        at += 8 + length;
    }
}

/* Reads a state into a pool of two systems, which is the pool of the states in the corpus, and of
 * one domain of gas or none. The pool gets the spins and the painted canvases that the state has,
 * by its head. */
static void read_into_pool(const char *path, const struct kiln_state_info *info, uint32_t gas_count)
{
    struct kiln_pool_layout layout = {.system_count = 2,
                                      .capacities = {26, 52},
                                      .gas_count = gas_count,
                                      .gas = {{.cells = {32, 32, 32}, .cell = 0.1f}}};
    for (uint32_t i = 0; i < layout.system_count; i++) {
        layout.spins[i] = info->spins[i];
        layout.travels[i] = info->travels[i];
    }
    layout.canvas_count = info->shape_count;
    memcpy(layout.canvases, info->shapes, sizeof layout.canvases);
    struct kiln_error error = {0};
    struct kiln_pool pool;
    struct kiln_threads *threads = kiln_threads_create(1);
    uint32_t words[78];
    struct kiln_state state = {.pool = &pool,
                               .history = {.of_slots = info->history[0] ? words : NULL}};
    fuzz_taken = threads && kiln_pool_init(&pool, NULL, &layout, &error) &&
                 kiln_state_read(&state, path, threads, &error);
    if (threads && !fuzz_taken)
        require(error.code != KILN_OK && *error.message, "an error without a message");
    kiln_pool_finish(&pool);
    kiln_threads_destroy(&threads);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[] = "/tmp/kiln-fuzz-XXXXXX";
    uint8_t *copy = malloc(size + 1);
    const int file = copy ? mkstemp(path) : -1;
    fuzz_taken = false;
    if (file >= 0) {
        struct kiln_state_info info;
        struct kiln_error error = {0};
        if (size)
            memcpy(copy, data, size);
        repair(copy, size);
        const bool written = write(file, copy, size) == (ssize_t)size;
        close(file);
        if (written && kiln_state_check(path, &info, &error)) {
            read_into_pool(path, &info, 0);
            if (!fuzz_taken)
                read_into_pool(path, &info, 1);
        } else if (written)
            require(error.code != KILN_OK && *error.message, "an error without a message");
        unlink(path);
    }
    free(copy);
    return 0;
}
