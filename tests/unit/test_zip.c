/* The chunks of EXR files: two decoders that are not ours read them back, pixels become the bytes
 * that OpenEXR documents, and every width of vectors gives the same bytes. */
#include <half.h>
#include <libdeflate.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "output/exr_rows.h"
#include "output/zip.h"
#include "shared/random.h"
#include "support/cmocka.h"

static uint32_t stream;

static uint32_t next_random(void)
{
    return random_mix(stream++);
}

/* ---- Compression ----------------------------------------------------------------------------- */

enum kind { EMPTY, NOISE, FEW, REPEATS, SHORT_REPEATS, RAMPS, BLOTS, KINDS };

static void fill(uint8_t *bytes, size_t size, enum kind kind, size_t row)
{
    for (size_t i = 0; i < size; i++) {
        const uint32_t random = next_random();
        const uint8_t noise = (uint8_t)(random >> 8);
        const size_t back = 3 * row; /* as far as a channel like this one */
        switch (kind) {
        case EMPTY:
            bytes[i] = 128;
            break;
        case NOISE:
            bytes[i] = noise;
            break;
        case FEW:
            bytes[i] = random % 4 == 0 ? (uint8_t)(120 + noise % 16) : 128;
            break;
        case REPEATS:
            bytes[i] = i < back || random % 50 == 0 ? noise : bytes[i - back];
            break;
        case SHORT_REPEATS: /* words of four bytes, apart by one */
            bytes[i] = i % 5 == 0 ? noise : (uint8_t)(random_mix((uint32_t)(i / 5) % 3) >> i % 5);
            break;
        case RAMPS:
            bytes[i] = (uint8_t)(i / row * 7 + i % row / 16 % 3);
            break;
        default:
            bytes[i] = random % 300 == 0 ? noise : i == 0 ? 1 : bytes[i - 1];
        }
    }
}

static void check_stream(const uint8_t *bytes, size_t size, const uint8_t *out, size_t written)
{
    uint8_t *back = malloc(size);
    assert_non_null(back);
    uLongf length = size;
    assert_int_equal(uncompress(back, &length, out, written), Z_OK);
    assert_int_equal(length, size);
    assert_memory_equal(back, bytes, size);
    struct libdeflate_decompressor *decompressor = libdeflate_alloc_decompressor();
    assert_non_null(decompressor);
    memset(back, 0, size);
    assert_int_equal(libdeflate_zlib_decompress(decompressor, out, written, back, size, NULL), 0);
    assert_memory_equal(back, bytes, size);
    libdeflate_free_decompressor(decompressor);
    free(back);
}

/* Compresses at all levels, and returns the number of bytes. */
static size_t check_chunk(const uint8_t *bytes, size_t size, const struct kiln_zip_layout *layout)
{
    const size_t room = kiln_zip_room(size);
    uint8_t *first = malloc(room), *out = malloc(room);
    struct kiln_zip_scratch *scratch = malloc(sizeof *scratch);
    assert_true(first && out && scratch);
    memset(scratch, 0x5a, sizeof *scratch);
    size_t expected = 0;
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd))
            continue;
        kiln_zip_run *zip = KILN_SIMD_PICK(kiln_zip, simd);
        const size_t written = zip(bytes, size, layout, out, scratch);
        assert_true(written > 0 && written <= room);
        if (expected == 0) {
            check_stream(bytes, size, out, written);
            memcpy(first, out, written);
            expected = written;
        }
        assert_int_equal(written, expected);
        assert_memory_equal(out, first, written);
    }
    free(first);
    free(out);
    free(scratch);
    return expected;
}

static size_t check_kind(enum kind kind, const struct kiln_zip_layout *layout, size_t lines)
{
    const size_t size = 2 * lines * layout->rows * layout->row_bytes;
    uint8_t *bytes = malloc(size);
    assert_non_null(bytes);
    fill(bytes, size, kind, layout->row_bytes);
    const size_t written = check_chunk(bytes, size, layout);
    free(bytes);
    return written;
}

static void chunks_come_back(void **state)
{
    (void)state;
    static const size_t widths[] = {1, 2, 7, 8, 9, 64, 301}, rows[] = {1, 2, 3, 18},
                        lines[] = {1, 2, 16};
    for (enum kind kind = 0; kind < KINDS; kind++) {
        for (size_t i = 0; i < sizeof widths / sizeof *widths; i++) {
            for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
                const struct kiln_zip_layout layout = {
                    .row_bytes = widths[i],
                    .rows = rows[k],
                    /* also none, some that are apart, and beyond the end */
                    .float_rows = (k % 3) * UINT64_C(0x20205) << rows[k] / 3,
                };
                check_kind(kind, &layout, lines[(i + k) % 3]);
            }
        }
    }
}

/* A plane may have more sequences than a block, and a match more bytes than a sequence says. */
static void large_chunks_come_back(void **state)
{
    (void)state;
    const struct kiln_zip_layout deep = {.row_bytes = 40000, .rows = 2, .float_rows = 3};
    const size_t size = 2 * 16 * deep.rows * deep.row_bytes;
    assert_true(check_kind(SHORT_REPEATS, &deep, 16) < size * 3 / 5);
    const struct kiln_zip_layout wide = {.row_bytes = 40000, .rows = 4};
    assert_true(check_kind(EMPTY, &wide, 16) < 8000);
}

/* Rows that repeat a few rows away take few bytes, and noise hardly grows. */
static void sizes_are_as_they_should_be(void **state)
{
    (void)state;
    const struct kiln_zip_layout layout = {.row_bytes = 1280, .rows = 18};
    const size_t size = 2 * 16 * layout.rows * layout.row_bytes;
    assert_true(check_kind(EMPTY, &layout, 16) < 2000);
    assert_true(check_kind(NOISE, &layout, 16) < size + size / 200);
    assert_true(check_kind(REPEATS, &layout, 16) < size / 8);
    assert_true(check_kind(FEW, &layout, 16) < size / 3);
}

/* ---- Packing --------------------------------------------------------------------------------- */

enum { MOST_PIXELS = 67, GUARD = 8 };

/* Returns a float of any size, or one near the middle between two halves. */
static float any_float(void)
{
    uint32_t bits = next_random();
    if (bits % 3 == 0)
        bits = (bits & 0x8fffe000u) | 0x30000000u | (bits >> 5 & 0x2000u) | (0xfffu + bits % 4);
    const float limits[] = {0.0f,     -0.0f,    65504.0f, 65519.9f, 65520.0f, -1e9f,
                            0x1p-14f, 0x1p-24f, 0x1p-25f, 0x3p-25f, INFINITY, -INFINITY};
    float x;
    memcpy(&x, &bits, sizeof x);
    if (bits % 11 == 0)
        return limits[bits / 11 % (sizeof limits / sizeof *limits)];
    return isnan(x) ? 1.0f : x;
}

/* Returns the bytes of a sample as the file has them, in the order of their places. */
static uint32_t file_bits(float x, bool half)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    if (!half)
        return bits;
    return imath_float_to_half(fmaxf(fminf(x, 65504.0f), -65504.0f));
}

static void check_rows(const struct kiln_exr_loops *loops, uint32_t channels, size_t width,
                       bool half)
{
    float pixels[MOST_PIXELS * 4];
    uint8_t low[4][2 * MOST_PIXELS + GUARD], high[4][2 * MOST_PIXELS + GUARD];
    struct kiln_exr_row rows[4];
    memset(low, 0xee, sizeof low);
    memset(high, 0xee, sizeof high);
    for (uint32_t c = 0; c < channels; c++)
        rows[c] = (struct kiln_exr_row){low[c], high[c]};
    for (size_t i = 0; i < width * channels; i++)
        pixels[i] = any_float();
    loops->pack(pixels, channels, width, half, rows);
    const size_t pairs = half ? 1 : 2; /* of a low and a high byte */
    for (uint32_t c = 0; c < channels; c++) {
        for (size_t i = 0; i < width * pairs; i++) {
            const uint32_t bits = file_bits(pixels[i / pairs * channels + c], half);
            const uint32_t pair = bits >> 16 * (i % pairs);
            assert_int_equal(low[c][i], pair & 0xff);
            assert_int_equal(high[c][i], pair >> 8 & 0xff);
        }
        for (size_t i = width * pairs; i < width * pairs + GUARD; i++)
            assert_true(low[c][i] == 0xee && high[c][i] == 0xee);
    }
}

static void pixels_become_the_bytes_of_files(void **state)
{
    (void)state;
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd))
            continue;
        const struct kiln_exr_loops *loops = KILN_SIMD_PICK(kiln_exr_loops, simd);
        for (uint32_t i = 0; i < 4000; i++)
            check_rows(loops, 1 + i % 4, 1 + i / 8 % (MOST_PIXELS - 1), i / 4 % 2 == 0);
    }
}

static void bytes_become_differences(void **state)
{
    (void)state;
    uint8_t bytes[200], out[201];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (uint8_t)next_random();
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd))
            continue;
        const struct kiln_exr_loops *loops = KILN_SIMD_PICK(kiln_exr_loops, simd);
        for (size_t count = 1; count <= sizeof bytes; count++) {
            out[count] = 7;
            loops->subtract(bytes, 200, count, out);
            for (size_t i = 0; i < count; i++)
                assert_int_equal(out[i], (bytes[i] - (i > 0 ? bytes[i - 1] : 200) + 128) & 0xff);
            assert_int_equal(out[count], 7);
        }
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(chunks_come_back),
        cmocka_unit_test(large_chunks_come_back),
        cmocka_unit_test(sizes_are_as_they_should_be),
        cmocka_unit_test(pixels_become_the_bytes_of_files),
        cmocka_unit_test(bytes_become_differences),
    };
    return cmocka_run_group_tests_name("zip", tests, NULL, NULL);
}
