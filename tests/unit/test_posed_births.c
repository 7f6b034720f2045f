/* Particles are born on a mesh with an animation where it is at their birth, with the velocity of
 * its surface there. If this fails, sparks stay behind a figure that walks, or fly off it. */
#include <math.h>
#include <unistd.h>

#include "shared/derived.h"
#include "shared/particle.h"
#include "support/cmocka.h"
#include "support/scenes.h"
#include "support/simulation.h"

/* The tetrahedron of moving.gltf, in an object that is turned, twice as large and moves at 2 m/s.
 */
#define SCENE(animation)                                                                           \
    "kiln: 1\noutput: {frames: 120, fps: 60}\n"                                                    \
    "backdrop: {objects: {part: {mesh: {file: moving.gltf, scale: 2, rotation: [0, 0, 90 deg],\n"  \
    "  position: {keys: {0 s: [0, 1, 0], 2 s: [4, 1, 0]}}, animation: {" animation "}}}}}\n"       \
    "systems: {a: {emit: {rate: 3000, life: 9 s, speed: 0, inherit: 1,\n"                          \
    "  from: {mesh: {object: part}}}}}\n"

/* Where a node of the file is, and its velocity. */
struct moment {
    double place[3], velocity[3];
    double turn, turning; /* rad, rad/s: about y */
    bool is_unknown;
};

/* The clip `go` leads to (0.2, 0.1, 0) in half a second, then to (0, 0.3, 0.1), and begins again.
 */
static struct moment go(double time_s)
{
    const double t = time_s - floor(time_s);
    if (t < 0.5)
        return (struct moment){.place = {0.4 * t, 0.2 * t, 0}, .velocity = {0.4, 0.2, 0}};
    const double u = t - 0.5;
    return (struct moment){.place = {0.2 - 0.4 * u, 0.1 + 0.4 * u, 0.2 * u},
                           .velocity = {-0.4, 0.4, 0.2}};
}

/* The clip `turn` turns by 45 degrees about y in half a second. What follows is not compared. */
static struct moment turn(double time_s)
{
    const double t = time_s - floor(time_s), quarter = 0.78539816339744831;
    return (struct moment){.turn = 2 * quarter * t, .turning = 2 * quarter, .is_unknown = t >= 0.5};
}

/* How far births lie from where they should, and how far their velocities are off. */
struct errors {
    double place, velocity;
};

/* Compares a birth at place and velocity, in the frame of the object, with the file's node. */
static void compare(const double at[3], const double v[3], const struct moment *m,
                    struct errors *worst)
{
    const double c = cos(m->turn), s = sin(m->turn);
    const double x = at[0] - m->place[0], y = at[1] - m->place[1], z = at[2] - m->place[2];
    const double own[3] = {c * x - s * z, y, s * x + c * z}; /* in the frame of the node */
    const double least = fmin(own[0], fmin(own[1], own[2]));
    const double sum = own[0] + own[1] + own[2];
    const double slope = fabs(sum - 1) / sqrt(3.0);
    const double side = fabs(least);
    worst->place = fmax(worst->place, fmin(side, slope));
    worst->place = fmax(worst->place, fmax(-least, sum - 1));
    const double expected[3] = {m->velocity[0] + m->turning * z, m->velocity[1],
                                m->velocity[2] - m->turning * x};
    for (int k = 0; k < 3; k++)
        worst->velocity = fmax(worst->velocity, fabs(v[k] - expected[k]));
}

static struct errors run_clip(const char *text, struct moment (*clip)(double time_s))
{
    struct errors worst = {0, 0};
    struct simulation run;
    struct kiln_scene *scene = load_scene(text, NULL);
    simulation_start(&run, scene, NULL, 1);
    simulation_run(&run, 90);
    const struct kiln_particle *records = simulation_records(&run);
    uint32_t seen = 0;
    for (uint32_t i = 0; i < run.pool.systems[0].capacity; i++) {
        if (!particle_is_alive(records[i]))
            continue;
        const double born_s = (double)particle_birth_time(kiln_scene_derived(scene, 0), records[i]);
        const float3 at = particle_position(records[i]), v = particle_velocity(records[i]);
        const double age = 1.5 - born_s;
        const double x = (double)at.x - (double)v.x * age - 2 * born_s;
        const double y = (double)at.y - (double)v.y * age - 1;
        const double z = (double)at.z - (double)v.z * age;
        /* the object turns x to y, and y to -x */
        const double place[3] = {y / 2, -x / 2, z / 2};
        const double velocity[3] = {(double)v.y / 2, (2 - (double)v.x) / 2, (double)v.z / 2};
        const struct moment m = clip(born_s);
        if (!m.is_unknown)
            compare(place, velocity, &m, &worst);
        seen++;
    }
    assert_in_range(seen, 4400, 4510);
    print_message("%u births: %.2g m off the mesh, %.2g m/s\n", seen, worst.place, worst.velocity);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
    return worst;
}

/* A mesh that only moves is exact. */
static void births_follow_clips(void **state)
{
    (void)state;
    const struct errors worst = run_clip(SCENE("clip: go"), go);
    assert_true(worst.place < 1e-5 && worst.velocity < 1e-4);
}

/* One that turns by 1.5 degrees in a step goes straight in it: at 1 m from its axis, it is 0.09 mm
 * off in the middle, and 0.02 m/s at the ends. */
static void births_follow_turns(void **state)
{
    (void)state;
    const struct errors worst = run_clip(SCENE("clip: turn"), turn);
    assert_true(worst.place < 1.2e-4 && worst.velocity < 0.025);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(births_follow_clips),
        cmocka_unit_test(births_follow_turns),
    };
    if (chdir(KILN_SOURCE_DIR "/tests/mutation") != 0)
        return 1;
    return cmocka_run_group_tests_name("posed_births", tests, NULL, NULL);
}
