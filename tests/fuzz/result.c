/* Fuzzes the reader of result.json, the file in which `kiln test` records the result of one golden
 * test. Any bytes must give a result or an error, never a crash; reading and writing a result twice
 * must give the same text. If this fails, a report may show wrong results, or a damaged file
 * crashes kiln. */
#include "suite/result.h"

#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

static struct kiln_text print(const struct kiln_result *result)
{
    struct kiln_text text = {0};
    require(kiln_result_print(result, &text), "cannot print a result");
    return text;
}

static void check_round_trip(struct kiln_arena *arena, const struct kiln_result *result)
{
    struct kiln_error error = {0};
    struct kiln_text text = print(result);
    const struct kiln_result *again =
        kiln_result_parse(arena, text.data, text.length, "again", &error);
    require(again, error.message);
    struct kiln_text text_again = print(again);
    require(strcmp(text.data, text_again.data) == 0, "a written result differs");
    kiln_text_free(&text);
    kiln_text_free(&text_again);
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
        const struct kiln_result *result = kiln_result_parse(arena, text, size, "fuzz", &error);
        fuzz_taken = result != NULL;
        if (result)
            check_round_trip(arena, result);
        else
            require(error.code != KILN_OK && *error.message, "an error without a message");
    }
    kiln_arena_destroy(&arena);
    free(text);
    return 0;
}
