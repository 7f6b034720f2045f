/* Checks that children are drawn with the color, size and temperature that their parent had when
 * they were born, also when it is dead. If this fails, the stars of a firework lose the color of
 * their shell when it has burst. */
#include <math.h>
#include <string.h>

#include "draw/moment/appearance.h"
#include "draw/moment/looks.h"
#include "scene/instant.h"
#include "shared/derived.h"
#include "support/cmocka.h"
#include "support/simulation.h"

/* Shells that burst, or leave the bounds, and two kinds of children of theirs. */
static const char SHELLS[] =
    "kiln: 1\n"
    "seed: 5\n"
    "output: {fps: 60, frames: 120}\n"
    "systems:\n"
    "  filler: {emit: {bursts: {0 s: 7}, life: 9 s}}\n"
    "  shell:\n"
    "    emit: {bursts: {0 s: 90}, life: [0.4 s, 1 s], speed: [1, 5], from: {point: {angle: 30 "
    "deg}}}\n"
    "    bounds: {min: [-9, -9, -9], max: [9, 3, 9]}\n"
    "    look: {color: {choose: [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0]]}, blend: add,\n"
    "           size: {life: [0.1, 0.5], times: {random: [0.5, 1.5]}},\n"
    "           temperature: {age: {0 s: 1000, 1 s: 3000}}}\n"
    "  star:\n"
    "    emit: {parent: {system: shell, on: {death: 3}, inherit: {color: true, size: true}},\n"
    "           life: 9 s, speed: 1}\n"
    "    look: {color: [0.1, 0.2, 0.3], size: 9 m, fade: {in: 0, out: 0}}\n"
    "  smoke:\n"
    "    emit: {parent: {system: shell, on: {trail: 30}, inherit: {size: true, temperature: "
    "true}},\n"
    "           life: 9 s, speed: 0}\n"
    "    look: {color: [1, 1, 1], blend: add, size: 9 m, temperature: 9000, intensity: 1}\n"
    "  true_heat: {emit: {rate: 1}, look: {blend: add, color: [1, 1, 1], intensity: 1,\n"
    "              temperature: {age: {0 s: 1000, 1 s: 3000}}}}\n";

enum { SHELL = 1, STAR, SMOKE, HEAT, SHELLS_COUNT = 90, STEPS = 75 };

static struct kiln_scene *load(const char *text)
{
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_error error = {0};
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "test.yaml", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

static bool about(float a, float b)
{
    return fabsf(a - b) < 0.004f * fabsf(b) + 1e-4f;
}

/* Returns the clocks of a shell, born at 0 s, when a child of it was born. */
static struct value_clocks clocks_of_shell(const struct kiln_scene *scene, uint32_t serial,
                                           struct kiln_particle child)
{
    const struct kiln_derived_params derived = kiln_scene_derived(scene, SHELL);
    struct kiln_particle shell = {.position_serial = {0, 0, 0, serial}};
    shell.velocity_birth.w = 1u << KILN_BIRTH_STEP_SHIFT;
    struct value_clocks clocks = kiln_scene_clocks(scene, SHELL, 0);
    clocks.age_s = particle_birth_time(derived, child);
    clocks.life = fminf(clocks.age_s / particle_life_s(scene->keys, derived, shell), 1.0f);
    clocks.stream = particle_stream(derived, shell);
    return clocks;
}

/* Checks what a child has of its shell. */
static void check_child(const struct kiln_moment *moment, uint32_t index, uint32_t slot)
{
    const struct kiln_scene *scene = moment->scene;
    const struct kiln_look *look = &scene->systems[SHELL].look;
    const struct kiln_appearance_system system = kiln_appearance_system(moment, index);
    const struct kiln_particle child = system.records[slot];
    struct kiln_appearance seen;
    assert_true(kiln_appearance_at(&system, slot, &seen));
    const uint32_t serial = child.position_serial.w / scene->systems[index].emit.parent.slots;
    const struct value_clocks clocks = clocks_of_shell(scene, serial, child);
    assert_true(about(2.0f * seen.radius, value_at(scene->keys, look->size, clocks)));
    if (index == STAR) {
        const float3 color = value3_at(scene->keys, look->color, clocks);
        const float4 row = kiln_appearance_look(&system, KILN_LOOK_COVER, &seen.clocks);
        assert_true(about(row.x, color.x) && about(row.y, color.y) && about(row.z, color.z));
        return;
    }
    const struct kiln_appearance_system heat = kiln_appearance_system(moment, HEAT);
    for (uint32_t row = KILN_LOOK_HOT; row <= KILN_LOOK_COOL; row++) {
        const float4 found = kiln_appearance_look(&system, row, &seen.clocks);
        const float4 expected = kiln_appearance_look(&heat, row, &clocks);
        assert_true(fabsf(found.x - expected.x) < 0.02f * expected.x + 1e-4f);
        assert_true(fabsf(found.y - expected.y) < 0.02f * expected.y + 1e-4f);
    }
}

static void children_have_their_parents_looks(void **state)
{
    (void)state;
    struct kiln_scene *scene = load(SHELLS);
    struct kiln_error error = {0};
    struct simulation run;
    struct kiln_moment moment;
    simulation_start(&run, scene, NULL, 2);
    assert_true(kiln_moment_init(&moment, NULL, scene, NULL, &error));
    uint32_t stars = 0, smoke = 0, orphans = 0;
    for (uint32_t step = 15; step <= STEPS; step += 15) {
        simulation_run(&run, 15);
        const struct kiln_instant instant = kiln_instant_at_step(step);
        assert_true(kiln_moment_fill(&moment, &run.pool, instant, true, &error));
        const struct kiln_particle *shells = moment.records + run.pool.systems[SHELL].base;
        for (uint32_t index = STAR; index <= SMOKE; index++) {
            const struct kiln_pool_system *slots = &run.pool.systems[index];
            const uint32_t each = scene->systems[index].emit.parent.slots;
            for (uint32_t slot = 0; slot < slots->capacity; slot++) {
                if (!particle_is_alive(moment.records[slots->base + slot]))
                    continue;
                check_child(&moment, index, slot);
                stars += index == STAR;
                smoke += index == SMOKE;
                orphans += !particle_is_alive(shells[slot / each]);
            }
        }
    }
    assert_true(stars > 300 && smoke > 2000 && orphans > 1500);
    kiln_moment_finish(&moment);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

/* Of a dead parent, serial and birth are left; of other particles, nothing. */
static void dead_parents_leave_their_birth(void **state)
{
    (void)state;
    struct kiln_scene *scene = load(SHELLS);
    struct simulation run;
    simulation_start(&run, scene, NULL, 1);
    simulation_run(&run, 70);
    const struct kiln_particle *shells = simulation_records(&run) + run.pool.systems[SHELL].base;
    for (uint32_t i = 0; i < SHELLS_COUNT; i++) {
        const struct kiln_particle left = {
            .position_serial = {0, 0, 0, i},
            .velocity_birth = {0, 0, 0, 1u << KILN_BIRTH_STEP_SHIFT}};
        assert_memory_equal(&shells[i], &left, sizeof left);
    }
    simulation_end(&run);
    scene->systems[STAR].emit.parent.look = (struct kiln_inherited){false, false, false};
    scene->systems[SMOKE].emit.parent.look = (struct kiln_inherited){false, false, false};
    simulation_start(&run, scene, NULL, 1);
    simulation_run(&run, 70);
    const struct kiln_particle none = {.position_serial = {0}};
    shells = simulation_records(&run) + run.pool.systems[SHELL].base;
    for (uint32_t i = 0; i < SHELLS_COUNT; i++)
        assert_memory_equal(&shells[i], &none, sizeof none);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(children_have_their_parents_looks),
        cmocka_unit_test(dead_parents_leave_their_birth),
    };
    return cmocka_run_group_tests_name("inherited", tests, NULL, NULL);
}
