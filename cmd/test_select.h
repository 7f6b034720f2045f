/* Finds the tests that a command line selects, by the operands and options that `kiln test` shares
 * with `kiln test calibrate` and `kiln test list`. */
#ifndef KILN_CMD_TEST_SELECT_H
#define KILN_CMD_TEST_SELECT_H

#include "options.h"

#define DEFAULT_RESULTS "out/test"

#define GOLDEN_OPTION                                                                              \
    {                                                                                              \
        .name = "golden", .kind = OPTION_TEXT, .placeholder = "FOLDER",                            \
        .help = "Folder of the goldens: FOLDER/TEST/frame_0024.png.", .fallback = "golden"         \
    }
#define RESULTS_OPTION                                                                             \
    {                                                                                              \
        .name = "results", .older_letter = 'o', .kind = OPTION_TEXT, .placeholder = "FOLDER",      \
        .help =                                                                                    \
            "Folder of the results: FOLDER/TEST/result.json, pictures and log.txt. Everything in " \
            "the folder must be written by kiln, as its list .kiln-results says.",                 \
        .fallback = DEFAULT_RESULTS                                                                \
    }
#define FILTER_OPTION                                                                              \
    {                                                                                              \
        .name = "filter", .letter = 'f', .repeats = true, .kind = OPTION_TEXT,                     \
        .placeholder = "PATTERN",                                                                  \
        .help = "Take the tests whose names fit a shell pattern, such as 'effects/*'. The "        \
                "pattern may also be given as an operand."                                         \
    }
#define SUITE_ROOT_OPTION                                                                          \
    {                                                                                              \
        .name = "asset-root", .kind = OPTION_TEXT, .placeholder = "FOLDER",                        \
        .help = "The folder that the scenes of test files must lie in.",                           \
        .fallback = "the working directory; for tests outside it, the folder that is given"        \
    }
#define SHARD_OPTION                                                                               \
    {                                                                                              \
        .name = "shard", .kind = OPTION_PART, .placeholder = "I/N",                                \
        .help = "Take the I-th of N parts of the tests, for N machines. Give each machine "        \
                "another --results, and merge these by 'kiln test report'."                        \
    }

/* Explains the operands, for the descriptions of commands. */
#define SELECT_DESCRIPTION                                                                         \
    "A PATH is a test file (*.test.yaml), a scene, or a folder, which is searched for both. "      \
    "Without a PATH, the working directory is searched. A NAME, or a shell pattern of names, "     \
    "takes some of the tests. A test is named by its path, without its suffix, from the folder "   \
    "that the goldens' folder lies in, or from the nearest folder with a file .kiln-tests: "       \
    "effects/fire."

/* Returns whether an operand is a path. One that does not exist but looks like a file is a path all
 * the same: the error then names a file. */
bool operand_is_path(const char *operand);

/* Finds the tests that a command line selects; the suite does not refer to the arguments. Returns
 * 0, or the exit code after reporting what is wrong; to find no test is an error. The caller
 * destroys the suite. */
int select_tests(struct kiln_suite **suite, const struct arguments *arguments, const char *command);

#endif
