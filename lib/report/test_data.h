/* Writes what the report page's script reads of a test. */
#ifndef KILN_REPORT_TEST_DATA_H
#define KILN_REPORT_TEST_DATA_H

#include "kiln_program.h"
#include "report/gallery.h"

/* Writes a test as a JSON object, for a <script> element. */
void kiln_test_data_write(FILE *out, const struct kiln_results *results, size_t test,
                          const struct kiln_gallery *gallery);

#endif
