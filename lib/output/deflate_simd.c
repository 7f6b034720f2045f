/* Compresses filtered rows of pictures to DEFLATE. One block has all of the bytes, with a Huffman
 * code made for them. Two passes read the bytes: the first counts, the second writes.
 *
 * Speed comes from these choices:
 * - Sixteen bytes are looked at together. If all of them are zero, a run begins, which becomes a
 *   literal and matches at distance 1. All other bytes are literals.
 * - Literals are written in pairs, by a table that has the codes of all pairs. Codes have at most
 *   12 bits, so that two pairs and the rest of a byte fit into 64 bits.
 * - Only an eighth of the literals is counted. Every literal has a code, whether or not the sample
 *   has it. Runs are all counted.
 * - The file is compiled for each level of vectors: AVX2 brings shifts by a register that are three
 *   times as cheap. */
#include <endian.h>
#include <string.h>

#include "output/deflate.h"
#include "output/huffman.h"

enum {
    END = 256,          /* the symbol behind the last byte */
    LENGTHS = 257,      /* the symbol of the first length */
    SYMBOLS = 286,      /* literals, END, lengths */
    DISTANCES = 2,      /* distance 1, and another one that makes the code complete */
    MAX_BITS = 12,      /* of a code */
    GROUP = 16,         /* bytes that are looked at together */
    SAMPLED = 8,        /* one group out of so many is counted */
    SHORTEST_MATCH = 3, /* bytes */
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

static void fill_byte(struct bits *bits)
{
    put(bits, 0, -bits->count & 7);
}

/* ---- Runs ------------------------------------------------------------------------------------ */

static inline uint64_t load(const uint8_t *bytes)
{
    uint64_t word;
    memcpy(&word, bytes, sizeof word);
    return word;
}

static inline bool is_zero(const uint8_t *group)
{
    return (load(group) | load(group + 8)) == 0;
}

/* Returns the number of zeros from here on, of which GROUP are known. */
static size_t zeros(const uint8_t *bytes, const uint8_t *end)
{
    const uint8_t *at = bytes + GROUP;
    for (; (size_t)(end - at) >= sizeof(uint64_t); at += sizeof(uint64_t)) {
        const uint64_t word = le64toh(load(at));
        if (word != 0)
            return (size_t)(at - bytes) + (size_t)__builtin_ctzll(word) / 8;
    }
    while (at < end && *at == 0)
        at++;
    return (size_t)(at - bytes);
}

/* The symbol of a match, and the bits that follow its code (RFC 1951, 3.2.5). */
struct length {
    unsigned symbol, extra_bits, extra;
};

static struct length length_of(size_t match)
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
static size_t next_match(size_t run)
{
    return run <= LONGEST_MATCH       ? run
           : run - LONGEST_MATCH >= 3 ? LONGEST_MATCH
                                      : LONGEST_MATCH - 3;
}

/* ---- The first pass: counting ---------------------------------------------------------------- */

/* Adds the matches of a run to `matches`, which counts them by their lengths. */
static inline void count_run(size_t run, uint32_t *matches)
{
    for (size_t left = run - 1; left > 0;) {
        const size_t match = next_match(left);
        matches[match]++;
        left -= match;
    }
}

/* Counts runs, and a sample of the literals, to weights of SYMBOLS symbols. */
static void count(const uint8_t *bytes, size_t size, uint32_t *weights)
{
    const uint8_t *at = bytes, *end = bytes + size;
    uint32_t halves[2][256] = {0}; /* two tables, since neighbours are often the same */
    uint32_t matches[LONGEST_MATCH + 1] = {0};
    for (unsigned turn = 0; (size_t)(end - at) >= GROUP; turn++) {
        if (is_zero(at)) {
            const size_t run = zeros(at, end);
            count_run(run, matches);
            weights[0]++;
            at += run;
            continue;
        }
        if (turn % SAMPLED == 0) {
            for (int i = 0; i < GROUP; i += 2) {
                halves[0][at[i]]++;
                halves[1][at[i + 1]]++;
            }
        }
        at += GROUP;
    }
    for (int i = 0; i < 256; i++)
        weights[i] += SAMPLED * (halves[0][i] + halves[1][i]) + 1;
    weights[END] = 1;
    for (unsigned i = SHORTEST_MATCH; i <= LONGEST_MATCH; i++)
        weights[length_of(i).symbol] += matches[i];
}

/* ---- The head of a block --------------------------------------------------------------------- */

/* A sequence of lengths of codes as symbols (RFC 1951, 3.2.7). */
struct lengths {
    uint8_t symbols[SYMBOLS + DISTANCES], extras[SYMBOLS + DISTANCES];
    size_t count;
};

enum {
    REPEAT = 16,     /* the length before, 3 to 6 times */
    FEW_ZEROS = 17,  /* 3 to 10 zeros */
    MANY_ZEROS = 18, /* 11 to 138 zeros */
    LENGTH_SYMBOLS = 19
};

static void add_length(struct lengths *list, unsigned symbol, size_t extra)
{
    list->symbols[list->count] = (uint8_t)symbol;
    list->extras[list->count++] = (uint8_t)extra;
}

/* Shortens sequences of the same length. */
static void list_lengths(const uint8_t *lengths, size_t count, struct lengths *list)
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

/* Writes the lengths of all codes. */
static void write_head(struct bits *bits, const uint8_t *lengths)
{
    static const uint8_t order[LENGTH_SYMBOLS] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                  11, 4,  12, 3, 13, 2, 14, 1, 15};
    static const uint8_t extra_bits[] = {2, 3, 7};
    struct lengths list = {.count = 0};
    list_lengths(lengths, SYMBOLS + DISTANCES, &list);
    uint32_t weights[LENGTH_SYMBOLS] = {0};
    for (size_t i = 0; i < list.count; i++)
        weights[list.symbols[i]]++;
    uint8_t own[LENGTH_SYMBOLS];
    uint16_t codes[LENGTH_SYMBOLS];
    kiln_huffman_lengths(weights, LENGTH_SYMBOLS, 7, own);
    kiln_huffman_codes(own, LENGTH_SYMBOLS, codes);
    put(bits, SYMBOLS - 257, 5);
    put(bits, DISTANCES - 1, 5);
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

/* ---- The second pass: writing ---------------------------------------------------------------- */

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
static void make_pairs(const uint32_t *codes, uint32_t *restrict pairs)
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

/* Makes a code for each match: that of its length, and that of its distance. */
static void make_matches(const uint32_t *codes, uint32_t *matches)
{
    for (unsigned i = SHORTEST_MATCH; i <= LONGEST_MATCH; i++) {
        const struct length length = length_of(i);
        const uint32_t code = codes[length.symbol];
        const uint32_t extra = (length.extra << 8) << length_in(code);
        matches[i] = (code | extra) + length.extra_bits + 1; /* the code of the distance is 0 */
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

/* Writes a literal and the matches of a run. */
static inline void put_run(struct bits *bits, const uint32_t *codes, const uint32_t *matches,
                           size_t run)
{
    put_code(bits, codes[0]);
    for (size_t left = run - 1; left > 0;) {
        const size_t match = next_match(left);
        put_code(bits, matches[match]);
        left -= match;
    }
}

static void write_bytes(struct bits *given, const uint32_t *codes, const uint32_t *pairs,
                        const uint8_t *bytes, size_t size)
{
    struct bits bits = *given;
    uint32_t matches[LONGEST_MATCH + 1];
    make_matches(codes, matches);
    const uint8_t *at = bytes, *end = bytes + size;
    while ((size_t)(end - at) >= GROUP) {
        if (is_zero(at)) {
            const size_t run = zeros(at, end);
            put_run(&bits, codes, matches, run);
            at += run;
            continue;
        }
        put_eight(&bits, pairs, at);
        put_eight(&bits, pairs, at + 8);
        at += GROUP;
    }
    for (; at < end; at++)
        put_code(&bits, codes[*at]);
    put_code(&bits, codes[END]);
    *given = bits;
}

/* ---- The interface --------------------------------------------------------------------------- */

enum { STORED_MOST = 65535 };

/* Writes blocks of plain bytes, 5 bytes larger each than what they hold. */
static size_t write_stored(const uint8_t *bytes, size_t size, bool last, uint8_t *out)
{
    uint8_t *start = out;
    do {
        const size_t part = size < STORED_MOST ? size : STORED_MOST;
        size -= part;
        *out++ = last && size == 0;
        *out++ = (uint8_t)part;
        *out++ = (uint8_t)(part >> 8);
        *out++ = (uint8_t)~part;
        *out++ = (uint8_t)(~part >> 8);
        memcpy(out, bytes, part);
        bytes += part;
        out += part;
    } while (size > 0);
    return (size_t)(out - start);
}

size_t KILN_SIMD_NAME(kiln_deflate)(const uint8_t *bytes, size_t size, bool last, uint8_t *out,
                                    struct kiln_deflate_scratch *scratch)
{
    uint32_t weights[SYMBOLS] = {0}, codes[SYMBOLS];
    uint16_t plain_codes[SYMBOLS];
    uint8_t lengths[SYMBOLS + DISTANCES];
    count(bytes, size, weights);
    kiln_huffman_lengths(weights, SYMBOLS, MAX_BITS, lengths);
    kiln_huffman_codes(lengths, SYMBOLS, plain_codes);
    for (int i = 0; i < SYMBOLS; i++)
        codes[i] = (uint32_t)plain_codes[i] << 8 | lengths[i];
    memset(lengths + SYMBOLS, 1, DISTANCES);
    make_pairs(codes, scratch->pairs);

    struct bits bits = {.out = out};
    put(&bits, last, 1);
    put(&bits, 2, 2); /* a block with codes of its own */
    write_head(&bits, lengths);
    write_bytes(&bits, codes, scratch->pairs, bytes, size);
    if (!last)
        put(&bits, 0, 3); /* an empty block of plain bytes, which end at a whole byte */
    fill_byte(&bits);
    if (!last) {
        memcpy(bits.out, (const uint8_t[]){0, 0, 0xff, 0xff}, 4);
        bits.out += 4;
    }
    const size_t written = (size_t)(bits.out - out);
    return written < size ? written : write_stored(bytes, size, last, out);
}
