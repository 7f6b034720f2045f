/* Finds the files that are tests. The name of a test begins from the nearest folder with a file
 * .kiln-tests, or else from the folder that the goldens' folder lies in. */
#ifndef KILN_SUITE_DISCOVER_H
#define KILN_SUITE_DISCOVER_H

#include "kiln_program.h"
#include "suite/suite.h"

struct kiln_found {
    const char *path;
    const char *name;     /* of the test: its path below the folder that names begin from */
    const char *identity; /* equal for one file that was found twice */
    bool in_folder;       /* not an operand itself */
};

/* The tests that were found, in the order of the operands and, in a folder, of their names. */
struct kiln_findings {
    struct kiln_found *items; /* in the arena */
    size_t count, capacity;
    const char **starts; /* for each folder that was searched, how names of tests in it start,
                            "effects/" or "" */
    size_t start_count;
};

/* Looks at the operands. In folders, a file of tests or a YAML file with the key kiln is taken.
 * Folders that are hidden, hold goldens or results, or are links, are not searched. A file that two
 * operands reach is taken once. KILN_USAGE for an operand that is no test and no folder, or is a
 * folder without any test; KILN_IO, KILN_DEVICE_FAILED. */
bool kiln_discover(struct kiln_arena *arena, const struct kiln_suite_params *params,
                   struct kiln_findings *findings, struct kiln_error *error);

#endif
