/* Declares the tests of a run, which are found in folders and read from test files. */
#ifndef KILN_SUITE_SUITE_H
#define KILN_SUITE_SUITE_H

#include "base/arena.h"
#include "kiln_program.h"
#include "suite/result.h"

/* A picture format of goldens. */
enum kiln_test_format { KILN_TEST_PNG, KILN_TEST_PNG16, KILN_TEST_EXR };

/* The form in which accepted frames are kept. */
enum kiln_test_golden { KILN_GOLDEN_PICTURE, KILN_GOLDEN_HASH };

struct kiln_test_mask {
    uint32_t rect[4];    /* x, y, width, height */
    const char *picture; /* a path, or NULL: the rectangle */
    const char *reason;
};

/* A test, as its test file describes it. A scene that is a test by itself has the defaults. Paths
 * can be opened as they are. */
struct kiln_test {
    const char *name;          /* without a device */
    const char *full_name;     /* with "@device" where the test names several */
    const char *path;          /* the test file, or the scene itself */
    const char *results;       /* RESULTS/FULL_NAME */
    const char *golden;        /* GOLDEN/NAME */
    struct kiln_error problem; /* a fault of the test file; then the members below may be wrong */
    const char *scene;
    const char *about;
    const char **overrides; /* "key=value" */
    size_t override_count;
    uint32_t *frames; /* ascending; none: the middle and the last one of the scene */
    size_t frame_count;
    enum kiln_test_format format;
    enum kiln_test_golden golden_form;
    const char *device;      /* as in kiln_device_params; NULL: the run's device */
    bool may_skip;           /* the device may be absent: the test is skipped then */
    const char **techniques; /* "stage=name"; they override those that every test pins */
    size_t technique_count;
    const char **limits; /* "metric=value"; none: the default ones */
    size_t limit_count;
    const char *limits_reason;
    double warn;      /* a score */
    double threshold; /* levels */
    uint32_t window;  /* pixels */
    struct kiln_test_mask *masks;
    size_t mask_count;
    double time_limit_s;
};

struct kiln_suite {
    struct kiln_arena *arena;
    struct kiln_test *tests;
    size_t count;
    uint32_t shard, shards;     /* as requested; 0 and 0: all tests */
    size_t all_count;           /* count of the tests of all shards */
    const char **name_prefixes; /* prefixes of the names of tests in the searched folders */
    size_t name_prefix_count;
    const char **unused; /* folders of goldens that no test uses */
    size_t unused_count, unused_capacity;
    char *results_folder;
    bool is_found_by_name; /* the working directory alone was searched, as by default */
};

#endif
