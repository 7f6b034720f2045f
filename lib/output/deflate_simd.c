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
#include "output/deflate.h"
#include "output/deflate_block.h"

enum {
    DISTANCES = 2, /* distance 1, and another one that makes the code complete */
    GROUP = 16,    /* bytes that are looked at together */
    SAMPLED = 8,   /* one group out of so many is counted */
};

/* ---- Runs ------------------------------------------------------------------------------------ */

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

/* ---- The second pass: writing ---------------------------------------------------------------- */

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
    write_head(&bits, lengths, DISTANCES);
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
