/* Compresses chunks of EXR files. A chunk has a plane with the low bytes of all samples and one
 * with the high bytes; in a line of a plane, channels follow each other. So a channel that is
 * another one times a power of two, or smoke that covers alike in two layers, repeats bytes a whole
 * number of rows away.
 *
 * Speed comes from these choices:
 * - Repeats are looked for at some bytes only: at fewer the longer none was found, at last at every
 *   eighth of a row, which finds long repeats of whole rows. Matches then grow in both directions.
 * - In a plane whose bytes are mostly the same, as high bytes are, a literal takes two or three
 *   bits, so that only long repeats pay. There every sixteenth byte is enough from the start.
 * - Rows of floats get a search at nearly every byte: they have short repeats, as depths of a slope
 *   do.
 * - A hash has one place, that of the latest bytes.
 * - Only a third of the literals is counted for the codes. Every literal has a code.
 * - The file is compiled for each level of vectors: AVX2 brings shifts by a register that are three
 *   times as cheap. */
#include "output/adler.h"
#include "output/deflate_block.h"
#include "output/zip.h"

enum {
    WORD = sizeof(uint64_t),
    DISTANCE_MOST = 32768,
    SEQUENCE_MOST = 65535, /* bytes of a match, which is written as several */
    SHORTEST_RUN = 8,
    COUNTED = 3, /* one literal out of so many is counted */
    GROUP = 16,  /* bytes of a sample, one out of SAMPLED */
    SAMPLED = 32,
};

/* ---- Repeats --------------------------------------------------------------------------------- */

/* How repeats are looked for: the first bytes that must be the same, the bytes of the shortest
 * match, how often nothing is found (as a power of two) until the step doubles, and the step at
 * which the bytes of a match are noted. A step is at most 2^most_step bytes. Without patience it
 * is always that. */
struct manner {
    unsigned same, least, patience, noted, most_step;
};

static const struct manner SPARSE = {8, 16, 0, 8, 4}, USUAL = {6, 6, 4, 2, 3},
                           DENSE = {4, 4, 6, 1, 3};

struct search {
    const uint8_t *bytes;
    size_t end;      /* of the plane */
    size_t literals; /* the first byte that is in no sequence */
    unsigned misses;
    struct kiln_zip_scratch *scratch;
    size_t count; /* of sequences */
};

#define INLINE static inline __attribute__((always_inline))

/* Returns the first bytes from here on, in the upper bytes of a word. */
INLINE uint64_t first_bytes(const uint8_t *bytes, unsigned count)
{
    return le64toh(load(bytes)) << (64 - 8 * count);
}

INLINE uint16_t *place_of(const struct search *s, uint64_t first)
{
    return &s->scratch->places[first * 0x9e3779b97f4a7c15u >> 52];
}

/* Returns how many bytes from `at` to `end` are those at a distance before. */
static inline size_t same_bytes(const uint8_t *bytes, size_t at, size_t distance, size_t end)
{
    size_t i = at;
    for (; i + WORD <= end; i += WORD) {
        const uint64_t change = le64toh(load(bytes + i) ^ load(bytes + i - distance));
        if (change != 0)
            return i - at + (size_t)__builtin_ctzll(change) / 8;
    }
    while (i < end && bytes[i] == bytes[i - distance])
        i++;
    return i - at;
}

/* Returns the distance of a repeat of the bytes at `at`, or 0. Notes the place. */
INLINE size_t find_repeat(const struct search *s, size_t at, unsigned same)
{
    const uint64_t first = first_bytes(s->bytes + at, same);
    uint16_t *place = place_of(s, first);
    const size_t distance = (at - *place) & 0xffff;
    *place = (uint16_t)at;
    if (at > 0 && first_bytes(s->bytes + at - 1, same) == first)
        return 1;
    const bool fits = distance - 1 < DISTANCE_MOST && distance <= at;
    return fits && first_bytes(s->bytes + at - distance, same) == first ? distance : 0;
}

/* Returns the first place from `at` on that is a multiple of `step`, a power of two, from `row`. */
INLINE size_t align(size_t row, size_t at, size_t step)
{
    return row + ((at - row + step - 1) & ~(step - 1));
}

/* Adds the match at a distance, and returns whether it is long enough. */
INLINE bool add_match(struct search *s, size_t at, size_t distance, size_t least)
{
    size_t from = at;
    const size_t most = s->end - at < SEQUENCE_MOST - WORD ? s->end : at + SEQUENCE_MOST - WORD;
    const size_t to = at + same_bytes(s->bytes, at, distance, most);
    const size_t first = at - s->literals < WORD ? s->literals : at - WORD;
    while (from > first && from > distance && s->bytes[from - 1] == s->bytes[from - 1 - distance])
        from--;
    if (to - from < least)
        return false;
    s->scratch->sequences[s->count++] =
        (struct kiln_zip_sequence){.literals = (uint32_t)(from - s->literals),
                                   .length = (uint16_t)(to - from),
                                   .distance = (uint16_t)(distance - 1)};
    s->literals = to;
    return true;
}

/* Lists the sequences of a row, or of its rest. Returns false where there is no room for more. */
INLINE bool search_row(struct search *s, size_t row, size_t row_end, const struct manner how)
{
    size_t at = s->literals > row ? s->literals : row;
    const size_t words = s->end < WORD ? 0 : s->end - WORD + 1; /* the first place without one */
    const size_t end = row_end < words ? row_end : words;
    const size_t most_step = (size_t)1 << how.most_step;
    unsigned misses = how.patience ? s->misses : how.most_step;
    if (how.patience == 0)
        at = align(row, at, most_step);
    while (at < end) {
        const size_t distance = find_repeat(s, at, how.same);
        const size_t least = distance == 1 ? SHORTEST_RUN : how.least;
        if (distance == 0 || !add_match(s, at, distance, least)) {
            misses++;
            const unsigned doubled = misses >> how.patience;
            const size_t step = doubled < how.most_step ? (size_t)1 << doubled : most_step;
            at = align(row, at + 1, step);
            continue;
        }
        for (size_t i = align(row, at + 1, how.noted);
             distance != 1 && i < s->literals && i + WORD <= s->end; i += how.noted)
            *place_of(s, first_bytes(s->bytes + i, how.same)) = (uint16_t)i;
        at = how.patience ? s->literals : align(row, s->literals, most_step);
        misses = how.patience ? 0 : misses;
        if (s->count == KILN_ZIP_SEQUENCES)
            return false;
    }
    s->misses = misses;
    return true;
}

static bool search_sparse(struct search *s, size_t row, size_t row_end)
{
    return search_row(s, row, row_end, SPARSE);
}

static bool search_usual(struct search *s, size_t row, size_t row_end)
{
    return search_row(s, row, row_end, USUAL);
}

static bool search_dense(struct search *s, size_t row, size_t row_end)
{
    return search_row(s, row, row_end, DENSE);
}

/* Returns whether few values make up most of the bytes that are not in runs: whether two of them
 * are the same more often than one time in eight. */
static bool is_uneven(const uint8_t *bytes, size_t size)
{
    uint32_t counts[256] = {0};
    uint64_t all = 0, same = 0;
    for (size_t at = 1; at + GROUP <= size; at += (size_t)GROUP * SAMPLED) {
        const uint8_t *group = bytes + at;
        if (memcmp(group, group - 1, GROUP) == 0)
            continue;
        for (int i = 0; i < GROUP; i++)
            counts[group[i]]++;
        all += GROUP;
    }
    for (int i = 0; i < 256; i++)
        same += (uint64_t)counts[i] * counts[i];
    return same * 8 > all * all;
}

/* ---- A block --------------------------------------------------------------------------------- */

/* The symbol of a distance, and the bits that follow its code (RFC 1951, 3.2.5). less: the distance
 * less 1. */
struct distance {
    unsigned symbol, extra_bits, extra;
};

INLINE struct distance distance_of(unsigned less)
{
    if (less < 4)
        return (struct distance){less, 0, 0};
    const unsigned bits = 30u - (unsigned)__builtin_clz(less);
    return (struct distance){2 * bits + (less >> bits), bits, less & ((1u << bits) - 1)};
}

/* Counts what the sequences of a block have, to weights of SYMBOLS symbols, then of distances. */
static void count(const uint8_t *bytes, const struct kiln_zip_sequence *sequences, size_t number,
                  uint32_t *weights)
{
    uint32_t literals[256] = {0}, matches[LONGEST_MATCH + 1] = {0};
    size_t at = 0;
    for (size_t k = 0; k < number; k++) {
        const struct kiln_zip_sequence s = sequences[k];
        for (; at < s.literals; at += COUNTED)
            literals[bytes[at]]++;
        at -= s.literals;
        bytes += s.literals + s.length;
        for (size_t left = s.length; left > 0;) {
            const size_t match = next_match(left);
            matches[match]++;
            weights[SYMBOLS + distance_of(s.distance).symbol]++;
            left -= match;
        }
    }
    for (int i = 0; i < 256; i++)
        weights[i] = COUNTED * literals[i] + 1;
    weights[END] = 1;
    for (unsigned i = SHORTEST_MATCH; i <= LONGEST_MATCH; i++)
        weights[length_of(i).symbol] += matches[i];
    weights[SYMBOLS]++; /* a code has at least two symbols */
    weights[SYMBOLS + 1]++;
}

/* The codes of a block, as tables have them. */
struct codes {
    uint32_t symbols[SYMBOLS], distances[MOST_DISTANCES];
    uint32_t matches[LONGEST_MATCH + 1]; /* by length, with the bits that follow */
    const uint32_t *pairs;
};

/* Makes codes, and writes the head of the block. */
static void make_codes(const uint32_t *weights, struct bits *bits, struct codes *codes,
                       uint32_t *pairs)
{
    uint8_t lengths[SYMBOLS + MOST_DISTANCES];
    uint16_t plain[SYMBOLS];
    kiln_huffman_lengths(weights, SYMBOLS, MAX_BITS, lengths);
    kiln_huffman_codes(lengths, SYMBOLS, plain);
    for (int i = 0; i < SYMBOLS; i++)
        codes->symbols[i] = (uint32_t)plain[i] << 8 | lengths[i];
    kiln_huffman_lengths(weights + SYMBOLS, MOST_DISTANCES, MAX_BITS, lengths + SYMBOLS);
    kiln_huffman_codes(lengths + SYMBOLS, MOST_DISTANCES, plain);
    for (int i = 0; i < MOST_DISTANCES; i++)
        codes->distances[i] = (uint32_t)plain[i] << 8 | lengths[SYMBOLS + i];
    for (unsigned i = SHORTEST_MATCH; i <= LONGEST_MATCH; i++) {
        const struct length length = length_of(i);
        const uint32_t code = codes->symbols[length.symbol];
        codes->matches[i] = (code | (length.extra << 8) << length_in(code)) + length.extra_bits;
    }
    make_pairs(codes->symbols, pairs);
    codes->pairs = pairs;
    write_head(bits, lengths, MOST_DISTANCES);
}

INLINE void put_literals(struct bits *bits, const struct codes *codes, const uint8_t *bytes,
                         size_t size)
{
    for (; size >= WORD; size -= WORD, bytes += WORD)
        put_eight(bits, codes->pairs, bytes);
    for (; size >= 2; size -= 2, bytes += 2)
        put_code(bits, codes->pairs[bytes[0] << 8 | bytes[1]]);
    if (size > 0)
        put_code(bits, codes->symbols[*bytes]);
}

INLINE void put_match(struct bits *bits, const struct codes *codes, size_t length, unsigned less)
{
    const struct distance distance = distance_of(less);
    const uint32_t code = codes->distances[distance.symbol];
    const uint64_t far = code >> 8 | (uint64_t)distance.extra << length_in(code);
    const unsigned far_bits = length_in(code) + distance.extra_bits;
    while (length > 0) {
        const size_t match = next_match(length);
        const uint32_t near = codes->matches[match];
        put(bits, near >> 8 | far << length_in(near), length_in(near) + far_bits);
        length -= match;
    }
}

/* Writes a block with all sequences, which begin at `bytes`. */
static void write_block(struct bits *given, const uint8_t *bytes, const struct search *s, bool last)
{
    uint32_t weights[SYMBOLS + MOST_DISTANCES] = {0};
    struct codes codes;
    const struct kiln_zip_sequence *sequences = s->scratch->sequences;
    put(given, last, 1);
    put(given, 2, 2); /* a block with codes of its own */
    count(bytes, sequences, s->count, weights);
    make_codes(weights, given, &codes, s->scratch->pairs);
    struct bits bits = *given;
    for (size_t i = 0; i < s->count; i++) {
        put_literals(&bits, &codes, bytes, sequences[i].literals);
        put_match(&bits, &codes, sequences[i].length, sequences[i].distance);
        bytes += sequences[i].literals + sequences[i].length;
    }
    put_code(&bits, codes.symbols[END]);
    *given = bits;
}

/* ---- The interface --------------------------------------------------------------------------- */

static void compress_plane(struct search *s, size_t begin, const struct kiln_zip_layout *layout,
                           bool last, struct bits *bits)
{
    const bool uneven = is_uneven(s->bytes + begin, s->end - begin);
    size_t block = begin, number = 0;
    s->literals = begin;
    s->misses = 0;
    s->count = 0;
    for (size_t row = begin; row < s->end; row += layout->row_bytes) {
        const size_t row_end = row + layout->row_bytes;
        const bool floats = layout->float_rows >> number & 1;
        while (!(floats   ? search_dense(s, row, row_end)
                 : uneven ? search_sparse(s, row, row_end)
                          : search_usual(s, row, row_end))) {
            write_block(bits, s->bytes + block, s, false);
            block = s->literals;
            s->count = 0;
        }
        number = number + 1 < layout->rows ? number + 1 : 0;
    }
    s->scratch->sequences[s->count++] =
        (struct kiln_zip_sequence){.literals = (uint32_t)(s->end - s->literals)};
    write_block(bits, s->bytes + block, s, last);
}

size_t KILN_SIMD_NAME(kiln_zip)(const uint8_t *bytes, size_t size,
                                const struct kiln_zip_layout *layout, uint8_t *out,
                                struct kiln_zip_scratch *scratch)
{
    struct bits bits = {.out = out};
    struct search search = {.bytes = bytes, .end = size / 2, .scratch = scratch};
    memset(scratch->places, 0, sizeof scratch->places);
    put(&bits, 0x0178, 16); /* the head of a zlib stream */
    compress_plane(&search, 0, layout, false, &bits);
    search.end = size;
    compress_plane(&search, size / 2, layout, true, &bits);
    fill_byte(&bits);
    const uint32_t adler = htobe32(kiln_adler32(bytes, size));
    memcpy(bits.out, &adler, sizeof adler);
    return (size_t)(bits.out - out) + sizeof adler;
}
