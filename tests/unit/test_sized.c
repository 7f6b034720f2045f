/* lib/base/sized: callers that were built against an older or a newer version. */
#include <errno.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/error.h"
#include "base/sized.h"
#include "support/cmocka.h"
#include "support/errors.h"

struct older_params {
    size_t size;
    int64_t first;
};

struct params {
    size_t size;
    int64_t first, second;
};

struct newer_params {
    size_t size;
    int64_t first, second, third;
};

static const struct params defaults = {sizeof defaults, 1, 2};

/* A member that a later version adds may not lie where an older caller has padding. */
#define ENDS_WITH(name, last)                                                                      \
    _Static_assert(sizeof(struct name) ==                                                          \
                       offsetof(struct name, last) + sizeof(((struct name *)NULL)->last),          \
                   #name)
ENDS_WITH(kiln_scene_params, params_file_count);
ENDS_WITH(kiln_device_params, log);
ENDS_WITH(kiln_flipbook, green_down);
ENDS_WITH(kiln_frame_layer, pixels);
ENDS_WITH(kiln_render_params, written);
ENDS_WITH(kiln_compare_mask, picture);
ENDS_WITH(kiln_compare_params, log);
ENDS_WITH(kiln_bake_params, log);
ENDS_WITH(kiln_export_params, log);
ENDS_WITH(kiln_join_params, log);
ENDS_WITH(kiln_encode_params, log);
ENDS_WITH(kiln_plan_params, log);
ENDS_WITH(kiln_limits, most);
ENDS_WITH(kiln_sandbox_params, writable_count);

static void defaults_fill_what_an_older_caller_lacks(void **state)
{
    (void)state;
    struct kiln_error error = kiln_error_empty();
    struct params own = defaults;
    const struct older_params older = {sizeof older, 10};
    assert_true(kiln_sized_take(&own, &older, "params", &error));
    assert_true(own.size == sizeof own && own.first == 10 && own.second == 2);
    own = defaults;
    assert_true(kiln_sized_take(&own, NULL, "params", &error));
    assert_memory_equal(&own, &defaults, sizeof own);
}

/* An error of a caller with less room for the message: nothing is written behind it. */
static void errors_keep_to_their_size(void **state)
{
    (void)state;
    enum { ROOM = 8 };
    struct kiln_error error;
    memset(&error, '#', sizeof error);
    error.size = offsetof(struct kiln_error, message) + ROOM;
    assert_false(kiln_error_set(&error, KILN_IO, "%s", "longer than that"));
    expect_error(&error, KILN_IO, "longer ");
    assert_false(kiln_error_set_errno(&error, KILN_IO, ENOENT, "x"));
    expect_error(&error, KILN_IO, "x: No s");
    for (size_t i = ROOM; i < sizeof error.message; i++)
        assert_int_equal(error.message[i], '#');
}

static void what_a_newer_caller_has_beyond_is_passed_over(void **state)
{
    (void)state;
    struct kiln_error error = kiln_error_empty();
    struct params own = defaults;
    const struct newer_params newer = {sizeof newer, 10, 20, 30};
    assert_true(kiln_sized_take(&own, &newer, "params", &error));
    assert_true(own.size == sizeof own && own.first == 10 && own.second == 20);
}

static void results_go_as_far_as_there_is_room(void **state)
{
    (void)state;
    struct {
        struct older_params older;
        int64_t behind;
    } room = {{sizeof room.older, 0}, 77};
    kiln_sized_give(&room.older, &defaults);
    assert_true(room.older.size == sizeof room.older && room.older.first == 1 && room.behind == 77);
    struct newer_params newer = {sizeof newer, 0, 0, 88};
    kiln_sized_give(&newer, &defaults);
    assert_true(newer.size == sizeof newer && newer.second == 2 && newer.third == 88);
    kiln_sized_give(NULL, &defaults);
}

static void no_version_had_such_a_size(void **state)
{
    (void)state;
    struct params own = defaults, given = {0, 5, 6};
    static const size_t sizes[] = {0, 7, SIZE_MAX};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct kiln_error error = kiln_error_empty();
        given.size = sizes[i];
        assert_false(kiln_sized_take(&own, &given, "params", &error));
        expect_error(&error, KILN_USAGE,
                     "struct params: the size is %zu; fill the struct first by its function in the "
                     "header, as kiln_render_defaults() fills a kiln_render_params",
                     sizes[i]);
        assert_false(kiln_sized_check(&given, "params", &error));
    }
    assert_memory_equal(&own, &defaults, sizeof own);
}

/* Each function that takes such a struct looks at its size before it does anything else. */
static void the_library_refuses_them(void **state)
{
    (void)state;
    struct kiln_error error = kiln_error_empty();
    const struct kiln_scene_params scene = {.size = 0};
    const struct kiln_device_params device = {.size = 0};
    const struct kiln_render_params render = {.size = 0};
    const struct kiln_compare_params compare = {.size = 0};
    const struct kiln_limits limits = {.size = 0};
    struct kiln_compare_result result = kiln_compare_result_empty();
    assert_null(kiln_scene_load("nowhere.yaml", &scene, &error));
    expect_error(&error, KILN_USAGE,
                 "struct kiln_scene_params: the size is 0; fill the struct first by its function "
                 "in the header, as kiln_render_defaults() fills a kiln_render_params");
    assert_null(kiln_device_open(&device, &error));
    expect_error(&error, KILN_USAGE,
                 "struct kiln_device_params: the size is 0; fill the struct first by its function "
                 "in the header, as kiln_render_defaults() fills a kiln_render_params");
    assert_false(kiln_render(NULL, NULL, &render, NULL, &error));
    expect_error(&error, KILN_USAGE,
                 "struct kiln_render_params: the size is 0; fill the struct first by its function "
                 "in the header, as kiln_render_defaults() fills a kiln_render_params");
    assert_false(kiln_compare(&compare, &result, &error));
    expect_error(&error, KILN_USAGE,
                 "struct kiln_compare_params: the size is 0; fill the struct first by its function "
                 "in the header, as kiln_render_defaults() fills a kiln_render_params");
    result.size = 0;
    assert_false(kiln_compare(NULL, &result, &error));
    expect_error(&error, KILN_USAGE,
                 "struct kiln_compare_result: the size is 0; fill the struct first by its function "
                 "in the header, as kiln_render_defaults() fills a kiln_render_params");
    assert_null(kiln_budget_create(&limits));
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_fill_what_an_older_caller_lacks),
        cmocka_unit_test(errors_keep_to_their_size),
        cmocka_unit_test(what_a_newer_caller_has_beyond_is_passed_over),
        cmocka_unit_test(results_go_as_far_as_there_is_room),
        cmocka_unit_test(no_version_had_such_a_size),
        cmocka_unit_test(the_library_refuses_them),
    };
    return cmocka_run_group_tests_name("sized", tests, NULL, NULL);
}
