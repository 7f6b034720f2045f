/* Writes the reports that the tests of this folder check: `write_reports good FOLDER` and
 * `write_reports bad FOLDER` write the results of a run to FOLDER/out, and a report of the run in
 * each format to FOLDER. In the good run no test failed; the bad run has tests of every status. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "support/results.h"

int main(int argc, char **argv)
{
    struct kiln_error error = {0};
    const char *out = "out";
    if (argc != 3 || chdir(argv[2]) != 0)
        return KILN_USAGE;
    if (!test_write_run(out, strcmp(argv[1], "good") == 0, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return (int)error.code;
    }
    struct kiln_results *results = kiln_results_load(&out, 1, &error);
    static const char *const formats[] = {"junit", "json", "tap", "github"};
    for (size_t i = 0; results && i < sizeof formats / sizeof *formats; i++) {
        struct kiln_results_output output = {.format = formats[i], .path = formats[i]};
        if (!kiln_results_write(results, &output, &error))
            kiln_results_destroy(&results);
    }
    if (!results)
        fprintf(stderr, "%s\n", error.message);
    int code = results ? (int)kiln_results_summary(results).code : 100 + (int)error.code;
    kiln_results_destroy(&results);
    return code;
}
