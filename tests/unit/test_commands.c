/* The commands that a result offers to a person. */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "suite/result_member.h"
#include "suite/test_case.h"
#include "support/cmocka.h"

struct fixture {
    struct kiln_suite suite;
    struct kiln_test test;
    struct kiln_test_params params;
    struct kiln_test_case test_case;
};

static void fixture_init(struct fixture *f, const char *name, const char *path)
{
    *f = (struct fixture){
        .suite = {.results_folder = (char *)"out/test"},
        .test = {.name = name, .full_name = name, .path = path},
        .params = kiln_test_defaults(),
    };
    f->test_case = (struct kiln_test_case){
        .arena = kiln_arena_create(), .suite = &f->suite, .test = &f->test, .params = &f->params};
    f->test.golden = kiln_test_case_text(&f->test_case, "golden/%s", name);
}

static void expect_rerun(const char *name, const char *full_name, const char *path,
                         const char *expected)
{
    struct fixture f;
    fixture_init(&f, name, path);
    f.test.full_name = full_name;
    assert_string_equal(kiln_test_case_rerun_command(&f.test_case), expected);
    kiln_arena_destroy(&f.test_case.arena);
}

static void a_test_is_found_under_its_name_again(void **state)
{
    (void)state;
    expect_rerun("fire", "fire", "fire.test.yaml", "kiln test fire.test.yaml");
    expect_rerun("fire", "fire", "a/b/fire.yml", "kiln test a/b/fire.yml");
    expect_rerun("b/fire", "b/fire", "a/b/fire.test.yaml", "kiln test a/b/fire.test.yaml");
    expect_rerun("b/fire", "b/fire", "b/fire.test.yaml", "kiln test b/fire.test.yaml");
    expect_rerun("b/fire", "b/fire", "/b/fire.yaml", "kiln test /b/fire.yaml");
    expect_rerun("fire", "fire@gpu", "a/fire.yaml", "kiln test --filter fire@gpu a/fire.yaml");
    expect_rerun("-a", "-a", "-a.yaml", "kiln test ./-a.yaml");
    expect_rerun("b/c", "b/c", "it's mine/b/c.yaml", "kiln test 'it'\\''s mine/b/c.yaml'");
}

static void what_was_asked_for_is_asked_for_again(void **state)
{
    (void)state;
    struct fixture f;
    const char *const techniques[] = {"sort=cpu"};
    fixture_init(&f, "fire", "fire.yaml");
    f.test.golden = "my goldens/fire";
    f.suite.results_folder = (char *)"r";
    f.params.device = "nvidia h200";
    f.params.techniques = techniques;
    f.params.technique_count = 1;
    f.params.repeat = 3;
    f.params.strict = f.params.ignore_hashes = true;
    const char *rerun = kiln_test_case_rerun_command(&f.test_case);
    assert_string_equal(rerun,
                        "kiln test --results r --golden 'my goldens' --device 'nvidia h200' "
                        "--technique sort=cpu --repeat 3 --ignore-hashes --strict fire.yaml");
    const char *approve = kiln_test_case_approve_command(&f.test_case);
    assert_string_equal(approve, "kiln test approve --results r --golden 'my goldens' fire.yaml");
    f.suite.is_found_by_name = true;
    assert_string_equal(kiln_test_case_approve_command(&f.test_case),
                        "kiln test approve --results r --golden 'my goldens' fire");
    /* The reader of results takes the same command. */
    struct kiln_result result;
    kiln_result_init(&result, "fire");
    result.test = "fire.yaml";
    result.golden = "my goldens/fire";
    struct kiln_arena *arena = f.test_case.arena;
    assert_string_equal(kiln_result_command(arena, &result, rerun, "r", false), rerun);
    assert_string_equal(kiln_result_command(arena, &result, approve, "r", true), approve);
    f.test.device = "software"; /* is in the test file */
    assert_null(strstr(kiln_test_case_rerun_command(&f.test_case), "--device"));
    kiln_arena_destroy(&f.test_case.arena);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_test_is_found_under_its_name_again),
        cmocka_unit_test(what_was_asked_for_is_asked_for_again),
    };
    return cmocka_run_group_tests_name("commands", tests, NULL, NULL);
}
