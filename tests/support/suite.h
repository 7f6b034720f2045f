/* A folder with one small test, which is run again and again. */
#ifndef KILN_TESTS_SUITE_H
#define KILN_TESTS_SUITE_H

#include "kiln_program.h"
#include "suite/suite.h"

#define SPARK_GOLDEN "golden/spark/frame_0003.png"

void spark_write(const char *more);

/* A run and its result. */
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

/* params NULL: the defaults. End it with spark_end. */
struct spark_run spark_run(const struct kiln_test_params *params);

void spark_end(struct spark_run *run);
bool spark_has_note(const struct spark_run *run, const char *part);

/* Runs, expecting that status and, of every frame, that judge; returns the notes' number. */
size_t spark_expect(const struct kiln_test_params *params, enum kiln_test_status status,
                    enum kiln_judged_by judged_by);

void spark_update(enum kiln_update update);

/* Makes every channel of a box of a PNG lighter by some levels. */
void spark_paint(const char *path, uint32_t x0, uint32_t y0, uint32_t width, uint32_t height,
                 int levels);

/* Replaces the first `from` in a file. */
void spark_replace(const char *path, const char *from, const char *to);

/* Ends the program as skipped when there is no device. */
int spark_needs_device(void **state);

#endif
