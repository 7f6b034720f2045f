/* lib/suite: which accepted pictures a device is judged by, and where new ones go. */
#include <fcntl.h>
#include <signal.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "base/file_in.h"
#include "suite/golden.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/pictures.h"

static const char llvmpipe[] = "llvmpipe-llvm-15.0.6-256-bits";

static const struct kiln_test fire = {.golden = "golden/fire", .format = KILN_TEST_PNG};

static void devices_have_names_for_files(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe-llvm-15.0.6-256-bits"},
        {"NVIDIA H200 PCIe/SSE2", "nvidia-h200-pcie-sse2"},
        {"  ../../etc/passwd  ", "..-..-etc-passwd"},
        {"AMD Radeon\xe2\x84\xa2 Pro", "amd-radeon-pro"},
        {"(/)", ""},
        {"", ""},
    };
    char name[KILN_DEVICE_NAME_SIZE];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        kiln_device_name(cases[i][0], name);
        assert_string_equal(name, cases[i][1]);
    }
    char longest[400];
    memset(longest, 'x', sizeof longest);
    longest[399] = '\0';
    kiln_device_name(longest, name);
    assert_int_equal(strlen(name), KILN_DEVICE_NAME_SIZE - 1);
}

/* ---- Finding ------------------------------------------------------------------------------ */

/* Compares the names of what is found in golden/fire, joined by blanks. */
static void expect_found(const char *device, const char *names)
{
    struct kiln_goldens *goldens = calloc(1, sizeof *goldens);
    struct kiln_error error = {0};
    char text[1024] = "";
    assert_non_null(goldens);
    if (!kiln_goldens_find(&fire, 24, device, goldens, &error))
        fail_msg("%s", error.message);
    for (size_t i = 0; i < goldens->count; i++) {
        size_t length = strlen(text);
        assert_memory_equal(goldens->paths[i], "golden/fire/frame_0024", 22);
        snprintf(text + length, sizeof text - length, "%s%s", i ? " " : "", goldens->paths[i] + 22);
    }
    assert_string_equal(text, names);
    if (goldens->count == 0)
        assert_string_equal(goldens->paths[0], "golden/fire/frame_0024.png");
    free(goldens);
}

static void expect_not_found(const char *message, enum kiln_code code)
{
    struct kiln_goldens *goldens = calloc(1, sizeof *goldens);
    struct kiln_error error = {0};
    assert_non_null(goldens);
    assert_false(kiln_goldens_find(&fire, 24, llvmpipe, goldens, &error));
    expect_error(&error, code, "%s", message);
    free(goldens);
}

static void put(const char *end)
{
    char path[200];
    snprintf(path, sizeof path, "golden/fire/frame_0024%s", end);
    test_write_file(path, "x");
}

static void the_most_specific_device_counts(void **state)
{
    (void)state;
    expect_found(llvmpipe, "");
    put(".png");
    expect_found(llvmpipe, ".png");
    put("~3.png");
    put("~10.png");
    put("~2.png");
    expect_found(llvmpipe, ".png ~2.png ~3.png ~10.png");
    put("@llvmpipe~2.png");
    expect_found(llvmpipe, "@llvmpipe~2.png");
    put("@llvmpipe.png");
    expect_found(llvmpipe, "@llvmpipe.png @llvmpipe~2.png");
    expect_found("nvidia-h200", ".png ~2.png ~3.png ~10.png");
    expect_found("llvmpipes", ".png ~2.png ~3.png ~10.png");
    put("@llvmpipe-llvm-15.0.6-256-bits.png");
    expect_found(llvmpipe, "@llvmpipe-llvm-15.0.6-256-bits.png");
    expect_found("llvmpipe-llvm-16", "@llvmpipe.png @llvmpipe~2.png");
    expect_found("llvmpipe", "@llvmpipe.png @llvmpipe~2.png");
}

static void strange_files_are_none_or_errors(void **state)
{
    (void)state;
    static const char *const others[] = {"5.png",    ".exr",     ".png~",           " (1).png",
                                         ".old.png", "_new.png", "@nvidia-h200.png"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        put(others[i]);
    test_write_file("golden/fire/.frame_0024.png.kiln-1-2.tmp", "x");
    expect_found(llvmpipe, "");

    /* A link that leads nowhere and a folder have the name: they are there. */
    assert_int_equal(symlink("gone", "golden/fire/frame_0024.png"), 0);
    assert_int_equal(mkdir("golden/fire/frame_0024~2.png", 0777), 0);
    expect_found(llvmpipe, ".png ~2.png");
    char hex[65];
    struct kiln_error error = {0};
    assert_false(kiln_pixel_hash("golden/fire/frame_0024.png", hex, &error));
    assert_false(kiln_pixel_hash("golden/fire/frame_0024~2.png", hex, &error));

    static const char *const wrong[] = {"~1.png",    "~02.png",  "~.png",   "@.png",
                                        "@Mesa.png", "~2@a.png", "~2~3.png"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char path[64], message[256];
        put(wrong[i]);
        snprintf(path, sizeof path, "golden/fire/frame_0024%s", wrong[i]);
        snprintf(message, sizeof message,
                 "%s: not the name of a golden; names are frame_0024[@DEVICE][~NUMBER].png with a "
                 "device in lower case and a number from 2 to 999, each of which may be left out",
                 path);
        expect_not_found(message, KILN_INVALID_INPUT);
        assert_int_equal(unlink(path), 0);
    }
}

static void there_are_at_most_sixteen(void **state)
{
    (void)state;
    put(".png");
    for (int i = 2; i <= 16; i++) {
        char end[16];
        snprintf(end, sizeof end, "~%d.png", i);
        put(end);
    }
    struct kiln_goldens *goldens = calloc(1, sizeof *goldens);
    struct kiln_error error = {0};
    assert_non_null(goldens);
    assert_true(kiln_goldens_find(&fire, 24, llvmpipe, goldens, &error));
    assert_int_equal(goldens->count, KILN_MAX_GOLDENS);
    free(goldens);
    char path[KILN_PATH_SIZE];
    assert_false(kiln_goldens_place(&fire, 24, llvmpipe, KILN_APPROVE_ALTERNATIVE, path, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "golden/fire: frame 24 has 16 accepted pictures; no more are allowed");
    put("~17.png");
    expect_not_found("golden/fire: more than 16 accepted pictures of frame 24; no more are allowed",
                     KILN_INVALID_INPUT);
}

static void a_folder_that_cannot_be_read_is_an_error(void **state)
{
    (void)state;
    assert_int_equal(mkdir("golden", 0777), 0);
    assert_int_equal(symlink("gone", "golden/fire"), 0);
    expect_not_found("golden/fire: the folder cannot be read: No such file or directory", KILN_IO);
    assert_int_equal(unlink("golden/fire"), 0);
    test_write_file("golden/fire", "a file");
    expect_not_found("golden/fire: the folder cannot be read: Not a directory", KILN_IO);
}

/* ---- Places ------------------------------------------------------------------------------- */

static void expect_place(const char *device, enum kiln_approve_as as, const char *end)
{
    char path[KILN_PATH_SIZE], expected[256];
    struct kiln_error error = {0};
    assert_true(kiln_goldens_place(&fire, 24, device, as, path, &error));
    snprintf(expected, sizeof expected, "golden/fire/frame_0024%s", end);
    assert_string_equal(path, expected);
}

static void pictures_have_their_places(void **state)
{
    (void)state;
    expect_place(llvmpipe, KILN_APPROVE_REPLACE, ".png");
    expect_place(llvmpipe, KILN_APPROVE_ALTERNATIVE, ".png");
    expect_place("nvidia-h200", KILN_APPROVE_DEVICE, "@nvidia-h200.png");
    put(".png");
    expect_place(llvmpipe, KILN_APPROVE_REPLACE, ".png");
    expect_place(llvmpipe, KILN_APPROVE_ALTERNATIVE, "~2.png");
    put("~2.png");
    put("~4.png");
    expect_place(llvmpipe, KILN_APPROVE_ALTERNATIVE, "~3.png");
    put("@llvmpipe.png");
    expect_place(llvmpipe, KILN_APPROVE_REPLACE, "@llvmpipe.png");
    expect_place(llvmpipe, KILN_APPROVE_ALTERNATIVE, "@llvmpipe~2.png");
    expect_place(llvmpipe, KILN_APPROVE_DEVICE, "@llvmpipe-llvm-15.0.6-256-bits.png");
    expect_place("nvidia-h200", KILN_APPROVE_ALTERNATIVE, "~3.png");
}

/* ---- Files -------------------------------------------------------------------------------- */

static void write_pictures(const char *pattern, uint32_t bits)
{
    const struct kiln_frame_range range = {0, 1};
    struct kiln_output_params params = test_output_params(pattern, &range);
    params.png_bits = bits;
    struct kiln_error error = {0};
    assert_true(test_write_all(&params, &error));
}

static void expect_hashes(const char *a, const char *b, bool equal)
{
    char x[65], y[65];
    struct kiln_error error = {0};
    assert_true(kiln_pixel_hash(a, x, &error) && kiln_pixel_hash(b, y, &error));
    assert_int_equal(strlen(x), 64);
    assert_int_equal(strcmp(x, y) == 0, equal);
}

static void hashes_are_of_pixels(void **state)
{
    (void)state;
    write_pictures("a_##.png", 8);
    write_pictures("b_##.png", 16);
    struct kiln_error error = {0};
    assert_true(kiln_file_copy("a_00.png", "deep/er/copy.png", &error));
    expect_hashes("a_00.png", "deep/er/copy.png", true);
    expect_hashes("a_00.png", "a_01.png", false);
    expect_hashes("a_00.png", "b_00.png", false);
    char hex[65];
    assert_false(kiln_pixel_hash("gone.png", hex, &error));
    expect_error(&error, KILN_IO,
                 "gone.png: the image cannot be opened: No such file or directory");
    test_write_file("bad.png", "\x89PNG");
    assert_false(kiln_pixel_hash("bad.png", hex, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "bad.png: the file is not an image: it starts with the bytes 89 50 4e 47; allowed "
                 "are PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or HDR files");
}

static void copies_replace_links_not_what_they_lead_to(void **state)
{
    (void)state;
    test_write_file("from", "new");
    test_write_file("precious", "old");
    assert_int_equal(symlink("precious", "link"), 0);
    struct kiln_error error = {0};
    assert_true(kiln_file_copy("from", "link", &error));
    char *kept = test_read_file("precious"), *copied = test_read_file("link");
    assert_string_equal(kept, "old");
    assert_string_equal(copied, "new");
    free(kept);
    free(copied);

    assert_int_equal(mkfifo("pipe", 0666), 0);
    assert_false(kiln_file_copy("pipe", "to", &error));
    expect_error(&error, KILN_INVALID_INPUT, "pipe: the path is not a regular file");
    assert_false(kiln_file_copy("gone", "to", &error));
    expect_error(&error, KILN_IO, "gone: No such file or directory");
    assert_false(kiln_file_copy("from", "pipe", &error));
    expect_error(&error, KILN_USAGE, "pipe: a device, pipe or socket has this name");
    assert_int_equal(access("to", F_OK), -1);
}

static void the_lock_lets_one_in(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    int lock = kiln_goldens_lock(&fire, &error);
    assert_true(lock >= 0);
    int told[2];
    assert_int_equal(pipe(told), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        alarm(60);
        bool ok = write(told[1], "b", 1) == 1;
        int own = kiln_goldens_lock(&fire, &error);
        ok = write(told[1], "l", 1) == 1 && ok && own >= 0;
        _exit(!ok);
    }
    char what = 0;
    assert_true(read(told[0], &what, 1) == 1 && what == 'b');
    usleep(50000);
    assert_int_equal(fcntl(told[0], F_SETFL, O_NONBLOCK), 0);
    assert_int_equal(read(told[0], &what, 1), -1); /* it waits */
    kiln_goldens_unlock(lock);
    int status = 1;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    assert_true(read(told[0], &what, 1) == 1 && what == 'l');
    close(told[0]);
    close(told[1]);

    test_write_file("file", "");
    const struct kiln_test wrong = {.golden = "file"};
    assert_int_equal(kiln_goldens_lock(&wrong, &error), -1);
    expect_error(&error, KILN_USAGE,
                 "file: the path is not a folder, but file/ needs a folder here");
}

/* ---- Accepting ---------------------------------------------------------------------------- */

/* Reads a picture for an acceptance. The caller frees its bytes. */
static unsigned char *read_picture(const char *picture, char pixels[65], size_t *size)
{
    struct kiln_error error = {0};
    unsigned char *bytes = kiln_file_read(picture, "image", "PNG", SIZE_MAX, size, &error);
    if (!bytes || !kiln_pixel_hash_of(bytes, *size, picture, pixels, &error))
        fail_msg("%s", error.message);
    return bytes;
}

static void accept(struct kiln_arena *arena, struct kiln_expect *expect, const char *picture,
                   enum kiln_approve_as as, const char *place)
{
    char pixels[65];
    size_t size = 0;
    unsigned char *bytes = read_picture(picture, pixels, &size);
    const struct kiln_acceptance acceptance = {.frame = 24,
                                               .bytes = bytes,
                                               .size = size,
                                               .pixels = pixels,
                                               .state = "13e7be772847a38f",
                                               .device_name = llvmpipe,
                                               .as = as};
    char path[KILN_PATH_SIZE];
    struct kiln_error error = {0};
    if (!kiln_goldens_accept(arena, &fire, expect, &acceptance, path, &error))
        fail_msg("%s", error.message);
    free(bytes);
    assert_string_equal(path, place);
    expect_hashes(picture, place, true);
    char hex[65];
    assert_true(kiln_pixel_hash(place, hex, &error));
    const struct kiln_expect_frame *frame = kiln_expect_find(expect, 24);
    assert_non_null(frame);
    assert_string_equal(frame->state, "13e7be772847a38f");
    assert_int_equal(frame->pixel_count, 1);
    assert_string_equal(frame->pixels[0].device, llvmpipe);
    assert_string_equal(frame->pixels[0].hash, hex);
    assert_string_equal(frame->pixels[0].golden, hex);
}

static void accepted_pictures_are_found(void **state)
{
    (void)state;
    write_pictures("new_##.png", 8);
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_error error = {0};
    struct kiln_expect *expect = kiln_expect_read(arena, fire.golden, &error);
    assert_non_null(expect);
    accept(arena, expect, "new_00.png", KILN_APPROVE_REPLACE, "golden/fire/frame_0024.png");
    accept(arena, expect, "new_01.png", KILN_APPROVE_REPLACE, "golden/fire/frame_0024.png");
    expect_found(llvmpipe, ".png");
    accept(arena, expect, "new_00.png", KILN_APPROVE_ALTERNATIVE, "golden/fire/frame_0024~2.png");
    expect_hashes("golden/fire/frame_0024.png", "new_01.png", true);
    accept(arena, expect, "new_00.png", KILN_APPROVE_DEVICE,
           "golden/fire/frame_0024@llvmpipe-llvm-15.0.6-256-bits.png");
    expect_found("nvidia-h200", ".png ~2.png");

    /* One whose pixels are there is not written again; a broken one is. */
    struct stat before, after;
    assert_int_equal(stat("golden/fire/frame_0024.png", &before), 0);
    char pixels[65];
    size_t size = 0;
    unsigned char *bytes = read_picture("new_01.png", pixels, &size);
    const struct kiln_acceptance same = {.frame = 24,
                                         .bytes = bytes,
                                         .size = size,
                                         .pixels = pixels,
                                         .device_name = llvmpipe,
                                         .golden = "golden/fire/frame_0024.png"};
    char path[KILN_PATH_SIZE];
    assert_true(kiln_goldens_accept(arena, &fire, expect, &same, path, &error));
    assert_int_equal(stat("golden/fire/frame_0024.png", &after), 0);
    assert_int_equal(before.st_ino, after.st_ino);
    test_write_file("golden/fire/frame_0024.png", "broken");
    assert_true(kiln_goldens_accept(arena, &fire, expect, &same, path, &error));
    expect_hashes("golden/fire/frame_0024.png", "new_01.png", true);

    assert_false(kiln_pixel_hash_of("no picture", 10, "broken.png", pixels, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "broken.png: the file is not an image: it starts with the bytes 6e 6f 20 70; "
                 "allowed are PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or HDR files");
    free(bytes);
    expect_hashes("golden/fire/frame_0024.png", "new_01.png", true);
    kiln_arena_destroy(&arena);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(devices_have_names_for_files),
        IN_FOLDER(the_most_specific_device_counts),
        IN_FOLDER(strange_files_are_none_or_errors),
        IN_FOLDER(there_are_at_most_sixteen),
        IN_FOLDER(a_folder_that_cannot_be_read_is_an_error),
        IN_FOLDER(pictures_have_their_places),
        IN_FOLDER(hashes_are_of_pixels),
        IN_FOLDER(copies_replace_links_not_what_they_lead_to),
        IN_FOLDER(the_lock_lets_one_in),
        IN_FOLDER(accepted_pictures_are_found),
    };
    return cmocka_run_group_tests_name("golden", tests, NULL, NULL);
}
