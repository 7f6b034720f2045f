/* Checks children that are born at each impact and by the metre, and particles that ride what they
 * hit, against counts and closed forms. If this fails, a trail has gaps or too many births, or
 * something that sticks to an object drifts on it. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "shared/heading.h"
#include "support/cmocka.h"
#include "support/simulation.h"

static struct simulation start(const char *text, const char *override, struct kiln_scene **scene)
{
    const char *const overrides[] = {override};
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_error error = {0};
    struct simulation run;
    params.asset_root = KILN_SOURCE_DIR;
    params.overrides = overrides;
    params.override_count = override != NULL;
    *scene = kiln_scene_parse(text, strlen(text), KILN_SOURCE_DIR "/test.yaml", &params, &error);
    if (!*scene)
        fail_msg("%s", error.message);
    simulation_start(&run, *scene, NULL, 2);
    return run;
}

static const struct kiln_particle *records_of(struct simulation *run, uint32_t system)
{
    return simulation_records(run) + run->pool.systems[system].base;
}

/* ---- each impact ----------------------------------------------------------------------------- */

/* Balls without loss: they fall 1 m in half a second, and are back on the floor after each second.
 */
static const char BALLS[] =
    "kiln: 1\n"
    "output: {fps: 60, frames: 300}\n"
    "backdrop: {floor: {height: 0 m}}\n"
    "systems:\n"
    "  ball:\n"
    "    emit: {bursts: {0 s: 200}, life: 4 s, speed: [0.5, 2], from: {point: {origin: [0, 1, 0],\n"
    "           direction: [1, 0, 0]}}}\n"
    "    forces: [gravity: [0, -8, 0]]\n"
    "    collide: {slowdown: 1}\n"
    "  dust:\n"
    "    emit: {parent: {system: ball, on: {bounce: {count: [2, 5], every: true, most: 3}}},\n"
    "           life: 9 s, speed: 0}\n"
    "  first:\n"
    "    emit: {parent: {system: ball, on: {bounce: 1}}, life: 9 s, speed: 0}\n";

enum { BALL_COUNT = 200, MOST_DUST = 5 };

/* Checks the dust of impact number `hit` of a ball, and counts it. */
static uint32_t check_dust(const struct kiln_particle *dust, double speed, uint32_t hit)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < MOST_DUST; i++) {
        const struct kiln_particle p = dust[hit * MOST_DUST + i];
        if (!particle_is_alive(p))
            continue;
        const float3 at = particle_position(p);
        assert_int_equal(count, i); /* the first slots of each impact are taken */
        assert_true(at.y >= 0.0f && at.y < 0.001f);
        assert_true(fabs((double)at.x - speed * (0.5 + hit)) < 0.02 * speed);
        count++;
    }
    return count;
}

static void each_impact_has_children(void **state)
{
    (void)state;
    for (uint32_t most = 1; most <= 4; most++) { /* 4 are more than a birth word counts */
        char override[64];
        struct kiln_scene *scene;
        uint64_t alive, expected = 0;
        uint32_t of_hit[4] = {0};
        snprintf(override, sizeof override, "systems.dust.emit.parent.on.bounce.most=%u", most);
        struct simulation run = start(BALLS, override, &scene);
        simulation_run(&run, 230); /* 3.8 s: four impacts */
        for (uint32_t i = 0; i < BALL_COUNT; i++) {
            const double speed = (double)particle_velocity(records_of(&run, 0)[i]).x;
            const struct kiln_particle *dust = records_of(&run, 1) + i * most * MOST_DUST;
            for (uint32_t hit = 0; hit < most; hit++) {
                const uint32_t count = check_dust(dust, speed, hit);
                assert_in_range(count, 2, 5);
                of_hit[hit] += count;
            }
            const struct kiln_particle first = records_of(&run, 2)[i];
            assert_true(particle_is_alive(first));
            assert_true(fabs((double)particle_position(first).x - 0.5 * speed) < 0.02 * speed);
        }
        for (uint32_t hit = 0; hit < most; hit++) {
            assert_in_range(of_hit[hit], 620, 780); /* 700; four standard deviations are 63 */
            assert_true(hit == 0 || of_hit[hit] != of_hit[hit - 1]); /* each draws anew */
            expected += of_hit[hit];
        }
        simulation_hash(&run, &alive);
        assert_int_equal(alive, 2 * BALL_COUNT + expected);
        simulation_end(&run);
        kiln_scene_destroy(&scene);
    }
}

/* ---- what sticks ----------------------------------------------------------------------------- */

/* Drops that fall onto an object that moves and turns once in two seconds from 1 s on. The second
 * system gives birth to children that get its velocity. */
#define STICKY(object)                                                                             \
    "kiln: 1\n"                                                                                    \
    "output: {fps: 60, frames: 400}\n"                                                             \
    "nodes:\n"                                                                                     \
    "  hub: {position: {keys: {1 s: [0, 0, 0], 3 s: [1, 0.5, -2]}},\n"                             \
    "        rotation: {keys: {1 s: [0, 0, 0], 3 s: [0, 360 deg, 0]}}}\n"                          \
    "backdrop: {objects: [" object "]}\n"                                                          \
    "systems:\n"                                                                                   \
    "  drop:\n"                                                                                    \
    "    emit: {bursts: {0 s: 300}, life: 6 s, speed: 2, from: {box: {origin: [0, 1.5, 0],\n"      \
    "           size: [1, 0.1, 1], direction: [0.2, -1, 0.1]}}}\n"                                 \
    "    forces: [gravity: [0, -8, 0]]\n"                                                          \
    "    collide: {then: stick}\n"                                                                 \
    "  spray:\n"                                                                                   \
    "    emit: {parent: {system: drop, on: {trail: 4}}, inherit: 1, life: 0.3 s, speed: 0}\n"

enum { DROP_COUNT = 300 };

enum { OF_MESH = 5, OF_WORLD }; /* of those below: a mesh, and one that is not attached */

static const char *const RIDDEN[] = {
    STICKY("box: {attach: hub, center: [0, 0, 0], size: [4, 0.4, 4], collide: true}"),
    STICKY("cylinder: {attach: hub, center: [0, 0, 0], radius: 2 m, height: 0.4 m, "
           "collide: true}"),
    STICKY("sphere: {attach: hub, center: [0, 0, 0], radius: 1 m, collide: true}"),
    STICKY("capsule: {attach: hub, center: [0, 0, 0], axis: [0, 1, 0], radius: 1 m, height: 0.3 m, "
           "collide: true}"),
    STICKY("cone: {attach: hub, center: [0, 0, 0], axis: [0, 1, 0], radius: 2 m, height: 0.5 m, "
           "collide: true}"),
    STICKY("mesh: {attach: hub, file: tests/mutation/tetrahedron.obj, position: [0, 0, 0], "
           "scale: 2, collide: true, cells: 24}"),
    STICKY("box: {center: {keys: {1 s: [0, 0, 0], 3 s: [1, 0.5, -2]}}, size: [4, 0.4, 4], "
           "collide: true}"),
};

/* Takes a place at 1 s to where the object carries it. */
static void carry(double time_s, bool turns, const float3 from, double to[3])
{
    const double part = (time_s - 1) / 2, angle = turns ? 6.283185307179586 * part : 0;
    to[0] = part + (double)from.x * cos(angle) + (double)from.z * sin(angle);
    to[1] = 0.5 * part + (double)from.y;
    to[2] = -2 * part - (double)from.x * sin(angle) + (double)from.z * cos(angle);
}

/* Checks that a heading at rest is that of the flight, and that the object turns it later on. */
static void check_heading(double time_s, bool turns, struct kiln_particle at_rest,
                          struct kiln_particle now)
{
    const float3 first = particle_heading(at_rest), heading = particle_heading(now);
    const double angle = turns ? 6.283185307179586 * (time_s - 1) / 2 : 0;
    const double x = (double)first.x * cos(angle) + (double)first.z * sin(angle);
    const double z = (double)first.z * cos(angle) - (double)first.x * sin(angle);
    assert_true(first.y < -0.9f && fabsf(first.x - 2.0f * first.z) < 2e-4f && first.x > 0.01f);
    if (!(fabs((double)heading.x - x) < 1e-3 && fabs((double)heading.z - z) < 1e-3))
        fail_msg("at %g s the heading is %g, %g, not %g, %g", time_s, (double)heading.x,
                 (double)heading.z, x, z);
}

/* Returns whether a drop rides the object, and not the floor under it. */
static bool rides(struct kiln_particle drop)
{
    return particle_is_alive(drop) && particle_has_stopped(drop) && drop.velocity_birth.y == 1;
}

static uint32_t count_riders(const struct kiln_particle *drops)
{
    uint32_t riders = 0;
    for (uint32_t i = 0; i < DROP_COUNT; i++)
        riders += rides(drops[i]);
    return riders;
}

static void what_sticks_rides(void **state)
{
    (void)state;
    for (size_t r = 0; r < sizeof RIDDEN / sizeof *RIDDEN; r++) {
        struct kiln_scene *scene;
        struct kiln_particle at_rest[DROP_COUNT];
        struct simulation run = start(RIDDEN[r], NULL, &scene);
        simulation_run(&run, 60);
        memcpy(at_rest, records_of(&run, 0), sizeof at_rest);
        const uint32_t riders = count_riders(at_rest);
        assert_true(riders == DROP_COUNT || (r == OF_MESH && riders > 50));
        for (uint32_t step = 61; step <= 180; step++) {
            simulation_run(&run, 1);
            const struct kiln_particle *drops = records_of(&run, 0);
            for (uint32_t i = 0; i < DROP_COUNT; i++) {
                double expected[3];
                if (!rides(at_rest[i]))
                    continue;
                const float3 at = particle_position(drops[i]), v = particle_velocity(drops[i]);
                carry(step / 60.0, r != OF_WORLD, particle_position(at_rest[i]), expected);
                const double off = fabs((double)at.x - expected[0]) +
                                   fabs((double)at.y - expected[1]) +
                                   fabs((double)at.z - expected[2]);
                if (!(off < 1e-4))
                    fail_msg("object %zu, step %u: %g m off", r, step, off);
                assert_true(v.x == 0.0f && v.y == 0.0f && v.z == 0.0f);
                assert_int_equal(drops[i].velocity_birth.x, at_rest[i].velocity_birth.x);
                assert_int_equal(drops[i].velocity_birth.y, 1);
                check_heading(step / 60.0, r != OF_WORLD, at_rest[i], drops[i]);
            }
        }
        simulation_end(&run);
        kiln_scene_destroy(&scene);
    }
}

/* Children of what rides get the velocity of the object. */
static void children_of_riders_move_on(void **state)
{
    (void)state;
    struct kiln_scene *scene;
    struct simulation run = start(RIDDEN[OF_WORLD], NULL, &scene);
    simulation_run(&run, 150);
    const struct kiln_pool_system *slots = &run.pool.systems[1];
    uint32_t seen = 0;
    for (uint32_t i = 0; i < slots->capacity; i++) {
        const struct kiln_particle p = records_of(&run, 1)[i];
        const float3 v = particle_velocity(p);
        if (!particle_is_alive(p))
            continue;
        seen++;
        assert_true(fabs((double)v.x - 0.5) < 1e-4 && fabs((double)v.y - 0.25) < 1e-4);
        assert_true(fabs((double)v.z + 1) < 1e-4);
    }
    assert_true(seen > DROP_COUNT / 2);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

/* A particle turns by itself until it stops. */
static void what_stops_does_not_turn(void **state)
{
    (void)state;
    struct kiln_scene *scene;
    struct simulation run = start(RIDDEN[0], NULL, &scene);
    simulation_run(&run, 100);
    const float dt_s = scene->dt_s;
    for (uint32_t i = 0; i < DROP_COUNT; i++) {
        const struct kiln_particle p = records_of(&run, 0)[i];
        const double stopped_s = (p.velocity_birth.x / 64.0 - 1) / 60;
        assert_true(stopped_s > 0.3 && stopped_s < 0.7); /* a fall of 1.3 m from 2 m/s */
        assert_true(fabs((double)particle_turned_s(p, 5.0f, dt_s) - stopped_s) < 1e-6);
        assert_true(particle_turned_s(p, 0.1f, dt_s) == 0.1f);
    }
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

/* ---- by the metre ---------------------------------------------------------------------------- */

/* Parents that fly straight on at speeds of their own, for 2 s. */
static const char FLIGHTS[] =
    "kiln: 1\n"
    "output: {fps: 60, frames: 300}\n"
    "backdrop: {floor: {height: -2 m}}\n"
    "systems:\n"
    "  spark:\n"
    "    emit: {rate: 30, life: 2 s, speed: [0.5, 6], from: {point: {origin: [1, 2, 3],\n"
    "           direction: [1, 0, 0]}}}\n"
    "    collide: {slowdown: 1}\n"
    "  smoke:\n"
    "    emit: {parent: {system: spark, on: {trail: {per_metre: 7.3, most: 60}}}, life: 9 s,\n"
    "           speed: 0}\n"
    "  dots:\n"
    "    emit: {parent: {system: spark, on: {trail: {per_metre: 2.1, most: 8}}}, life: 9 s,\n"
    "           speed: 0}\n";

/* Checks the children of a parent that has flown along x for some time. */
static void check_row(const struct kiln_particle *row, uint32_t most, double speed, double time_s,
                      double per_metre)
{
    const double expected = fmin(floor(speed * time_s * per_metre), most);
    for (uint32_t n = 0; n < most; n++) {
        const double place = (n + 1) / per_metre;
        if (fabs(speed * time_s - place) < 1e-5)
            return; /* too close to say */
        if (particle_is_alive(row[n]) != (n < expected))
            fail_msg("child %u at %g m/s after %g s, of %g", n, speed, time_s, expected);
        if (n < expected)
            assert_true(fabs((double)particle_position(row[n]).x - 1 - place) < 2e-5);
    }
}

static void trails_are_even_in_space(void **state)
{
    (void)state;
    struct kiln_scene *scene;
    struct simulation run = start(FLIGHTS, NULL, &scene);
    for (uint32_t step = 20; step <= 280; step += 20) {
        simulation_run(&run, 20);
        const struct kiln_pool_system *slots = &run.pool.systems[0];
        for (uint32_t i = 0; i < slots->capacity; i++) {
            const struct kiln_particle p = records_of(&run, 0)[i];
            if (!particle_is_alive(p))
                continue;
            const double speed = (double)particle_velocity(p).x;
            const double flown_s = (double)particle_age(p, step, scene->dt_s);
            check_row(records_of(&run, 1) + i * 60, 60, speed, flown_s, 7.3);
            check_row(records_of(&run, 2) + i * 8, 8, speed, flown_s, 2.1);
        }
    }
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

/* A way with corners is as long as its pieces. Without gravity and without loss, a ball goes on at
 * its speed when it has met the floor, and child n is n / 25 m along the way, on either side of the
 * corner. */
static void ways_have_corners(void **state)
{
    (void)state;
    static const char TEXT[] =
        "kiln: 1\n"
        "output: {fps: 60, frames: 300}\n"
        "backdrop: {floor: {height: 0 m}}\n"
        "systems:\n"
        "  ball:\n"
        "    emit: {bursts: {0 s: 100}, life: 9 s, speed: [1, 4], from: {point: {origin: [0, 1, "
        "0],\n"
        "           direction: [0, -1, 0], angle: 60 deg}}}\n"
        "    collide: {slowdown: 1}\n"
        "  smoke:\n"
        "    emit: {parent: {system: ball, on: {trail: {per_metre: 25, most: 300}}}, life: 9 s,\n"
        "           speed: 0}\n";
    struct kiln_scene *scene;
    struct simulation run = start(TEXT, NULL, &scene);
    uint32_t corners = 0;
    for (uint32_t step = 10; step <= 170; step += 10) {
        simulation_run(&run, 10);
        for (uint32_t i = 0; i < 100; i++) {
            const float3 v = particle_velocity(records_of(&run, 0)[i]);
            const double speed = (double)float3_length(v), way = speed * step / 60.0;
            const double up = -fabs((double)v.y) / speed, ahead = (double)v.x / speed;
            const struct kiln_particle *row = records_of(&run, 1) + i * 300;
            for (uint32_t n = 0; n < 300; n++) {
                const double along = (n + 1) / 25.0;
                if (fabs(along - way) < 1e-4)
                    continue; /* too close to say */
                if (particle_is_alive(row[n]) != (along < way))
                    fail_msg("child %u at step %u, way %g m", n, step, way);
                if (along > way)
                    break;
                const float3 at = particle_position(row[n]);
                assert_true(fabs((double)at.y - fabs(1 + up * along)) < 1e-3);
                assert_true(fabs((double)at.x - ahead * along) < 1e-3);
                corners += 1 + up * along < 0;
            }
        }
    }
    assert_true(corners > 1000);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

/* On a way that is bent, births count the straight pieces from step to step. */
static void ways_bend(void **state)
{
    (void)state;
    static const char TEXT[] =
        "kiln: 1\n"
        "output: {fps: 60, frames: 300}\n"
        "systems:\n"
        "  ball:\n"
        "    emit: {bursts: {0 s: 100}, life: 9 s, speed: [1, 4], from: {point: {origin: [0, 1, "
        "0],\n"
        "           angle: 180 deg}}}\n"
        "    forces: [gravity: [0, -8, 0], drag: 0.3]\n"
        "  smoke:\n"
        "    emit: {parent: {system: ball, on: {trail: {per_metre: 25, most: 500}}}, life: 9 s,\n"
        "           speed: 0}\n";
    struct kiln_scene *scene;
    double way[100] = {0};
    float3 at[100];
    struct simulation run = start(TEXT, NULL, &scene);
    for (int i = 0; i < 100; i++)
        at[i] = (float3){0.0f, 1.0f, 0.0f};
    for (uint32_t step = 1; step <= 100; step++) {
        simulation_run(&run, 1);
        for (uint32_t i = 0; i < 100; i++) {
            const float3 to = particle_position(records_of(&run, 0)[i]);
            way[i] += (double)float3_length(float3_sub(to, at[i]));
            at[i] = to;
            const struct kiln_particle *row = records_of(&run, 1) + i * 500;
            const double count = way[i] * 25;
            if (fabs(count - floor(count + 0.5)) < 0.001)
                continue;
            assert_true(count < 1 || particle_is_alive(row[(uint32_t)count - 1]));
            assert_false(particle_is_alive(row[(uint32_t)count]));
        }
    }
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

/* ---- emitters by the metre ------------------------------------------------------------------- */

/* On a circle of 1 m, once around in a second, the n-th birth is at the angle n / 40. */
static void emitters_on_circles(void **state)
{
    (void)state;
    static const char TEXT[] =
        "kiln: 1\n"
        "output: {fps: 60, frames: 120}\n"
        "nodes:\n"
        "  hub: {rotation: {keys: {0 s: [0, 0, 0], 1 s: [0, 360 deg, 0]}, repeat: loop}}\n"
        "  arm: {parent: hub, position: [0.5, 0, 0]}\n"
        "systems:\n"
        "  a: {emit: {attach: arm, per_metre: 40, life: 9 s, speed: 0,\n"
        "             from: {point: {origin: [0.5, 0, 0]}}}}\n";
    struct kiln_scene *scene;
    struct simulation run = start(TEXT, NULL, &scene);
    for (uint32_t step = 1; step <= 100; step++) {
        uint64_t alive;
        simulation_run(&run, 1);
        simulation_hash(&run, &alive);
        assert_int_equal(alive, (uint64_t)floor(step / 60.0 * 6.283185307179586 * 40));
        for (uint32_t i = 0; i < alive; i++) {
            const float3 at = particle_position(records_of(&run, 0)[i]);
            const double angle = (i + 1) / 40.0;
            assert_true(fabs((double)at.x - cos(angle)) < 3e-5);
            assert_true(fabs((double)at.z + sin(angle)) < 3e-5);
        }
    }
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

/* An origin that is at t^2 m has births at even distances. It jumps back at 2 s, which is no way.
 */
static void emitters_that_accelerate(void **state)
{
    (void)state;
    static const char TEXT[] =
        "kiln: 1\n"
        "output: {fps: 60, frames: 240}\n"
        "systems:\n"
        "  a: {emit: {per_metre: 13.7, life: 9 s, speed: 0,\n"
        "             from: {point: {origin: {keys: {0 s: [0, 0, 0], 2 s: [4, 0, 0]}, ease: in,\n"
        "                                     repeat: loop}}}}}\n";
    struct kiln_scene *scene;
    struct simulation run = start(TEXT, NULL, &scene);
    for (uint32_t step = 1; step <= 210; step++) {
        uint64_t alive;
        simulation_run(&run, 1);
        simulation_hash(&run, &alive);
        const double time_s = step / 60.0, in_loop_s = time_s < 2 ? time_s : time_s - 2;
        const double way = (time_s < 2 ? 0 : 4) + in_loop_s * in_loop_s;
        assert_int_equal(alive, (uint64_t)floor(way * 13.7));
        for (uint32_t i = 0; i < alive; i++) {
            const double place = fmod((i + 1) / 13.7, 4);
            const float3 at = particle_position(records_of(&run, 0)[i]);
            if (!(fabs((double)at.x - place) < 1e-4))
                fail_msg("birth %u at %g instead of %g", i, (double)at.x, place);
        }
    }
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

static void keep_warning(void *user, enum kiln_log_level level, const char *line)
{
    char *text = user;
    assert_int_equal(level, KILN_LOG_WARNING);
    assert_int_equal(text[0], '\0');
    snprintf(text, KILN_MESSAGE_SIZE, "%s", line);
}

/* Loads a scene with births by the metre, and fails if its warning is not the expected one. */
static void expect_warning(const char *emit, const char *wanted)
{
    char text[1024], warning[KILN_MESSAGE_SIZE] = "";
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_error error = {0};
    params.log = (struct kiln_log){keep_warning, warning};
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {frames: 60, fps: 60}\n"
             "nodes:\n"
             "  spun: {rotation: {keys: {0 s: [0, 0, 0], 1 s: [0, 360 deg, 0]}}}\n"
             "  moved: {position: {keys: {0 s: [0, 0, 0], 1 s: [0.5, 0, 0]}}}\n"
             "systems:\n  a: {emit: {%s}}\n",
             emit);
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "test.yaml", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    assert_string_equal(warning, wanted);
    kiln_scene_destroy(&scene);
}

/* Births by the metre alone need a way that has one. */
static void short_ways_have_a_warning(void **state)
{
    (void)state;
    static const char AT_REST[] =
        "test.yaml:7:25: systems.a.emit.per_metre: nothing is born: there are births by the metre "
        "alone, and the origin of `from` does not move in the whole run; `rate` has births where "
        "nothing moves";
    expect_warning("per_metre: 100", AT_REST);
    expect_warning("per_metre: 100, attach: spun", AT_REST);
    expect_warning("per_metre: 1.9, attach: moved",
                   "test.yaml:7:25: systems.a.emit.per_metre: nothing is born: there are births by "
                   "the metre alone, and the way of the origin of `from` in the whole run is 0.5 "
                   "m, shorter than from one birth to the next, 0.526 m");
    expect_warning("per_metre: 2.1, attach: moved", "");
    expect_warning("per_metre: 100, attach: spun, from: {point: {origin: [1, 0, 0]}}", "");
    expect_warning("per_metre: 100, rate: 1", "");
    expect_warning("per_metre: 100, bursts: {0 s: 1}", "");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_impact_has_children),
        cmocka_unit_test(what_sticks_rides),
        cmocka_unit_test(children_of_riders_move_on),
        cmocka_unit_test(what_stops_does_not_turn),
        cmocka_unit_test(trails_are_even_in_space),
        cmocka_unit_test(ways_have_corners),
        cmocka_unit_test(ways_bend),
        cmocka_unit_test(emitters_on_circles),
        cmocka_unit_test(emitters_that_accelerate),
        cmocka_unit_test(short_ways_have_a_warning),
    };
    return cmocka_run_group_tests_name("trails", tests, NULL, NULL);
}
