/* lib/job/state: a run goes on from a saved state as if it had never stopped, and a file that is
 * not as it was written is refused. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "job/state.h"
#include "job/states.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/scenes.h"
#include "support/simulation.h"

#define FILE_NAME "a.kilnstate"
#define MOTION    "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef"

static void save(struct simulation *run, uint32_t *words)
{
    struct kiln_state state = {.pool = &run->pool, .history = {words, 3}};
    struct kiln_error error = {0};
    memcpy(state.info.motion, MOTION, sizeof state.info.motion);
    if (words)
        memcpy(state.info.history, MOTION, sizeof state.info.history);
    state.info.step = run->step;
    state.info.frame = 7;
    state.info.hash = simulation_hash(run, &state.info.alive);
    if (!kiln_state_write(&state, FILE_NAME, true, run->threads, &error))
        fail_msg("%s", error.message);
}

static void take_up(struct simulation *run, struct kiln_state *state)
{
    struct kiln_error error = {0};
    state->pool = &run->pool;
    if (!kiln_state_read(state, FILE_NAME, run->threads, &error))
        fail_msg("%s", error.message);
    run->step = state->info.step;
}

/* Saves after so many steps, goes on in another run, and compares with one that never stopped.
 * Destroys the scene. */
static void check(struct kiln_scene *scene, const char *name, uint32_t steps)
{
    struct simulation whole, first, second;
    simulation_start_with(&whole, scene, NULL, KILN_SIMULATE_CPU, 2);
    simulation_start_with(&first, scene, NULL, KILN_SIMULATE_CPU, 2);
    simulation_start_with(&second, scene, NULL, KILN_SIMULATE_CPU, 1);
    simulation_run(&whole, 120);
    simulation_run(&first, steps);
    save(&first, NULL);
    struct kiln_state state = {.pool = NULL};
    take_up(&second, &state);
    assert_int_equal(state.info.step, steps);
    assert_string_equal(state.info.motion, MOTION);
    assert_string_equal(state.info.kiln, KILN_VERSION);
    uint64_t alive, expected_alive;
    struct kiln_state_hash hash = simulation_hash(&second, &alive);
    assert_memory_equal(&hash, &state.info.hash, sizeof hash);
    assert_int_equal(alive, state.info.alive);
    simulation_run(&second, 120 - steps);
    hash = simulation_hash(&second, &alive);
    const struct kiln_state_hash expected = simulation_hash(&whole, &expected_alive);
    if (memcmp(&hash, &expected, sizeof hash) != 0 || alive != expected_alive)
        fail_msg("%s from step %u: another state after 120 steps", name, steps);
    assert_true(alive > 100);
    simulation_end(&whole);
    simulation_end(&first);
    simulation_end(&second);
    kiln_scene_destroy(&scene);
}

static void check_scene(const char *fixture, const char *override, uint32_t steps)
{
    check(load_fixture(fixture, override), fixture, steps);
}

static void runs_go_on(void **state)
{
    (void)state;
    check_scene("rest", NULL, 57); /* spins, children, a wind */
    check_scene("rest", NULL, 119);
    check_scene("rest", "systems.drops.emit.rate=200000", 60); /* several blocks */
    check_scene("surfaces", NULL, 60);                         /* canvases, a mesh that moves */
    /* ways of balls that spin, impacts that are counted, particles that stick */
    check_scene("rest", "systems.shards.emit.parent.on={trail: {per_metre: 20}}", 57);
    check_scene("rest", "systems.shards.emit.parent.on={bounce: {count: 2, every: true}}", 57);
    check_scene("rest", "systems.shards.emit.parent.on={bounce: {every: true, most: 5}}", 57);
    check_scene("rest", "systems.shards.emit.parent.inherit.color=true", 57);
    check_scene("surfaces", "systems.drops.collide.then=stick", 60);
    check_scene("surfaces", "backdrop.objects.2.mesh.paint.per_step=2", 60); /* splats that wait */
}

/* Births on meshes, also on one with an animation, and on images and paths. */
static void sources_go_on(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\noutput: {frames: 120, fps: 60}\n"
        "backdrop: {objects: {part: {mesh: {file: moving.gltf, animation: {},\n"
        "  position: {keys: {0 s: [0, 0, 0], 2 s: [3, 0, 0]}}}}}}\n"
        "systems:\n"
        "  file: {emit: {rate: 300, life: [1 s, 2 s], from: {mesh: {file: card.obj}}}}\n"
        "  part: {emit: {rate: 300, life: 1 s, inherit: 1, from: {mesh: {object: part}}}}\n"
        "  logo: {emit: {rate: 300, life: 1 s, from: {image: disc.png}}}\n"
        "  path: {emit: {bursts: {0.1 s: 40, 1.2 s: 40}, life: 1 s,\n"
        "    from: {path: {points: [[0, 0, 0], [1, 1, 0], [2, 0, 0]], ordered: true}}}}\n";
    char folder[4096];
    assert_non_null(getcwd(folder, sizeof folder));
    for (uint32_t steps = 57; steps < 100; steps += 33) {
        assert_int_equal(chdir(KILN_SOURCE_DIR "/tests/mutation"), 0);
        struct kiln_scene *scene = load_scene(text, NULL);
        assert_int_equal(chdir(folder), 0);
        check(scene, "sources", steps);
    }
}

/* Also into a pool that has run and painted already. */
static void states_replace_what_is_there(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_fixture("surfaces", NULL);
    struct simulation first, second;
    simulation_start_with(&first, scene, NULL, KILN_SIMULATE_CPU, 2);
    simulation_start_with(&second, scene, NULL, KILN_SIMULATE_CPU, 2);
    simulation_run(&first, 100);
    simulation_run(&second, 70);
    save(&first, NULL);
    const uint32_t changes = second.pool.canvases[0].changes;
    struct kiln_state loaded = {.pool = NULL};
    take_up(&second, &loaded);
    assert_true(second.pool.canvases[0].changes > changes); /* who drew it draws it anew */
    simulation_run(&first, 20);
    simulation_run(&second, 20);
    uint64_t alive;
    const struct kiln_state_hash a = simulation_hash(&first, &alive);
    const struct kiln_state_hash b = simulation_hash(&second, &alive);
    assert_memory_equal(&a, &b, sizeof a);
    simulation_end(&first);
    simulation_end(&second);
    kiln_scene_destroy(&scene);
}

static void histories_are_kept(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_fixture("rest", NULL);
    struct simulation run;
    simulation_start_with(&run, scene, NULL, KILN_SIMULATE_CPU, 2);
    simulation_run(&run, 30);
    const uint32_t count = run.pool.slot_count;
    uint32_t *words = calloc(count, sizeof *words), *read = calloc(count, sizeof *read);
    assert_non_null(words);
    assert_non_null(read);
    for (uint32_t i = 0; i < count; i++)
        words[i] = (i * 7 + 3) % count;
    save(&run, words);
    struct kiln_state with = {.history = {.of_slots = read}}, without = {.pool = NULL};
    take_up(&run, &with);
    assert_memory_equal(read, words, count * sizeof *words);
    assert_int_equal(with.history.of_whole, 3);
    assert_int_equal(with.info.frame, 7);
    take_up(&run, &without); /* the same file serves who wants none */
    save(&run, NULL);
    struct kiln_error error = {0};
    with.pool = &run.pool;
    assert_false(kiln_state_read(&with, FILE_NAME, run.threads, &error));
    expect_error(&error, KILN_INVALID_INPUT, FILE_NAME ": the state has no history of a stage");
    free(words);
    free(read);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

/* ---- files that are not as they were written ------------------------------------------------- */

static char *read_bytes(size_t *size)
{
    FILE *file = fopen(FILE_NAME, "rb");
    assert_non_null(file);
    char *bytes = malloc(1 << 20);
    assert_non_null(bytes);
    *size = fread(bytes, 1, 1 << 20, file);
    fclose(file);
    return bytes;
}

static void write_bytes(const char *bytes, size_t size)
{
    FILE *file = fopen(FILE_NAME, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

/* Lengths of the first words of a state, and of all that is read before its head. */
enum { MAGIC = 11, FIRST_LINE = 13, START = 17 };

#define NO_STATE "the file is not a saved state"
#define FORMAT   "the state has another format; this kiln reads format 1"
#define DAMAGED  "the file is damaged"
#define CUT_OFF  "the file is cut off"

static void check_refused(const char *bytes, size_t size, const char *what, size_t where,
                          const char *message)
{
    struct kiln_state_info info;
    struct kiln_error error = {0};
    write_bytes(bytes, size);
    if (kiln_state_check(FILE_NAME, &info, &error))
        fail_msg("a state %s at byte %zu is taken for one", what, where);
    /* A changed length of a block may reach beyond the end of the file. */
    if (strcmp(message, DAMAGED) == 0 && strcmp(error.message, FILE_NAME ": " CUT_OFF) == 0)
        message = CUT_OFF;
    expect_error(&error, KILN_INVALID_INPUT, FILE_NAME ": %s", message);
}

static void damage_is_seen(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_fixture("rest", "systems.drops.emit.rate=20");
    struct simulation run;
    simulation_start_with(&run, scene, NULL, KILN_SIMULATE_CPU, 2);
    simulation_run(&run, 30);
    save(&run, NULL);
    size_t size;
    char *bytes = read_bytes(&size);
    assert_true(size > 500);
    struct kiln_state_info info;
    struct kiln_error error = {0};
    assert_true(kiln_state_check(FILE_NAME, &info, &error));
#ifdef __SANITIZE_ADDRESS__
    enum { STRIDE = 7 }; /* sanitizers take several times as long */
#else
    enum { STRIDE = 1 };
#endif
    for (size_t i = 0; i < size; i += STRIDE) {
        const char before = bytes[i];
        bytes[i] = before == 'k' ? 'x' : 'k';
        check_refused(bytes, size, "changed", i,
                      i < MAGIC        ? NO_STATE
                      : i < FIRST_LINE ? FORMAT
                                       : DAMAGED);
        bytes[i] = before;
    }
    for (size_t i = 0; i < size; i += i < 300 ? 1 : 13)
        check_refused(bytes, i, "cut off", i, i < START ? NO_STATE : CUT_OFF);
    bytes[size] = 0;
    check_refused(bytes, size + 1, "that goes on", size, "the file has bytes after its end");
    free(bytes);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

static void other_files_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"", NO_STATE},
        {"kiln: 1\nseed: 12345678\n", NO_STATE},
        {"kiln state 2\n____", FORMAT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_state_info info;
        struct kiln_error error = {0};
        write_bytes(cases[i].text, strlen(cases[i].text));
        assert_false(kiln_state_check(FILE_NAME, &info, &error));
        expect_error(&error, KILN_INVALID_INPUT, FILE_NAME ": %s", cases[i].message);
    }
    struct kiln_state_info info;
    struct kiln_error error = {0};
    assert_false(kiln_state_check("nowhere", &info, &error));
    expect_error(&error, KILN_IO,
                 "nowhere: the saved state cannot be opened: No such file or directory");
    assert_false(kiln_state_check(".", &info, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 ".: the path is not a file but a folder; allowed are kiln bake files");
}

/* A state of other systems, whatever its hash says. */
static void other_systems_are_refused(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_fixture("rest", NULL), *other = load_fixture("surfaces", NULL);
    struct simulation run, stranger;
    simulation_start_with(&run, scene, NULL, KILN_SIMULATE_CPU, 2);
    simulation_start_with(&stranger, other, NULL, KILN_SIMULATE_CPU, 2);
    simulation_run(&run, 3);
    save(&run, NULL);
    struct kiln_state loaded = {.pool = &stranger.pool};
    struct kiln_error error = {0};
    assert_false(kiln_state_read(&loaded, FILE_NAME, run.threads, &error));
    expect_error(&error, KILN_INVALID_INPUT, FILE_NAME ": the state belongs to other systems");
    simulation_end(&run);
    simulation_end(&stranger);
    kiln_scene_destroy(&scene);
    kiln_scene_destroy(&other);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(runs_go_on, test_enter_folder, test_leave_folder),
        cmocka_unit_test_setup_teardown(sources_go_on, test_enter_folder, test_leave_folder),
        cmocka_unit_test_setup_teardown(states_replace_what_is_there, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(histories_are_kept, test_enter_folder, test_leave_folder),
        cmocka_unit_test_setup_teardown(damage_is_seen, test_enter_folder, test_leave_folder),
        cmocka_unit_test_setup_teardown(other_files_are_refused, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(other_systems_are_refused, test_enter_folder,
                                        test_leave_folder),
    };
    return cmocka_run_group_tests_name("state", tests, NULL, NULL);
}
