/* This header writes blocks of a DEFLATE stream (RFC 1951) for the files that choose its literals
 * and matches: bits, the head of a block, and the codes of literals and lengths. Literals are
 * written in pairs, by a table that has the codes of all pairs. Codes have at most 12 bits, so that
 * two pairs and the rest of a byte fit into 64 bits. */
#ifndef KILN_OUTPUT_DEFLATE_BLOCK_H
#define KILN_OUTPUT_DEFLATE_BLOCK_H

#include <endian.h>
#include <stdbool.h>
#include <string.h>

#include "output/huffman.h"

enum {
    END = 256,           /* the symbol behind the last byte */
    LENGTHS = 257,       /* the symbol of the first length */
    SYMBOLS = 286,       /* literals, END, lengths */
    MOST_DISTANCES = 30, /* symbols of distances */
    MAX_BITS = 12,       /* of a code */
    SHORTEST_MATCH = 3,  /* bytes */
    LONGEST_MATCH = 258
};

/* ---- Bits ------------------------------------------------------------------------------------ */

/* Bits are collected from the lowest on, and stored eight bytes at a time. */
struct bits {
    uint64_t word;
    unsigned count; /* bits in `word`; at most 7 after a store */
    uint8_t *out;
};

/* Stores the whole bytes. Writes 8 bytes, of which those behind the whole ones are overwritten
 * later. */
static inline void store(struct bits *bits)
{
    const uint64_t little = htole64(bits->word);
    memcpy(bits->out, &little, sizeof little);
    bits->out += bits->count >> 3;
    bits->word >>= bits->count & ~7u;
    bits->count &= 7;
}

enum { PUT_MOST = 56 }; /* bits */

/* Adds at most PUT_MOST bits. */
static inline void put(struct bits *bits, uint64_t value, unsigned count)
{
    bits->word |= value << bits->count;
    bits->count += count;
    store(bits);
}

static inline void fill_byte(struct bits *bits)
{
    put(bits, 0, -bits->count & 7);
}

static inline uint64_t load(const uint8_t *bytes)
{
    uint64_t word;
    memcpy(&word, bytes, sizeof word);
    return word;
}

/* ---- Matches --------------------------------------------------------------------------------- */

/* The symbol of a match, and the bits that follow its code (RFC 1951, 3.2.5). */
struct length {
    unsigned symbol, extra_bits, extra;
};

static inline struct length length_of(size_t match)
{
    unsigned rest = (unsigned)match - 3, extra_bits = 0;
    if (match == LONGEST_MATCH)
        return (struct length){SYMBOLS - 1, 0, 0};
    while (rest >> extra_bits >= 8)
        extra_bits++;
    return (struct length){LENGTHS + extra_bits * 4 + (rest >> extra_bits), extra_bits,
                           rest & ((1u << extra_bits) - 1)};
}

/* Returns the length of the next match of a run, so that no rest is shorter than 3. */
static inline size_t next_match(size_t run)
{
    return run <= LONGEST_MATCH       ? run
           : run - LONGEST_MATCH >= 3 ? LONGEST_MATCH
                                      : LONGEST_MATCH - 3;
}

/* ---- The head of a block --------------------------------------------------------------------- */

/* A sequence of lengths of codes as symbols (RFC 1951, 3.2.7). */
struct lengths {
    uint8_t symbols[SYMBOLS + MOST_DISTANCES], extras[SYMBOLS + MOST_DISTANCES];
    size_t count;
};

enum {
    REPEAT = 16,     /* the length before, 3 to 6 times */
    FEW_ZEROS = 17,  /* 3 to 10 zeros */
    MANY_ZEROS = 18, /* 11 to 138 zeros */
    LENGTH_SYMBOLS = 19
};

static inline void add_length(struct lengths *list, unsigned symbol, size_t extra)
{
    list->symbols[list->count] = (uint8_t)symbol;
    list->extras[list->count++] = (uint8_t)extra;
}

/* Shortens sequences of the same length. */
static inline void list_lengths(const uint8_t *lengths, size_t count, struct lengths *list)
{
    for (size_t i = 0; i < count;) {
        size_t same = 1;
        while (i + same < count && lengths[i + same] == lengths[i] && same < 138)
            same++;
        size_t used = 1;
        if (lengths[i] == 0 && same >= 3) {
            used = same;
            add_length(list, same > 10 ? MANY_ZEROS : FEW_ZEROS, same - (same > 10 ? 11 : 3));
        } else {
            add_length(list, lengths[i], 0);
            if (same >= 4) {
                used = same < 7 ? same : 7;
                add_length(list, REPEAT, used - 4);
            }
        }
        i += used;
    }
}

/* Writes the lengths of all codes: those of SYMBOLS symbols, then those of the distances. */
static inline void write_head(struct bits *bits, const uint8_t *lengths, size_t distances)
{
    static const uint8_t order[LENGTH_SYMBOLS] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                  11, 4,  12, 3, 13, 2, 14, 1, 15};
    static const uint8_t extra_bits[] = {2, 3, 7};
    struct lengths list = {.count = 0};
    list_lengths(lengths, SYMBOLS + distances, &list);
    uint32_t weights[LENGTH_SYMBOLS] = {0};
    for (size_t i = 0; i < list.count; i++)
        weights[list.symbols[i]]++;
    uint8_t own[LENGTH_SYMBOLS];
    uint16_t codes[LENGTH_SYMBOLS];
    kiln_huffman_lengths(weights, LENGTH_SYMBOLS, 7, own);
    kiln_huffman_codes(own, LENGTH_SYMBOLS, codes);
    put(bits, SYMBOLS - 257, 5);
    put(bits, distances - 1, 5);
    put(bits, LENGTH_SYMBOLS - 4, 4);
    for (size_t i = 0; i < LENGTH_SYMBOLS; i++)
        put(bits, own[order[i]], 3);
    for (size_t i = 0; i < list.count; i++) {
        const unsigned symbol = list.symbols[i];
        put(bits, codes[symbol], own[symbol]);
        if (symbol >= REPEAT)
            put(bits, list.extras[i], extra_bits[symbol - REPEAT]);
    }
}

/* ---- Codes ----------------------------------------------------------------------------------- */

/* Codes lie in tables with their lengths: the code from bit 8 on, its length below. */
static inline unsigned length_in(uint32_t code)
{
    return code & 0xff;
}

static inline void put_code(struct bits *bits, uint32_t code)
{
    put(bits, code >> 8, length_in(code));
}

/* Makes a code for each pair of literals: that of the first, then that of the second. */
static inline void make_pairs(const uint32_t *codes, uint32_t *restrict pairs)
{
    uint32_t second_codes[256], second_lengths[256];
    for (int i = 0; i < 256; i++) {
        second_codes[i] = codes[i] & ~0xffu;
        second_lengths[i] = length_in(codes[i]);
    }
    for (int first = 0; first < 256; first++, pairs += 256) {
        const uint32_t code = codes[first], bits = length_in(code);
        for (int i = 0; i < 256; i++)
            pairs[i] = code + second_lengths[i] + (second_codes[i] << bits);
    }
}

/* Writes the codes of eight literals. Mostly they fit between two stores. */
static inline void put_eight(struct bits *bits, const uint32_t *pairs, const uint8_t *bytes)
{
    const uint64_t word = be64toh(load(bytes));
    const uint32_t a = pairs[word >> 48], b = pairs[word >> 32 & 0xffff];
    const uint32_t c = pairs[word >> 16 & 0xffff], d = pairs[word & 0xffff];
    const uint64_t ab = a >> 8 | (uint64_t)(b >> 8) << length_in(a);
    const uint64_t cd = c >> 8 | (uint64_t)(d >> 8) << length_in(c);
    const unsigned first = length_in(a) + length_in(b), second = length_in(c) + length_in(d);
    if (first + second <= PUT_MOST) {
        put(bits, ab | cd << first, first + second);
    } else {
        put(bits, ab, first);
        put(bits, cd, second);
    }
}

#endif
