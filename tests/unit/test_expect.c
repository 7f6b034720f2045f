/* lib/suite: what expect.yaml says, and that writing it keeps what others wrote. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "suite/expect.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"

#define HASH_A "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"
#define HASH_B "bbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbb"
#define HASH_C "1234567890123456789012345678901234567890123456789012345678901234"

static const char whole[] =
    "# Written by kiln test, and rewritten by it: comments are not kept.\n"
    "kiln_expect: 1\n"
    "scene_hash: \"" HASH_C "\"\n"
    "techniques: [\"simulate=cpu\", \"sort=cpu\"]\n"
    "limits: {flip.mean: 0.004, flip.p99.5: 0.25}\n"
    "reason: \"fast \\\"smoke\\\"\"\n"
    "warn: 0.75\n"
    "masks:\n"
    "  - {rect: [0, 1, 40, 20], reason: \"clock\"}\n"
    "  - {picture: \"mask.png\"}\n"
    "measured: {flip.mean: 0.001}\n"
    "frames:\n"
    "  0: {}\n"
    "  24:\n"
    "    state: \"13e7be772847a38f\"\n"
    "    pixels:\n"
    "      llvmpipe-llvm-15.0.6-256-bits: {hash: \"" HASH_A "\", golden: \"" HASH_A "\"}\n"
    "      nvidia-h200: {hash: \"" HASH_C "\", golden: \"" HASH_A "\"}\n"
    "  96:\n"
    "    state: \"0000000000000000\"\n";

struct reading {
    struct kiln_arena *arena;
    struct kiln_expect *expect;
};

static struct reading read_text(const char *text)
{
    struct reading r = {.arena = kiln_arena_create()};
    struct kiln_error error = {0};
    r.expect = kiln_expect_parse(r.arena, text, strlen(text), "g", &error);
    if (!r.expect)
        fail_msg("not read: %s", error.message);
    return r;
}

static void expect_text(const struct kiln_expect *expect, const char *text)
{
    struct kiln_text out = {0};
    assert_true(kiln_expect_print(expect, "g", &out));
    assert_string_equal(out.data, text);
    kiln_text_free(&out);
}

static void all_of_it_is_read(void **state)
{
    (void)state;
    struct reading r = read_text(whole);
    const struct kiln_expect *e = r.expect;
    assert_string_equal(e->scene_hash, HASH_C);
    assert_int_equal(e->technique_count, 2);
    assert_string_equal(e->techniques[1], "sort=cpu");
    assert_int_equal(e->limit_count, 2);
    assert_string_equal(e->limits[1].metric, "flip.p99.5");
    assert_true(e->limits[1].value == 0.25 && e->warn == 0.75);
    assert_string_equal(e->reason, "fast \"smoke\"");
    assert_int_equal(e->measured_count, 1);
    assert_true(e->measured[0].value == 0.001);
    assert_int_equal(e->mask_count, 2);
    assert_int_equal(e->masks[0].rect[2], 40);
    assert_null(e->masks[0].picture);
    assert_string_equal(e->masks[1].picture, "g/mask.png");
    assert_int_equal(e->frame_count, 3);
    const struct kiln_expect_frame *frame = kiln_expect_find(e, 24);
    assert_non_null(frame);
    assert_string_equal(frame->state, "13e7be772847a38f");
    assert_int_equal(frame->pixel_count, 2);
    assert_string_equal(frame->pixels[1].device, "nvidia-h200");
    assert_string_equal(frame->pixels[1].hash, HASH_C);
    assert_string_equal(frame->pixels[1].golden, HASH_A);
    assert_null(kiln_expect_find(e, 0)->state);
    assert_null(kiln_expect_find(e, 25));
    expect_text(e, whole);
    kiln_arena_destroy(&r.arena);
}

static void little_of_it_is_enough(void **state)
{
    (void)state;
    struct reading r = read_text("kiln_expect: 1\n");
    const struct kiln_expect *e = r.expect;
    assert_null(e->scene_hash);
    assert_int_equal(e->technique_count + e->limit_count + e->measured_count + e->mask_count +
                         e->frame_count,
                     0);
    assert_true(e->warn < 0);
    expect_text(e, "# Written by kiln test, and rewritten by it: comments are not kept.\n"
                   "kiln_expect: 1\n");
    kiln_arena_destroy(&r.arena);
}

#define START "kiln_expect: 1\n"
#define ENTRY "{hash: " HASH_A ", golden: " HASH_A "}"

static void wrong_files_say_where(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"", ": the file is empty; an expect.yaml starts with 'kiln_expect: 1'"},
        {"[]\n", ":1:1: expected a mapping of keys, found a list"},
        {"kiln_expect: 2\n", ":1:14: kiln_expect: 2 is out of range; allowed is 1"},
        {"frames: {}\n", ":1:1: kiln_expect: the key is missing and must be given"},
        {START "frame: {}\n", ":2:1: frame: unknown key (did you mean 'frames'?)"},
        {START "scene_hash: 12\n",
         ":2:13: scene_hash: expected a hash of 64 hex digits, found '12'"},
        {START "limits: {flip.men: 1}\n",
         ":2:10: limits.flip.men: unknown metric 'flip.men' (did you mean 'flip.mean'?)"},
        {START "warn: .nan\n", ":2:7: warn: .nan is not a finite number"},
        {START "frames: [24]\n",
         ":2:9: frames: expected {number: {state: ..., pixels: ...}, ...}, found a list"},
        {START "frames: {x: {}}\n", ":2:10: frames.x: expected a whole number from 0 to 999999, "
                                    "found 'x'"},
        {START "frames: {-1: {}}\n",
         ":2:10: frames.-1: -1 is out of range; allowed is from 0 to 999999"},
        {START "frames: {24: {}, 24: {}}\n", ":2:18: duplicate key '24' (first in line 2)"},
        {START "frames: {24: {}, 24.0: {}}\n", ":2:18: frames.24.0: frame 24 is given twice"},
        {START "frames: {24: {stat: a}}\n",
         ":2:15: frames.24.stat: unknown key (did you mean 'state'?)"},
        {START "frames: {24: {state: 13E7BE772847A38F}}\n",
         ":2:22: frames.24.state: expected a hash of 16 hex digits, found '13E7BE772847A38F'"},
        {START "frames: {24: {pixels: {Mesa (1): " ENTRY "}}}\n",
         ":2:24: frames.24.pixels.Mesa (1): no device's name; a name has lower-case letters, "
         "digits, '.' and '-', as in llvmpipe-llvm-15.0.6-256-bits"},
        {START "frames: {24: {pixels: {a: {hash: [], golden: " HASH_A "}}}}\n",
         ":2:34: frames.24.pixels.a.hash: expected a hash of 64 hex digits, found a list"},
        {START "a: &x [*x, *x]\n", ":2:7: anchors and aliases are not allowed"},
        {START "reason: !!binary x\n", ":2:18: tags are not allowed"},
        {START "frames: {24: {state: \xff}}\n", ":2:22: not a text: invalid UTF-8 (byte 0xff)"},
        {START "frames: {\n", NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_arena *arena = kiln_arena_create();
        struct kiln_error error = {0};
        assert_null(
            kiln_expect_parse(arena, cases[i].text, strlen(cases[i].text), "g/fire", &error));
        if (cases[i].message)
            expect_error(&error, KILN_INVALID_INPUT, "g/fire/expect.yaml%s", cases[i].message);
        else /* libfyaml says why */
            expect_error_around(&error, KILN_INVALID_INPUT, "",
                                "g/fire/expect.yaml:3:1: not valid YAML: ");
        kiln_arena_destroy(&arena);
    }
}

static void deep_and_wide_files_are_refused(void **state)
{
    (void)state;
    char *text = malloc(1 << 20);
    assert_non_null(text);
    size_t start = (size_t)snprintf(text, 64, START "reason: ");
    memset(text + start, '[', 100000);
    text[start + 100000] = '\0';
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_error error = {0};
    assert_null(kiln_expect_parse(arena, text, strlen(text), "g", &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "g/expect.yaml:2:72: nested deeper than the 64 levels that are allowed");
    size_t length = (size_t)sprintf(text, START "frames:\n");
    for (int i = 0; i < 1100; i++)
        length += (size_t)sprintf(text + length, "  %d: {}\n", i);
    assert_null(kiln_expect_parse(arena, text, length, "g", &error));
    expect_error(
        &error, KILN_INVALID_INPUT,
        "g/expect.yaml:1027:3: more than 1024 entries in one list or mapping; no more are allowed");
    kiln_arena_destroy(&arena);
    free(text);
}

/* ---- accepting ---------------------------------------------------------------------------- */

static const struct kiln_expect_pixels ours = {
    .device = "nvidia-h200", .hash = HASH_B, .golden = HASH_B};

static void other_devices_stay_as_they_are(void **state)
{
    (void)state;
    struct reading r = read_text(whole);
    assert_true(kiln_expect_accept(r.arena, r.expect, 24, "ffffffffffffffff", &ours));
    struct kiln_text expected = {0};
    const char *state_at = strstr(whole, "13e7be772847a38f"),
               *ours_at = strstr(whole, HASH_C "\", g");
    kiln_text_add(&expected, "%.*sffffffffffffffff%.*s" HASH_B "\", golden: \"" HASH_B "%s",
                  (int)(state_at - whole), whole, (int)(ours_at - state_at - 16), state_at + 16,
                  strstr(ours_at, HASH_A) + 64);
    expect_text(r.expect, expected.data);
    kiln_text_free(&expected);
    kiln_arena_destroy(&r.arena);
}

static void entries_are_added_in_their_order(void **state)
{
    (void)state;
    struct reading r = read_text(START);
    static const struct kiln_expect_pixels first = {
        .device = "a", .hash = HASH_A, .kiln = "0.2.0 (1234567)"};
    assert_true(kiln_expect_accept(r.arena, r.expect, 96, "1111111111111111", NULL));
    assert_true(kiln_expect_accept(r.arena, r.expect, 5, NULL, &ours));
    assert_true(kiln_expect_accept(r.arena, r.expect, 24, NULL, NULL));
    assert_true(kiln_expect_accept(r.arena, r.expect, 5, NULL, &first));
    assert_true(kiln_expect_accept(r.arena, r.expect, 5, "2222222222222222", &first));
    assert_true(kiln_expect_accept(r.arena, r.expect, 96, NULL, NULL));
    expect_text(r.expect,
                "# Written by kiln test, and rewritten by it: comments are not kept.\n" START
                "frames:\n"
                "  5:\n"
                "    state: \"2222222222222222\"\n"
                "    pixels:\n"
                "      a: {hash: \"" HASH_A "\", kiln: \"0.2.0 (1234567)\"}\n"
                "      nvidia-h200: {hash: \"" HASH_B "\", golden: \"" HASH_B "\"}\n"
                "  24: {}\n"
                "  96:\n"
                "    state: \"1111111111111111\"\n");
    kiln_arena_destroy(&r.arena);
}

static void techniques_are_taken_from_a_run(void **state)
{
    (void)state;
    struct reading r = read_text(whole);
    assert_true(kiln_expect_set_techniques(r.arena, r.expect, "sort=cpu  raster=geometry "));
    assert_int_equal(r.expect->technique_count, 2);
    assert_string_equal(r.expect->techniques[1], "raster=geometry");
    assert_true(kiln_expect_set_techniques(r.arena, r.expect, ""));
    assert_int_equal(r.expect->technique_count, 0);
    kiln_arena_destroy(&r.arena);
}

static void a_device_has_one_entry_in_any_order(void **state)
{
    (void)state;
    struct reading r = read_text(START "frames: {1: {pixels: {z: " ENTRY ", nvidia-h200: " ENTRY
                                       ", a: " ENTRY "}}}\n");
    assert_true(kiln_expect_accept(r.arena, r.expect, 1, NULL, &ours));
    const struct kiln_expect_frame *frame = kiln_expect_find(r.expect, 1);
    assert_int_equal(frame->pixel_count, 3);
    assert_string_equal(frame->pixels[1].hash, HASH_B);
    assert_string_equal(frame->pixels[0].hash, HASH_A);
    assert_string_equal(frame->pixels[2].hash, HASH_A);
    kiln_arena_destroy(&r.arena);
}

/* ---- files -------------------------------------------------------------------------------- */

static void files_are_written_whole(void **state)
{
    (void)state;
    struct reading r = read_text(whole);
    struct kiln_error error = {0};
    assert_true(kiln_expect_write(r.expect, "new/g", &error));
    struct kiln_expect *again = kiln_expect_read(r.arena, "new/g", &error);
    assert_non_null(again);
    assert_string_equal(again->masks[1].picture, "new/g/g/mask.png"); /* it was another folder's */
    char *text = test_read_file("new/g/expect.yaml");
    assert_non_null(strstr(text, "nvidia-h200"));

    /* What could not be read again is not written. */
    r.expect->frames[1].pixels[0].device = "No Device";
    assert_false(kiln_expect_write(r.expect, "new/g", &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "new/g/expect.yaml:17:7: frames.24.pixels.No Device: no device's name; a name has "
                 "lower-case letters, digits, '.' and '-', as in llvmpipe-llvm-15.0.6-256-bits");
    char *same = test_read_file("new/g/expect.yaml");
    assert_string_equal(same, text);
    free(same);
    free(text);

    assert_int_equal(mkdir("taken", 0777) + mkdir("taken/expect.yaml", 0777), 0);
    r.expect->frames[1].pixels[0].device = "a";
    assert_false(kiln_expect_write(r.expect, "taken", &error));
    expect_error(&error, KILN_USAGE, "taken/expect.yaml: a folder has this name");
    kiln_arena_destroy(&r.arena);
}

static void values_that_are_no_numbers_are_left_out(void **state)
{
    (void)state;
    struct reading r = read_text(START);
    struct kiln_expect_value values[] = {{"psnr", INFINITY}, {"flip.mean", 0.5}, {"ssim", NAN}};
    r.expect->measured = values;
    r.expect->measured_count = 3;
    expect_text(r.expect,
                "# Written by kiln test, and rewritten by it: comments are not kept.\n" START
                "measured: {flip.mean: 0.5}\n");
    kiln_arena_destroy(&r.arena);
}

static void a_missing_file_is_empty_and_a_broken_one_an_error(void **state)
{
    (void)state;
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_error error = {0};
    const struct kiln_expect *expect = kiln_expect_read(arena, "none", &error);
    assert_non_null(expect);
    assert_int_equal(expect->frame_count, 0);

    assert_int_equal(mkdir("g", 0777), 0);
    assert_int_equal(symlink("gone", "g/expect.yaml"), 0);
    assert_null(kiln_expect_read(arena, "g", &error));
    expect_error(&error, KILN_INVALID_INPUT, "g/expect.yaml: No such file or directory");

    test_write_file("file", "");
    assert_null(kiln_expect_read(arena, "file", &error));
    expect_error(&error, KILN_IO, "file/expect.yaml: Not a directory");

    assert_int_equal(mkdir("folder", 0777) + mkdir("folder/expect.yaml", 0777), 0);
    assert_null(kiln_expect_read(arena, "folder", &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "folder/expect.yaml: the path is a folder, not an expect.yaml");
    kiln_arena_destroy(&arena);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_of_it_is_read),
        cmocka_unit_test(little_of_it_is_enough),
        cmocka_unit_test(wrong_files_say_where),
        cmocka_unit_test(deep_and_wide_files_are_refused),
        cmocka_unit_test(other_devices_stay_as_they_are),
        cmocka_unit_test(entries_are_added_in_their_order),
        cmocka_unit_test(techniques_are_taken_from_a_run),
        cmocka_unit_test(a_device_has_one_entry_in_any_order),
        cmocka_unit_test(values_that_are_no_numbers_are_left_out),
        IN_FOLDER(files_are_written_whole),
        IN_FOLDER(a_missing_file_is_empty_and_a_broken_one_an_error),
    };
    return cmocka_run_group_tests_name("expect", tests, NULL, NULL);
}
