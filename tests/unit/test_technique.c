/* lib/frame/technique.c: the choice of techniques. */
#include <stddef.h>
#include <stdint.h>

#include "frame/technique.h"
#include "support/cmocka.h"
#include "support/errors.h"

static bool choose(bool software, bool exact, const char *flag, char text[256],
                   struct kiln_error *error)
{
    struct kiln_device_info device = {
        .gl = true, .software = software, .exact = exact, .name = "Device"};
    struct kiln_techniques techniques;
    if (!kiln_techniques_choose(&device, &flag, flag ? 1 : 0, &techniques, error))
        return false;
    kiln_techniques_describe(&techniques, text, 256);
    return true;
}

static void defaults_follow_the_device(void **state)
{
    (void)state;
    char text[256];
    struct kiln_error error = {0};
    assert_true(choose(true, true, NULL, text, &error));
    assert_string_equal(
        text,
        "simulate=cpu gas=cpu sort=cpu backdrop=cpu march=cpu raster=cpu bloom=cpu composite=cpu");
    assert_true(choose(false, true, NULL, text, &error));
    assert_string_equal(text, "simulate=inplace gas=gl sort=bitonic backdrop=gl march=gl "
                              "raster=tiled bloom=gl composite=gl");
    assert_true(choose(false, false, NULL, text, &error));
    assert_string_equal(
        text,
        "simulate=cpu gas=cpu sort=cpu backdrop=gl march=gl raster=tiled bloom=gl composite=gl");
}

static void auto_is_the_default(void **state)
{
    (void)state;
    const char *const flags[] = {"simulate=cpu", "simulate=auto"};
    struct kiln_device_info gpu = {.gl = true, .exact = true, .name = "Device"};
    struct kiln_techniques techniques;
    struct kiln_error error = {0};
    assert_true(kiln_techniques_choose(&gpu, flags, 2, &techniques, &error));
    assert_int_equal(techniques.simulate, KILN_SIMULATE_INPLACE);
    assert_true(kiln_techniques_choose(&gpu, flags, 1, &techniques, &error));
    assert_int_equal(techniques.simulate, KILN_SIMULATE_CPU);
}

static void every_choice_says_why(void **state)
{
    (void)state;
    const struct kiln_device_info devices[] = {{.gl = true, .software = true, .exact = true},
                                               {.gl = true, .exact = true, .name = "GPU"},
                                               {.gl = true, .name = "inexact"}};
    for (size_t i = 0; i < sizeof devices / sizeof *devices; i++) {
        const char *const flag = "sort=cpu";
        struct kiln_techniques techniques;
        struct kiln_error error = {0};
        assert_true(kiln_techniques_choose(&devices[i], &flag, 1, &techniques, &error));
        for (int stage = 0; stage < KILN_STAGE_COUNT; stage++) {
            const struct kiln_technique_choice *choice = &techniques.choices[stage];
            bool forced = strcmp(choice->stage, "sort") == 0;
            assert_true(forced == (choice->why == NULL));
            if (choice->why)
                assert_in_range(strlen(choice->why), 10, 70); /* a line of --stats */
        }
    }
}

static void each_stage_has_a_pass_of_its_own(void **state)
{
    (void)state;
    uint32_t passes = 0;
    for (size_t stage = 0; stage < KILN_STAGE_COUNT; stage++) {
        const char *names[KILN_MAX_TECHNIQUES];
        size_t count = kiln_stage_techniques(stage, names);
        assert_in_range(count, 2, KILN_MAX_TECHNIQUES - 1);
        assert_string_equal(names[0], "cpu");
        uint32_t pass = 1u << kiln_stage_pass(stage);
        if (strcmp(kiln_stage_name(stage), "gas") == 0) { /* a step has its gas and its particles */
            assert_int_equal(kiln_stage_pass(stage), KILN_PASS_simulate);
            continue;
        }
        assert_true((passes & pass) == 0);
        passes |= pass;
    }
    assert_string_equal(kiln_stage_name(0), "simulate");
    assert_int_equal(kiln_stage_pass(0), KILN_PASS_simulate);
}

/* The message names the technique, the device and what to do. */
static void a_device_without_gl_takes_cpu_alone(void **state)
{
    (void)state;
    const struct kiln_device_info host = {.software = true, .exact = true, .name = "cpu"};
    static const char *const flags[] = {"simulate=inplace", "gas=gl",   "sort=radix",  "march=gl",
                                        "raster=geometry",  "bloom=gl", "composite=gl"};
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) {
        struct kiln_techniques techniques;
        struct kiln_error error = {0};
        assert_true(kiln_techniques_need_gl(&flags[i], 1));
        assert_false(kiln_techniques_choose(&host, &flags[i], 1, &techniques, &error));
        expect_error(&error, KILN_USAGE,
                     "technique %s needs OpenGL, which the device 'cpu' does not have: use "
                     "%.*s=cpu, or another device ('kiln devices' lists them)",
                     flags[i], (int)strcspn(flags[i], "="), flags[i]);
    }
}

static void flags_force_a_technique(void **state)
{
    (void)state;
    char text[256];
    struct kiln_error error = {0};
    assert_true(choose(true, true, "simulate=inplace", text, &error));
    assert_string_equal(text, "simulate=inplace gas=cpu sort=cpu backdrop=cpu march=cpu raster=cpu "
                              "bloom=cpu composite=cpu");
    assert_true(choose(true, true, "raster=geometry", text, &error));
    assert_string_equal(text, "simulate=cpu gas=cpu sort=cpu backdrop=cpu march=cpu "
                              "raster=geometry bloom=cpu composite=cpu");

    assert_true(choose(true, true, "sort=radix", text, &error));
    assert_string_equal(text, "simulate=cpu gas=cpu sort=radix backdrop=cpu march=cpu raster=cpu "
                              "bloom=cpu composite=cpu");
    assert_true(choose(false, true, "raster=geometry", text, &error));
    assert_string_equal(text, "simulate=inplace gas=gl sort=bitonic backdrop=gl march=gl "
                              "raster=geometry bloom=gl composite=gl");

    assert_false(choose(true, true, "simulate", text, &error));
    expect_error(&error, KILN_USAGE, "technique 'simulate': expected stage=name");
    assert_false(choose(true, true, "simulat=cpu", text, &error));
    expect_error(&error, KILN_USAGE,
                 "technique: stage 'simulat' is not known (did you mean 'simulate'?); "
                 "allowed are simulate, gas, sort, backdrop, march, raster, bloom, composite");
    assert_false(choose(true, true, "sort=gpu", text, &error));
    expect_error(&error, KILN_USAGE,
                 "technique: sort 'gpu' is not known (did you mean 'cpu'?); "
                 "allowed are cpu, radix, bitonic, oddeven, auto");
}

static void a_sort_can_be_spread_over_frames(void **state)
{
    (void)state;
    char text[256];
    struct kiln_error error = {0};
    assert_true(choose(true, true, "sort=oddeven:8", text, &error));
    assert_string_equal(text, "simulate=cpu gas=cpu sort=oddeven:8 backdrop=cpu march=cpu "
                              "raster=cpu bloom=cpu composite=cpu");
    assert_true(choose(true, true, "sort=oddeven", text, &error));
    assert_string_equal(text, "simulate=cpu gas=cpu sort=oddeven backdrop=cpu march=cpu raster=cpu "
                              "bloom=cpu composite=cpu");
    const char *const bad[] = {"0", "65", "-1", "", "8x", "8:8"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char flag[32];
        snprintf(flag, sizeof flag, "sort=oddeven:%s", bad[i]);
        assert_false(choose(true, true, flag, text, &error));
        expect_error(&error, KILN_USAGE,
                     "technique: sort=oddeven:%s: expected oddeven:N, where N is the number of "
                     "frames, 1 to 64, that the sort is spread over",
                     bad[i]);
    }
    assert_false(choose(true, true, "sort=radix:8", text, &error));
    expect_error(&error, KILN_USAGE,
                 "technique: sort 'radix:8' is not known (did you mean 'radix'?); allowed are cpu, "
                 "radix, bitonic, oddeven, auto");

    /* The last one for a stage counts, its number as well. */
    const char *const flags[] = {"sort=oddeven:8", "sort=auto"};
    struct kiln_device_info device = {
        .gl = true, .software = true, .exact = true, .name = "Device"};
    struct kiln_techniques techniques;
    assert_true(kiln_techniques_choose(&device, flags, 2, &techniques, &error));
    assert_int_equal(techniques.sort_number, 0);
}

/* `auto` takes no technique of the papers, on no device. */
static void papers_are_asked_for(void **state)
{
    (void)state;
    static const char *const flags[] = {"sort=oddeven:8", "simulate=texels"};
    struct kiln_error error = {0};
    struct kiln_techniques techniques;
    char name[KILN_TECHNIQUE_SIZE];
    const char *instead;
    for (int i = 0; i < 8; i++) {
        const struct kiln_device_info device = {
            .gl = i & 1, .software = i & 2, .exact = i & 4, .name = "Device"};
        if (kiln_techniques_choose(&device, NULL, 0, &techniques, &error))
            assert_false(kiln_techniques_paper(&techniques, name, &instead));
    }
    const struct kiln_device_info device = {
        .gl = true, .software = true, .exact = true, .name = "Device"};
    assert_true(kiln_techniques_choose(&device, flags, 1, &techniques, &error));
    assert_true(kiln_techniques_paper(&techniques, name, &instead));
    assert_string_equal(name, "sort=oddeven");
    assert_string_equal(instead, "sort=radix");
    assert_int_equal(kiln_techniques_history(&techniques), 8);
    assert_true(kiln_techniques_choose(&device, flags + 1, 1, &techniques, &error));
    assert_true(kiln_techniques_paper(&techniques, name, &instead));
    assert_string_equal(name, "simulate=texels");
    assert_int_equal(kiln_techniques_history(&techniques), 0);
}

static void inexact_devices_do_not_simulate_or_sort(void **state)
{
    (void)state;
    char text[256];
    const char *const flags[] = {"simulate=inplace", "simulate=pingpong", "simulate=feedback",
                                 "simulate=texels"};
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) {
        struct kiln_error error = {0};
        assert_false(choose(false, false, flags[i], text, &error));
        expect_error(&error, KILN_NO_DEVICE,
                     "Device computes inexactly and cannot simulate; use simulate=cpu");
        assert_true(choose(true, true, flags[i], text, &error));
        assert_memory_equal(text, flags[i], strlen(flags[i]));
    }
    struct kiln_error error = {0};
    assert_false(choose(false, false, "sort=radix", text, &error));
    expect_error(&error, KILN_NO_DEVICE, "Device computes inexactly and cannot sort; use sort=cpu");
    error = (struct kiln_error){0};
    assert_false(choose(false, false, "gas=gl", text, &error));
    expect_error(&error, KILN_NO_DEVICE,
                 "Device computes inexactly and cannot step gas; use gas=cpu");
}

static void combinations_start_with_the_pinned_one(void **state)
{
    (void)state;
    struct kiln_device_info gpu = {.gl = true, .exact = true, .name = "Device"};
    struct kiln_technique_list list;
    static char seen[4096][256];
    size_t count = 0;
    for (; kiln_techniques_combination(count, &list); count++) {
        const char *flags[KILN_STAGE_COUNT];
        struct kiln_techniques techniques;
        struct kiln_error error = {0};
        for (int i = 0; i < KILN_STAGE_COUNT; i++)
            flags[i] = list.flags[i];
        assert_true(kiln_techniques_choose(&gpu, flags, KILN_STAGE_COUNT, &techniques, &error));
        kiln_techniques_describe(&techniques, seen[count], sizeof seen[count]);
        for (size_t i = 0; i < count; i++)
            assert_string_not_equal(seen[i], seen[count]);
        assert_true(count < 4095);
    }
    assert_true(count >= 2560);
    assert_string_equal(
        seen[0],
        "simulate=cpu gas=cpu sort=cpu backdrop=cpu march=cpu raster=cpu bloom=cpu composite=cpu");
    assert_string_equal(
        seen[1],
        "simulate=cpu gas=cpu sort=cpu backdrop=cpu march=cpu raster=cpu bloom=cpu composite=gl");
    assert_string_equal(
        seen[2],
        "simulate=cpu gas=cpu sort=cpu backdrop=cpu march=cpu raster=cpu bloom=gl composite=cpu");
    assert_string_equal(seen[4], "simulate=cpu gas=cpu sort=cpu backdrop=cpu march=cpu "
                                 "raster=geometry bloom=cpu composite=cpu");
    assert_string_equal(seen[8], "simulate=cpu gas=cpu sort=cpu backdrop=cpu march=cpu "
                                 "raster=instanced bloom=cpu composite=cpu");
    assert_string_equal(seen[12], "simulate=cpu gas=cpu sort=cpu backdrop=cpu march=cpu "
                                  "raster=tiled bloom=cpu composite=cpu");
    assert_string_equal(
        seen[16],
        "simulate=cpu gas=cpu sort=cpu backdrop=cpu march=gl raster=cpu bloom=cpu composite=cpu");
    assert_string_equal(
        seen[32],
        "simulate=cpu gas=cpu sort=cpu backdrop=gl march=cpu raster=cpu bloom=cpu composite=cpu");
    assert_string_equal(seen[64], "simulate=cpu gas=cpu sort=radix backdrop=cpu march=cpu "
                                  "raster=cpu bloom=cpu composite=cpu");
    assert_string_equal(
        seen[256],
        "simulate=cpu gas=gl sort=cpu backdrop=cpu march=cpu raster=cpu bloom=cpu composite=cpu");
    assert_string_equal(seen[512], "simulate=inplace gas=cpu sort=cpu backdrop=cpu march=cpu "
                                   "raster=cpu bloom=cpu composite=cpu");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_follow_the_device),
        cmocka_unit_test(auto_is_the_default),
        cmocka_unit_test(every_choice_says_why),
        cmocka_unit_test(each_stage_has_a_pass_of_its_own),
        cmocka_unit_test(a_device_without_gl_takes_cpu_alone),
        cmocka_unit_test(flags_force_a_technique),
        cmocka_unit_test(a_sort_can_be_spread_over_frames),
        cmocka_unit_test(papers_are_asked_for),
        cmocka_unit_test(inexact_devices_do_not_simulate_or_sort),
        cmocka_unit_test(combinations_start_with_the_pinned_one),
    };
    return cmocka_run_group_tests_name("technique", tests, NULL, NULL);
}
