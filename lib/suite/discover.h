/* Finds the files that are tests. A test's name is its path below the nearest folder with a file
 * .kiln-tests, or else below the folder that the goldens' folder lies in. */
#ifndef KILN_SUITE_DISCOVER_H
#define KILN_SUITE_DISCOVER_H

#include "kiln_program.h"
#include "suite/suite.h"

struct kiln_found {
    const char *path;
    const char *name;     /* the test's name: its path below the folder that names begin from */
    const char *identity; /* equal if a file was found twice */
    bool in_folder;       /* found in a folder, and no operand itself */
};

/* The tests that were found, in the order of the operands and, in a folder, of their names. */
struct kiln_findings {
    struct kiln_found *items; /* in the arena */
    size_t count, capacity;
    const char **name_prefixes; /* for each searched folder, the prefix of the names of its tests,
                                   "effects/" or "" */
    size_t name_prefix_count;
};

/* Finds the tests among the operands, params->paths. In a folder, it takes test files and YAML
 * files with the key kiln. It does not search folders that are hidden, hold goldens or results, or
 * are links. A file that two operands reach is taken once. KILN_USAGE for an operand that is no
 * test and no folder, or is a folder without any test; KILN_IO, KILN_DEVICE_FAILED. */
bool kiln_discover(struct kiln_arena *arena, const struct kiln_suite_params *params,
                   struct kiln_findings *findings, struct kiln_error *error);

#endif
