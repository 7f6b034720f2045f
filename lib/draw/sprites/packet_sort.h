/* This header sorts the columns of a matrix of keys by a network of comparisons, a vector of
 * columns at a time. It sorts blocks of rows in registers, then merges them by bitonic merges. Each
 * comparison puts the lesser key into the upper row. So rows that a block lacks at its end need no
 * comparisons, as if they held the greatest key. */
#ifndef KILN_DRAW_SPRITES_PACKET_SORT_H
#define KILN_DRAW_SPRITES_PACKET_SORT_H

#include "base/lanes.h"
#include "draw/sprites/packets.h"

/* Keys are positive normal numbers, which compare as their bits do. */
typedef double keys __attribute__((vector_size(4 * LANES)));

/* Orders each lane of two rows. */
SIMD void order_rows(keys *upper, keys *lower)
{
    const keys a = *upper, b = *lower;
#if defined KILN_LEVEL_AVX512
    *upper = (keys)_mm512_min_pd((__m512d)a, (__m512d)b);
    *lower = (keys)_mm512_max_pd((__m512d)a, (__m512d)b);
#elif defined KILN_LEVEL_AVX2
    *upper = (keys)_mm256_min_pd((__m256d)a, (__m256d)b);
    *lower = (keys)_mm256_max_pd((__m256d)a, (__m256d)b);
#elif defined KILN_LEVEL_NEON
    *upper = (keys)vminq_f64((float64x2_t)a, (float64x2_t)b);
    *lower = (keys)vmaxq_f64((float64x2_t)a, (float64x2_t)b);
#elif defined __SSE2__
    *upper = (keys)_mm_min_pd((__m128d)a, (__m128d)b);
    *lower = (keys)_mm_max_pd((__m128d)a, (__m128d)b);
#else
    typedef int64_t mask __attribute__((vector_size(4 * LANES)));
    const mask less = a < b;
    *upper = (keys)(((mask)a & less) | ((mask)b & ~less));
    *lower = (keys)(((mask)b & less) | ((mask)a & ~less));
#endif
}

/* Sorts four rows. */
SIMD void sort_four(keys *row)
{
    order_rows(&row[0], &row[2]);
    order_rows(&row[1], &row[3]);
    order_rows(&row[0], &row[1]);
    order_rows(&row[2], &row[3]);
    order_rows(&row[1], &row[2]);
}

/* Orders the rows of a block that are `apart` rows from each other. */
SIMD void order_apart(keys *row, int count, int apart)
{
    for (int i = 0; i < count; i++) {
        if (!(i & apart))
            order_rows(&row[i], &row[i + apart]);
    }
}

/* Orders the first row with the last, the second with the last but one, and so on. */
SIMD void order_mirrored(keys *row, int count)
{
    for (int i = 0; i < count / 2; i++)
        order_rows(&row[i], &row[count - 1 - i]);
}

SIMD void load_rows(keys row[KILN_PACKET_SORT_BLOCK], const keys *from)
{
    for (int i = 0; i < KILN_PACKET_SORT_BLOCK; i++)
        row[i] = from[i];
}

SIMD void store_rows(keys *to, const keys row[KILN_PACKET_SORT_BLOCK])
{
    for (int i = 0; i < KILN_PACKET_SORT_BLOCK; i++)
        to[i] = row[i];
}

/* Sorts a block of rows by bitonic merges of four rows each. */
SIMD void sort_block(keys *rows)
{
    keys row[KILN_PACKET_SORT_BLOCK];
    load_rows(row, rows);
    for (int i = 0; i < KILN_PACKET_SORT_BLOCK; i += 4)
        sort_four(row + i);
    for (int i = 0; i < KILN_PACKET_SORT_BLOCK; i += 8) {
        order_mirrored(row + i, 8);
        order_apart(row + i, 8, 2);
        order_apart(row + i, 8, 1);
    }
    order_mirrored(row, 16);
    order_apart(row, 16, 4);
    order_apart(row, 16, 2);
    order_apart(row, 16, 1);
    store_rows(rows, row);
}

/* Sorts a block of rows that is bitonic. */
SIMD void finish_block(keys *rows)
{
    keys row[KILN_PACKET_SORT_BLOCK];
    load_rows(row, rows);
    order_apart(row, 16, 8);
    order_apart(row, 16, 4);
    order_apart(row, 16, 2);
    order_apart(row, 16, 1);
    store_rows(rows, row);
}

/* Begins the merge of two sorted blocks of `length` rows. Of the rows of both, `count` exist. The
 * first two steps of the network are done together, so that a row is loaded once. */
SIMD void begin_merge(keys *rows, size_t count, size_t length)
{
    const size_t half = length / 2;
    for (size_t i = 0; i < half; i++) {
        const size_t last = 2 * length - 1 - i;
        keys *upper = &rows[i], *upper_next = &rows[i + half];
        if (last - half >= count) {
            order_rows(upper, upper_next);
            continue;
        }
        keys a = *upper, b = *upper_next, c = rows[last - half];
        order_rows(&b, &c);
        if (last < count) {
            keys d = rows[last];
            order_rows(&a, &d);
            order_rows(&c, &d);
            rows[last] = d;
        }
        order_rows(&a, &b);
        *upper = a;
        *upper_next = b;
        rows[last - half] = c;
    }
}

/* Merges pairs of sorted blocks of `length` rows. */
SIMD void merge_blocks(keys *rows, size_t count, size_t length)
{
    for (size_t block = 0; block + length < count; block += 2 * length)
        begin_merge(rows + block, count - block, length);
    for (size_t apart = length / 4; apart >= KILN_PACKET_SORT_BLOCK; apart /= 2) {
        for (size_t block = 0; block + apart < count; block += 2 * apart) {
            for (size_t i = block; i < block + apart && i + apart < count; i++)
                order_rows(&rows[i], &rows[i + apart]);
        }
    }
    for (size_t i = 0; i < count; i += KILN_PACKET_SORT_BLOCK)
        finish_block(rows + i);
}

/* Sorts rows, whose number is a multiple of KILN_PACKET_SORT_BLOCK. */
static void sort_rows(keys *rows, size_t count)
{
    for (size_t i = 0; i < count; i += KILN_PACKET_SORT_BLOCK)
        sort_block(rows + i);
    for (size_t length = KILN_PACKET_SORT_BLOCK; length < count; length *= 2)
        merge_blocks(rows, count, length);
}

#endif
