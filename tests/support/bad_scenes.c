/* Loads the faulty scenes of a table, and compares their error messages with the expected ones. */
#include "support/bad_scenes.h"

#include <stdio.h>

#include "support/cmocka.h"
#include "support/scenes.h"

void expect_all(const struct bad *cases, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        struct kiln_error error = {0};
        struct kiln_scene *scene = try_scene(cases[i].text, NULL, &error);
        if (scene)
            fail_msg("accepted:\n%s", cases[i].text);
        char expected[KILN_MESSAGE_SIZE];
        snprintf(expected, sizeof expected, "%s%s", SCENE_NAME, cases[i].message);
        assert_string_equal(error.message, expected);
        assert_int_equal(error.code, KILN_INVALID_INPUT);
    }
}
