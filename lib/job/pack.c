/* Packs tables of words, and unpacks them. A table is a sequence of blocks of 2^16 rows, so that
 * threads pack and unpack them in parallel. A block is a head of two words (its size and its
 * CRC-32, which covers size, number and bytes) and a frame of zstd. The frame holds a bit for each
 * row that is not zero, then each byte of each column of those rows, one plane after the other. */
#include "job/pack.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include "base/error.h"
#include "base/unpack.h"

enum {
    BLOCK_ROWS = 1 << 16,
    BITMAP_BYTES = BLOCK_ROWS / 8,
    MAX_RAW = BITMAP_BYTES + BLOCK_ROWS * KILN_PACK_MAX_COLUMNS * 4,
    HEAD_BYTES = 8,
    LEVEL = 1, /* higher levels do not pack the noise of mantissas smaller */
    MAX_BLOCKS_AT_ONCE = 16,
};

/* A block that is being packed or unpacked. */
struct block {
    const struct kiln_table *table;
    size_t number; /* its index in the table */
    uint8_t *raw, *packed;
    size_t raw_size, packed_size;
    uint32_t crc;
    enum kiln_code outcome;
};

static size_t block_count(const struct kiln_table *table)
{
    return (table->rows + BLOCK_ROWS - 1) / BLOCK_ROWS;
}

static size_t rows_of(const struct block *block)
{
    const size_t rest = block->table->rows - block->number * BLOCK_ROWS;
    return rest < BLOCK_ROWS ? rest : BLOCK_ROWS;
}

static size_t largest_raw(const struct kiln_table *table)
{
    const size_t rows = table->rows < BLOCK_ROWS ? table->rows : BLOCK_ROWS;
    return BITMAP_BYTES + rows * table->columns * 4;
}

static void put_word(uint8_t *bytes, uint32_t word)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(word >> (8 * i));
}

static uint32_t get_word(const uint8_t *bytes)
{
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static uint32_t block_crc(size_t number, const uint8_t *packed, size_t size)
{
    uint8_t head[HEAD_BYTES];
    put_word(head, (uint32_t)size);
    put_word(head + 4, (uint32_t)number);
    return (uint32_t)crc32_z(crc32_z(0, head, sizeof head), packed, size);
}

/* ---- packing --------------------------------------------------------------------------------- */

static bool is_zero(const uint32_t *row, uint32_t columns)
{
    uint32_t any = 0;
    for (uint32_t c = 0; c < columns; c++)
        any |= row[c];
    return any == 0;
}

/* Marks the rows that are not zero in the bitmap and lists them; returns their number. */
static size_t list_rows(const struct kiln_table *table, const uint32_t *first, size_t rows,
                        uint8_t *bitmap, uint32_t *row_indices)
{
    size_t count = 0;
    memset(bitmap, 0, BITMAP_BYTES);
    for (size_t i = 0; i < rows; i++) {
        if (is_zero(first + i * table->columns, table->columns))
            continue;
        bitmap[i / 8] |= (uint8_t)(1u << (i % 8));
        row_indices[count++] = (uint32_t)i;
    }
    return count;
}

static size_t spread_planes(const struct kiln_table *table, const uint32_t *first,
                            const uint32_t *row_indices, size_t count, uint8_t *planes)
{
    for (uint32_t c = 0; c < table->columns; c++) {
        uint32_t before = 0;
        uint8_t *plane = planes + (size_t)c * 4 * count;
        for (size_t i = 0; i < count; i++) {
            uint32_t word = first[(size_t)row_indices[i] * table->columns + c],
                     value = word - before;
            value = table->rising >> c & 1 ? value : word;
            before = word;
            for (size_t k = 0; k < 4; k++)
                plane[k * count + i] = (uint8_t)(value >> (8 * k));
        }
    }
    return (size_t)table->columns * 4 * count;
}

static void pack_blocks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct block *blocks = context;
    for (struct block *block = blocks + begin; block < blocks + end; block++) {
        const struct kiln_table *table = block->table;
        const uint32_t *first = table->words + block->number * BLOCK_ROWS * table->columns;
        uint32_t *row_indices = malloc(BLOCK_ROWS * sizeof *row_indices);
        block->outcome = row_indices ? KILN_OK : KILN_DEVICE_FAILED;
        if (!row_indices)
            continue;
        const size_t count = list_rows(table, first, rows_of(block), block->raw, row_indices);
        block->raw_size = BITMAP_BYTES + spread_planes(table, first, row_indices, count,
                                                       block->raw + BITMAP_BYTES);
        free(row_indices);
        block->packed_size = ZSTD_compress(block->packed, ZSTD_compressBound(block->raw_size),
                                           block->raw, block->raw_size, LEVEL);
        if (ZSTD_isError(block->packed_size))
            block->outcome = KILN_DEVICE_FAILED;
        else
            block->crc = block_crc(block->number, block->packed, block->packed_size);
    }
}

/* ---- unpacking ------------------------------------------------------------------------------- */

static void join_planes(const struct kiln_table *table, const uint8_t *planes, size_t count,
                        const uint8_t *bitmap, uint32_t *first, size_t rows)
{
    for (uint32_t c = 0; c < table->columns; c++) {
        uint32_t before = 0;
        const uint8_t *plane = planes + (size_t)c * 4 * count;
        size_t next = 0;
        for (size_t i = 0; i < rows; i++) {
            uint32_t word = 0;
            if (bitmap[i / 8] >> (i % 8) & 1) {
                for (size_t k = 0; k < 4; k++)
                    word |= (uint32_t)plane[k * count + next] << (8 * k);
                word += table->rising >> c & 1 ? before : 0;
                before = word;
                next++;
            }
            first[i * table->columns + c] = word;
        }
    }
}

/* Counts the rows that the bitmap marks. False when it marks a row behind the last row of the
 * block. */
static bool count_rows(const uint8_t *bitmap, size_t rows, size_t *count)
{
    *count = 0;
    for (size_t i = 0; i < BLOCK_ROWS; i++) {
        const bool is_stored = bitmap[i / 8] >> (i % 8) & 1;
        if (is_stored && i >= rows)
            return false;
        *count += is_stored;
    }
    return true;
}

static void unpack_blocks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct block *blocks = context;
    for (struct block *block = blocks + begin; block < blocks + end; block++) {
        const struct kiln_table *table = block->table;
        const size_t rows = rows_of(block);
        size_t count = 0;
        block->outcome = kiln_unpack(block->raw, largest_raw(table), block->packed,
                                     block->packed_size, &block->raw_size);
        if (block->outcome == KILN_OK &&
            (block->raw_size < BITMAP_BYTES || !count_rows(block->raw, rows, &count) ||
             block->raw_size != BITMAP_BYTES + count * table->columns * 4))
            block->outcome = KILN_INVALID_INPUT;
        if (block->outcome == KILN_OK)
            join_planes(table, block->raw + BITMAP_BYTES, count, block->raw,
                        table->words + block->number * BLOCK_ROWS * table->columns, rows);
    }
}

/* ---- blocks in parallel ---------------------------------------------------------------------- */

struct batch {
    struct block blocks[MAX_BLOCKS_AT_ONCE];
    size_t most; /* the most blocks that are packed at once */
    uint8_t *memory;
};

static bool make_batch(struct batch *batch, const struct kiln_table *table, uint32_t threads,
                       struct kiln_error *error)
{
    const size_t raw = largest_raw(table), packed = ZSTD_compressBound(raw);
    size_t most = block_count(table) < threads ? block_count(table) : threads;
    most = most > MAX_BLOCKS_AT_ONCE ? MAX_BLOCKS_AT_ONCE : most;
    *batch = (struct batch){.most = most, .memory = malloc(most * (raw + packed) + 1)};
    if (!batch->memory)
        return kiln_error_no_memory(error, "a saved state");
    for (size_t i = 0; i < most; i++) {
        batch->blocks[i].table = table;
        batch->blocks[i].raw = batch->memory + i * (raw + packed);
        batch->blocks[i].packed = batch->blocks[i].raw + raw;
    }
    return true;
}

/* Gives the batch's blocks their numbers, from `first` on; returns how many blocks there are. */
static size_t take_batch(struct batch *batch, size_t first, size_t count)
{
    const size_t taken = count - first < batch->most ? count - first : batch->most;
    for (size_t i = 0; i < taken; i++)
        batch->blocks[i].number = first + i;
    return taken;
}

bool kiln_pack_write(const struct kiln_table *table, struct kiln_threads *threads,
                     struct kiln_temporary *file, struct kiln_error *error)
{
    struct batch batch;
    if (!make_batch(&batch, table, kiln_threads_count(threads), error))
        return false;
    const size_t count = block_count(table);
    bool ok = true;
    for (size_t first = 0; first < count && ok; first += batch.most) {
        const size_t taken = take_batch(&batch, first, count);
        kiln_threads_for(threads, taken, 1, pack_blocks, batch.blocks);
        for (size_t i = 0; i < taken && ok; i++) {
            const struct block *block = &batch.blocks[i];
            uint8_t head[HEAD_BYTES];
            put_word(head, (uint32_t)block->packed_size);
            put_word(head + 4, block->crc);
            ok = block->outcome == KILN_OK || kiln_error_no_memory(error, "a saved state");
            if (ok && kiln_temporary_write(file, head, sizeof head))
                kiln_temporary_write(file, block->packed, block->packed_size);
        }
    }
    free(batch.memory);
    return ok;
}

bool kiln_pack_read_bytes(int file, void *bytes, size_t size, const char *path,
                          struct kiln_error *error)
{
    for (size_t done = 0; done < size;) {
        const ssize_t got = read(file, (char *)bytes + done, size - done);
        if (got == 0)
            return kiln_error_set(error, KILN_INVALID_INPUT, "%s: the file is cut off", path);
        if (got < 0 && errno != EINTR)
            return kiln_error_set_errno(error, KILN_IO, errno, "%s", path);
        done += got > 0 ? (size_t)got : 0;
    }
    return true;
}

static bool read_block(struct block *block, int file, const char *path, struct kiln_error *error)
{
    uint8_t head[HEAD_BYTES];
    if (!kiln_pack_read_bytes(file, head, sizeof head, path, error))
        return false;
    block->packed_size = get_word(head);
    if (block->packed_size > ZSTD_compressBound(largest_raw(block->table)))
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: the file is damaged", path);
    if (!kiln_pack_read_bytes(file, block->packed, block->packed_size, path, error))
        return false;
    return get_word(head + 4) == block_crc(block->number, block->packed, block->packed_size) ||
           kiln_error_set(error, KILN_INVALID_INPUT, "%s: the file is damaged", path);
}

static bool check_outcome(enum kiln_code outcome, const char *path, struct kiln_error *error)
{
    if (outcome == KILN_DEVICE_FAILED)
        return kiln_error_no_memory(error, "%s", path);
    return outcome == KILN_OK || kiln_error_set(error, outcome, "%s: the file is damaged", path);
}

bool kiln_pack_read(const struct kiln_table *table, struct kiln_threads *threads, int file,
                    const char *path, struct kiln_error *error)
{
    struct batch batch;
    if (!make_batch(&batch, table, kiln_threads_count(threads), error))
        return false;
    const size_t count = block_count(table);
    bool ok = true;
    for (size_t first = 0; first < count && ok; first += batch.most) {
        const size_t taken = take_batch(&batch, first, count);
        for (size_t i = 0; i < taken && ok; i++)
            ok = read_block(&batch.blocks[i], file, path, error);
        if (ok)
            kiln_threads_for(threads, taken, 1, unpack_blocks, batch.blocks);
        for (size_t i = 0; i < taken && ok; i++)
            ok = check_outcome(batch.blocks[i].outcome, path, error);
    }
    free(batch.memory);
    return ok;
}

bool kiln_pack_check(const struct kiln_table *table, int file, const char *path,
                     struct kiln_error *error)
{
    struct batch batch;
    if (!make_batch(&batch, table, 1, error))
        return false;
    bool ok = true;
    for (size_t i = 0; i < block_count(table) && ok; i++) {
        batch.blocks[0].number = i;
        ok = read_block(&batch.blocks[0], file, path, error);
    }
    free(batch.memory);
    return ok;
}
