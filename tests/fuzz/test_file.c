/* Fuzzes the reader of files *.test.yaml, which describe golden tests. Any bytes must give a test
 * whose values are all within their documented ranges, or a test with an error in its member
 * `problem`, never a crash. If this fails, one wrong test file ends the whole run of `kiln test`,
 * or a test runs with values out of range. */
#include "suite/test_file.h"

#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

static void check_test(const struct kiln_test *test)
{
    require(*test->scene && test->about && test->limits_reason, "a text is missing");
    require(test->frame_count <= KILN_TEST_MAX_FRAMES, "too many frames");
    for (size_t i = 1; i < test->frame_count; i++)
        require(test->frames[i] > test->frames[i - 1], "frames do not ascend");
    for (size_t i = 0; i < test->override_count; i++)
        require(strchr(test->overrides[i], '='), "an override without a value");
    for (size_t i = 0; i < test->limit_count; i++)
        require(strchr(test->limits[i], '=') && !strchr(test->limits[i], ','), "a wrong limit");
    for (size_t i = 0; i < test->mask_count; i++)
        require(test->masks[i].picture || test->masks[i].rect[2] * test->masks[i].rect[3] > 0,
                "a mask of nothing");
    require(test->warn >= 0 && test->warn <= 1 && test->window > 0 && test->time_limit_s > 0,
            "a number is out of its range");
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
        struct kiln_test_file file;
        fuzz_taken = false;
        if (kiln_test_file_parse(arena, text, size, "x/fuzz.test.yaml", &file, &error)) {
            const struct kiln_error *problem = &file.test.problem;
            require((problem->code == KILN_OK) == !*problem->message, "a problem without a text");
            fuzz_taken = problem->code == KILN_OK;
            check_test(&file.test);
        } else {
            require(error.code == KILN_DEVICE_FAILED,
                    "a fault of the file is not the test's problem");
        }
    }
    kiln_arena_destroy(&arena);
    free(text);
    return 0;
}
