/* Writes and runs one small golden test, named spark, in the working directory, and changes its
 * files, for tests of lib/suite, which runs golden tests. The golden test draws frames 3 and 5 of a
 * few sparks. */
#ifndef KILN_TESTS_SUITE_H
#define KILN_TESTS_SUITE_H

#include "kiln_program.h"
#include "suite/suite.h"

/* Path of the golden picture of frame 3, the first of the two frames. */
#define SPARK_GOLDEN "golden/spark/frame_0003.png"

/* Writes the golden test and its scene. Appends `more`, lines of YAML, to the file of the golden
 * test. */
void spark_write(const char *more);

/* Holds a run of the golden test and its result. spark_end frees it. */
struct spark_run {
    struct kiln_arena *arena;
    struct kiln_suite *suite;
    struct kiln_test_summary summary;
    struct kiln_result *result; /* NULL unless `ok` */
    struct kiln_error error;
    bool ok; /* true: the run took place, whatever its result; false: `error` is set */
};

/* Returns a suite of the golden test alone, which the caller destroys. */
struct kiln_suite *spark_suite(void);

/* Returns parameters for the device that KILN_TEST_DEVICE names, or else the default device. */
struct kiln_test_params spark_params(void);

/* Runs the golden test, with spark_params if params is NULL. The caller ends the run with
 * spark_end. */
struct spark_run spark_run(const struct kiln_test_params *params);

void spark_end(struct spark_run *run);

/* Returns whether one of the result's notes equals a text that is formatted as by printf. If no
 * note does, prints all notes. */
bool spark_has_note(const struct spark_run *run, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Runs the golden test, with spark_params if params is NULL. Fails unless its status is `status`
 * and both frames were judged by `judged_by`. Returns the number of notes. */
size_t spark_expect(const struct kiln_test_params *params, enum kiln_test_status status,
                    enum kiln_judged_by judged_by);

/* Runs the golden test so that it writes the goldens that `update` asks for. Fails unless it
 * passes. */
void spark_update(enum kiln_update update);

/* Adds `levels` to red, green and blue in a rectangle, px, of an 8-bit PNG. Subtracts them from a
 * value that would exceed 255, so that all values of the rectangle change by as much. */
void spark_paint(const char *path, uint32_t x0, uint32_t y0, uint32_t width, uint32_t height,
                 int levels);

/* Replaces the first occurrence of `from` in a file by `to`. Fails if there is none. */
void spark_replace(const char *path, const char *from, const char *to);

/* A group set-up for cmocka that ends the program as skipped if there is no device with GL. */
int spark_needs_device(void **state);

#endif
