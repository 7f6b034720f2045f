/* Tests tables of bad scenes and their error messages. */
#ifndef KILN_TESTS_BAD_SCENES_H
#define KILN_TESTS_BAD_SCENES_H

#include <stddef.h>

struct bad {
    const char *text;
    const char *message; /* the error's message, without the name of the file before it */
};

/* Fails unless each scene is refused with KILN_INVALID_INPUT and its message. */
void expect_all(const struct bad *cases, size_t count);

/* Defines a test bad_TABLE that expects all of a table. */
#define BAD_TEST(table)                                                                            \
    static void bad_##table(void **state)                                                          \
    {                                                                                              \
        (void)state;                                                                               \
        expect_all(table, sizeof table / sizeof *table);                                           \
    }

#endif
