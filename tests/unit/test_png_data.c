/* The data of PNG files: every kind of picture comes back from two decoders that are not ours, the
 * bytes are the same for any number of threads, and noise does not grow. */
#include <libdeflate.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "output/deflate.h"
#include "output/png_data.h"
#include "support/cmocka.h"

/* ---- Pictures -------------------------------------------------------------------------------- */

enum kind { FLAT, SMOOTH, DITHERED, NOISE, STRIPES, BLOTS, KINDS };

static uint32_t random_state = 1;

static uint32_t next_random(void)
{
    random_state = random_state * 1664525u + 1013904223u;
    return random_state >> 16;
}

/* Returns a sample of a picture, in 16 bits. */
static uint32_t sample(enum kind kind, uint32_t x, uint32_t y, uint32_t channel)
{
    switch (kind) {
    case FLAT:
        return 0x1234;
    case SMOOTH:
        return (x * 97 + y * 131 + channel * 5000) & 0xffff;
    case DITHERED:
        return (x * 30 + y * 20 + channel * 5000 + next_random() % 300) & 0xffff;
    case STRIPES:
        return x % 200 < 100 ? 0xffff : next_random() & 0xffff;
    case BLOTS:
        return next_random() % 97 == 0 ? next_random() & 0xffff : 0;
    default:
        return next_random() & 0xffff;
    }
}

static struct kiln_picture *make_picture(enum kind kind, uint32_t width, uint32_t height,
                                         uint32_t bits, bool alpha)
{
    struct kiln_error error = {0};
    struct kiln_picture *picture = kiln_picture_create(width, height, bits, NULL, NULL, 0, &error);
    assert_non_null(picture);
    picture->has_alpha = alpha;
    uint8_t *bytes = picture->display;
    uint16_t *words = picture->display;
    for (uint32_t y = 0, i = 0; y < height; y++) {
        for (uint32_t x = 0; x < width * 4; x++, i++) {
            const uint32_t value = sample(kind, x / 4, y, x % 4);
            if (bits == 8)
                bytes[i] = (uint8_t)(value >> 8);
            else
                words[i] = (uint16_t)value;
        }
    }
    return picture;
}

/* ---- Decoding -------------------------------------------------------------------------------- */

struct data {
    uint8_t *bytes;
    size_t size;
};

static struct data compress_picture(const struct kiln_picture *picture, uint32_t threads)
{
    struct kiln_error error = {0};
    struct kiln_png_data *data = kiln_png_data_create(picture, KILN_PNG_FAST, threads, &error);
    assert_non_null(data);
    struct data all = {0};
    const uint8_t *bytes;
    for (size_t size = 1; size > 0;) {
        assert_true(kiln_png_data_next(data, NULL, &bytes, &size, &error));
        if (size == 0)
            break;
        all.bytes = realloc(all.bytes, all.size + size);
        assert_non_null(all.bytes);
        memcpy(all.bytes + all.size, bytes, size);
        all.size += size;
    }
    kiln_png_data_destroy(&data);
    assert_null(data);
    return all;
}

/* Decodes by zlib and by libdeflate, which must agree; both check the Adler-32. */
static uint8_t *decode(struct data data, size_t size)
{
    uint8_t *rows = malloc(size + 1), *again = malloc(size + 1);
    assert_non_null(rows);
    assert_non_null(again);
    uLongf decoded = (uLongf)size + 1;
    assert_int_equal(uncompress(rows, &decoded, data.bytes, (uLong)data.size), Z_OK);
    assert_int_equal(decoded, size);
    struct libdeflate_decompressor *other = libdeflate_alloc_decompressor();
    assert_non_null(other);
    assert_int_equal(libdeflate_zlib_decompress(other, data.bytes, data.size, again, size, NULL),
                     LIBDEFLATE_SUCCESS);
    libdeflate_free_decompressor(other);
    assert_memory_equal(rows, again, size);
    free(again);
    return rows;
}

/* Returns what a filter guesses of a byte (PNG specification, 9.2). */
static uint8_t guess(uint8_t number, int left, int above, int corner)
{
    const int p = left + above - corner;
    const int from_left = abs(p - left), from_above = abs(p - above), from_corner = abs(p - corner);
    switch (number) {
    case 0:
        return 0;
    case 1:
        return (uint8_t)left;
    case 2:
        return (uint8_t)above;
    case 3:
        return (uint8_t)((left + above) / 2);
    default:
        assert_int_equal(number, 4);
        return (uint8_t)(from_left <= from_above && from_left <= from_corner ? left
                         : from_above <= from_corner                         ? above
                                                                             : corner);
    }
}

/* Takes the filters back, in place. */
static void unfilter(uint8_t *rows, size_t row_bytes, uint32_t height, size_t back)
{
    for (uint32_t y = 0; y < height; y++) {
        uint8_t *row = rows + y * (row_bytes + 1) + 1, *above = row - row_bytes - 1;
        for (size_t i = 0; i < row_bytes; i++) {
            const int a = i >= back ? row[i - back] : 0, b = y > 0 ? above[i] : 0;
            const int c = i >= back && y > 0 ? above[i - back] : 0;
            row[i] = (uint8_t)(row[i] + guess(row[-1], a, b, c));
        }
    }
}

static void check_samples(const struct kiln_picture *picture, const uint8_t *rows, size_t row_bytes)
{
    const uint8_t *bytes = picture->display;
    const uint16_t *words = picture->display;
    const uint32_t channels = picture->has_alpha ? 4 : 3;
    for (uint32_t y = 0; y < picture->height; y++) {
        const uint8_t *row = rows + y * (row_bytes + 1) + 1;
        for (size_t x = 0; x < picture->width; x++) {
            for (uint32_t i = 0; i < channels; i++) {
                const size_t from = ((size_t)y * picture->width + x) * 4 + i;
                const size_t at = x * channels + i;
                if (picture->bits == 8 ? row[at] != bytes[from]
                                       : row[2 * at] * 256 + row[2 * at + 1] != words[from])
                    fail_msg("pixel %zu, %u, channel %u", x, y, i);
            }
        }
    }
}

/* Returns the size of the data, which is the same for 1, 2 and 5 threads. */
static size_t check_picture(const struct kiln_picture *picture)
{
    const struct data data = compress_picture(picture, 1);
    for (uint32_t threads = 2; threads <= 5; threads += 3) {
        struct data other = compress_picture(picture, threads);
        assert_int_equal(other.size, data.size);
        assert_memory_equal(other.bytes, data.bytes, data.size);
        free(other.bytes);
    }
    const size_t back = (picture->has_alpha ? 4 : 3) * (size_t)(picture->bits / 8);
    const size_t row_bytes = picture->width * back;
    uint8_t *rows = decode(data, picture->height * (row_bytes + 1));
    unfilter(rows, row_bytes, picture->height, back);
    check_samples(picture, rows, row_bytes);
    free(rows);
    free(data.bytes);
    return data.size;
}

/* ---- Tests ----------------------------------------------------------------------------------- */

static void every_picture_comes_back(void **state)
{
    (void)state;
    static const struct {
        uint32_t width, height;
    } sizes[] = {{1, 1},   {2, 1},   {1, 300},   {5, 3},     {17, 9},
                 {64, 36}, {333, 7}, {16384, 1}, {16384, 3}, {301, 411}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        for (int kind = 0; kind < KINDS; kind++) {
            for (int variant = 0; variant < 4; variant++) {
                struct kiln_picture *picture =
                    make_picture((enum kind)kind, sizes[i].width, sizes[i].height,
                                 variant & 1 ? 16 : 8, variant & 2);
                check_picture(picture);
                kiln_picture_destroy(&picture);
            }
        }
    }
}

static void flat_pictures_are_small_and_noise_does_not_grow(void **state)
{
    (void)state;
    static const struct {
        enum kind kind;
        double most; /* bytes for a byte of the pixels */
    } cases[] = {{FLAT, 0.006}, {SMOOTH, 0.2}, {DITHERED, 0.4}, {NOISE, 1.001}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_picture *picture = make_picture(cases[i].kind, 640, 480, 8, false);
        const size_t size = check_picture(picture);
        if ((double)size > cases[i].most * 640 * 480 * 3)
            fail_msg("kind %d: %zu bytes", (int)cases[i].kind, size);
        kiln_picture_destroy(&picture);
    }
}

/* Runs of zeros between other bytes, whose lengths are those at which matches change. */
static void runs_of_every_length_come_back(void **state)
{
    (void)state;
    enum { MOST = 1100 };
    static struct kiln_deflate_scratch scratch;
    struct kiln_error error = {0};
    enum kiln_simd simd;
    assert_true(kiln_simd_choose(&simd, &error));
    uint8_t bytes[MOST + 40], out[2 * MOST + 1000], back[MOST + 40];
    assert_true(kiln_deflate_room(sizeof bytes) <= sizeof out);
    for (size_t run = 0; run <= MOST; run += run < 540 ? 1 : 7) {
        for (size_t before = 0; before <= 17; before += before < 2 ? 1 : 15) {
            const size_t after = run % 23, size = before + run + after;
            if (size == 0)
                continue;
            memset(bytes, 0, sizeof bytes);
            for (size_t i = 0; i < before; i++)
                bytes[i] = (uint8_t)(next_random() % 255 + 1);
            for (size_t i = 0; i < after; i++)
                bytes[before + run + i] = (uint8_t)(next_random() % 255 + 1);
            /* two calls, whose output is one stream */
            const size_t half =
                KILN_SIMD_PICK(kiln_deflate, simd)(bytes, size, false, out, &scratch);
            struct data data = {out, half};
            uint8_t *rest = malloc(kiln_deflate_room(size));
            assert_non_null(rest);
            const size_t more =
                KILN_SIMD_PICK(kiln_deflate, simd)(bytes, size, true, rest, &scratch);
            uint8_t *both = malloc(half + more);
            assert_non_null(both);
            memcpy(both, data.bytes, half);
            memcpy(both + half, rest, more);
            z_stream stream = {.next_in = both, .avail_in = (uInt)(half + more)};
            assert_int_equal(inflateInit2(&stream, -15), Z_OK);
            for (int turn = 0; turn < 2; turn++) {
                stream.next_out = back;
                stream.avail_out = (uInt)size;
                const int status = inflate(&stream, turn == 0 ? Z_SYNC_FLUSH : Z_FINISH);
                assert_int_equal(status, turn == 0 ? Z_OK : Z_STREAM_END);
                assert_int_equal(stream.avail_out, 0);
                assert_memory_equal(back, bytes, size);
            }
            assert_int_equal(stream.avail_in, 0);
            inflateEnd(&stream);
            free(both);
            free(rest);
        }
    }
}

static bool refuse(void *user, struct kiln_error *error)
{
    (void)user;
    error->code = KILN_INTERRUPTED;
    return false;
}

static void the_caller_can_stop_it(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    const struct kiln_caller caller = {.may_go_on = refuse};
    struct kiln_picture *picture = make_picture(SMOOTH, 100, 100, 8, false);
    struct kiln_png_data *data = kiln_png_data_create(picture, KILN_PNG_FAST, 2, &error);
    const uint8_t *bytes;
    size_t size;
    assert_false(kiln_png_data_next(data, &caller, &bytes, &size, &error));
    assert_int_equal(error.code, KILN_INTERRUPTED);
    kiln_png_data_destroy(&data);
    kiln_picture_destroy(&picture);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_picture_comes_back),
        cmocka_unit_test(flat_pictures_are_small_and_noise_does_not_grow),
        cmocka_unit_test(runs_of_every_length_come_back),
        cmocka_unit_test(the_caller_can_stop_it),
    };
    return cmocka_run_group_tests_name("png_data", tests, NULL, NULL);
}
