/* Declares functions that write what several formats of reports say in the same way. */
#ifndef KILN_REPORT_TEXT_H
#define KILN_REPORT_TEXT_H

#include "kiln_program.h"
#include "report/report.h"

/* The most frames of a test that did not pass and that a report lists one by one. */
enum { KILN_REPORT_MAX_FRAMES = 20 };

/* Writes a value to four digits, such as "0.0153", or "inf". The point is '.' in any locale. */
void kiln_report_text_number(char out[32], double value);

/* Writes seconds to the millisecond: "12.345". */
void kiln_report_text_seconds(char out[32], double seconds);

/* Writes a summary: "7 tests: 3 pass, 1 fail, 3 error; in 12.345 s". */
void kiln_report_text_summary(char out[256], const struct kiln_results *results);

/* Finds the worst value of a column over the frames that were measured; false without any. */
bool kiln_report_worst_value(const struct kiln_result *result, size_t column, double *value);

#endif
