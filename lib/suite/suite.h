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

/* A test, as a test file says or, for a scene that is a test by itself, by the defaults. Paths can
 * be opened as they are. */
struct kiln_test {
    const char *name;          /* without a device */
    const char *full_name;     /* with "@device" where the test names several */
    const char *path;          /* of the file that makes it a test */
    const char *results;       /* RESULTS/FULL_NAME */
    const char *golden;        /* GOLDEN/NAME */
    struct kiln_error problem; /* the test file is wrong: what follows means nothing */
    const char *scene;
    const char *about;
    const char **overrides; /* "key=value" */
    size_t override_count;
    uint32_t *frames; /* ascending; none: the middle and the last one of the scene */
    size_t frame_count;
    enum kiln_test_format format;
    enum kiln_test_golden kept;
    const char *device;      /* wanted, or NULL: that of the run */
    bool may_skip;           /* the device may be absent: the test is skipped then */
    const char **techniques; /* "stage=name", over those that every test pins */
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
    uint32_t shard, shards; /* as asked for; 0 and 0: all tests */
    size_t all_count;       /* tests of all shards */
    const char **starts;    /* how names of tests start in the folders that were searched */
    size_t start_count;
    const char **unused; /* folders of goldens */
    size_t unused_count, unused_capacity;
    char *results_folder;
};

#endif
