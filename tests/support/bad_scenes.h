/* Tables of bad scenes, and what is said of them. */
#ifndef KILN_TESTS_BAD_SCENES_H
#define KILN_TESTS_BAD_SCENES_H

#include <stddef.h>

struct bad {
    const char *text;
    const char *message; /* after the name of the file */
};

void expect_all(const struct bad *cases, size_t count);

/* The test of a table. */
#define BAD_TEST(table)                                                                            \
    static void bad_##table(void **state)                                                          \
    {                                                                                              \
        (void)state;                                                                               \
        expect_all(table, sizeof table / sizeof *table);                                           \
    }

#endif
