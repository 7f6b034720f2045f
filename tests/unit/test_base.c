/* lib/base: arena, text, threads, hash. */
#include <locale.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/arena.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/text.h"
#include "base/thread.h"
#include "support/cmocka.h"
#include "support/errors.h"

static void arena_refuses_overflow(void **state)
{
    (void)state;
    struct kiln_arena *arena = kiln_arena_create();
    assert_non_null(arena);
    assert_null(kiln_arena_alloc(arena, SIZE_MAX / 2, 4));
    assert_null(kiln_arena_alloc(arena, SIZE_MAX, 1));
    unsigned char *large = kiln_arena_alloc(arena, 1 << 20, 1);
    assert_non_null(large);
    assert_int_equal((uintptr_t)large % _Alignof(max_align_t), 0);
    assert_int_equal(large[(1 << 20) - 1], 0);
    assert_string_equal(kiln_arena_format(arena, "%s/%.2s%u", "a", "bcd", 7u), "a/bc7");
    kiln_arena_destroy(&arena);
    assert_null(arena);
    kiln_arena_destroy(&arena);
}

static void numbers_are_read_without_locale(void **state)
{
    (void)state;
    double value = 0;
    assert_true(kiln_text_to_double("1.5e-3", &value));
    assert_true(value == 1.5e-3);
    static const char *const bad[] = {"", " 1", "1 ", "0x10", "nan", "inf", "1e999", "1,5", "--1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_false(kiln_text_to_double(bad[i], &value));

    uint64_t whole = 0;
    assert_true(kiln_text_to_uint64("18446744073709551615", &whole));
    assert_true(whole == UINT64_MAX);
    assert_false(kiln_text_to_uint64("18446744073709551616", &whole));
    assert_false(kiln_text_to_uint64("-1", &whole));
}

static void numbers_are_written_shortest(void **state)
{
    (void)state;
    char text[32];
    kiln_text_from_float(text, 0.1f);
    assert_string_equal(text, "0.1");
    kiln_text_from_float(text, 16777217.0f);
    assert_string_equal(text, "16777216");
    kiln_text_from_double(text, 1.0 / 3.0);
    double back = 0;
    assert_true(kiln_text_to_double(text, &back) && back == 1.0 / 3.0);
}

static void nearest_name_finds_misspellings(void **state)
{
    (void)state;
    static const char *const names[] = {"rate", "life", "speed", "bursts"};
    assert_string_equal(kiln_text_nearest("raet", names, 4), "rate");
    assert_string_equal(kiln_text_nearest("burst", names, 4), "bursts");
    assert_null(kiln_text_nearest("temperature", names, 4));
    assert_null(kiln_text_nearest("", names, 4));
}

static void json_strings_are_escaped(void **state)
{
    (void)state;
    struct kiln_text text = {0};
    kiln_text_add_json(&text, "a\"\\\n\xc3\xa9\xff");
    assert_string_equal(text.data, "\"a\\\"\\\\\\u000a\xc3\xa9\\ufffd\"");
    kiln_text_free(&text);
}

static void count_piece(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    unsigned char *seen = context;
    for (size_t i = begin; i < end; i++)
        seen[i]++;
}

static void threads_cover_a_range_once(void **state)
{
    (void)state;
    static const uint32_t counts[] = {1, 2, 8};
    for (size_t c = 0; c < 3; c++) {
        struct kiln_threads *threads = kiln_threads_create(counts[c]);
        assert_non_null(threads);
        assert_int_equal(kiln_threads_count(threads), counts[c]);
        for (size_t size = 0; size < 1000; size += 37) {
            unsigned char seen[1000] = {0};
            kiln_threads_for(threads, size, 16, count_piece, seen);
            for (size_t i = 0; i < 1000; i++)
                assert_int_equal(seen[i], i < size);
        }
        kiln_threads_destroy(&threads);
    }
}

static void count_slowly(void *context, size_t begin, size_t end, uint32_t worker)
{
    count_piece(context, begin, end, worker);
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
}

static bool says_no_the_third_time(void *user, struct kiln_error *error)
{
    uint32_t *asked = user;
    return ++*asked < 3 || kiln_error_set(error, KILN_INTERRUPTED, "no more");
}

static void loops_stop_when_the_caller_wants_no_more(void **state)
{
    (void)state;
    for (uint32_t count = 1; count <= 3; count += 2) {
        static unsigned char seen[30000];
        uint32_t asked = 0, done = 0;
        struct kiln_error error = {0};
        struct kiln_threads *threads = kiln_threads_create(count);
        assert_true(kiln_threads_try(threads, 20, 1, count_piece, seen, &error));
        kiln_threads_set_caller(threads, &(struct kiln_caller){says_no_the_third_time, &asked});
        memset(seen, 0, sizeof seen);
        assert_false(kiln_threads_try(threads, sizeof seen, 1, count_slowly, seen, &error));
        expect_error(&error, KILN_INTERRUPTED, "no more");
        for (size_t i = 0; i < sizeof seen; i++)
            done += seen[i];
        assert_in_range(done, 1, sizeof seen / 2);
        memset(seen, 0, sizeof seen);
        error = (struct kiln_error){0};
        assert_false(kiln_threads_try(threads, 20, 1, count_piece, seen, &error));
        expect_error(&error, KILN_INTERRUPTED, "no more");
        assert_int_equal(asked, 3);
        assert_int_equal(seen[0], 0);
        kiln_threads_for(threads, 20, 1, count_piece, seen); /* has to run to its end */
        assert_int_equal(seen[19], 1);
        kiln_threads_destroy(&threads);
    }
}

/* The test vector of FIPS 180-2, B.1. */
static void sha256_matches_the_standard(void **state)
{
    (void)state;
    char hex[65];
    kiln_hash_sha256("abc", 3, hex);
    assert_string_equal(hex, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

/* An error has the place in the source that detected it, as a path in the tree. A struct of an
 * older version, which has no room for the place, is not written beyond its end. */
static void errors_have_their_origin(void **state)
{
    (void)state;
    struct kiln_error error = kiln_error_empty();
    assert_false(kiln_error_no_memory(&error, "%d pictures", 3));
    assert_int_equal(error.line, __LINE__ - 1);
    assert_string_equal(error.file, "tests/unit/test_base.c");
    assert_int_equal(error.code, KILN_DEVICE_FAILED);
    assert_string_equal(error.message, "out of memory for 3 pictures");

    struct kiln_error older = {.size = offsetof(struct kiln_error, file), .line = -1};
    assert_false(kiln_error_set(&older, KILN_IO, "x.png: no"));
    assert_string_equal(older.message, "x.png: no");
    assert_null(older.file);
    assert_int_equal(older.line, -1);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_have_their_origin),
        cmocka_unit_test(arena_refuses_overflow),
        cmocka_unit_test(numbers_are_read_without_locale),
        cmocka_unit_test(numbers_are_written_shortest),
        cmocka_unit_test(nearest_name_finds_misspellings),
        cmocka_unit_test(json_strings_are_escaped),
        cmocka_unit_test(threads_cover_a_range_once),
        cmocka_unit_test(loops_stop_when_the_caller_wants_no_more),
        cmocka_unit_test(sha256_matches_the_standard),
    };
    return cmocka_run_group_tests_name("base", tests, NULL, NULL);
}
