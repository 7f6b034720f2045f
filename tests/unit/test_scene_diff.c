/* The keys that differ between two scenes. */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "suite/test_case.h"
#include "support/cmocka.h"
#include "support/errors.h"

static void expect_changes(const char *before, const char *after, const char *expected)
{
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_result_change *changes = NULL;
    struct kiln_error error = {0};
    size_t count = 0;
    if (!kiln_scene_diff(arena, before, "before.yaml", after, &changes, &count, &error))
        fail_msg("%s", error.message);
    char text[1024] = "";
    for (size_t i = 0; i < count; i++) {
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s: '%s' '%s'\n", changes[i].key,
                 changes[i].before, changes[i].after);
        assert_string_equal(changes[i].place, "");
    }
    assert_string_equal(text, expected);
    kiln_arena_destroy(&arena);
}

static void keys_that_differ_are_listed(void **state)
{
    (void)state;
    expect_changes("kiln: 1\na: 1\n", "kiln: 1\na: 1\n", "");
    expect_changes("kiln: 1\nb: 2\na: 1\n", "kiln: 1\na: 1\nb: 2\n", "");
    expect_changes("kiln: 1\na: {b: 1, c: {d: 2}}\n", "kiln: 1\na: {b: 1, c: {d: 3}}\n",
                   "a.c.d: '2' '3'\n");
    expect_changes("kiln: 1\na: 1\nz: 1\n", "kiln: 1\nb: 2\nz: 1\n", "a: '1' ''\nb: '' '2'\n");
    expect_changes("kiln: 1\nsize: [1, 2]\n", "kiln: 1\nsize: [1, 3]\n",
                   "size: '[1, 2]' '[1, 3]'\n");
    expect_changes("kiln: 1\nforces: [{gravity: [0, 1, 0]}, {drag: 2}]\n",
                   "kiln: 1\nforces: [{gravity: [0, 2, 0]}]\n",
                   "forces.0.gravity: '[0, 1, 0]' '[0, 2, 0]'\nforces.1.drag: '2' ''\n");
    expect_changes("kiln: 1\nforces: []\n", "kiln: 1\nforces: [{drag: 2}]\n",
                   "forces: '[]' ''\nforces.0.drag: '' '2'\n");
}

/* The new text has the places of kiln_scene_print_origins. */
static void places_are_named(void **state)
{
    (void)state;
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_result_change *changes = NULL;
    struct kiln_error error = {0};
    size_t count = 0;
    assert_true(kiln_scene_diff(arena, "a: 1\nb: {c: 2, d: 3}\ne: \"  # x\"\n", "before.yaml",
                                "a: 2  # s.yaml:3\nb:  # s.yaml:4\n  c: 2  # s.yaml:5\n"
                                "  d: 4  # parts/fire.yaml:7, used at s.yaml:4\n"
                                "e: \"  # y\"  # default\n",
                                &changes, &count, &error));
    assert_int_equal(count, 3);
    assert_string_equal(changes[0].place, "s.yaml:3");
    assert_string_equal(changes[1].key, "b.d");
    assert_string_equal(changes[1].place, "parts/fire.yaml:7, used at s.yaml:4");
    assert_string_equal(changes[2].place, "default");
    kiln_arena_destroy(&arena);
}

static void broken_scenes_are_errors(void **state)
{
    (void)state;
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_result_change *changes = NULL;
    struct kiln_error error = {0};
    size_t count = 0;
    assert_false(
        kiln_scene_diff(arena, "kiln: [\n", "before.yaml", "kiln: 1\n", &changes, &count, &error));
    expect_error_around(&error, KILN_INVALID_INPUT, "",
                        "before.yaml:2:1: not valid YAML: "); /* libfyaml says why */
    kiln_arena_destroy(&arena);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(keys_that_differ_are_listed),
        cmocka_unit_test(places_are_named),
        cmocka_unit_test(broken_scenes_are_errors),
    };
    return cmocka_run_group_tests_name("scene_diff", tests, NULL, NULL);
}
