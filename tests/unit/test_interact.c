/* Collisions of particles with each other: closed forms in double, what is kept, and that no pair
 * is missed. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "shared/papers/interact_staggered.h"
#include "sim/crowd/interact.h"
#include "support/balls.h"
#include "support/cmocka.h"

static struct scene_fixture fixture; /* too large for a stack */

static void start(struct simulation *run)
{
    simulation_start(run, &fixture.scene, NULL, 2);
}

static void is_about(float3 found, double x, double y, double z, double within)
{
    if (!(fabs((double)found.x - x) <= within && fabs((double)found.y - y) <= within &&
          fabs((double)found.z - z) <= within))
        fail_msg("(%.7g, %.7g, %.7g), expected (%.7g, %.7g, %.7g) within %g", (double)found.x,
                 (double)found.y, (double)found.z, x, y, z, within);
}

static float3 position_of(struct simulation *run, uint32_t slot)
{
    return particle_position(simulation_records(run)[slot]);
}

static float3 velocity_of(struct simulation *run, uint32_t slot)
{
    return particle_velocity(simulation_records(run)[slot]);
}

/* ---- two balls ------------------------------------------------------------------------------ */

/* Two balls fly at each other for a second; they meet in the middle of a step. */
static void two_balls(struct simulation *run, float radius, float aside)
{
    balls_init(&fixture, 2, radius);
    start(run);
    balls_place(run, 0, FLOAT3(-0.513f, 0.0f, 0.0f), FLOAT3(1.0f, 0.0f, 0.0f));
    balls_place(run, 1, FLOAT3(0.513f, aside, 0.0f), FLOAT3(-1.0f, 0.0f, 0.0f));
    simulation_run(run, 60);
}

static void head_on_they_exchange_velocities(void **state)
{
    (void)state;
    struct simulation run;
    two_balls(&run, 0.1f, 0.0f);
    is_about(velocity_of(&run, 0), -1.0, 0.0, 0.0, 1e-6);
    is_about(velocity_of(&run, 1), 1.0, 0.0, 0.0, 1e-6);
    const double met_s = 0.513 - 0.1; /* each at 1 m/s, to 0.1 m from the middle */
    is_about(position_of(&run, 0), -0.1 - (1.0 - met_s), 0.0, 0.0, 2e-6);
    is_about(position_of(&run, 1), 0.1 + (1.0 - met_s), 0.0, 0.0, 2e-6);
    simulation_end(&run);
}

/* Only the velocities along the line between the centres at contact are exchanged. */
static void aslant_they_part_along_the_line_of_contact(void **state)
{
    (void)state;
    struct simulation run;
    const double radius = 0.1, aside = 0.12;
    two_balls(&run, (float)radius, (float)aside);
    const double ahead = sqrt(4.0 * radius * radius - aside * aside);
    const double met_s = (2.0 * 0.513 - ahead) / 2.0;
    const double nx = ahead / (2.0 * radius), ny = aside / (2.0 * radius);
    const double change = 2.0 * nx; /* speed of approach along the normal */
    const double vx = 1.0 - change * nx, vy = -change * ny;
    const double x = -0.513 + met_s + vx * (1.0 - met_s), y = vy * (1.0 - met_s);
    is_about(velocity_of(&run, 0), vx, vy, 0.0, 4e-6);
    is_about(velocity_of(&run, 1), -vx, -vy, 0.0, 4e-6);
    is_about(position_of(&run, 0), x, y, 0.0, 4e-6);
    is_about(position_of(&run, 1), -x, aside - y, 0.0, 4e-6);
    simulation_end(&run);
}

static void half_of_the_speed_may_be_lost(void **state)
{
    (void)state;
    struct simulation run;
    balls_init(&fixture, 2, 0.1f)->restitution = fixture_constant(0.5f);
    start(&run);
    balls_place(&run, 0, FLOAT3(0.0f, -0.5f, 0.0f), FLOAT3(0.0f, 3.0f, 0.2f));
    balls_place(&run, 1, FLOAT3(0.0f, 0.5f, 0.0f), FLOAT3(0.0f, 0.0f, 0.2f));
    simulation_run(&run, 60);
    is_about(velocity_of(&run, 0), 0.0, 0.75, 0.2, 2e-6);
    is_about(velocity_of(&run, 1), 0.0, 2.25, 0.2, 2e-6);
    simulation_end(&run);
}

/* Radii as the look draws them; the fixture's key and the serial decide. */
static double drawn_radius(uint32_t serial)
{
    const uint32_t stream = random_stream(random_key(fixture.scene.seed, 0), serial);
    return 0.5 * 0.2 * (double)random_between(stream, RANDOM_SCALE, 0.5f, 2.0f);
}

static double drawn_mass(uint32_t serial)
{
    return pow(drawn_radius(serial), 3.0);
}

static void init_drawn(uint32_t count)
{
    balls_init(&fixture, count, 0.1f)->as_drawn = true;
    fixture.scene.systems[0].look.scale = fixture_range(0.5f, 2.0f);
}

static void the_larger_ball_is_heavier(void **state)
{
    (void)state;
    struct simulation run;
    init_drawn(2);
    while (fabs(drawn_mass(0) - drawn_mass(1)) < 0.5 * drawn_mass(0))
        fixture.scene.seed++;
    start(&run);
    balls_place(&run, 0, FLOAT3(-0.5f, 0.0f, 0.0f), FLOAT3(2.0f, 0.0f, 0.0f));
    balls_place(&run, 1, FLOAT3(0.5f, 0.0f, 0.0f), FLOAT3(-1.0f, 0.0f, 0.0f));
    simulation_run(&run, 60);
    const double a = drawn_mass(0), b = drawn_mass(1);
    const double after_a = (2.0 * (a - b) - 2.0 * b) / (a + b);
    const double after_b = (-1.0 * (b - a) + 4.0 * a) / (a + b);
    is_about(velocity_of(&run, 0), after_a, 0.0, 0.0, 4e-6);
    is_about(velocity_of(&run, 1), after_b, 0.0, 0.0, 4e-6);
    const double met_s = (1.0 - drawn_radius(0) - drawn_radius(1)) / 3.0;
    is_about(position_of(&run, 0), -0.5 + 2.0 * met_s + after_a * (1.0 - met_s), 0.0, 0.0, 4e-6);
    simulation_end(&run);
}

static void balls_in_one_place_part(void **state)
{
    (void)state;
    struct simulation run;
    balls_init(&fixture, 2, 0.1f);
    start(&run);
    balls_place(&run, 0, FLOAT3(1.0f, 1.0f, 1.0f), FLOAT3(0.0f, 0.0f, 0.0f));
    balls_place(&run, 1, FLOAT3(1.0f, 1.0f, 1.0f), FLOAT3(0.0f, 0.0f, 0.0f));
    simulation_run(&run, 60);
    const float3 a = position_of(&run, 0), b = position_of(&run, 1);
    assert_true(fabsf(a.y - b.y) > 0.199f && fabsf(a.y - b.y) < 0.201f);
    assert_true(fabsf(a.y + b.y - 2.0f) < 1e-6f);
    simulation_end(&run);
}

/* ---- many balls ----------------------------------------------------------------------------- */

/* Momentum goes along the row, a ball a step. */
static void newtons_cradle(void **state)
{
    (void)state;
    struct simulation run;
    enum { BALLS = 6 };
    balls_init(&fixture, BALLS, 0.1f);
    start(&run);
    balls_place(&run, 0, FLOAT3(-1.0f, 0.0f, 0.0f), FLOAT3(2.0f, 0.0f, 0.0f));
    for (uint32_t i = 1; i < BALLS; i++)
        balls_place(&run, i, FLOAT3(0.2f * (float)i, 0.0f, 0.0f), FLOAT3(0.0f, 0.0f, 0.0f));
    simulation_run(&run, 60);
    for (uint32_t i = 0; i + 1 < BALLS; i++)
        is_about(velocity_of(&run, i), 0.0, 0.0, 0.0, 1e-5);
    is_about(velocity_of(&run, BALLS - 1), 2.0, 0.0, 0.0, 1e-5);
    simulation_end(&run);
}

/* Of three that touch, the outer two wait for each other; nothing is made or lost. */
static void a_chain_keeps_its_momentum(void **state)
{
    (void)state;
    struct simulation run;
    balls_init(&fixture, 3, 0.1f)->rounds = 1;
    start(&run);
    balls_place(&run, 0, FLOAT3(-0.15f, 0.0f, 0.0f), FLOAT3(1.0f, 0.3f, 0.0f));
    balls_place(&run, 1, FLOAT3(0.0f, 0.01f, 0.0f), FLOAT3(0.0f, 0.0f, 0.0f));
    balls_place(&run, 2, FLOAT3(0.16f, 0.0f, 0.0f), FLOAT3(-2.0f, 0.0f, 0.5f));
    for (int step = 0; step < 20; step++) {
        simulation_run(&run, 1);
        const struct balls_sums sums = balls_sum(&run, 3, NULL);
        assert_true(fabs(sums.momentum[0] + 1.0) < 1e-6);
        assert_true(fabs(sums.momentum[1] - 0.3) < 1e-6);
        assert_true(fabs(sums.momentum[2] - 0.5) < 1e-6);
        assert_true(fabs(sums.energy - 0.5 * (1.09 + 4.25)) < 4e-6);
    }
    const float3 a = position_of(&run, 0), b = position_of(&run, 1), c = position_of(&run, 2);
    assert_true(float3_length(float3_sub(a, b)) > 0.1999f);
    assert_true(float3_length(float3_sub(b, c)) > 0.1999f);
    simulation_end(&run);
}

enum { MANY = 1000 };

/* A ball of balls that fall inwards. */
static void place_crowd(struct simulation *run)
{
    uint32_t seed = 5;
    for (uint32_t i = 0; i < MANY; i++) {
        const float x = balls_random(&seed), y = balls_random(&seed), z = balls_random(&seed);
        balls_place(run, i, FLOAT3(x, y, z),
                    FLOAT3(-x + balls_random(&seed), -y, -z + balls_random(&seed)));
    }
}

static void are_kept(struct balls_sums before, struct balls_sums after)
{
    const double scale = sqrt(2.0 * before.energy * before.mass);
    for (int k = 0; k < 3; k++)
        assert_true(fabs(after.momentum[k] - before.momentum[k]) < 2e-7 * scale);
    assert_true(fabs(after.energy - before.energy) < 2e-6 * before.energy);
}

static void a_crowd_keeps_momentum_and_energy(void **state)
{
    (void)state;
    struct simulation run;
    for (int drawn = 0; drawn < 2; drawn++) {
        if (drawn)
            init_drawn(MANY);
        else
            balls_init(&fixture, MANY, 0.05f);
        start(&run);
        place_crowd(&run);
        double (*mass)(uint32_t) = drawn ? drawn_mass : NULL;
        const struct balls_sums before = balls_sum(&run, MANY, mass);
        simulation_run(&run, 90);
        const struct balls_sums after = balls_sum(&run, MANY, mass);
        are_kept(before, after);
        simulation_end(&run);
    }
}

/* Walls of six boxes: what bounces off them keeps its speed. */
static void a_box_full_of_balls_keeps_its_energy(void **state)
{
    (void)state;
    struct simulation run;
    balls_init(&fixture, MANY, 0.05f);
    fixture.scene.systems[0].collide.enabled = true;
    for (int side = -1; side <= 1; side += 2) {
        const float at = 2.2f * (float)side;
        fixture_add_box(&fixture, at, 0.0f, 0.0f, 2.0f, 9.0f, 9.0f);
        fixture_add_box(&fixture, 0.0f, at, 0.0f, 9.0f, 2.0f, 9.0f);
        fixture_add_box(&fixture, 0.0f, 0.0f, at, 9.0f, 9.0f, 2.0f);
    }
    start(&run);
    place_crowd(&run);
    const struct balls_sums before = balls_sum(&run, MANY, NULL);
    simulation_run(&run, 120);
    const struct balls_sums after = balls_sum(&run, MANY, NULL);
    assert_int_equal((int)after.mass, MANY);
    assert_true(fabs(after.energy - before.energy) < 1e-5 * before.energy);
    for (uint32_t i = 0; i < MANY; i++) {
        const float3 p = position_of(&run, i);
        assert_true(fabsf(p.x) < 1.21f && fabsf(p.y) < 1.21f && fabsf(p.z) < 1.21f);
    }
    simulation_end(&run);
}

/* A ball rests on the floor with its skin, not with its middle. */
static void balls_meet_surfaces_with_their_radius(void **state)
{
    (void)state;
    struct simulation run;
    balls_init(&fixture, 2, 0.25f);
    struct kiln_system *s = &fixture.scene.systems[0];
    fixture_add_force(s, KILN_FORCE_GRAVITY)->vector = fixture_constant3(0.0f, -9.81f, 0.0f);
    s->collide.enabled = true;
    s->collide.slowdown = fixture_constant(0.4f);
    fixture.scene.backdrop.floor_enabled = true;
    fixture.scene.backdrop.floor_collide = true;
    fixture.scene.backdrop.floor_height = fixture_constant(0.0f);
    fixture_add_box(&fixture, 3.0f, 0.5f, 0.0f, 1.0f, 1.0f, 1.0f);
    start(&run);
    balls_place(&run, 0, FLOAT3(0.0f, 1.0f, 0.0f), FLOAT3(0.0f, 0.0f, 0.0f));
    balls_place(&run, 1, FLOAT3(3.0f, 2.0f, 0.0f), FLOAT3(0.0f, 0.0f, 0.0f));
    for (int step = 0; step < 180; step++) {
        simulation_run(&run, 1);
        assert_true(position_of(&run, 0).y > 0.2499f && position_of(&run, 1).y > 1.2499f);
    }
    assert_true(position_of(&run, 0).y < 0.26f && position_of(&run, 1).y < 1.26f);
    simulation_end(&run);
}

/* ---- the search ----------------------------------------------------------------------------- */

struct found {
    uint32_t collisions; /* bodies that touch another */
    uint32_t missed;     /* of which the search knows no partner, or not the closest one */
};

/* Compares each body's partner with the closest of all. */
static struct found compare_with_all(const struct kiln_crowd *view, const struct kiln_body *bodies,
                                     const uint32_t *partners, uint32_t count)
{
    struct found found = {0};
    for (uint32_t i = 0; i < count; i++) {
        struct contact_choice best = contact_no_choice();
        for (uint32_t k = 0; k < count; k++)
            best = contact_choose(view, best, bodies[i], bodies[k], k);
        found.collisions += best.partner != INTERACT_NOBODY;
        found.missed += partners[i] != best.partner;
        if (partners[i] != INTERACT_NOBODY) {
            assert_true(contact_is_near(bodies[i], bodies[partners[i]]) ||
                        contact_is_ahead(view, bodies[i], bodies[partners[i]]));
        }
    }
    return found;
}

/* What the technique finds of the balls that have been placed. */
static struct found search(struct simulation *run)
{
    struct kiln_error error = {0};
    struct kiln_sim_grids grids;
    struct kiln_sim_params *params = malloc(sizeof *params);
    struct kiln_interact interact;
    assert_non_null(params);
    assert_true(kiln_sim_grids_init(&grids, NULL, &fixture.scene, run->threads, &error));
    kiln_sim_params_init(params, &fixture.scene, &grids);
    assert_true(
        kiln_sim_params_step(params, &fixture.scene, &run->pool, BALLS_FIRST_STEP + 1, &error));
    assert_true(kiln_interact_init(&interact, NULL, &fixture.scene, run->threads, &error));
    assert_true(kiln_interact_gather(&interact, params, &run->pool, NULL, &error));
    const struct kiln_body *bodies = kiln_buffer_host(&interact.bodies, KILN_READ, &error);
    const uint32_t *partners = kiln_buffer_host(&interact.partners, KILN_READ, &error);
    const float fastest = fixture.scene.systems[0].interactions[0].fastest.constant;
    const struct kiln_interact_params told = {.ahead_s = fastest > 0.0f ? fixture.scene.dt_s : 0.0f,
                                              .fastest_square = fastest * fastest};
    const struct kiln_crowd view = {.params = &told};
    const struct found found = compare_with_all(&view, bodies, partners, MANY);
    kiln_interact_finish(&interact);
    kiln_sim_grids_finish(&grids);
    free(params);
    return found;
}

/* Balls within `spread` m of a place, in one round, which leaves the bodies as they were found. */
static struct found search_around(float center, float spread, enum kiln_contact_mode mode)
{
    struct simulation run;
    fixture.scene.systems[0].interactions[0].rounds = 1;
    fixture.scene.systems[0].interactions[0].mode = mode;
    start(&run);
    uint32_t seed = 11;
    for (uint32_t i = 0; i < MANY; i++) {
        const float x = center + spread * balls_random(&seed);
        const float y = spread * balls_random(&seed), z = spread * balls_random(&seed) - center;
        balls_place(&run, i, FLOAT3(x, y, z),
                    FLOAT3(balls_random(&seed), balls_random(&seed), balls_random(&seed)));
    }
    const struct found found = search(&run);
    simulation_end(&run);
    return found;
}

static void no_pair_is_missed(void **state)
{
    (void)state;
    static const float places[][2] = {{0.0f, 1.5f}, {0.0f, 0.3f}, {30000.0f, 1.5f}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        init_drawn(MANY);
        const struct found found = search_around(places[i][0], places[i][1], KILN_CONTACT_EXACT);
        assert_true(found.collisions > 100);
        assert_int_equal(found.missed, 0);
        fixture.scene.systems[0].interactions[0].fastest = fixture_constant(8.0f);
        const struct found foreseen = search_around(places[i][0], places[i][1], KILN_CONTACT_EXACT);
        assert_true(foreseen.collisions >= found.collisions + (i == 0));
        assert_int_equal(foreseen.missed, 0);
    }
}

/* ---- ahead of time -------------------------------------------------------------------------- */

/* In a step each flies ten times its radius. */
static void fast_balls_do_not_pass_through_each_other(void **state)
{
    (void)state;
    struct simulation run;
    const double radius = 0.1, aside = 0.12, speed = 60, start_m = 3.513;
    for (int half = 0; half < 2; half++) {
        balls_init(&fixture, 2, (float)radius)->fastest = fixture_constant(120.0f);
        fixture.scene.systems[0].interactions[0].restitution = fixture_constant(half ? 0.5f : 1.0f);
        start(&run);
        balls_place(&run, 0, FLOAT3((float)-start_m, 0.0f, 0.0f), FLOAT3((float)speed, 0.0f, 0.0f));
        balls_place(&run, 1, FLOAT3((float)start_m, (float)aside, 0.0f),
                    FLOAT3((float)-speed, 0.0f, 0.0f));
        simulation_run(&run, 6);
        const double ahead = sqrt(4 * radius * radius - aside * aside);
        const double met_s = (2 * start_m - ahead) / (2 * speed), left_s = 0.1 - met_s;
        const double nx = ahead / (2 * radius), ny = aside / (2 * radius);
        const double change = (half ? 1.5 : 2.0) * speed * nx;
        const double vx = speed - change * nx, vy = -change * ny;
        const double x = -start_m + met_s * speed + vx * left_s, y = vy * left_s;
        is_about(velocity_of(&run, 0), vx, vy, 0, 2e-4);
        is_about(velocity_of(&run, 1), -vx, -vy, 0, 2e-4);
        is_about(position_of(&run, 0), x, y, 0, 2e-4);
        is_about(position_of(&run, 1), -x, aside - y, 0, 2e-4);
        simulation_end(&run);
    }
}

/* Balls in a line, each of which flies over up to two of its widths in a step: how many neighbours
 * have changed places. */
static uint32_t count_jumps(float fastest)
{
    struct simulation run;
    enum { LINE = 40 };
    uint32_t seed = 3;
    balls_init(&fixture, LINE, 0.05f)->fastest = fixture_constant(fastest);
    start(&run);
    for (uint32_t i = 0; i < LINE; i++)
        balls_place(&run, i, FLOAT3(0.5f * (float)i, 0.0f, 0.0f),
                    FLOAT3(12.0f * balls_random(&seed), 0.0f, 0.0f));
    const struct balls_sums before = balls_sum(&run, LINE, NULL);
    simulation_run(&run, 30);
    uint32_t jumps = 0;
    for (uint32_t i = 0; i + 1 < LINE; i++)
        jumps += position_of(&run, i).x > position_of(&run, i + 1).x;
    are_kept(before, balls_sum(&run, LINE, NULL));
    simulation_end(&run);
    return jumps;
}

static void fewer_of_a_fast_crowd_pass_through_each_other(void **state)
{
    (void)state;
    const uint32_t without = count_jumps(0.0f), foreseen = count_jumps(24.0f);
    print_message("of 39 neighbours %u changed places, foreseen %u\n", without, foreseen);
    assert_true(without >= 8 && foreseen * 2 <= without);
}

/* The paper's grids find most. */
static void staggered_grids_miss_some(void **state)
{
    (void)state;
    static const float spreads[] = {3.0f, 1.5f, 1.0f};
    for (size_t i = 0; i < sizeof spreads / sizeof *spreads; i++) {
        balls_init(&fixture, MANY, 0.1f);
        const struct found found = search_around(0.0f, spreads[i], KILN_CONTACT_STAGGERED);
        assert_true(found.collisions > 20);
        const double share = (double)found.missed / (double)found.collisions;
        print_message("balls within %.1f m: %u collide, staggered grids miss %.1f %%\n",
                      (double)spreads[i], found.collisions, 100.0 * share);
        assert_true(share > 0.0 && share < 0.5);
    }
}

static void staggered_collisions_keep_momentum_and_energy(void **state)
{
    (void)state;
    struct simulation run;
    balls_init(&fixture, MANY, 0.05f)->mode = KILN_CONTACT_STAGGERED;
    start(&run);
    place_crowd(&run);
    const struct balls_sums before = balls_sum(&run, MANY, NULL);
    simulation_run(&run, 60);
    const struct balls_sums after = balls_sum(&run, MANY, NULL);
    are_kept(before, after);
    simulation_end(&run);
}

/* Some are as far away as anything may be, all around: their cells' numbers are at the limits. */
static void any_number_of_threads_finds_the_same(void **state)
{
    (void)state;
    static const uint32_t threads[] = {1, 2, 7, 40};
    struct kiln_state_hash hashes[2][4];
    for (size_t i = 0; i < 8; i++) {
        struct simulation run;
        const enum kiln_contact_mode mode = i < 4 ? KILN_CONTACT_STAGGERED : KILN_CONTACT_EXACT;
        balls_init(&fixture, MANY, 0.05f)->mode = mode;
        simulation_start(&run, &fixture.scene, NULL, threads[i % 4]);
        place_crowd(&run);
        for (uint32_t far = 0; far < 60; far++) {
            const float at = far % 2 ? 1e6f : -1e6f, aside = 0.03f * (float)(far / 6);
            const uint32_t axis = far / 2 % 3;
            balls_place(
                &run, far * 16,
                FLOAT3(axis == 0 ? at : aside, axis == 1 ? at : 0.0f, axis == 2 ? at : 0.0f),
                FLOAT3(0.0f, 0.0f, 0.0f));
        }
        hashes[i / 4][i % 4] = simulation_run_hashed(&run, 10);
        simulation_end(&run);
    }
    for (size_t i = 0; i < 8; i++)
        assert_memory_equal(&hashes[i / 4][i % 4], &hashes[i / 4][0], sizeof hashes[0][0]);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(head_on_they_exchange_velocities),
        cmocka_unit_test(aslant_they_part_along_the_line_of_contact),
        cmocka_unit_test(half_of_the_speed_may_be_lost),
        cmocka_unit_test(the_larger_ball_is_heavier),
        cmocka_unit_test(balls_in_one_place_part),
        cmocka_unit_test(newtons_cradle),
        cmocka_unit_test(a_chain_keeps_its_momentum),
        cmocka_unit_test(a_crowd_keeps_momentum_and_energy),
        cmocka_unit_test(a_box_full_of_balls_keeps_its_energy),
        cmocka_unit_test(balls_meet_surfaces_with_their_radius),
        cmocka_unit_test(no_pair_is_missed),
        cmocka_unit_test(fast_balls_do_not_pass_through_each_other),
        cmocka_unit_test(fewer_of_a_fast_crowd_pass_through_each_other),
        cmocka_unit_test(staggered_grids_miss_some),
        cmocka_unit_test(staggered_collisions_keep_momentum_and_energy),
        cmocka_unit_test(any_number_of_threads_finds_the_same),
    };
    return cmocka_run_group_tests_name("interact", tests, NULL, NULL);
}
