/* Writes and runs one small golden test in the working directory, and changes its files, for tests
 * of lib/suite. The golden test draws two frames of a few sparks. */
#ifndef KILN_TESTS_SUITE_H
#define KILN_TESTS_SUITE_H

#include "kiln_program.h"
#include "suite/suite.h"

/* Path of the golden of frame 3, the first of the two frames. */
#define SPARK_GOLDEN "golden/spark/frame_0003.png"

/* Writes the golden test and its scene. Appends `more` to the file of the golden test. */
void spark_write(const char *more);

/* A run of the golden test, and its result. spark_end frees it. */
struct spark_run {
    struct kiln_arena *arena;
    struct kiln_suite *suite;
    struct kiln_test_summary summary;
    struct kiln_result *result; /* NULL unless `ok` */
    struct kiln_error error;
    bool ok; /* the run took place, whatever its result; else `error` is set */
};

/* Returns a suite of the golden test alone, which the caller destroys. */
struct kiln_suite *spark_suite(void);

/* Returns parameters for the device that KILN_TEST_DEVICE names, or else the default device. */
struct kiln_test_params spark_params(void);

/* Runs the golden test, with spark_params if params is NULL. The caller ends the run with
 * spark_end. */
struct spark_run spark_run(const struct kiln_test_params *params);

void spark_end(struct spark_run *run);

/* Returns whether one of the result's notes is this one, which is formatted as by printf. Prints
 * all notes if not. */
bool spark_has_note(const struct spark_run *run, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Runs the golden test. Fails unless its status is `status` and both frames were judged by
 * `judged_by`. Returns the number of notes. */
size_t spark_expect(const struct kiln_test_params *params, enum kiln_test_status status,
                    enum kiln_judged_by judged_by);

/* Runs the golden test so that it writes the goldens that `update` asks for. Fails unless it
 * passes. */
void spark_update(enum kiln_update update);

/* Adds `levels` to red, green and blue in a rectangle of an 8-bit PNG. Where a value would exceed
 * 255, subtracts them instead, so that every pixel of the rectangle changes by as much. */
void spark_paint(const char *path, uint32_t x0, uint32_t y0, uint32_t width, uint32_t height,
                 int levels);

/* Replaces the first occurrence of `from` in a file by `to`. Fails if there is none. */
void spark_replace(const char *path, const char *from, const char *to);

/* A group set-up for cmocka that ends the program as skipped if there is no device with GL. */
int spark_needs_device(void **state);

#endif
