/* Declares the result of a test, which the process that ran the test writes, and reports, `approve`
 * and the run read. It is a JSON file, RESULTS/NAME/result.json, beside the pictures that it names.
 */
#ifndef KILN_SUITE_RESULT_H
#define KILN_SUITE_RESULT_H

#include "base/arena.h"
#include "base/text.h"
#include "kiln_program.h"

enum { KILN_TEST_MAX_FRAMES = 1000, KILN_RESULT_MAX_ENTRIES = 1000 };

/* What decided the verdict on a frame. */
enum kiln_judged_by {
    KILN_JUDGED_BY_NOTHING, /* no golden, or nothing was rendered, or each time something else */
    KILN_JUDGED_BY_STATE,   /* the state hash differs: the simulation changed */
    KILN_JUDGED_BY_PIXELS,  /* the pixels' hash is known */
    KILN_JUDGED_BY_METRICS,
    KILN_JUDGED_BY_COUNT
};
/* "nothing", "state", "pixels", "metrics" */
const char *kiln_judged_by_name(enum kiln_judged_by judged_by);

/* The result of a frame. Texts are never NULL, and "" where there is nothing. Files are relative to
 * the result's folder and have no '/' in their names. */
struct kiln_result_frame {
    uint32_t number;
    enum kiln_test_status status;
    enum kiln_judged_by judged_by;
    const char *message;   /* why, "" for a pass */
    const char *picture;   /* what was rendered */
    const char *reference; /* a copy of the golden that was nearest; "" without one */
    const char *error_map; /* FLIP's, in magma; "" where it was not measured */
    const char *golden;    /* the golden's own path, as a person would open it; where it would be */
    const char *state, *state_expected;   /* 16 hex digits; expected "" when nothing is */
    const char *pixels, *pixels_expected; /* SHA-256 of the decoded pixels */
    const char *kiln_expected;            /* that drew what was accepted; "" where not known */
    bool measured;                        /* what follows means something */
    double values[KILN_MAX_COLUMNS];      /* by the result's columns */
    bool beyond[KILN_MAX_COLUMNS];
    double score;
    uint32_t worst_x, worst_y;
    uint32_t window_x, window_y, window_width, window_height, window_differing;
};

/* A key of the scene that is not as it was when the goldens were accepted. */
struct kiln_result_change {
    const char *key;            /* "systems.fire.emit.rate" */
    const char *before, *after; /* as a scene would write them; "" where it is not there */
};

struct kiln_result {
    const char *name;   /* of the test, with its device */
    const char *test;   /* path of the test file or scene */
    const char *scene;  /* path of the scene */
    const char *about;  /* the test's own description */
    const char *golden; /* the folder of its goldens */
    enum kiln_test_status status;
    enum kiln_code code;     /* ok for pass, skip and warn, and only for these */
    const char *message;     /* the cause in one line: of an error, or of the worst frame */
    const char *log;         /* file with what its process printed, or "" */
    const char *device;      /* GL renderer */
    const char *device_name; /* as in expect.yaml: "llvmpipe-llvm-15.0.6-256-bits" */
    const char *driver;      /* GL version and vendor */
    const char *platform;
    const char *techniques, *techniques_expected;
    const char *version; /* of kiln, with its commit where that is known */
    bool pins_gl;        /* the test itself names a device or a technique of GL */
    uint32_t seed;
    uint32_t width, height;
    uint32_t threads, repeat;
    const char *scene_hash, *scene_hash_expected;
    const char *started; /* 2026-01-31T12:00:00Z */
    double total_s;
    double warn; /* the score beyond which a frame that passes is warned of */
    bool hdr;
    const char *rerun, *approve; /* the exact commands */
    size_t column_count;
    struct kiln_compare_column columns[KILN_MAX_COLUMNS];
    size_t frame_count;
    struct kiln_result_frame *frames; /* ascending by number */
    size_t change_count;
    struct kiln_result_change *changes;
    size_t note_count;
    const char **notes; /* for people: stale limits, goldens written */
};

/* Initialise a result, or a frame of it, with its name or number alone: texts are "", numbers 0. */
void kiln_result_init(struct kiln_result *result, const char *name);
void kiln_result_frame_init(struct kiln_result_frame *frame, uint32_t number);

/* Returns the score of a result's worst frame: the highest of the measured ones, 0 without any. */
double kiln_result_score(const struct kiln_result *result);

/* Returns the frame that a person should see first: of the worst status, the one with the highest
 * score. A frame without values has the highest one unless it passed. 0 without frames. */
size_t kiln_result_worst_frame(const struct kiln_result *result);

/* Writes FOLDER/result.json, whole or not at all; makes missing folders. KILN_IO. */
bool kiln_result_write(const struct kiln_result *result, const char *folder,
                       struct kiln_error *error);

/* Reads FOLDER/result.json; all of it lies in the arena. NULL with KILN_INVALID_INPUT when there is
 * no such file or it is no result, with line and column. */
struct kiln_result *kiln_result_read(struct kiln_arena *arena, const char *folder,
                                     struct kiln_error *error);

/* Reads the text of a result.json, which must end in a zero byte that size does not count; name
 * stands for the file in messages. */
struct kiln_result *kiln_result_parse(struct kiln_arena *arena, const char *text, size_t size,
                                      const char *name, struct kiln_error *error);

/* Adds the text of result.json. False when memory is short. */
bool kiln_result_print(const struct kiln_result *result, struct kiln_text *text);

/* Adds the members of result.json but its version to an open object of JSON, whose lines begin
 * with two spaces. An infinite value is null. Of more changes or notes than
 * KILN_RESULT_MAX_ENTRIES, the last one says how many are left out. */
void kiln_result_add_json(struct kiln_json *json, const struct kiln_result *result);

#endif
