/* Declares golden-image tests and their reports. This header is part of kiln_program.h, which
 * includes it. */
#ifndef KILN_TEST_H
#define KILN_TEST_H

#include "kiln_program.h"

/* A test renders frames of a scene and compares them with accepted ones: first the state hash, then
 * the hash of the decoded pixels, then the metrics (docs/testing.md). A suite is a list of tests.
 * Each test runs alone, so that a program can give it a process of its own:
 *
 *     suite = kiln_suite_load(&params, &error);
 *     kiln_suite_begin(suite, &error);
 *     for (size_t i = 0; i < kiln_suite_count(suite); i++)
 *         kiln_test_run(suite, i, &KILN_TEST_DEFAULTS, &summary, &error);
 *     kiln_suite_write_run(suite, seconds, &error);
 *     results = kiln_results_load(&folder, 1, &error);
 *     kiln_results_write(results, &(struct kiln_results_output){"junit", "junit.xml"}, &error);
 */

/* The status of a frame or a test, from good to bad. A test has the worst status of its frames. */
enum kiln_test_status {
    KILN_TEST_PASS,
    KILN_TEST_SKIP,   /* no device of this machine is one that the test is for */
    KILN_TEST_WARN,   /* within the limits, but beyond the warn level */
    KILN_TEST_CHANGE, /* within the limits, but other pixels than were accepted on this device */
    KILN_TEST_NEW,    /* a golden is missing */
    KILN_TEST_FAIL,   /* the state or a picture differs */
    KILN_TEST_ERROR,  /* nothing could be judged: a wrong scene, no device, a crash or a hang */
    KILN_TEST_STATUS_COUNT
};

const char *kiln_test_status_name(enum kiln_test_status status);

struct kiln_suite;

struct kiln_suite_params {
    const char *const *paths; /* tests (*.test.yaml), scenes, and folders of both; at least one */
    size_t path_count;
    const char *const *names; /* names or shell patterns of the tests to take; none takes all */
    size_t name_count;
    const char *golden;     /* the folder of the goldens: GOLDEN/TEST/frame_0024.png */
    const char *results;    /* the folder of results: RESULTS/TEST/result.json and pictures */
    const char *asset_root; /* the folder that scenes of test files must lie in; NULL: the working
                             * directory or, for a test outside it, the folder in `paths` */
    uint32_t shard, shards; /* take the shard-th test (from 1) and each shards-th after it; both 0:
                             * take all */
};
static inline struct kiln_suite_params kiln_suite_defaults(void)
{
    return (struct kiln_suite_params){.golden = "golden", .results = "out/test"};
}

/* Finds and reads the tests, ordered by name; no scene is loaded yet. A wrong test file is no error
 * here: its test gives that error when it runs. Returns NULL with KILN_USAGE (a path that does not
 * exist, a folder without a test, a name that no test has, two tests of one name, shard 4 of 3),
 * KILN_IO, or KILN_DEVICE_FAILED when memory is short. */
struct kiln_suite *kiln_suite_load(const struct kiln_suite_params *params,
                                   struct kiln_error *error);
void kiln_suite_destroy(struct kiln_suite **suite);
size_t kiln_suite_count(const struct kiln_suite *suite);

/* Prepares the folder of results, which is made if it is missing. Removes the files that an earlier
 * run of these tests wrote there and that have not changed since. Removes nothing and returns false
 * with KILN_USAGE when the folder has files but no list of results (.kiln-results), or when a file
 * that a test would write is there and is not in the list or has changed. KILN_IO. */
bool kiln_suite_begin(const struct kiln_suite *suite, struct kiln_error *error);

/* Declares the files that a run of the tests reads (test files, scenes and their assets, masks,
 * goldens) and the files of results that it writes. Errors are those of kiln_claims_write. */
bool kiln_suite_claim(const struct kiln_suite *suite, struct kiln_claims *claims,
                      struct kiln_error *error);

struct kiln_test_info {
    const char *name;    /* "effects/fire", or "effects/fire@nvidia" if the test names devices */
    const char *path;    /* path of the test file or scene */
    const char *results; /* RESULTS/NAME, the folder of its result */
    double time_limit_s;
};

/* Returns facts of the test of an index below kiln_suite_count. The texts belong to the suite. */
struct kiln_test_info kiln_suite_test(const struct kiln_suite *suite, size_t index);
/* Returns the folders of goldens that no test uses, which belong to the suite. There are none
 * unless the suite has all tests of folders. */
const char *const *kiln_suite_unused(const struct kiln_suite *suite, size_t *count);

/* Writes the reference of the keys of a test file, for people. Returns false when that fails. */
bool kiln_test_write_reference(FILE *out);

/* Which goldens a run of a test writes. Each value includes the ones before it. */
enum kiln_update {
    KILN_UPDATE_NONE,
    KILN_UPDATE_MISSING, /* write goldens that do not exist */
    KILN_UPDATE_FAILED, /* replace goldens of frames that fail, and goldens that are not readable */
    KILN_UPDATE_ALL,    /* replace goldens of frames that pass */
};

struct kiln_test_params {
    const char *device;            /* as kiln_device_params.wanted, if the test names no device */
    const char *const *techniques; /* "stage=name"; they replace those that the test pins */
    size_t technique_count;
    uint32_t threads; /* 0 takes one a core */
    uint32_t repeat;  /* number of renders, which must all have the same hashes; at least 1 */
    enum kiln_update update;
    bool dry_run;        /* note what an update would write, but do not write it */
    bool ignore_hashes;  /* judge by the metrics alone */
    bool strict;         /* where the device's pixels were accepted, or the device is `cpu`, only
                            equal pixels pass */
    const char *build;   /* the program's version and commit, "0.2.0 (254e4dc)", which is recorded
                            with accepted frames; NULL: kiln_version() */
    const char *against; /* path of a kiln program that draws the reference; NULL: goldens are it */
    bool (*stop)(void *user); /* called between frames; true ends with KILN_INTERRUPTED */
    void *user;
    struct kiln_log log;
};
static inline struct kiln_test_params kiln_test_defaults(void)
{
    return (struct kiln_test_params){.repeat = 1};
}

struct kiln_test_summary {
    enum kiln_test_status status;
    enum kiln_code code; /* the exit code that the status stands for */
    char name[256];
    char message[KILN_MESSAGE_SIZE]; /* the cause of the worst frame's status */
    uint32_t frames, notes;          /* number of frames; number of notes (kiln_test_read_note) */
    double score;                    /* the highest of its frames: up to 1 is within the limits */
    double total_s;
};

/* Renders and judges one test, updates goldens as params->update says, and writes the result,
 * whatever it is. A test that fails is no error here: returns false only with KILN_INTERRUPTED, or
 * when the result cannot be written. */
bool kiln_test_run(const struct kiln_suite *suite, size_t index,
                   const struct kiln_test_params *params, struct kiln_test_summary *summary,
                   struct kiln_error *error);

/* Writes the result of a test whose own process could not: one that crashed (code
 * KILN_DEVICE_FAILED) or ran too long. */
bool kiln_test_record_error(const struct kiln_suite *suite, size_t index, enum kiln_code code,
                            const char *message, double total_s, struct kiln_error *error);

/* Reads the result that a run of the test wrote, in this process or another. */
bool kiln_test_read_summary(const struct kiln_suite *suite, size_t index,
                            struct kiln_test_summary *summary, struct kiln_error *error);

/* Reads a note of a result, for people: "limit flip.mean=0.3 is stale: ...". `note` is below the
 * summary's `notes`. */
bool kiln_test_read_note(const struct kiln_suite *suite, size_t index, uint32_t note,
                         char text[KILN_MESSAGE_SIZE], struct kiln_error *error);

/* How a picture of the results is accepted as a golden. */
enum kiln_approve_as {
    KILN_APPROVE_REPLACE,     /* in place of the golden that the picture was judged by */
    KILN_APPROVE_DEVICE,      /* for devices of this name only, beside the default golden */
    KILN_APPROVE_ALTERNATIVE, /* as one more golden, any of which a picture may match */
};
struct kiln_approve_params {
    const struct kiln_suite *suite; /* has the test and the folders of goldens and results */
    const char *name;               /* full name of the test */
    enum kiln_approve_as as;
    const char *device;        /* approve only results of a device whose name contains this; NULL:
                                  of any device */
    bool dry_run, one_of_many; /* write nothing; ignore a skipped test, since others are approved */
    void (*change)(void *user, const char *line); /* called for each file: "wrote golden/..." */
    void *user;
};

/* Approves the frames of a result that are new, fail, change or draw a warning. The result may come
 * from a stranger: what is written, and where, follows from the suite, and the result must agree
 * with it. KILN_USAGE with the nearest name when there is no result of this name, or when the suite
 * does not have the test; KILN_INVALID_INPUT when the result has no pictures, or when the test, the
 * scene, the pictures or the goldens are others than in the run; KILN_IO. */
bool kiln_test_approve(const struct kiln_approve_params *params, struct kiln_error *error);

/* How limits are calibrated. Calibration renders a test with several devices, threads and
 * techniques, measures how the pictures differ, and proposes limits that allow this difference. */
struct kiln_calibrate_params {
    const char *const *devices; /* as kiln_device_params.wanted; none: the default device */
    size_t device_count;
    uint32_t renders;    /* number of renders, each with other threads and techniques; at least 2 */
    double margin;       /* factor of the worst value that is proposed as a limit; at least 1 */
    bool write;          /* write the limits into expect.yaml, with the measured values */
    const char *scratch; /* a folder for pictures, which are removed again */
    /* Called before each render with its settings: "threads=2 simulate=inplace". */
    void (*render)(void *user, const char *line);
    bool (*stop)(void *user); /* true ends with KILN_INTERRUPTED */
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
        double now, proposed;    /* the limit in force, and the proposed one */
        double worst;            /* the worst value of all renders */
    } metrics[KILN_MAX_COLUMNS]; /* metrics with a limit; `count` of them */
    uint32_t renders;
    bool equal; /* all renders have the same bits */
};

/* Calibrates the limits of a test. Returns false with an error of rendering or comparing, KILN_IO
 * or KILN_INTERRUPTED. */
bool kiln_test_calibrate(const struct kiln_suite *suite, size_t index,
                         const struct kiln_calibrate_params *params,
                         struct kiln_calibration *calibration, struct kiln_error *error);

/* Ends a run that kiln_suite_begin began: writes RESULTS/run.json, which names the tests of the
 * run, and the list of the files that kiln wrote there. A test without a result counts as an error.
 */
bool kiln_suite_write_run(const struct kiln_suite *suite, double total_s, struct kiln_error *error);

/* The results of a run, or of several runs that were shards of one. */
struct kiln_results;

/* Reads the results in these folders, one a shard. Returns results that the caller destroys, or
 * NULL with KILN_INVALID_INPUT when a folder has no run.json or a broken file. */
struct kiln_results *kiln_results_load(const char *const *folders, size_t folder_count,
                                       struct kiln_error *error);

/* Does what kiln_results_load does, and counts missing shards as errors: a missing shard gives, in
 * place of its tests, one named "shard 2 of 4" or "shards 2-4 of 4" with code KILN_INVALID_INPUT.
 */
struct kiln_results *kiln_results_load_whole(const char *const *folders, size_t folder_count,
                                             struct kiln_error *error);
void kiln_results_destroy(struct kiln_results **results);

struct kiln_results_summary {
    uint32_t tests;
    uint32_t counts[KILN_TEST_STATUS_COUNT];
    struct kiln_results_frames { /* numbers of frames by how they were judged */
        uint32_t all, by_pixels, by_metrics, by_state;
    } frames, gl_frames; /* gl_frames: of tests that pin a device or technique of GL */
    enum kiln_code code; /* the code of the worst test */
    double total_s;
    uint32_t missing_shard, shards; /* the first missing shard and the number of shards; 0: none */
};
struct kiln_results_summary kiln_results_summary(const struct kiln_results *results);

/* Writes the numbers of frames, "67 frames: 66 by pixels, 1 by metrics", without a newline. Returns
 * false when that fails. */
bool kiln_write_frames(FILE *out, const struct kiln_results_summary *summary);

/* Returns the name of a test, which belongs to the results. `index` is below the summary's `tests`.
 */
const char *kiln_results_name(const struct kiln_results *results, size_t index);

/* Add to an open object the members that the report `json` has for the run, or for the test of an
 * index below the summary's `tests`. */
void kiln_results_add_head(struct kiln_json *json, const struct kiln_results *results);
void kiln_results_add_test(struct kiln_json *json, const struct kiln_results *results,
                           size_t index);

/* Returns the worse of two codes. From the worst on, the codes are: interrupted, a failed device,
 * over a limit, input and output, no device, invalid input, usage, a picture that differs, a
 * missing golden, a reader that went away, ok. */
enum kiln_code kiln_code_worse(enum kiln_code a, enum kiln_code b);

struct kiln_results_output {
    const char *format; /* "junit", "json", "tap", "github" or "html" */
    const char *path;   /* "-" is standard output */
    bool link;          /* html: refer to pictures by their paths, instead of holding them */
    bool overwrite; /* replace any file; else only a report of this format by kiln is replaced */
};

/* Declares the files that results were loaded from, in these folders, as read. */
bool kiln_results_claim_inputs(const struct kiln_results *results, const char *const *folders,
                               size_t folder_count, struct kiln_claims *claims,
                               struct kiln_error *error);

/* Declares the file of a report as written, before the run. KILN_USAGE when a file is there that
 * the report may not replace. */
bool kiln_results_claim(const struct kiln_results_output *output, struct kiln_claims *claims,
                        struct kiln_error *error);

/* Writes a report. KILN_USAGE for an unknown format, KILN_IO. */
bool kiln_results_write(const struct kiln_results *results,
                        const struct kiln_results_output *output, struct kiln_error *error);

/* Writes the formats of reports and their purposes, for people. Returns false when that fails. */
bool kiln_write_reports(FILE *out);

#endif
