/* Declares golden-image tests and their reports. This header is part of kiln_program.h, which
 * includes it. */
#ifndef KILN_TEST_H
#define KILN_TEST_H

#include "kiln_program.h"

/* A test renders frames of a scene and judges them by what was once accepted: the state hash, then
 * the hash of the decoded pixels, then the metrics (docs/testing.md). A suite is a list of tests; a
 * test runs alone, so that a program can give each a process of its own:
 *
 *     suite = kiln_suite_load(&params, &error);
 *     kiln_suite_begin(suite, &error);
 *     for (size_t i = 0; i < kiln_suite_count(suite); i++)
 *         kiln_test_run(suite, i, &KILN_TEST_DEFAULTS, &summary, &error);
 *     kiln_suite_write_run(suite, seconds, &error);
 *     results = kiln_results_load(&folder, 1, &error);
 *     kiln_results_write(results, &(struct kiln_results_output){"junit", "junit.xml"}, &error);
 */

/* Ordered: of several, the last counts. */
enum kiln_test_status {
    KILN_TEST_PASS,
    KILN_TEST_SKIP,   /* not for any device of this machine */
    KILN_TEST_WARN,   /* within the limits, beyond the warn level */
    KILN_TEST_CHANGE, /* within the limits, but other pixels than were accepted on this device */
    KILN_TEST_NEW,    /* a golden is missing */
    KILN_TEST_FAIL,   /* the state or a picture differs */
    KILN_TEST_ERROR,  /* nothing that could be judged: the scene, the device, a crash, a hang */
    KILN_TEST_STATUS_COUNT
};

const char *kiln_test_status_name(enum kiln_test_status status);

struct kiln_suite;

struct kiln_suite_params {
    const char *const *paths; /* tests (*.test.yaml), scenes, and folders of both; at least one */
    size_t path_count;
    const char *const *names; /* of the tests to take, or shell patterns of them; 0 takes all */
    size_t name_count;
    const char *golden;     /* the folder of the goldens: GOLDEN/TEST/frame_0024.png */
    const char *results;    /* another, for results: RESULTS/TEST/result.json and pictures */
    const char *asset_root; /* the folder that scenes of test files must lie in; NULL: the working
                             * directory or, of a test outside it, the folder that was given */
    uint32_t shard, shards; /* the shard-th test (from 1) and each shards-th after it; 0, 0: all */
};
static inline struct kiln_suite_params kiln_suite_defaults(void)
{
    return (struct kiln_suite_params){.golden = "golden", .results = "out/test"};
}

/* Finds and reads the tests, ordered by name; no scene is loaded yet. A test file that is wrong is
 * no error here but that of its test. NULL with KILN_USAGE (a path that does not exist, a folder
 * without a test, a name that no test has, two tests of one name, shard 4 of 3), KILN_IO, or
 * KILN_DEVICE_FAILED when memory is short. */
struct kiln_suite *kiln_suite_load(const struct kiln_suite_params *params,
                                   struct kiln_error *error);
void kiln_suite_destroy(struct kiln_suite **suite);
size_t kiln_suite_count(const struct kiln_suite *suite);

/* Prepares the folder of results: removes what an earlier run of these tests left there, as far as
 * kiln wrote it and nobody changed it since. Makes the folder where there is none. KILN_USAGE, and
 * nothing is removed, when it has contents and no list of what kiln wrote (.kiln-results), or when
 * there is a file where a test would write one that is not listed or was changed. KILN_IO. */
bool kiln_suite_begin(const struct kiln_suite *suite, struct kiln_error *error);

/* Declares what a run of the tests reads (test files, scenes and what they name, masks, goldens)
 * and the files of its results. */
bool kiln_suite_claim(const struct kiln_suite *suite, struct kiln_claims *claims,
                      struct kiln_error *error);

struct kiln_test_info {
    const char *name;    /* "effects/fire", and "effects/fire@nvidia" where it names devices */
    const char *path;    /* of the test file or scene */
    const char *results; /* RESULTS/NAME, where its result goes */
    double time_limit_s;
};

/* The texts belong to the suite. */
struct kiln_test_info kiln_suite_test(const struct kiln_suite *suite, size_t index);
/* Folders of goldens that no test uses; none unless all tests of folders are asked for. */
const char *const *kiln_suite_unused(const struct kiln_suite *suite, size_t *count);

/* The keys of a test file, for people. */
bool kiln_test_write_reference(FILE *out);

enum kiln_update {
    KILN_UPDATE_NONE,
    KILN_UPDATE_MISSING, /* write goldens that do not exist */
    KILN_UPDATE_FAILED,  /* and replace those of frames that fail, or that cannot be decoded */
    KILN_UPDATE_ALL,     /* and those of frames that pass */
};

struct kiln_test_params {
    const char *device;            /* as in kiln_device_params, where the test names none */
    const char *const *techniques; /* "stage=name", over those that the test pins */
    size_t technique_count;
    uint32_t threads; /* 0 takes one a core */
    uint32_t repeat;  /* renders, all of which must have the same hashes; at least 1 */
    enum kiln_update update;
    bool dry_run;        /* say what an update would write, and write it not */
    bool ignore_hashes;  /* judge by the metrics alone */
    bool strict;         /* where pixels are known, or made by `cpu`, only these pass */
    const char *build;   /* the caller's "0.2.0 (254e4dc)", for what is accepted; NULL: a version */
    const char *against; /* a kiln program that draws the accepted side; NULL: goldens are that */
    bool (*stop)(void *user); /* asked between frames */
    void *user;
    struct kiln_log log;
};
static inline struct kiln_test_params kiln_test_defaults(void)
{
    return (struct kiln_test_params){.repeat = 1};
}

struct kiln_test_summary {
    enum kiln_test_status status;
    enum kiln_code code; /* what it means for an exit code */
    char name[256];
    char message[KILN_MESSAGE_SIZE]; /* of its worst frame; a cause unless it passed */
    uint32_t frames, notes;          /* notes: of stale limits, goldens written, ... */
    double score;                    /* the worst of its frames: 1 is just within its limits */
    double total_s;
};

/* Renders and judges one test, updates goldens as told, and writes its result, whatever it is. A
 * test that fails is no error here: false with KILN_INTERRUPTED, or for an unwritable result. */
bool kiln_test_run(const struct kiln_suite *suite, size_t index,
                   const struct kiln_test_params *params, struct kiln_test_summary *summary,
                   struct kiln_error *error);

/* Writes the result of a test whose process crashed (code KILN_DEVICE_FAILED) or ran too long. */
bool kiln_test_record_error(const struct kiln_suite *suite, size_t index, enum kiln_code code,
                            const char *message, double total_s, struct kiln_error *error);

/* Reads the result that a run of the test wrote, here or in another process. */
bool kiln_test_read_summary(const struct kiln_suite *suite, size_t index,
                            struct kiln_test_summary *summary, struct kiln_error *error);

/* A note of a result, for people: "limit flip.mean=0.3 is stale: ...". index below notes. */
bool kiln_test_read_note(const struct kiln_suite *suite, size_t index, uint32_t note,
                         char text[KILN_MESSAGE_SIZE], struct kiln_error *error);

/* Accepts pictures of the results as goldens. */
enum kiln_approve_as {
    KILN_APPROVE_REPLACE,     /* in place of the golden that the picture was judged by */
    KILN_APPROVE_DEVICE,      /* for devices of this name only, beside the default */
    KILN_APPROVE_ALTERNATIVE, /* as one more picture that is right */
};
struct kiln_approve_params {
    const char *results; /* the folder of the results */
    const char *name;    /* of the test */
    enum kiln_approve_as as;
    const char *device;        /* only what a device drew whose name has this in it; NULL: any */
    bool dry_run, one_of_many; /* one of many: what was skipped is passed over */
    void (*change)(void *user, const char *line); /* told of each file: "wrote golden/..." */
    void *user;
};

/* Of frames that are new, fail, change or draw a warning. KILN_USAGE with the nearest name when
 * there is no such result, KILN_INVALID_INPUT when it has no pictures (an error), or when the
 * scene, the pictures or the goldens have changed since, KILN_IO. */
bool kiln_test_approve(const struct kiln_approve_params *params, struct kiln_error *error);

/* Measures how pictures of a test differ for reasons that nobody means, and proposes limits. */
struct kiln_calibrate_params {
    const char *const *devices; /* 0: the default one */
    size_t device_count;
    uint32_t renders;    /* each with other threads and techniques; at least 2 */
    double margin;       /* proposed: the worst value times this; at least 1 */
    bool write;          /* into expect.yaml, with the values */
    const char *scratch; /* a folder for pictures that are removed again */
    void (*render)(void *user, const char *line); /* told of each: "threads=2 simulate=inplace" */
    bool (*stop)(void *user);
    void *user;
    struct kiln_log log;
};
static inline struct kiln_calibrate_params kiln_calibrate_defaults(void)
{
    return (struct kiln_calibrate_params){.renders = 8, .margin = 3, .scratch = "/tmp"};
}

struct kiln_calibration {
    size_t count;
    struct kiln_calibrated {
        char metric[KILN_METRIC_NAME_SIZE];
        double now, proposed;    /* the limit in force, and another */
        double worst;            /* measured */
    } metrics[KILN_MAX_COLUMNS]; /* those that have limits */
    uint32_t renders;
    bool equal; /* all of them to the bit */
};
bool kiln_test_calibrate(const struct kiln_suite *suite, size_t index,
                         const struct kiln_calibrate_params *params,
                         struct kiln_calibration *calibration, struct kiln_error *error);

/* Ends a run that kiln_suite_begin began: writes RESULTS/run.json, which tells what tests it
 * consisted of, and the list of what kiln wrote there. Tests without a result are errors. */
bool kiln_suite_write_run(const struct kiln_suite *suite, double total_s, struct kiln_error *error);

/* The results of a run, or of several that were shards of one. */
struct kiln_results;

/* KILN_INVALID_INPUT when a folder has no run.json, or something in it is broken. */
struct kiln_results *kiln_results_load(const char *const *folders, size_t folder_count,
                                       struct kiln_error *error);

/* The same where no shard may be missing: in place of the tests of such ones is an error of code
 * KILN_INVALID_INPUT, named "shard 2 of 4" or "shards 2-4 of 4". */
struct kiln_results *kiln_results_load_whole(const char *const *folders, size_t folder_count,
                                             struct kiln_error *error);
void kiln_results_destroy(struct kiln_results **results);

struct kiln_results_summary {
    uint32_t tests;
    uint32_t counts[KILN_TEST_STATUS_COUNT];
    struct kiln_results_frames { /* by what judged them */
        uint32_t all, by_pixels, by_metrics, by_state;
    } frames, gl_frames; /* gl: of tests that pin a device or technique of GL */
    enum kiln_code code; /* that of the worst test */
    double total_s;
    uint32_t missing_shard, shards; /* the first that is not there, of how many; 0: all are */
};
struct kiln_results_summary kiln_results_summary(const struct kiln_results *results);

/* "67 frames: 66 by pixels, 1 by metrics", without the end of a line. */
bool kiln_write_frames(FILE *out, const struct kiln_results_summary *summary);

/* The name of a test, which belongs to the results; index below the summary's `tests`. */
const char *kiln_results_name(const struct kiln_results *results, size_t index);

/* Adds to an open object what the report `json` has of the run, and of a test; index as above. */
void kiln_results_add_head(struct kiln_json *json, const struct kiln_results *results);
void kiln_results_add_test(struct kiln_json *json, const struct kiln_results *results,
                           size_t index);

/* Of two codes the worse: a device that failed, then input and output, no device, invalid input,
 * usage, a picture that differs, a missing golden, ok; being interrupted comes before all. */
enum kiln_code kiln_code_worse(enum kiln_code a, enum kiln_code b);

struct kiln_results_output {
    const char *format; /* "junit", "json", "tap", "github" or "html" */
    const char *path;   /* "-" is standard output */
    bool link;          /* html: refer to pictures by their paths, instead of holding them */
    bool overwrite;     /* whatever is there; else only such a report of kiln's is replaced */
};

/* Declares the files of results that were loaded from these folders as read. */
bool kiln_results_claim_inputs(const struct kiln_results *results, const char *const *folders,
                               size_t folder_count, struct kiln_claims *claims,
                               struct kiln_error *error);

/* Declares the file of a report, before the run. KILN_USAGE when something else is there. */
bool kiln_results_claim(const struct kiln_results_output *output, struct kiln_claims *claims,
                        struct kiln_error *error);

/* Writes a report. KILN_USAGE for another format, KILN_IO. */
bool kiln_results_write(const struct kiln_results *results,
                        const struct kiln_results_output *output, struct kiln_error *error);

/* The formats of reports and what each is for, for people. */
bool kiln_write_reports(FILE *out);

#endif
