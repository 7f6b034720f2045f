/* Declares a trial, which is a run of one test under way: what the files of a run hand to each
 * other. */
#ifndef KILN_SUITE_TRIAL_H
#define KILN_SUITE_TRIAL_H

#include "kiln_program.h"
#include "suite/rendering.h"

/* What is known of a frame beside its result. */
struct kiln_trial_frame {
    enum kiln_code code; /* of an error */
    bool has_golden;
    bool broken_golden; /* the golden cannot be decoded, while the picture could take its place */
    bool equals_golden; /* the picture's pixels are those of a golden */
    bool unlisted;      /* like its golden, but no expect.yaml says what was accepted */
    char golden_hash[65];
    const char *unsteady; /* how another render differed; NULL: none did */
};

struct kiln_trial {
    struct kiln_arena *arena;
    const struct kiln_suite *suite;
    const struct kiln_test *test;
    const struct kiln_test_params *params;
    struct kiln_expect *expect;
    struct kiln_rendering rendering; /* the first one */
    const char **limits;             /* of all sources, in the order in which they override */
    size_t limit_count;
    bool own_limits; /* not just the default ones */
    bool other_keys; /* a kiln that writes scenes with other keys wrote the accepted one */
    struct kiln_compare_mask *masks;
    size_t mask_count;
    double warn;
    struct kiln_result *result;
    struct kiln_trial_frame *frames; /* by the result's */
    size_t note_capacity;
    bool no_memory; /* sticky: a text is missing */
    enum kiln_code code;
    double started_s;
};

/* Sets limits, masks and the level of warnings, from the test and what was accepted, and the
 * result's columns. KILN_USAGE for a limit without sense. */
bool kiln_trial_set_limits(struct kiln_trial *trial, struct kiln_error *error);

/* Formats a text in the arena; "" and no_memory when memory is short. */
const char *kiln_trial_text(struct kiln_trial *trial, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Adds a note to the result. */
void kiln_trial_note(struct kiln_trial *trial, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Makes the path RESULTS/NAME/file; false with KILN_IO when it is too long. */
bool kiln_trial_path(const struct kiln_trial *trial, const char *file, char path[KILN_PATH_SIZE],
                     struct kiln_error *error);

/* Compares a rendered picture with a golden as the test wants it; error_map is a path or NULL. A
 * picture that cannot be read is an error; a difference is not. */
struct kiln_trial_comparison {
    struct kiln_compare_frame frame; /* without its texts */
    struct kiln_compare_result result;
    char message[KILN_MESSAGE_SIZE]; /* why it has no values */
};
bool kiln_trial_compare(const struct kiln_trial *trial, const char *golden, const char *picture,
                        const char *error_map, struct kiln_trial_comparison *comparison,
                        struct kiln_error *error);

/* Fills frame `index` of the result, whose number, picture, state and pixels are there (judge.c).
 * What goes wrong is the frame's status. */
void kiln_trial_judge(struct kiln_trial *trial, size_t index);

/* Accepts what the parameters ask for, or notes what it would accept (update.c). KILN_IO. */
bool kiln_trial_update(struct kiln_trial *trial, struct kiln_error *error);

/* Lists the keys that differ between two scenes as kiln_scene_print writes them (scene_diff.c);
 * name stands for the first in messages. */
bool kiln_scene_diff(struct kiln_arena *arena, const char *before, const char *name,
                     const char *after, struct kiln_result_change **changes, size_t *count,
                     struct kiln_error *error);

/* Notes what a tester should know although nothing failed (notes.c). */
void kiln_trial_take_notes(struct kiln_trial *trial);

/* Return the commands that run this test again, and that approve its pictures (commands.c). */
const char *kiln_trial_rerun_command(struct kiln_trial *trial);
const char *kiln_trial_approve_command(struct kiln_trial *trial);

#endif
