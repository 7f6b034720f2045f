/* systems.NAME.seed: the number of a system in all random numbers of its particles (lib/scene,
 * shaders/shared/random.h). If it failed, a system that is put before others would change where
 * their particles fly although they have seeds, or scenes without seeds would have other hashes
 * than before, so that their saved states were refused. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/motion.h"
#include "scene/parts.h"
#include "support/errors.h"
#include "support/simulation.h"

#define HEAD "kiln: 1\nsystems:\n"

/* A system of which every random number that moves particles is used. */
#define SYSTEM(name, seed)                                                                         \
    "  " name ":\n" seed "    emit: {rate: 200, life: [0.5 s, 1 s], speed: [1, 3],\n"              \
    "           from: {sphere: {origin: [0, 1, 0], radius: 0.4 m}}}\n"                             \
    "    forces: [{drag: {random: [0, 2]}},\n"                                                     \
    "             {wind: {velocity: {noise: [[0, 0, 0], [1, 1, 1]], per: particle}}}]\n"           \
    "    collide: {randomness: {random: [0, 1], times: {noise: [0, 1], per: system}}}\n"
#define FIRST(more) "  first:\n    emit: {rate: 50}\n" more
#define OFF(more)   "  first:\n    enabled: false\n    emit: {rate: 50}\n" more

enum { STEPS = 90 };

struct warnings {
    int count;
    char last[KILN_MESSAGE_SIZE];
};

static void keep_warning(void *user, enum kiln_log_level level, const char *line)
{
    struct warnings *warnings = user;
    assert_int_equal(level, KILN_LOG_WARNING);
    warnings->count++;
    snprintf(warnings->last, sizeof warnings->last, "%s", line);
}

static struct kiln_scene *load(const char *text, struct warnings *warnings)
{
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_error error = {0};
    if (warnings)
        params.log = (struct kiln_log){keep_warning, warnings};
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "seeds.yaml", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

/* Copies the records of the last system of a scene after STEPS steps, which the caller frees. */
static struct kiln_particle *records(const char *text, size_t *count)
{
    struct kiln_scene *scene = load(text, NULL);
    struct simulation run;
    simulation_start(&run, scene, NULL, 1);
    simulation_run(&run, STEPS);
    const struct kiln_pool_system *slots = &run.pool.systems[scene->system_count - 1];
    *count = scene->systems[scene->system_count - 1].capacity;
    struct kiln_particle *copy = malloc(*count * sizeof *copy);
    assert_non_null(copy);
    memcpy(copy, simulation_records(&run) + slots->base, *count * sizeof *copy);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
    return copy;
}

/* Returns whether the last systems of two scenes have the same records. */
static bool fly_alike(const char *one, const char *other)
{
    size_t count, other_count;
    struct kiln_particle *a = records(one, &count), *b = records(other, &other_count);
    const bool alike = count == other_count && memcmp(a, b, count * sizeof *a) == 0;
    free(a);
    free(b);
    return alike;
}

static void a_system_with_a_seed_stays_as_it_is(void **state)
{
    (void)state;
    static const char alone[] = HEAD SYSTEM("dust", "");
    assert_false(fly_alike(alone, HEAD FIRST(SYSTEM("dust", ""))));
    assert_false(fly_alike(alone, HEAD OFF(SYSTEM("dust", ""))));
    assert_true(fly_alike(alone, HEAD SYSTEM("dust", "    seed: 0\n")));
    assert_true(fly_alike(alone, HEAD FIRST(SYSTEM("dust", "    seed: 0\n"))));
    assert_true(fly_alike(alone, HEAD OFF(SYSTEM("renamed", "    seed: 0\n"))));
    assert_true(fly_alike(HEAD SYSTEM("dust", "    seed: 400\n"),
                          HEAD FIRST(SYSTEM("dust", "    seed: 400\n"))));
    assert_false(fly_alike(alone, HEAD SYSTEM("dust", "    seed: 400\n")));
    assert_false(fly_alike(alone, HEAD SYSTEM("dust", "    seed: 4294967294\n")));
}

/* What is used, and what uses it, draw for themselves. */
static void a_system_that_is_used_stays_as_it_is(void **state)
{
    (void)state;
    static const char alone[] = HEAD SYSTEM("dust", "    seed: 0\n");
    assert_true(
        fly_alike(alone, HEAD "  one: {use: dust, seed: 8}\n  two: {use: one, seed: 9}\n" SYSTEM(
                             "dust", "    seed: 0\n")));
    assert_true(
        fly_alike(alone, HEAD SYSTEM("dust", "    seed: 7\n") "  copy: {use: dust, seed: 0}\n"));
    assert_false(
        fly_alike(alone, HEAD SYSTEM("dust", "    seed: 0\n") "  copy: {use: dust, seed: 1}\n"));
}

static void check_hashes(const char *one, const char *other, bool same)
{
    struct kiln_scene *a = load(one, NULL), *b = load(other, NULL);
    struct kiln_error error = {0};
    char motion[2][65];
    assert_true(kiln_scene_part_hash(a, KILN_PART_MOTION, motion[0], &error));
    assert_true(kiln_scene_part_hash(b, KILN_PART_MOTION, motion[1], &error));
    assert_int_equal(strcmp(a->hash, b->hash) == 0, same);
    assert_int_equal(strcmp(motion[0], motion[1]) == 0, same);
    kiln_scene_destroy(&a);
    kiln_scene_destroy(&b);
}

/* Scenes without seeds keep the hashes of scenes from before there were any. */
static void a_seed_belongs_to_the_hash_unless_it_is_the_place(void **state)
{
    (void)state;
    check_hashes(HEAD SYSTEM("dust", ""), HEAD SYSTEM("dust", "    seed: 0\n"), true);
    check_hashes(HEAD SYSTEM("dust", ""), HEAD SYSTEM("dust", "    seed: auto\n"), true);
    check_hashes(HEAD SYSTEM("dust", ""), HEAD SYSTEM("dust", "    seed: 1\n"), false);
    check_hashes(HEAD FIRST(SYSTEM("dust", "")), HEAD FIRST(SYSTEM("dust", "    seed: 1\n")), true);
    check_hashes(HEAD FIRST(SYSTEM("dust", "")), HEAD FIRST(SYSTEM("dust", "    seed: 0\n")),
                 false);
}

static void a_printed_scene_has_all_numbers(void **state)
{
    (void)state;
    struct kiln_scene *scene = load(HEAD FIRST(SYSTEM("dust", "")), NULL);
    struct kiln_text text;
    assert_true(kiln_print_scene(scene, 0, &text));
    assert_non_null(strstr(text.data, "  first:\n    enabled: true\n    seed: 0\n"));
    assert_non_null(strstr(text.data, "  dust:\n    enabled: true\n    seed: 1\n"));
    kiln_text_free(&text);
    assert_true(kiln_print_scene(scene, KILN_PART_HASHED, &text));
    assert_non_null(strstr(text.data, "  first:\n    enabled: true\n    emit:\n"));
    kiln_text_free(&text);
    kiln_scene_destroy(&scene);
}

static void a_number_that_another_system_has_asked_for_is_warned_of(void **state)
{
    (void)state;
    static const char *const silent[] = {
        HEAD OFF(SYSTEM("dust", "    seed: 0\n")),
        HEAD SYSTEM("one", "    seed: 5\n") SYSTEM("two", "    seed: 5\n"),
        HEAD FIRST(SYSTEM("dust", "    seed: 1\n")),
    };
    struct warnings warnings = {0};
    struct kiln_scene *scene = load(HEAD FIRST(SYSTEM("dust", "    seed: 0\n")), &warnings);
    kiln_scene_destroy(&scene);
    assert_int_equal(warnings.count, 1);
    expect_message(warnings.last,
                   "seeds.yaml:4:5: systems.first: its place is 0, which is also the seed of "
                   "systems.dust, so both draw the same numbers; a seed of its own sets it apart");
    for (size_t i = 0; i < sizeof silent / sizeof *silent; i++) {
        scene = load(silent[i], &warnings);
        kiln_scene_destroy(&scene);
        assert_int_equal(warnings.count, 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_system_with_a_seed_stays_as_it_is),
        cmocka_unit_test(a_system_that_is_used_stays_as_it_is),
        cmocka_unit_test(a_seed_belongs_to_the_hash_unless_it_is_the_place),
        cmocka_unit_test(a_printed_scene_has_all_numbers),
        cmocka_unit_test(a_number_that_another_system_has_asked_for_is_warned_of),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
