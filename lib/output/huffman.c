/* Makes prefix codes of limited length for DEFLATE. The lengths are those of Huffman's algorithm.
 * Where some are above the limit, they are cut, and the shortest change of other lengths makes the
 * code complete again: that costs far less than a tenth of a percent, and an optimal limited code
 * takes several times as long. */
#include "output/huffman.h"

#include <stdlib.h>
#include <string.h>

/* Bits of a sorting key that hold the symbol. */
enum { SYMBOL_BITS = 9, SYMBOL_MASK = (1 << SYMBOL_BITS) - 1 };

static int compare_keys(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Fills `keys` with the symbols of nonzero weight, lightest first. Symbols of one weight are in the
 * order of their numbers, so no two keys are equal and every sort gives the same order. */
static size_t sort_symbols(const uint32_t *weights, size_t count, uint64_t *keys)
{
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        if (weights[i] > 0)
            keys[used++] = (uint64_t)weights[i] << SYMBOL_BITS | i;
    }
    qsort(keys, used, sizeof *keys, compare_keys);
    return used;
}

/* Joins the two lightest trees until one is left. Leaves lie in `keys`, lightest first; joined
 * trees get ascending weights and so form a second queue. parents[i] of leaf i, and of tree
 * used + i, is the number of the tree that it became a part of. */
static void join_trees(const uint64_t *keys, size_t used, uint16_t *parents)
{
    uint64_t trees[KILN_HUFFMAN_MAX_SYMBOLS];
    size_t leaf = 0, tree = 0;
    for (size_t made = 0; made + 1 < used; made++) {
        trees[made] = 0;
        for (int side = 0; side < 2; side++) {
            if (leaf < used && (tree == made || keys[leaf] >> SYMBOL_BITS <= trees[tree])) {
                trees[made] += keys[leaf] >> SYMBOL_BITS;
                parents[leaf++] = (uint16_t)made;
            } else {
                trees[made] += trees[tree];
                parents[used + tree++] = (uint16_t)made;
            }
        }
    }
}

/* Counts the leaves of each depth; depths above the limit count as the limit. */
static void count_depths(const uint16_t *parents, size_t used, unsigned max_bits, uint32_t *counts)
{
    uint16_t depths[KILN_HUFFMAN_MAX_SYMBOLS];
    const size_t root = used - 2;
    depths[root] = 0;
    for (size_t tree = root; tree-- > 0;)
        depths[tree] = (uint16_t)(depths[parents[used + tree]] + 1);
    for (size_t leaf = 0; leaf < used; leaf++) {
        const unsigned depth = depths[parents[leaf]] + 1u;
        counts[depth < max_bits ? depth : max_bits]++;
    }
}

/* Makes the code complete after depths were cut: as long as it is too full, the deepest leaf that
 * can go down takes a leaf of the greatest depth as its neighbour. */
static void refit(uint32_t *counts, unsigned max_bits)
{
    uint32_t space = 0;
    for (unsigned bits = 1; bits <= max_bits; bits++)
        space += counts[bits] << (max_bits - bits);
    for (; space > 1u << max_bits; space--) {
        unsigned bits = max_bits - 1;
        while (counts[bits] == 0)
            bits--;
        counts[max_bits]--;
        counts[bits]--;
        counts[bits + 1] += 2;
    }
}

void kiln_huffman_lengths(const uint32_t *weights, size_t count, unsigned max_bits,
                          uint8_t *lengths)
{
    uint64_t keys[KILN_HUFFMAN_MAX_SYMBOLS];
    uint16_t parents[2 * KILN_HUFFMAN_MAX_SYMBOLS] = {0};
    uint32_t counts[KILN_HUFFMAN_MAX_BITS + 1] = {0};
    const size_t used = sort_symbols(weights, count, keys);
    join_trees(keys, used, parents);
    count_depths(parents, used, max_bits, counts);
    refit(counts, max_bits);
    memset(lengths, 0, count);
    size_t leaf = 0;
    for (unsigned bits = max_bits; bits > 0; bits--) {
        for (uint32_t i = 0; i < counts[bits]; i++)
            lengths[keys[leaf++] & SYMBOL_MASK] = (uint8_t)bits;
    }
}

void kiln_huffman_codes(const uint8_t *lengths, size_t count, uint16_t *codes)
{
    uint32_t counts[KILN_HUFFMAN_MAX_BITS + 1] = {0}, next[KILN_HUFFMAN_MAX_BITS + 1] = {0};
    for (size_t i = 0; i < count; i++)
        counts[lengths[i]]++;
    counts[0] = 0;
    for (unsigned bits = 1; bits <= KILN_HUFFMAN_MAX_BITS; bits++)
        next[bits] = (next[bits - 1] + counts[bits - 1]) << 1;
    for (size_t i = 0; i < count; i++) {
        uint32_t code = lengths[i] > 0 ? next[lengths[i]]++ : 0, turned = 0;
        for (unsigned bit = 0; bit < lengths[i]; bit++, code >>= 1)
            turned = turned << 1 | (code & 1);
        codes[i] = (uint16_t)turned;
    }
}
