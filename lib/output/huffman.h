/* Makes prefix codes of limited length for DEFLATE (RFC 1951, 3.2.2). All arithmetic is of
 * integers, so the same weights give the same codes on every machine. */
#ifndef KILN_OUTPUT_HUFFMAN_H
#define KILN_OUTPUT_HUFFMAN_H

#include <stddef.h>
#include <stdint.h>

/* The most symbols of an alphabet: literals and lengths of DEFLATE. */
enum { KILN_HUFFMAN_MAX_SYMBOLS = 286, KILN_HUFFMAN_MAX_BITS = 15 };

/* Gives each symbol of a nonzero weight a length of 1 to max_bits, and 0 to the other symbols. The
 * code is complete: no sequence of bits is left without a symbol. At least two weights are nonzero,
 * `count` is at most KILN_HUFFMAN_MAX_SYMBOLS, 1 << max_bits is at least `count`, and max_bits is
 * at most KILN_HUFFMAN_MAX_BITS. The sum of the weights is below 2^54. */
void kiln_huffman_lengths(const uint32_t *weights, size_t count, unsigned max_bits,
                          uint8_t *lengths);

/* Makes the canonical code of these lengths. codes[i] is the code of symbol i, first bit lowest, as
 * DEFLATE packs it; 0 where lengths[i] is 0. */
void kiln_huffman_codes(const uint8_t *lengths, size_t count, uint16_t *codes);

#endif
