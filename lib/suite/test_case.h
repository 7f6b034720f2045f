/* Declares a test case: the state of one test while it runs, which run.c, judge.c, update.c and
 * others share. */
#ifndef KILN_SUITE_TEST_CASE_H
#define KILN_SUITE_TEST_CASE_H

#include "kiln_program.h"
#include "suite/rendering.h"

/* The data of a frame that a test case needs and does not write into its result. */
struct kiln_test_case_frame {
    enum kiln_code code; /* of the frame's error */
    bool has_golden;
    bool broken_golden;  /* the golden cannot be decoded, but the picture can replace it */
    bool equals_golden;  /* the picture's pixels are those of a golden */
    bool without_expect; /* within the limits of its golden, but there is no expect.yaml */
    char golden_hash[65];
    const char *repeat_difference; /* how another render differed; NULL: none did */
};

struct kiln_test_case {
    struct kiln_arena *arena;
    const struct kiln_suite *suite;
    const struct kiln_test *test;
    const struct kiln_test_params *params;
    struct kiln_expect *expect;
    struct kiln_rendering rendering; /* the first render */
    const char **limits;             /* of all sources; later ones override earlier ones */
    size_t limit_count;
    bool has_own_limits;    /* the test or expect.yaml sets limits */
    bool scene_keys_differ; /* the accepted scene was written by a kiln with other keys */
    struct kiln_compare_mask *masks;
    size_t mask_count;
    double warn;
    struct kiln_result *result;
    struct kiln_test_case_frame *frames; /* in the order of the result's */
    size_t note_capacity;
    bool no_memory; /* sticky: a text could not be allocated */
    enum kiln_code code;
    double started_s;
};

/* Sets limits, masks and the warning score from the test and its expect.yaml, and with them the
 * result's columns. KILN_USAGE for an invalid limit. */
bool kiln_test_case_set_limits(struct kiln_test_case *test_case, struct kiln_error *error);

/* Formats a text in the arena. When memory is short, it returns "" and sets no_memory. */
const char *kiln_test_case_text(struct kiln_test_case *test_case, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Adds a note to the result. */
void kiln_test_case_note(struct kiln_test_case *test_case, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Makes the path RESULTS/NAME/file; false with KILN_IO when it is too long. */
bool kiln_test_case_path(const struct kiln_test_case *test_case, const char *file,
                         char path[KILN_PATH_SIZE], struct kiln_error *error);

/* Compares a rendered picture with a golden by the limits and masks of the test; error_map is a
 * path or NULL. A picture that cannot be read is an error; a difference is not. */
struct kiln_test_case_comparison {
    struct kiln_compare_frame frame; /* without its texts */
    struct kiln_compare_result result;
    char message[KILN_MESSAGE_SIZE]; /* why the frame was not measured */
};
bool kiln_test_case_compare(const struct kiln_test_case *test_case, const char *golden,
                            const char *picture, const char *error_map,
                            struct kiln_test_case_comparison *comparison, struct kiln_error *error);

/* Judges frame `index` of the result, whose number, picture, state and pixels are set (judge.c). An
 * error becomes the frame's status and message. */
void kiln_test_case_judge(struct kiln_test_case *test_case, size_t index);

/* Accepts what --update asks for or, in a dry run, notes what it would accept (update.c). KILN_IO.
 */
bool kiln_test_case_update(struct kiln_test_case *test_case, struct kiln_error *error);

/* Lists the keys that differ between two scenes as kiln_scene_print writes them (scene_diff.c), of
 * which the second may have the places of kiln_scene_print_origins; name stands for the first scene
 * in messages. */
bool kiln_scene_diff(struct kiln_arena *arena, const char *before, const char *name,
                     const char *after, struct kiln_result_change **changes, size_t *count,
                     struct kiln_error *error);

/* Adds notes about what a tester should know although nothing failed (notes.c). */
void kiln_test_case_take_notes(struct kiln_test_case *test_case);

/* Return the commands that run this test again, and that approve its pictures (commands.c). */
const char *kiln_test_case_rerun_command(struct kiln_test_case *test_case);
const char *kiln_test_case_approve_command(struct kiln_test_case *test_case);

#endif
