/* Loads the faulty scenes of a test's table, and compares each error message with the message that
 * the table expects. */
#include "support/bad_scenes.h"

#include <stdio.h>

#include "support/cmocka.h"
#include "support/errors.h"
#include "support/scenes.h"

void expect_all(const struct bad *cases, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        struct kiln_error error = {0};
        struct kiln_scene *scene = try_scene(cases[i].text, NULL, &error);
        if (scene)
            fail_msg("accepted:\n%s", cases[i].text);
        expect_error(&error, KILN_INVALID_INPUT, SCENE_NAME "%s", cases[i].message);
    }
}
