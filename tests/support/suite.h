/* Writes, runs and changes one small golden test, in the working directory of a test of suites. */
#ifndef KILN_TESTS_SUITE_H
#define KILN_TESTS_SUITE_H

#include "kiln_program.h"
#include "suite/suite.h"

#define SPARK_GOLDEN "golden/spark/frame_0003.png"

/* Writes the test and its scene; `more` is appended to the test file. */
void spark_write(const char *more);

/* A run of the test and its result. */
struct spark_run {
    struct kiln_arena *arena;
    struct kiln_suite *suite;
    struct kiln_test_summary summary;
    struct kiln_result *result;
    struct kiln_error error;
    bool ok;
};

struct kiln_suite *spark_suite(void);
struct kiln_test_params spark_params(void);

/* Runs the test, with spark_params if params is NULL. Call spark_end for the result. */
struct spark_run spark_run(const struct kiln_test_params *params);

void spark_end(struct spark_run *run);
bool spark_has_note(const struct spark_run *run, const char *part);

/* Runs the test, and fails unless it has this status and all its frames were judged so. Returns the
 * number of notes. */
size_t spark_expect(const struct kiln_test_params *params, enum kiln_test_status status,
                    enum kiln_judged_by judged_by);

void spark_update(enum kiln_update update);

/* Makes red, green and blue in a rectangle of a PNG lighter by some levels; darker where they would
 * exceed 255. */
void spark_paint(const char *path, uint32_t x0, uint32_t y0, uint32_t width, uint32_t height,
                 int levels);

/* Replaces the first occurrence of `from` in a file. */
void spark_replace(const char *path, const char *from, const char *to);

/* A group set-up that ends the program as skipped when there is no device with GL. */
int spark_needs_device(void **state);

#endif
