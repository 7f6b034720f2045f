/* Balls that turn (UberFlow 2004, 4.5): closed forms in double, what is kept, and what a run saves.
 */
#include <stddef.h>
#include <stdint.h>

#include "shared/spin.h"
#include "support/balls.h"
#include "support/cmocka.h"

static struct scene_fixture fixture; /* too large for a stack */

static const double RADIUS = 0.1, G = 9.81;

/* A ball, in double. */
struct ball {
    double x[3], v[3], w[3];
};

static void set3(double to[3], float3 from)
{
    to[0] = (double)from.x;
    to[1] = (double)from.y;
    to[2] = (double)from.z;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double y[3])
{
    for (int i = 0; i < 3; i++)
        y[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static struct kiln_spin *spins_of(struct simulation *run)
{
    struct kiln_error error = {0};
    struct kiln_spin *spins = kiln_buffer_host(&run->pool.spins, KILN_READ_WRITE, &error);
    assert_non_null(spins);
    return spins;
}

static struct ball ball_in(struct simulation *run, uint32_t slot)
{
    const struct kiln_particle p = simulation_records(run)[slot];
    struct ball ball;
    assert_true(particle_is_alive(p));
    set3(ball.x, particle_position(p));
    set3(ball.v, particle_velocity(p));
    set3(ball.w, spin_rate(spins_of(run)[slot].rate));
    return ball;
}

static void place(struct simulation *run, uint32_t slot, const struct ball *ball)
{
    balls_place(run, slot, FLOAT3((float)ball->x[0], (float)ball->x[1], (float)ball->x[2]),
                FLOAT3((float)ball->v[0], (float)ball->v[1], (float)ball->v[2]));
    spins_of(run)[slot] = (struct kiln_spin){
        .rate = spin_words_of(FLOAT3((float)ball->w[0], (float)ball->w[1], (float)ball->w[2])),
        .pose = spin_pose_words(FLOAT4(0.0f, 0.0f, 0.0f, 1.0f)),
    };
}

static void are_about(const double found[3], double x, double y, double z, double within)
{
    if (!(fabs(found[0] - x) <= within && fabs(found[1] - y) <= within &&
          fabs(found[2] - z) <= within))
        fail_msg("(%.7g, %.7g, %.7g), expected (%.7g, %.7g, %.7g) within %g", found[0], found[1],
                 found[2], x, y, z, within);
}

static struct kiln_interaction *init(uint32_t count, float friction)
{
    struct kiln_interaction *collide = balls_init(&fixture, count, (float)RADIUS);
    collide->spins = true;
    collide->friction = fixture_constant(friction);
    return collide;
}

/* ---- two balls ------------------------------------------------------------------------------ */

/* What a blow along n, from a to b, makes of two equal balls: the textbook's impulses. */
static void collide_in_double(struct ball *a, struct ball *b, const double n[3], double restitution,
                              double friction)
{
    double parting[3], skins[3], turning[3], slip[3], k[3], kn[3];
    for (int i = 0; i < 3; i++) {
        parting[i] = b->v[i] - a->v[i];
        skins[i] = RADIUS * (a->w[i] + b->w[i]);
    }
    cross(skins, n, turning);
    const double along = dot(parting, n), blow = -(1 + restitution) * along;
    for (int i = 0; i < 3; i++)
        slip[i] = parting[i] - along * n[i] - turning[i];
    const double speed = sqrt(dot(slip, slip));
    const double taken = fmin(2.0 / 7.0 * speed, friction * blow);
    for (int i = 0; i < 3; i++)
        k[i] = speed > 0 ? -taken / speed * slip[i] : 0;
    cross(k, n, kn);
    for (int i = 0; i < 3; i++) {
        b->v[i] += 0.5 * (blow * n[i] + k[i]);
        a->v[i] -= 0.5 * (blow * n[i] + k[i]);
        b->w[i] += 2.5 / RADIUS * 0.5 * kn[i];
        a->w[i] += 2.5 / RADIUS * 0.5 * kn[i];
    }
}

/* They meet in the middle of a step: friction stops the slip, or is not enough to. */
static void two_rub_as_in_the_closed_form(void **state)
{
    (void)state;
    for (int sticks = 0; sticks < 2; sticks++) {
        const double aside = 0.12, restitution = 0.8, friction = sticks ? 2.0 : 0.15;
        struct ball a = {{-0.513, 0, 0}, {1, 0.2, 0}, {2, -7, 9}};
        struct ball b = {{0.513, aside, 0}, {-1, 0.2, 0}, {1, 5, -4}};
        init(2, (float)friction)->restitution = fixture_constant((float)restitution);
        struct simulation run;
        simulation_start(&run, &fixture.scene, NULL, 2);
        place(&run, 0, &a);
        place(&run, 1, &b);
        simulation_run(&run, 60);
        const double ahead = sqrt(4 * RADIUS * RADIUS - aside * aside);
        const double met_s = (2 * 0.513 - ahead) / 2;
        const double n[3] = {ahead / (2 * RADIUS), aside / (2 * RADIUS), 0};
        double x[3];
        for (int i = 0; i < 3; i++)
            x[i] = a.x[i] + met_s * a.v[i];
        collide_in_double(&a, &b, n, restitution, friction);
        const struct ball found = ball_in(&run, 0), other = ball_in(&run, 1);
        are_about(found.v, a.v[0], a.v[1], a.v[2], 1e-5);
        are_about(other.v, b.v[0], b.v[1], b.v[2], 1e-5);
        are_about(found.w, a.w[0], a.w[1], a.w[2], 2e-4);
        are_about(other.w, b.w[0], b.w[1], b.w[2], 2e-4);
        are_about(found.x, x[0] + a.v[0] * (1 - met_s), x[1] + a.v[1] * (1 - met_s),
                  x[2] + a.v[2] * (1 - met_s), 1e-5);
        simulation_end(&run);
    }
}

struct sums {
    double momentum[3], angular[3], energy;
};

/* Of balls of masses as their volumes, about the middle of the pair's place. */
static struct sums sums_of(const struct ball *balls, const double *radii, const double *middle)
{
    struct sums sums = {0};
    for (int i = 0; i < 2; i++) {
        const double mass = pow(radii[i] / RADIUS, 3), inertia = 0.4 * mass * radii[i] * radii[i];
        const struct ball *b = &balls[i];
        double arm[3], moment[3];
        for (int c = 0; c < 3; c++)
            arm[c] = b->x[c] - middle[c];
        cross(arm, b->v, moment);
        for (int c = 0; c < 3; c++) {
            sums.momentum[c] += mass * b->v[c];
            sums.angular[c] += mass * moment[c] + inertia * b->w[c];
        }
        sums.energy += 0.5 * mass * dot(b->v, b->v) + 0.5 * inertia * dot(b->w, b->w);
    }
    return sums;
}

static double drawn_radius(uint32_t serial)
{
    const uint32_t stream = random_stream(random_key(fixture.scene.seed, 0), serial);
    return (double)(((2.0f * (float)RADIUS) * 0.5f) *
                    random_between(stream, RANDOM_SCALE, 0.6f, 1.4f));
}

/* Where the pair of a ball is: near the origin, where floats are fine. */
static void find_middle(uint32_t ball, double middle[3])
{
    const uint32_t pair = ball / 2;
    for (uint32_t c = 0, of = 1; c < 3; c++, of *= 6)
        middle[c] = 2.0 * (pair / of % 6) - 5;
}

/* Many pairs, each apart from the others: of unequal balls, that hit or graze each other. */
static void pairs_keep_momentum_angular_momentum_and_no_more_energy(void **state)
{
    (void)state;
    enum { PAIRS = 200 };
    struct kiln_interaction *collide = init(2 * PAIRS, 0.3f);
    collide->as_drawn = true;
    collide->restitution = fixture_constant(0.9f);
    fixture.scene.systems[0].look.scale = fixture_range(0.6f, 1.4f);
    struct simulation run;
    struct ball balls[2 * PAIRS];
    simulation_start(&run, &fixture.scene, NULL, 2);
    uint32_t seed = 17;
    for (uint32_t i = 0; i < 2 * PAIRS; i++) {
        const double side = i % 2 ? 1 : -1;
        double middle[3];
        find_middle(i, middle);
        balls[i] =
            (struct ball){{middle[0] + 0.2 * side, middle[1] + 0.12 * (double)balls_random(&seed),
                           middle[2] + 0.12 * (double)balls_random(&seed)},
                          {-side, 0.3 * (double)balls_random(&seed), 0},
                          {0, 0, 0}};
        for (int c = 0; c < 3; c++)
            balls[i].w[c] = 15 * (double)balls_random(&seed);
        place(&run, i, &balls[i]);
        balls[i] = ball_in(&run, i);
    }
    simulation_run(&run, 12);
    uint32_t rubbed = 0;
    for (uint32_t i = 0; i < 2 * PAIRS; i += 2) {
        const double radii[2] = {drawn_radius(i), drawn_radius(i + 1)};
        double middle[3];
        find_middle(i, middle);
        const struct ball after[2] = {ball_in(&run, i), ball_in(&run, i + 1)};
        const struct sums a = sums_of(&balls[i], radii, middle), b = sums_of(after, radii, middle);
        are_about(b.momentum, a.momentum[0], a.momentum[1], a.momentum[2], 2e-5);
        are_about(b.angular, a.angular[0], a.angular[1], a.angular[2], 2e-5);
        assert_true(b.energy <= a.energy * (1 + 1e-5));
        rubbed += fabs(after[0].w[0] - balls[i].w[0]) > 1e-3;
    }
    assert_true(rubbed > PAIRS / 2 && rubbed < PAIRS);
    simulation_end(&run);
}

/* ---- on surfaces ---------------------------------------------------------------------------- */

static void init_on_ground(float friction)
{
    init(1, 0.0f);
    struct kiln_system *s = &fixture.scene.systems[0];
    fixture_add_force(s, KILN_FORCE_GRAVITY)->vector = fixture_constant3(0.0f, (float)-G, 0.0f);
    s->collide.enabled = true;
    s->collide.restitution = fixture_constant(0.0f);
    s->collide.friction = fixture_constant(friction);
}

/* From there, for so many steps. */
static struct ball roll(const struct ball *from, uint32_t steps)
{
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    place(&run, 0, from);
    simulation_run(&run, steps);
    const struct ball ball = ball_in(&run, 0);
    simulation_end(&run);
    return ball;
}

/* 5/7 g sin(slope), or g (sin - friction cos) where friction is not enough for that. */
static void balls_roll_down_a_slope(void **state)
{
    (void)state;
    const double slope = 0.4, c = cos(slope), s = sin(slope);
    for (int slips = 0; slips < 2; slips++) {
        const double friction = slips ? 0.05 : 0.5;
        init_on_ground((float)friction);
        fixture_add_plane(&fixture, 0, 0, 0)->axis = fixture_constant3((float)s, (float)c, 0.0f);
        const struct ball from = {.x = {RADIUS * s, RADIUS * c, 0}};
        const struct ball early = roll(&from, 30), late = roll(&from, 90);
        const double found = (late.v[0] * c - late.v[1] * s) - (early.v[0] * c - early.v[1] * s);
        const double expected = slips ? G * (s - friction * c) : 5.0 / 7.0 * G * s;
        assert_true(fabs(found - expected) < 1e-3 * expected);
        const double skin = -late.w[2] * RADIUS, speed = late.v[0] * c - late.v[1] * s;
        assert_true(slips ? skin < 0.6 * speed : fabs(skin - speed) < 1e-3 * speed);
        assert_true(late.x[0] * s + late.x[1] * c < RADIUS + 0.01);
    }
}

static void init_on_floor(float friction)
{
    init_on_ground(friction);
    fixture.scene.backdrop.floor_enabled = true;
    fixture.scene.backdrop.floor_collide = true;
    fixture.scene.backdrop.floor_height = fixture_constant(0.0f);
}

/* Pushed, it slides at first; with backspin, it comes back. What turns against its way at the
 * start, 2/5 r w, is taken from 5/7 of the speed. */
static void sliding_ends_in_rolling(void **state)
{
    (void)state;
    static const double backspins[] = {0, 20, 60};
    for (int i = 0; i < 3; i++) {
        init_on_floor(0.2f);
        const struct ball from = {{0, RADIUS, 0}, {2, 0, 0}, {0, 0, backspins[i]}};
        const struct ball ball = roll(&from, 240);
        const double speed = 5.0 / 7.0 * (2 - 0.4 * RADIUS * backspins[i]);
        assert_true(i < 2 ? speed > 0 : speed < 0);
        are_about(ball.v, speed, ball.v[1], 0, 2e-3);
        are_about(ball.w, 0, 0, -speed / RADIUS, 2e-2);
    }
}

/* Rolling resistance slows by 5/7 of its part of gravity, down to rest. */
static void rolling_may_cost(void **state)
{
    (void)state;
    init_on_floor(0.5f);
    fixture.scene.systems[0].interactions[0].rolling = fixture_constant(0.02f);
    const struct ball from = {{0, RADIUS, 0}, {1, 0, 0}, {0, 0, -1 / RADIUS}};
    const double slower = 5.0 / 7.0 * 0.02 * G;
    const struct ball early = roll(&from, 30), later = roll(&from, 90), late = roll(&from, 600);
    assert_true(fabs(early.v[0] - later.v[0] - slower) < 1e-3 * slower);
    assert_true(fabs(late.v[0]) < 1e-3 && fabs(late.w[2]) < 1e-2);
}

/* A belt takes a ball along at 2/7 of its speed, when that has come to roll. */
static void a_belt_takes_balls_along(void **state)
{
    (void)state;
    init_on_ground(0.3f);
    struct kiln_object *belt = fixture_add_box(&fixture, 0, -0.5f, 0, 100, 1, 4);
    belt->center.x = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0.0f, 0.0f, 10.0f, 20.0f);
    const struct ball from = {.x = {0, RADIUS, 0}};
    const struct ball ball = roll(&from, 120);
    are_about(ball.v, 4.0 / 7.0, ball.v[1], 0, 2e-3);
}

/* On a table that turns, a ball that rolls goes round in a circle, 2/7 as fast as the table. */
static void balls_circle_on_a_turntable(void **state)
{
    (void)state;
    const double table = 2, speed = 0.5, time_s = 2;
    init_on_ground(0.9f);
    struct kiln_object *box = fixture_add_box(&fixture, 0, -0.5f, 0, 40, 1, 40);
    box->rotation.y =
        fixture_ramp(&fixture, KILN_CLOCK_TIME, 0.0f, 0.0f, 10.0f, 10.0f * (float)table);
    const struct ball from = {{0, RADIUS, 0}, {speed, 0, 0}, {0, 0, -speed / RADIUS}};
    const struct ball ball = roll(&from, (uint32_t)(60 * time_s));
    const double angle = 2.0 / 7.0 * table * time_s; /* about y, from x to -z */
    are_about(ball.v, speed * cos(angle), ball.v[1], -speed * sin(angle), 0.03 * speed);
    const double circle = speed / (2.0 / 7.0 * table);
    are_about(ball.x, circle * sin(angle), ball.x[1], circle * (cos(angle) - 1), 0.03 * circle);
}

/* In a room without gravity, among all kinds of walls: whatever it meets, no energy comes of it. */
static void energy_never_grows(void **state)
{
    (void)state;
    init_on_floor(0.4f);
    struct kiln_system *s = &fixture.scene.systems[0];
    s->force_count = 0;
    s->collide.restitution = fixture_constant(1.0f);
    s->collide.randomness = fixture_constant(0.2f);
    fixture_add_box(&fixture, 0, 3, 0, 8, 2, 8);
    for (int i = 0; i < 2; i++)
        fixture_add_box(&fixture, i ? 2 : -2, 1, 0, 2, 4, 8);
    fixture_add_plane(&fixture, 0, 0, -1);
    fixture.scene.backdrop.objects[3].axis = fixture_constant3(0, 0, 1);
    fixture_add_plane(&fixture, 0, 0, 1);
    fixture.scene.backdrop.objects[4].axis = fixture_constant3(0, 0.3f, -1);
    fixture_add_sphere(&fixture, 0.1f, 0, -0.1f, 0.3f);
    fixture_add_cylinder(&fixture, -0.5f, 1.5f, 0.4f, 0.3f, 0.5f);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    const struct ball from = {{0.4, 1, -0.3}, {3, 1, 2}, {40, -10, 30}};
    place(&run, 0, &from);
    double least = INFINITY, first = 0;
    for (int step = 0; step < 900; step++) {
        simulation_run(&run, 1);
        const struct ball b = ball_in(&run, 0);
        const double energy = 0.5 * dot(b.v, b.v) + 0.2 * RADIUS * RADIUS * dot(b.w, b.w);
        assert_true(energy < least * (1 + 1e-5));
        least = fmin(least, energy);
        first = step == 0 ? energy : first;
    }
    assert_true(least < 0.9 * first && least > 0.01 * first);
    simulation_end(&run);
}

/* ---- what is kept of them ------------------------------------------------------------------- */

static void poses_turn_by_the_rate(void **state)
{
    (void)state;
    init(1, 0.0f);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    const struct ball from = {.w = {1.2, -2.4, 0.8}};
    const double rate = sqrt(dot(from.w, from.w)), half_angle = 0.5 * rate * 1.5;
    place(&run, 0, &from);
    simulation_run(&run, 90);
    const float4 q = spin_pose(spins_of(&run)[0].pose);
    const double found[3] = {(double)q.x, (double)q.y, (double)q.z};
    are_about(found, sin(half_angle) * from.w[0] / rate, sin(half_angle) * from.w[1] / rate,
              sin(half_angle) * from.w[2] / rate, 1e-5);
    assert_true(fabs((double)q.w - cos(half_angle)) < 1e-5);
    simulation_end(&run);
}

/* Whatever rates are given: poses stay turns, and nobody is lost. */
static void absurd_rates_do_no_harm(void **state)
{
    (void)state;
    static const double rates[] = {0, 1e-30, 1e5, 1e9, 1e30, INFINITY, (double)NAN};
    enum { COUNT = sizeof rates / sizeof *rates };
    init(2 * COUNT, 0.5f);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    for (uint32_t i = 0; i < COUNT; i++) {
        place(&run, 2 * i, &(struct ball){{i, 0.3, 0}, {0, -2, 0}, {rates[i], 1, rates[i]}});
        place(&run, 2 * i + 1, &(struct ball){{i, 0, 0}, {0, 2, 0}, {0, 0, rates[i]}});
    }
    simulation_run(&run, 20);
    for (uint32_t i = 0; i < 2 * COUNT; i++) {
        const float4 q = spin_pose(spins_of(&run)[i].pose);
        const double square = (double)q.x * (double)q.x + (double)q.y * (double)q.y +
                              (double)q.z * (double)q.z + (double)q.w * (double)q.w;
        const struct ball ball = ball_in(&run, i);
        assert_true(fabs(square - 1) < 1e-5 && fabs(ball.v[1]) < 1e6);
    }
    simulation_end(&run);
}

static void init_born(void)
{
    struct kiln_interaction *collide = init(1, 0.3f);
    struct kiln_system *s = &fixture.scene.systems[0];
    s->emit.rate = fixture_constant(240.0f);
    s->emit.life = fixture_range(1.0f, 1.0f);
    s->emit.shape = KILN_EMITTER_SPHERE;
    s->emit.radius = fixture_constant(0.8f);
    s->capacity = 300;
    collide->turning = fixture_range(2.0f, 5.0f);
    collide->axis = fixture_constant3(0.0f, 0.0f, 7.0f);
}

static void the_scene_says_how_fast_they_turn_at_birth(void **state)
{
    (void)state;
    for (int drawn = 0; drawn < 2; drawn++) {
        init_born();
        if (drawn)
            fixture.scene.systems[0].interactions[0].axis = fixture_constant3(0.0f, 0.0f, 0.0f);
        fixture.scene.systems[0].interactions[0].radius = fixture_constant(1e-3f);
        struct simulation run;
        simulation_start(&run, &fixture.scene, NULL, 1);
        simulation_run(&run, 20);
        double least = 100, most = 0, mean[3] = {0, 0, 0};
        for (uint32_t i = 0; i < 80; i++) {
            const struct ball ball = ball_in(&run, i);
            const double rate = sqrt(dot(ball.w, ball.w));
            least = fmin(least, rate);
            most = fmax(most, rate);
            for (int c = 0; c < 3; c++)
                mean[c] += ball.w[c] / rate / 80;
        }
        assert_true(least > 1.999 && least < 2.3 && most < 5.001 && most > 4.7);
        are_about(mean, 0, 0, drawn ? 0 : 1, drawn ? 0.2 : 1e-5);
        simulation_end(&run);
    }
}

/* They are part of the state: of its hash, and of what another run goes on from. */
static void another_run_goes_on(void **state)
{
    (void)state;
    init_born();
    struct kiln_error error = {0};
    struct simulation run, other;
    uint64_t alive;
    simulation_start(&run, &fixture.scene, NULL, 2);
    simulation_start(&other, &fixture.scene, NULL, 1);
    simulation_run(&run, 40);
    assert_true(kiln_pool_copy(&other.pool, &run.pool, &error));
    other.step = run.step;
    simulation_run(&run, 40);
    simulation_run(&other, 40);
    const struct kiln_state_hash a = simulation_hash(&run, &alive),
                                 b = simulation_hash(&other, &alive);
    assert_memory_equal(&a, &b, sizeof a);
    spins_of(&other)[5].pose.x ^= 1u;
    const struct kiln_state_hash c = simulation_hash(&other, &alive);
    assert_memory_not_equal(&a, &c, sizeof a);
    simulation_end(&run);
    simulation_end(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_rub_as_in_the_closed_form),
        cmocka_unit_test(pairs_keep_momentum_angular_momentum_and_no_more_energy),
        cmocka_unit_test(balls_roll_down_a_slope),
        cmocka_unit_test(sliding_ends_in_rolling),
        cmocka_unit_test(rolling_may_cost),
        cmocka_unit_test(a_belt_takes_balls_along),
        cmocka_unit_test(balls_circle_on_a_turntable),
        cmocka_unit_test(energy_never_grows),
        cmocka_unit_test(poses_turn_by_the_rate),
        cmocka_unit_test(absurd_rates_do_no_harm),
        cmocka_unit_test(the_scene_says_how_fast_they_turn_at_birth),
        cmocka_unit_test(another_run_goes_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
