/* Declares the result of a test. The process that runs the test writes it as a JSON file,
 * RESULTS/NAME/result.json, beside the pictures that it names. `kiln test`, `kiln test approve` and
 * the reports read it. */
#ifndef KILN_SUITE_RESULT_H
#define KILN_SUITE_RESULT_H

#include "base/arena.h"
#include "base/text.h"
#include "kiln_program.h"
#include "suite/result_file.h"

enum { KILN_TEST_MAX_FRAMES = 1000, KILN_RESULT_MAX_ENTRIES = 1000 };

/* The rule that decided the verdict on a frame. */
enum kiln_judged_by {
    KILN_JUDGED_BY_NOTHING, /* no golden, nothing rendered, or repeated renders differ */
    KILN_JUDGED_BY_STATE,   /* the state hash differs: the simulation changed */
    KILN_JUDGED_BY_PIXELS,  /* the hash of the pixels was compared with the accepted one */
    KILN_JUDGED_BY_METRICS,
    KILN_JUDGED_BY_COUNT
};
/* Returns "nothing", "state", "pixels" or "metrics". */
const char *kiln_judged_by_name(enum kiln_judged_by judged_by);

/* The result of a frame. Texts are "" where there is nothing, and never NULL. The picture, the
 * reference and the error map are names of files in the result's folder, without '/'. */
struct kiln_result_frame {
    uint32_t number;
    enum kiln_test_status status;
    enum kiln_judged_by judged_by;
    const char *message;   /* the reason of the status, "" for a pass */
    const char *picture;   /* the rendered picture */
    const char *reference; /* a copy of the nearest golden; "" without one */
    const char *error_map; /* FLIP's, in magma; "" where it was not measured */
    const char *golden;    /* path of the golden itself, or the path where it would be */
    const char *state, *state_expected;   /* 16 hex digits; expected: "" if none was accepted */
    const char *pixels, *pixels_expected; /* SHA-256 of the decoded pixels */
    const char *kiln_expected;       /* the kiln that drew the accepted pixels; "" if not known */
    bool measured;                   /* the members below are valid */
    double values[KILN_MAX_COLUMNS]; /* in the order of the result's columns */
    bool beyond[KILN_MAX_COLUMNS];
    double score; /* 1 at the limits of the metrics; higher is worse */
    uint32_t worst_x, worst_y;
    uint32_t window_x, window_y, window_width, window_height, window_differing;
};

/* The words in a note that say that a limit is stale. A note is a text alone in result.json, so the
 * reports find such notes by these words. */
#define KILN_NOTE_STALE " is stale"

/* A key of the scene that has changed since the goldens were accepted. */
struct kiln_result_change {
    const char *key;            /* "systems.fire.emit.rate" */
    const char *before, *after; /* values as a scene would write them; "" without the key */
    const char *place; /* where the new value comes from: "fire.yaml:7", "default"; "": not known */
};

struct kiln_result {
    const char *name;   /* full name of the test, with its device */
    const char *test;   /* path of the test file or scene */
    const char *scene;  /* path of the scene */
    const char *about;  /* the test's own description */
    const char *golden; /* the folder of its goldens */
    enum kiln_test_status status;
    enum kiln_code code;     /* KILN_OK for pass, skip, warn and change, and only for these */
    const char *message;     /* one line: the error, or the message of the worst frame */
    const char *log;         /* file with the output of the test's process, or "" */
    const char *device;      /* GL renderer */
    const char *device_name; /* as in expect.yaml: "llvmpipe-llvm-15.0.6-256-bits" */
    const char *driver;      /* GL version and vendor */
    const char *platform;
    const char *techniques, *techniques_expected;
    const char *version; /* version of kiln, with its commit if known */
    bool pins_gl;        /* the test itself names a device or a technique of GL */
    uint32_t seed;
    uint32_t width, height;
    uint32_t threads, repeat;
    const char *scene_hash, *scene_hash_expected;
    const char *started; /* 2026-01-31T12:00:00Z */
    double total_s;
    double warn; /* a frame that passes with a higher score is a warning */
    bool hdr;
    const char *rerun, *approve; /* the commands: quoted for a shell, of checked parts */
    size_t column_count;
    struct kiln_compare_column columns[KILN_MAX_COLUMNS];
    size_t frame_count;
    struct kiln_result_frame *frames; /* ascending by number */
    size_t change_count;
    struct kiln_result_change *changes;
    size_t note_count;
    const char **notes; /* for people: stale limits, goldens written */
};

/* Initialise a result with its name and a frame with its number; other texts are "", numbers 0. */
void kiln_result_init(struct kiln_result *result, const char *name);
void kiln_result_frame_init(struct kiln_result_frame *frame, uint32_t number);

/* Returns the highest, that is the worst, score of the measured frames, or 0 without any. */
double kiln_result_score(const struct kiln_result *result);

/* Returns the index of the frame that a person should see first: among the frames of the worst
 * status, the one with the highest score. A frame that was not measured comes before them unless it
 * passed. Returns 0 without frames. */
size_t kiln_result_worst_frame(const struct kiln_result *result);

/* Writes FOLDER/result.json, whole or not at all; makes missing folders. KILN_IO. */
bool kiln_result_write(const struct kiln_result *result, const char *folder,
                       struct kiln_error *error);

/* Reads result.json of the place; all of it lies in the arena. NULL with KILN_INVALID_INPUT when
 * there is no such file, when it is no plain file below the folder of results, or when it is no
 * result of the place's name, with line and column. */
struct kiln_result *kiln_result_read(struct kiln_arena *arena,
                                     const struct kiln_result_place *place,
                                     struct kiln_error *error);

/* Reads the text of a result.json, which must end in a zero byte that size does not count; name
 * stands for the file in messages. */
struct kiln_result *kiln_result_parse(struct kiln_arena *arena, const char *text, size_t size,
                                      const char *name, struct kiln_error *error);

/* Adds the text of result.json. False when memory is short. */
bool kiln_result_print(const struct kiln_result *result, struct kiln_text *text);

/* Adds the members of result.json, except its version, to an open JSON object whose lines begin
 * with two spaces. An infinite value is written as null. If there are more changes or notes than
 * KILN_RESULT_MAX_ENTRIES, the last entry says how many are left out. */
void kiln_result_add_json(struct kiln_json *json, const struct kiln_result *result);

#endif
