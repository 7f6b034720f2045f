/* Declares the function that writes the data of a test for the report page, the HTML file of
 * `kiln test`.
 *
 * lib/report/html.c calls it for each test while it writes the page. The page's scripts
 * (lib/report/page) read the members of the object by their names. So a member may be added, but
 * one that is renamed or removed must be changed in the scripts, too. */
#ifndef KILN_REPORT_TEST_DATA_H
#define KILN_REPORT_TEST_DATA_H

#include "kiln_program.h"
#include "report/gallery.h"

/* Writes the test of that index as a JSON object. It is escaped for a <script> element, which the
 * caller opens and closes. The gallery says where the pictures of the test's frames are. */
void kiln_test_data_write(FILE *out, const struct kiln_results *results, size_t test,
                          const struct kiln_gallery *gallery);

#endif
