/* A packet holds the fragments of one sprite in a vector of neighbouring pixels, for fragments.c.
 * packets_simd.c, which is compiled for each KILN_SIMD_LEVEL, adds packets and blends them. The
 * depths of a packet are keys, which grow from far to near; of equal keys, the sprite that comes
 * first in the list of sprites is farther. */
#ifndef KILN_DRAW_SPRITES_PACKETS_H
#define KILN_DRAW_SPRITES_PACKETS_H

#include "draw/sprites/tile.h"

/* Keys are 64-bit numbers whose upper words, less than this one, tell the depth, and whose lower
 * words tell the sprite. */
#define KILN_PACKET_KEYS_END ((uint64_t)0x7fefffff << 32)

enum {
    KILN_PACKET_PIXELS = 1 << 19, /* pixels of all packets together, for which there is room */
    KILN_PACKET_SORT_BLOCK = 16,  /* rows of keys that are sorted in registers */
};

/* Holds packets in the order of their sprites. */
struct kiln_packets {
    void *packets; /* the packet number 0 has no fragments */
    size_t stride; /* bytes from one to the next: kiln_packet_code.size, or with `glow` glow_size */
    bool glow;     /* a packet has the glow of each pixel, instead of bloom weights */
    uint16_t *places;            /* by packet: number of its vector of pixels in the scratch tile */
    double *keys;                /* room for the keys of all packets */
    size_t count;                /* packets, with number 0 */
    uint64_t first_key, end_key; /* fragments with first_key <= key < end_key are gathered now */
};

/* Holds a range of pixels of a tile. */
struct kiln_packet_box {
    int x_from, x_to, y_from, y_to;
};

/* Adds the packets of a sprite, which alone is drawn in the scratch tile, and empties that again.
 * extra: set if kiln_sprite_has_extra; order: the number of the sprite in the list. */
typedef void kiln_packets_add(struct kiln_packets *packets, struct kiln_tile *scratch,
                              const struct kiln_packet_box *box, const struct kiln_sprite *s,
                              const struct kiln_sprite_extra *extra, uint32_t order);

/* Returns the least key of a packet that is gathered now, or KILN_PACKET_KEYS_END. */
typedef uint64_t kiln_packets_least_key(const struct kiln_packets *packets, size_t number);

/* Sorts the fragments of each pixel of some packets and blends them, from the farthest to the
 * nearest, into the pixels of a row that begin at x. list: numbers of packets, ascending. */
typedef void kiln_packets_blend(const struct kiln_packets *packets, const uint32_t *list,
                                size_t count, float (*planes)[KILN_TILE_PITCH], int x);

struct kiln_packet_code {
    int lanes;              /* pixels of a packet */
    size_t size, glow_size; /* of a packet, bytes: without and with the glow of each pixel */
    kiln_packets_add *add;
    kiln_packets_least_key *least_key;
    kiln_packets_blend *blend;
};
KILN_SIMD_DECLARE(const struct kiln_packet_code, kiln_packet_code);

#endif
