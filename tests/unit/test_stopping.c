/* Files whose completion takes long: their caller is asked meanwhile, and nothing is left of what
 * it does not want any more. */
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

/* Of each one-file output, and the least times that it asks: so often that the next one is never
 * far. Codecs without delay have nothing left to do. */
static const struct {
    const char *suffix;
    bool flipbook;
    uint32_t asks;
} outputs[] = {
    {"gif", false, 200 + 20 * 36}, /* for splits of the palette's boxes, and for rows */
    {"png", true, 2},              /* for bands of 256 KiB of the atlas, and of its motion */
    {"webm", false, 5},            /* for frames that it looked ahead at */
    {"mp4", false, 5},
};
enum { OUTPUT_COUNT = sizeof outputs / sizeof *outputs, FRAMES = 20 };

struct caller {
    uint32_t asked, refused_at; /* 0: never */
    bool is_finishing;
};

static bool may_go_on(void *user, struct kiln_error *error)
{
    struct caller *caller = user;
    assert_true(caller->is_finishing);
    caller->asked++;
    return caller->asked != caller->refused_at ||
           kiln_error_set(error, KILN_INTERRUPTED, "enough of it");
}

/* Writes all frames and finishes; the picture's files stay as finish left them. */
static bool complete(size_t i, const char *folder, struct caller *caller, bool overwrite,
                     struct kiln_error *error)
{
    char path[64];
    const struct kiln_frame_range range = {0, FRAMES - 1};
    snprintf(path, sizeof path, "%s/x.%s", folder, outputs[i].suffix);
    struct kiln_output_params params = test_output_params(path, &range);
    params.caller = (struct kiln_caller){may_go_on, caller};
    params.overwrite = overwrite;
    if (outputs[i].flipbook)
        params.flipbook = (struct kiln_flipbook){.columns = 5, .rows = 4, .motion = true};
    struct kiln_output *output = kiln_output_open(&params, error);
    assert_non_null(output);
    for (uint32_t frame = 0; frame < FRAMES; frame++)
        assert_true(kiln_output_write(output, test_picture(output, &params, frame), error));
    caller->is_finishing = true;
    bool good = kiln_output_finish(output, error);
    kiln_output_close(&output);
    return good;
}

static void refuse(size_t i, const char *folder, uint32_t at, bool overwrite)
{
    struct caller caller = {.refused_at = at};
    struct kiln_error error = {0};
    assert_false(complete(i, folder, &caller, overwrite, &error));
    expect_error(&error, KILN_INTERRUPTED, "enough of it");
    assert_int_equal(caller.asked, at); /* ended there */
}

static void stopped_completion_leaves_nothing(void **state)
{
    (void)state;
    for (size_t i = 0; i < OUTPUT_COUNT; i++) {
        char folder[32];
        struct caller patient = {0};
        struct kiln_error error = {0};
        test_make_folder(folder);
        assert_true(complete(i, folder, &patient, false, &error));
        assert_true(patient.asked >= outputs[i].asks);
        int files = test_count_files(folder);
        assert_int_equal(files, outputs[i].flipbook ? 3 : 1);

        /* What was there stays when a new one is not completed. */
        refuse(i, folder, patient.asked, true);
        assert_int_equal(test_count_files(folder), files);
        test_remove_folder(folder);

        const uint32_t moments[] = {1, patient.asked / 2, patient.asked};
        for (size_t m = 0; m < 3; m++) {
            test_make_folder(folder);
            refuse(i, folder, moments[m], false);
            assert_int_equal(test_count_files(folder), 0);
            struct caller next = {0};
            assert_true(complete(i, folder, &next, false, &error)); /* as if it were the first */
            assert_int_equal(next.asked, patient.asked);
            test_remove_folder(folder);
        }
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(stopped_completion_leaves_nothing),
    };
    return cmocka_run_group_tests_name("stopping", tests, NULL, NULL);
}
