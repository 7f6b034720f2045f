/* lib/job/workload: how the work of frames and steps varies with births and lives. */
#include <math.h>
#include <string.h>

#include "job/workload.h"
#include "kiln.h"
#include "support/cmocka.h"

/* Parses a scene of 60 frames at 30 a second with one system "a" of points. */
static struct kiln_scene *scene_of(const char *emit, const char *more)
{
    char text[1024];
    struct kiln_error error = {0};
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {size: [64, 36], fps: 30, frames: 60}\n%s\nsystems:\n"
             "  a: {emit: {%s}, look: {shape: point, size: 1 cm}}\n",
             more, emit);
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "test.yaml", NULL, &error);
    assert_string_equal(error.message, "");
    assert_non_null(scene);
    return scene;
}

struct clip {
    struct kiln_scene *scene;
    struct kiln_workload *workload;
};

static struct clip clip_of(const char *emit, const char *more)
{
    struct clip clip = {.scene = scene_of(emit, more)};
    clip.workload = kiln_workload_create(clip.scene);
    assert_non_null(clip.workload);
    return clip;
}

static void finish(struct clip *clip)
{
    kiln_workload_destroy(&clip->workload);
    kiln_scene_destroy(&clip->scene);
}

/* Returns the work of a frame beyond that of one without particles. */
static double added(const struct clip *clip, uint32_t frame)
{
    struct clip empty = clip_of("rate: 0", "");
    const double work =
        kiln_workload_frame(clip->workload, frame) - kiln_workload_frame(empty.workload, frame);
    finish(&empty);
    return work;
}

static void finds_a_burst_that_lives_for_a_few_frames(void **state)
{
    (void)state;
    struct clip clip = clip_of("bursts: {1.2: 100000}, life: 0.1 s", "");
    const uint32_t heaviest = kiln_workload_heaviest(clip.workload);
    assert_in_range(heaviest, 37, 39); /* the frame at 1.2 s shows earlier bursts only */
    assert_true(added(&clip, 36) == 0.0);
    assert_true(added(&clip, heaviest) > 0.0);
    assert_true(added(&clip, 41) == 0.0);
    assert_int_equal(kiln_workload_lightest(clip.workload), 0);
    finish(&clip);
}

static void the_first_frame_shows_a_burst_at_its_time(void **state)
{
    (void)state;
    struct clip clip = clip_of("bursts: {0: 1000}, life: 1 s", "");
    assert_true(added(&clip, 0) > 0.0);
    finish(&clip);
}

static void a_rate_gives_as_many_as_it_bears_in_a_life(void **state)
{
    (void)state;
    struct clip one = clip_of("bursts: {0: 1000}, life: 10 s", "");
    struct clip clip = clip_of("rate: 2000, life: [0.4 s, 0.6 s]", "simulation: {warmup: 2 s}");
    const double ratio = added(&clip, 30) / added(&one, 30);
    assert_true(ratio > 0.9 && ratio < 1.1);
    assert_true(added(&clip, 0) > 0.9 * added(&clip, 30)); /* the warm-up fills the clip */
    finish(&clip);
    finish(&one);
}

static void lives_shorter_than_a_frame_count_in_part(void **state)
{
    (void)state;
    struct clip one = clip_of("bursts: {0: 1000}, life: 10 s", "");
    struct clip clip = clip_of("rate: 1e5, life: 10 ms", "");
    const double ratio = added(&clip, 30) / added(&one, 30);
    assert_true(ratio > 0.9 && ratio < 1.1);
    finish(&clip);
    finish(&one);
}

static void children_follow_their_parents(void **state)
{
    (void)state;
    struct clip clip = clip_of("bursts: {0: 10}, life: 1 s", "");
    struct kiln_error error = {0};
    static const char text[] =
        "kiln: 1\noutput: {size: [64, 36], fps: 30, frames: 60}\nsystems:\n"
        "  a: {emit: {bursts: {0: 10}, life: 1 s}, look: {shape: point, size: 1 cm}}\n"
        "  b: {emit: {parent: {system: a, on: {death: {count: 100}}}, life: 0.3 s}, "
        "look: {shape: point, size: 1 cm}}\n";
    struct clip family = {.scene = kiln_scene_parse(text, strlen(text), "test.yaml", NULL, &error)};
    assert_non_null(family.scene);
    family.workload = kiln_workload_create(family.scene);
    assert_non_null(family.workload);
    assert_in_range(kiln_workload_heaviest(family.workload), 29, 34);
    assert_true(added(&family, 15) == added(&clip, 15));
    finish(&family);
    finish(&clip);
}

/* Returns a clip of 1000 parents that are born at 1 s, with a trail. */
static struct clip clip_of_trail(const char *life, const char *rate)
{
    char text[512];
    struct kiln_error error = {0};
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {size: [64, 36], fps: 30, frames: 90}\nsystems:\n"
             "  a: {emit: {bursts: {1: 1000}, life: %s}, look: {shape: point, size: 0 cm}}\n"
             "  b: {emit: {parent: {system: a, on: {trail: {rate: %s}}}, life: 0.2 s}, "
             "look: {shape: point, size: 20 m}}\n",
             life, rate);
    struct clip clip = {.scene = kiln_scene_parse(text, strlen(text), "test.yaml", NULL, &error)};
    assert_non_null(clip.scene);
    clip.workload = kiln_workload_create(clip.scene);
    assert_non_null(clip.workload);
    return clip;
}

static void trails_begin_at_their_parents_births(void **state)
{
    (void)state;
    struct clip one = clip_of_trail("1 s", "0.5");
    struct clip many = clip_of_trail("1 s", "50");
    assert_true(added(&one, 33) > 5.0 * added(&one, 45)); /* the only child lives until 1.2 s */
    const double ratio = added(&many, 50) / added(&one, 33);
    assert_true(ratio > 9.0 && ratio < 11.0); /* ten live at a time */
    finish(&one);
    finish(&many);
}

static void steps_add_up(void **state)
{
    (void)state;
    struct clip clip = clip_of("rate: 500, life: 2 s", "simulation: {warmup: 1 s}");
    const double all = kiln_workload_steps(clip.workload, 0, 178);
    double sum = 0.0;
    for (uint32_t step = 0; step < 178; step++)
        sum += kiln_workload_steps(clip.workload, step, step + 1);
    assert_true(sum > 0.99 * all && sum < 1.01 * all);
    assert_true(kiln_workload_steps(clip.workload, 5, 5) == 0.0);
    finish(&clip);
}

/* Gas adds work as it spreads: a second step of it in each step of the scene doubles what steps
 * add, and not what frames add. */
static void gas_adds_work_as_it_spreads(void **state)
{
    (void)state;
    static const char fire[] = "gas: {a: {box: {size: [2, 4, 2]}, cells: 64, rate: %d, sources: "
                               "[{from: {disc: {radius: 0.3 m}}}]}}";
    char text[2][200];
    snprintf(text[0], sizeof text[0], fire, 0);
    snprintf(text[1], sizeof text[1], fire, 120);
    struct clip empty = clip_of("rate: 0", ""), one = clip_of("rate: 0", text[0]);
    struct clip two = clip_of("rate: 0", text[1]);
    const double fixed = kiln_workload_steps(empty.workload, 0, 100);
    const double once = kiln_workload_steps(one.workload, 0, 100) - fixed;
    const double twice = kiln_workload_steps(two.workload, 0, 100) - fixed;
    assert_true(once > 0.0 && fabs(twice - 2.0 * once) < 1e-9 * twice);
    assert_true(kiln_workload_steps(one.workload, 80, 90) >
                1.5 * kiln_workload_steps(one.workload, 10, 20));
    for (uint32_t frame = 1; frame < 60; frame++) {
        assert_true(added(&one, frame) > 0.0 && added(&one, frame) == added(&two, frame));
        assert_true(added(&one, frame) >= added(&one, frame - 1));
    }
    assert_int_equal(kiln_workload_lightest(one.workload), 0);
    assert_true(kiln_workload_heaviest(one.workload) > 30);
    finish(&empty);
    finish(&one);
    finish(&two);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_a_burst_that_lives_for_a_few_frames),
        cmocka_unit_test(the_first_frame_shows_a_burst_at_its_time),
        cmocka_unit_test(a_rate_gives_as_many_as_it_bears_in_a_life),
        cmocka_unit_test(lives_shorter_than_a_frame_count_in_part),
        cmocka_unit_test(children_follow_their_parents),
        cmocka_unit_test(trails_begin_at_their_parents_births),
        cmocka_unit_test(steps_add_up),
        cmocka_unit_test(gas_adds_work_as_it_spreads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
