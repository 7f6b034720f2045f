/* Saved states of gas: if this fails, a job that was killed goes on with other gas than it had, a
 * damaged file brings gas into a run that no step makes, or numbers that are not finite end in a
 * picture. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "job/state.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/gas_rig.h"
#include "support/scenes.h"
#include "support/simulation.h"

#define FILE_NAME "a.kilnstate"

/* Fire with coloured smoke, a solid that moves, a wind, and particles that are its sources and ride
 * it; and a closed room in a node that turns, whose smoke is kept. */
static const char ALL[] =
    "kiln: 1\nseed: 3\nsimulation: {rate: 30}\n"
    "nodes: {turner: {position: [4, 1, 0], rotation: {keys: {0 s: [0, 0, 0], 1 s: [0, 0, 100 "
    "deg]}}}}\n"
    "backdrop: {objects: {ball: {sphere: {radius: 0.2,\n"
    "  center: {keys: {0 s: [-0.5, 1, 0], 1 s: [0.5, 1.1, 0]}}}}}}\n"
    "systems: {dots: {emit: {rate: 200, life: 2 s, speed: 1, from: {sphere: {origin: [0, 0.3, "
    "0]}}},\n"
    "  forces: [{wind: {gas: fire, pull: 6 1/s}}]}}\n"
    "gas:\n"
    "  fire: {box: {size: [1.6, 2.4, 1.6]}, cell: 0.05, detail: 2, vorticity: 0.5,\n"
    "    forces: [{wind: {velocity: [0.5, 0, 0], pull: 1 1/s}}],\n"
    "    sources: [{from: {disc: {radius: 0.25, origin: [0, 0.05, 0]}}, velocity: [0, 0.7, 0]},\n"
    "      {from: {system: dots}, fuel: 0, temperature: 0, smoke: 0.5, reach: 0.15,\n"
    "        inherit: 0.5, color: [0.9, 0.3, 0.1]}]}\n"
    "  room: {attach: turner, box: {center: [0, 0, 0], size: [0.8, 0.8, 0.8]}, cell: 0.05,\n"
    "    burn: none, decay: 0,\n"
    "    sides: {left: closed, right: closed, top: closed, back: closed, front: closed},\n"
    "    sources: [{from: {point: {}}, fuel: 0, temperature: 1, smoke: 1,\n"
    "      rate: {keys: {0.3 s: 20, 0.31 s: 0}}}]}\n";

static const char ROOM[] =
    "kiln: 1\nsimulation: {rate: 30}\n"
    "gas: {room: {box: {size: [1.6, 1.6, 1.6]}, cell: 0.1, burn: none, detail: 2,\n"
    "  sources: [{from: {point: {origin: [0, 0.8, 0]}}, fuel: 0, temperature: 1, smoke: 1}]}}\n";

static void expect_same(struct simulation *a, struct simulation *b, uint32_t saved)
{
    uint64_t alive[2];
    const struct kiln_state_hash first = simulation_hash(a, &alive[0]);
    const struct kiln_state_hash second = simulation_hash(b, &alive[1]);
    if (memcmp(&first, &second, sizeof first) != 0 || alive[0] != alive[1])
        fail_msg("a state of step %u goes on with another one in step %u", saved, b->step);
}

/* A run that takes up a state has the states of the run that saved it, step by step: before there
 * is gas, in the midst of it, and into a run whose gas is another one. */
static void runs_of_gas_go_on(void **state)
{
    (void)state;
    static const uint32_t steps[] = {0, 1, 7, 16};
    struct kiln_scene *scene = load_scene(ALL, NULL);
    struct simulation whole, other;
    simulation_start(&other, scene, NULL, 1);
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        struct kiln_error error = {0};
        simulation_start(&whole, scene, NULL, 2);
        simulation_run(&whole, steps[i]);
        simulation_save(&whole, FILE_NAME);
        if (!simulation_take_up(&other, FILE_NAME, &error))
            fail_msg("%s", error.message);
        expect_same(&whole, &other, steps[i]);
        for (int k = 0; k < 5; k++) {
            simulation_run(&whole, 1);
            simulation_run(&other, 1);
            expect_same(&whole, &other, steps[i]);
            assert_true(whole.pool.gas[0].kept == other.pool.gas[0].kept);
            assert_true(whole.pool.gas[1].due == other.pool.gas[1].due);
        }
        if (steps[i] == 16)
            assert_true(gas_sum(&whole.pool.gas[0], GAS_FLAME) > 1.0 &&
                        gas_sum(&whole.pool.gas[1], GAS_SMOKE) > 1.0);
        simulation_end(&whole);
    }
    simulation_end(&other);
    kiln_scene_destroy(&scene);
}

/* A run that reads its own state after each few steps is the run that never did: as one that is cut
 * into many pieces. */
static void pieces_make_up_a_run(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(ROOM, NULL);
    struct simulation whole, pieces;
    simulation_start(&whole, scene, NULL, 2);
    simulation_start(&pieces, scene, NULL, 1);
    for (uint32_t step = 0; step < 24; step += 3) {
        struct kiln_error error = {0};
        simulation_run(&whole, 3);
        simulation_run(&pieces, 3);
        simulation_save(&pieces, FILE_NAME);
        simulation_end(&pieces);
        simulation_start(&pieces, scene, NULL, 1);
        if (!simulation_take_up(&pieces, FILE_NAME, &error))
            fail_msg("%s", error.message);
        expect_same(&whole, &pieces, step);
    }
    simulation_end(&whole);
    simulation_end(&pieces);
    kiln_scene_destroy(&scene);
}

/* ---- damage ---------------------------------------------------------------------------------- */

#define DAMAGED FILE_NAME ": the gas of the state is damaged"

struct runs {
    struct kiln_scene *scene;
    struct simulation first, second;
};

static void start_room(struct runs *runs)
{
    runs->scene = load_scene(ROOM, NULL);
    simulation_start(&runs->first, runs->scene, NULL, 1);
    simulation_start(&runs->second, runs->scene, NULL, 1);
    simulation_run(&runs->first, 4);
}

static void end_room(struct runs *runs)
{
    simulation_end(&runs->first);
    simulation_end(&runs->second);
    kiln_scene_destroy(&runs->scene);
}

/* Returns the number of an active brick. */
static size_t some_brick(const struct kiln_gas *gas)
{
    size_t i = 0;
    while (!gas->brick[i].now)
        i++;
    return i;
}

/* A state whose checksums are right, but which has a number that no step makes. */
static void wrong_numbers_are_refused(void **state)
{
    (void)state;
    struct runs runs;
    start_room(&runs);
    struct kiln_gas *gas = &runs.first.pool.gas[0];
    const struct kiln_gas_brick *brick = &gas->brick[some_brick(gas)];
    const ptrdiff_t last = gas->cells.z * gas->plane;
    const struct {
        float *number, value;
    } cases[] = {
        {&brick->now[GAS_SMOKE], -0.5f},
        {&brick->now[17 * GAS_CARRIED + GAS_TEMPERATURE], NAN},
        {&brick->now[511 * GAS_CARRIED + GAS_FLAME], INFINITY},
        {&brick->extras[9], NAN},
        {&gas->faces[0][3], NAN},
        {&gas->faces[0][gas->cells.x], INFINITY},
        {&gas->faces[1][gas->cells.y * gas->row], -INFINITY},
        {&gas->faces[2][last], NAN},
        {&gas->pressure[2], NAN},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_error error = {0};
        const float before = *cases[i].number;
        *cases[i].number = cases[i].value;
        simulation_save(&runs.first, FILE_NAME);
        if (simulation_take_up(&runs.second, FILE_NAME, &error))
            fail_msg("case %zu: a state with the number %g is read", i, (double)cases[i].value);
        expect_error(&error, KILN_INVALID_INPUT, DAMAGED);
        *cases[i].number = before;
        simulation_save(&runs.first, FILE_NAME);
        error = (struct kiln_error){0};
        if (!simulation_take_up(&runs.second, FILE_NAME, &error))
            fail_msg("%s", error.message);
    }
    end_room(&runs);
}

/* A head with a window that no domain of gas has. */
static void wrong_windows_are_refused(void **state)
{
    (void)state;
    struct runs runs;
    start_room(&runs);
    struct kiln_gas *gas = &runs.second.pool.gas[0];
    const struct kiln_state_gas good = kiln_state_gas_of(&runs.first.pool.gas[0]);
    assert_true(kiln_state_gas_is_plausible(&good) && good.bricks > 0);
    struct kiln_state_gas bad[] = {good, good, good, good, good, good, good, good, good};
    const float infinite = INFINITY;
    const double not_a_number = NAN;
    bad[0].cells[0] += 8;       /* no multiple of 16 */
    bad[1].at[1] = 4;           /* neither */
    bad[2].cells[2] = 2048;     /* more than the longest edge */
    bad[3].at[0] = 0xfffffff0;  /* wraps around */
    bad[4].cells[1] = 0;        /* of no height */
    bad[5].bricks = 0x7fffffff; /* more than there are */
    bad[6].groups = 4;          /* more than there are */
    memcpy(&bad[7].fastest, &infinite, sizeof infinite);
    memcpy(&bad[8].due, &not_a_number, sizeof not_a_number);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        if (kiln_state_gas_is_plausible(&bad[i]))
            fail_msg("the head of case %zu is taken for one", i);
    struct kiln_state_gas strange[] = {good, good};
    strange[0].at[1] = 16; /* beyond this domain, of 16 cells */
    strange[1].groups = 1;
    for (size_t i = 0; i < sizeof strange / sizeof *strange; i++) {
        struct kiln_error error = {0};
        assert_true(kiln_state_gas_is_plausible(&strange[i]));
        assert_false(kiln_state_gas_shape(gas, &strange[i], "s", &error));
        expect_error(&error, KILN_INVALID_INPUT, "s: the state belongs to other domains of gas");
    }
    end_room(&runs);
}

/* Fills the list of bricks with one list, and all other tables with zeros. */
struct listing {
    struct kiln_state_visitor visitor;
    const uint32_t *list;
    uint32_t *tables; /* that were visited */
};

static bool fill_table(const struct kiln_state_visitor *visitor, const struct kiln_table *table,
                       struct kiln_error *error)
{
    const struct listing *listing = (const struct listing *)visitor;
    (void)error;
    if ((*listing->tables)++ == 0)
        memcpy(table->words, listing->list, table->rows * sizeof *listing->list);
    else
        memset(table->words, 0, table->rows * table->columns * sizeof *listing->list);
    return true;
}

/* Bricks that are listed twice, out of order, or beyond the window. Entries are twice the number of
 * a brick, plus 1 if it has gas. */
static void wrong_lists_are_refused(void **state)
{
    (void)state;
    static const uint32_t lists[][3] = {{0, 5, 14}, {3, 3, 4},  {2, 3, 5},
                                        {4, 2, 6},  {0, 2, 16}, {0, 2, 0xffffffff}};
    struct runs runs;
    start_room(&runs);
    struct kiln_gas *gas = &runs.second.pool.gas[0];
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        uint32_t tables = 0;
        const struct listing listing = {.visitor = {.visit = fill_table, .path = FILE_NAME},
                                        .list = lists[i],
                                        .tables = &tables};
        struct kiln_state_gas head = kiln_state_gas_of(&runs.first.pool.gas[0]);
        struct kiln_error error = {0};
        head.bricks = 3;
        assert_true(kiln_state_gas_shape(gas, &head, "s", &error));
        assert_int_equal(gas->bricks.x * gas->bricks.y * gas->bricks.z, 8);
        assert_true(kiln_state_gas_visit(&listing.visitor, &head, gas, &error) == (i == 0));
        if (i > 0)
            expect_error(&error, KILN_INVALID_INPUT, DAMAGED);
    }
    end_room(&runs);
}

/* Any byte that changes, and any end that is cut off, is seen. */
static void damage_is_seen(void **state)
{
    (void)state;
    struct runs runs;
    start_room(&runs);
    simulation_save(&runs.first, FILE_NAME);
    FILE *file = fopen(FILE_NAME, "rb");
    assert_non_null(file);
    uint8_t *bytes = malloc(1 << 22);
    assert_non_null(bytes);
    const size_t size = fread(bytes, 1, 1 << 22, file);
    fclose(file);
    assert_true(size > 1000 && size < 1 << 22);
    const size_t stride = size / 97 + 1;
    for (size_t i = 20; i < size; i += stride)
        for (int cut = 0; cut < 2; cut++) {
            struct kiln_error error = {0};
            const uint8_t before = bytes[i];
            if (!cut)
                bytes[i] = (uint8_t)(before ^ 4u);
            file = fopen(FILE_NAME, "wb");
            assert_non_null(file);
            assert_int_equal(fwrite(bytes, 1, cut ? i : size, file), cut ? i : size);
            fclose(file);
            bytes[i] = before;
            if (simulation_take_up(&runs.second, FILE_NAME, &error))
                fail_msg("a state %s at byte %zu is read", cut ? "cut" : "changed", i);
            assert_int_equal(error.code, KILN_INVALID_INPUT);
        }
    free(bytes);
    end_room(&runs);
}

/* ---- numbers that are not finite ------------------------------------------------------------- */

/* A velocity that is not finite ends the run with the domain, the step and the place: that of the
 * first such cell. The step mixes the velocity of the face at (0.05, 0.9, 0.25) m into cells of 0.1
 * m that are up to two away from it. */
static void infinite_numbers_end_a_run(void **state)
{
    (void)state;
    static const float values[] = {INFINITY, NAN, -INFINITY};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        struct runs runs;
        struct kiln_error error = {0};
        start_room(&runs);
        const struct kiln_gas *gas = &runs.first.pool.gas[0];
        gas->faces[1][10 * gas->plane + 9 * gas->row + 8] = values[i];
        assert_false(kiln_simulate_step(runs.first.simulate, &runs.first.pool, 5, &error));
        expect_error(&error, KILN_DEVICE_FAILED,
                     "gas.room: found a number that is not finite in step 5 at (0.05, 0.85, 0.05) "
                     "m; smaller values of its sources and forces, or more substeps, may help");
        end_room(&runs);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(runs_of_gas_go_on, test_enter_folder, test_leave_folder),
        cmocka_unit_test_setup_teardown(pieces_make_up_a_run, test_enter_folder, test_leave_folder),
        cmocka_unit_test_setup_teardown(wrong_numbers_are_refused, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test(wrong_windows_are_refused),
        cmocka_unit_test(wrong_lists_are_refused),
        cmocka_unit_test_setup_teardown(damage_is_seen, test_enter_folder, test_leave_folder),
        cmocka_unit_test(infinite_numbers_end_a_run),
    };
    return cmocka_run_group_tests_name("gas_states", tests, NULL, NULL);
}
