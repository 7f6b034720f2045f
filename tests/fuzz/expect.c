/* Fuzzes the reader of expect.yaml, the file that records which frames of a golden test were
 * accepted. Any bytes must give expectations or an error, never a crash; reading and writing
 * expectations twice must give the same text. If this fails, `kiln test approve` may lose earlier
 * acceptances, or crash on a damaged file. */
#include "suite/expect.h"

#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

static struct kiln_text print(const struct kiln_expect *expect)
{
    struct kiln_text text = {0};
    require(kiln_expect_print(expect, "g", &text), "cannot print what is expected");
    return text;
}

static void check_round_trip(struct kiln_arena *arena, const struct kiln_expect *expect)
{
    struct kiln_error error = {0};
    struct kiln_text text = print(expect);
    const struct kiln_expect *again = kiln_expect_parse(arena, text.data, text.length, "g", &error);
    require(again, error.message);
    struct kiln_text text_again = print(again);
    require(strcmp(text.data, text_again.data) == 0, "a written text differs");
    kiln_text_free(&text);
    kiln_text_free(&text_again);
}

/* Records that a picture of frame 24 is accepted on one device, and checks that the entries of all
 * other frames and devices stay. */
static void check_accepting(struct kiln_arena *arena, struct kiln_expect *expect)
{
    static const char hash[] = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";
    static const struct kiln_expect_pixels pixels = {
        .device = "nvidia-h200", .hash = hash, .golden = hash, .kiln = "0.2.0"};
    const struct kiln_expect_frame *frame = kiln_expect_find(expect, 24);
    size_t frames = expect->frame_count + !frame, devices = frame ? frame->pixel_count : 0;
    for (size_t i = 0; frame && i < frame->pixel_count; i++)
        devices -= strcmp(frame->pixels[i].device, pixels.device) == 0;
    require(kiln_expect_accept(arena, expect, 24, "0123456789abcdef", &pixels), "out of memory");
    frame = kiln_expect_find(expect, 24);
    require(frame && frame->pixel_count == devices + 1, "another device's entry is lost");
    require(expect->frame_count == frames, "another frame is lost");
    for (size_t i = 1; i < expect->frame_count; i++)
        require(expect->frames[i].number > expect->frames[i - 1].number, "frames do not ascend");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    struct kiln_arena *arena = kiln_arena_create();
    if (text && arena) {
        if (size)
            memcpy(text, data, size);
        text[size] = '\0';
        struct kiln_error error = {0};
        struct kiln_expect *expect = kiln_expect_parse(arena, text, size, "g", &error);
        fuzz_taken = expect != NULL;
        if (expect) {
            check_round_trip(arena, expect);
            check_accepting(arena, expect);
            check_round_trip(arena, expect);
        } else {
            require(error.code != KILN_OK && *error.message, "an error without a message");
        }
    }
    kiln_arena_destroy(&arena);
    free(text);
    return 0;
}
