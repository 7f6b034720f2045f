/* Checks that kiln refuses faulty scenes with the right error messages. A test lists its scenes and
 * messages in a table. */
#ifndef KILN_TESTS_BAD_SCENES_H
#define KILN_TESTS_BAD_SCENES_H

#include <stddef.h>

/* Holds a faulty scene and the message that it must give. */
struct bad {
    const char *text;    /* the scene file */
    const char *message; /* the expected message, without the file's name at its start */
};

/* Loads each scene of a table of `count` rows. Fails unless every scene is refused with
 * KILN_INVALID_INPUT and exactly the expected message. */
void expect_all(const struct bad *cases, size_t count);

/* Defines a cmocka test named bad_TABLE, which calls expect_all with the table. */
#define BAD_TEST(table)                                                                            \
    static void bad_##table(void **state)                                                          \
    {                                                                                              \
        (void)state;                                                                               \
        expect_all(table, sizeof table / sizeof *table);                                           \
    }

#endif
