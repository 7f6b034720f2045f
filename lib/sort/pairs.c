/* This file sorts pairs in threads by a radix sort, least significant digit first. It takes one
 * pass or three, so that the last pass reads the memory of `pairs` and can write the list over the
 * scratch. Digits are as short as the span of the keys allows. Each thread owns one chunk of the
 * pairs and counts its digits. Prefix sums over (digit, chunk) then say where each pair goes, so
 * the result is stable and the same for any number of threads. */
#include "sort/pairs.h"

#include <string.h>

enum {
    MOST_DIGIT_BITS = 11,
    MOST_DIGITS = 1 << MOST_DIGIT_BITS,
    PASSES = 3,
    MIN_CHUNK = 8192, /* pairs; a shorter chunk is not worth a thread */
};

struct pass {
    const kiln_sort_pair *from;
    kiln_sort_pair *to; /* NULL in the last pass, which writes `list` */
    uint32_t *list;
    bool reverse;
    size_t count;
    uint32_t chunk_count;
    uint32_t least; /* the least key, which is subtracted from every key */
    unsigned shift, digit_bits;
    uint32_t *places; /* for each chunk a word a digit: first its count, then the index of its
                       * next pair */
};

size_t kiln_sort_count_words(const struct kiln_threads *threads)
{
    return (size_t)kiln_threads_count(threads) * MOST_DIGITS;
}

static size_t chunk_begin(const struct pass *pass, size_t chunk)
{
    return pass->count * chunk / pass->chunk_count;
}

static uint32_t digit_of(const struct pass *pass, kiln_sort_pair pair)
{
    uint32_t key = (uint32_t)(pair >> 32) - pass->least;
    return key >> pass->shift & ((1u << pass->digit_bits) - 1);
}

static void count_digits(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct pass pass = *(const struct pass *)context;
    for (size_t chunk = begin; chunk < end; chunk++) {
        uint32_t *counts = pass.places + (chunk << pass.digit_bits);
        memset(counts, 0, sizeof *counts << pass.digit_bits);
        size_t last = chunk_begin(&pass, chunk + 1);
        for (size_t i = chunk_begin(&pass, chunk); i < last; i++)
            counts[digit_of(&pass, pass.from[i])]++;
    }
}

/* Replaces the counts by their prefix sums over (digit, chunk). */
static void sum_counts(const struct pass *pass)
{
    uint32_t place = 0;
    for (uint32_t digit = 0; digit < 1u << pass->digit_bits; digit++)
        for (uint32_t chunk = 0; chunk < pass->chunk_count; chunk++) {
            uint32_t *at = &pass->places[((size_t)chunk << pass->digit_bits) + digit];
            uint32_t count = *at;
            *at = place;
            place += count;
        }
}

static void move_pairs(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct pass pass = *(const struct pass *)context;
    for (size_t chunk = begin; chunk < end; chunk++) {
        uint32_t *places = pass.places + (chunk << pass.digit_bits);
        size_t last = chunk_begin(&pass, chunk + 1);
        for (size_t i = chunk_begin(&pass, chunk); i < last; i++)
            pass.to[places[digit_of(&pass, pass.from[i])]++] = pass.from[i];
    }
}

static void write_list(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct pass pass = *(const struct pass *)context;
    for (size_t chunk = begin; chunk < end; chunk++) {
        uint32_t *places = pass.places + (chunk << pass.digit_bits);
        size_t last = chunk_begin(&pass, chunk + 1);
        for (size_t i = chunk_begin(&pass, chunk); i < last; i++) {
            size_t place = places[digit_of(&pass, pass.from[i])]++;
            pass.list[pass.reverse ? pass.count - 1 - place : place] = (uint32_t)pass.from[i];
        }
    }
}

static void run_pass(struct kiln_threads *threads, struct pass *pass)
{
    kiln_threads_for(threads, pass->chunk_count, 1, count_digits, pass);
    sum_counts(pass);
    kiln_threads_for(threads, pass->chunk_count, 1, pass->to ? move_pairs : write_list, pass);
}

void kiln_sort_pairs(struct kiln_threads *threads, kiln_sort_pair *pairs, size_t count,
                     struct kiln_sort_span span, bool reverse, uint32_t *list, uint32_t *counts)
{
    if (count == 0)
        return;
    unsigned bits = 0;
    while (bits < 32 && (span.greatest - span.least) >> bits != 0)
        bits++;
    const size_t useful_chunks = count / MIN_CHUNK + 1;
    const uint32_t thread_count = kiln_threads_count(threads);
    struct pass pass = {
        .from = pairs,
        .list = list,
        .reverse = reverse,
        .count = count,
        .chunk_count = useful_chunks < thread_count ? (uint32_t)useful_chunks : thread_count,
        .least = span.least,
        .digit_bits = bits <= MOST_DIGIT_BITS ? bits : (bits + PASSES - 1) / PASSES,
        .places = counts,
    };
    kiln_sort_pair *scratch = (kiln_sort_pair *)(void *)list;
    while (pass.shift + pass.digit_bits < bits) {
        pass.to = pass.from == pairs ? scratch : pairs;
        run_pass(threads, &pass);
        pass.from = pass.to;
        pass.shift += pass.digit_bits;
    }
    pass.to = NULL;
    run_pass(threads, &pass);
}
