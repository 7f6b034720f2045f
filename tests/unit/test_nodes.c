/* Nodes: their frames are compared with closed forms in double precision, the births of attached
 * emitters with the circle that their node goes, and attached objects, lights and cameras with the
 * same scene written without nodes. If this fails, what is attached to a node is elsewhere. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/matrix.h"
#include "scene/scene.h"
#include "shared/derived.h"
#include "support/cmocka.h"
#include "support/frame.h"
#include "support/scenes.h"
#include "support/simulation.h"

static const double PI = 3.14159265358979324;

static struct kiln_scene *scene_of(const char *nodes)
{
    char text[4096];
    snprintf(text, sizeof text, "kiln: 1\nseed: 3\noutput: {frames: 600, fps: 60}\nnodes:\n%s",
             nodes);
    return load_scene(text, NULL);
}

static struct kiln_node_frame frame_of(const struct kiln_scene *scene, const char *name,
                                       double time_s)
{
    uint32_t node = 0;
    while (node + 1 < scene->node_count && strcmp(scene->nodes[node].name, name) != 0)
        node++;
    return kiln_node_frame_at(scene, node, (float)time_s, (float)time_s);
}

static void expect_near(const char *what, double time_s, const double found[3], double x, double y,
                        double z, double limit)
{
    const double off = hypot(hypot(found[0] - x, found[1] - y), found[2] - z);
    if (!(off <= limit))
        fail_msg("%s at %g s: [%.9g, %.9g, %.9g], not [%.9g, %.9g, %.9g]", what, time_s, found[0],
                 found[1], found[2], x, y, z);
}

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Rotates v by the quaternion of a frame. */
static void turned(const struct kiln_node_frame *frame, const double v[3], double y[3])
{
    const double *q = frame->turn;
    const double t[3] = {2 * (q[1] * v[2] - q[2] * v[1]), 2 * (q[2] * v[0] - q[0] * v[2]),
                         2 * (q[0] * v[1] - q[1] * v[0])};
    y[0] = v[0] + q[3] * t[0] + q[1] * t[2] - q[2] * t[1];
    y[1] = v[1] + q[3] * t[1] + q[2] * t[0] - q[0] * t[2];
    y[2] = v[2] + q[3] * t[2] + q[0] * t[1] - q[1] * t[0];
}

static void an_arm_goes_in_a_circle(void **state)
{
    (void)state;
    struct kiln_scene *scene =
        scene_of("  hub: {rotation: {keys: {0 s: [0, 0, 0], 10 s: [0, 3600 deg, 0]}}}\n"
                 "  arm: {parent: hub, position: [2, 0.5, 0]}\n");
    for (int i = 0; i < 600; i++) {
        const double time_s = i / 60.0, angle = 2 * PI * time_s;
        const struct kiln_node_frame arm = frame_of(scene, "arm", time_s);
        /* an angle near 60 is a float, and so is its slope times the time: true to 6e-6 */
        expect_near("place", time_s, arm.at, 2 * cos(angle), 0.5, -2 * sin(angle), 2e-5);
        expect_near("velocity", time_s, arm.velocity, -4 * PI * sin(angle), 0, -4 * PI * cos(angle),
                    1e-4);
        expect_near("spin", time_s, arm.spin, 0, 2 * PI, 0, 1e-5);
        assert_true(fabs(hypot(arm.at[0], arm.at[2]) - 2) < 1e-6);
    }
    kiln_scene_destroy(&scene);
}

static void a_path_is_run_through_by_its_length(void **state)
{
    (void)state;
    static const struct {
        const char *ease;
        double at[3], speed[3]; /* parts of the way after 1/4, 1/2 and 3/4 of the time; times it */
    } cases[] = {
        {"linear", {0.25, 0.5, 0.75}, {1, 1, 1}},
        {"in", {0.0625, 0.25, 0.5625}, {0.5, 1, 1.5}},
        {"out", {0.4375, 0.75, 0.9375}, {1.5, 1, 0.5}},
        {"smooth", {0.15625, 0.5, 0.84375}, {1.125, 1.5, 1.125}},
        {"step", {0, 0, 0}, {0, 0, 0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[256];
        snprintf(text, sizeof text,
                 "  a: {position: {path: {points: [[1, 2, 3], [2, 2, 3], [11, 2, 3]], over: [1 s, "
                 "3 s], ease: %s}}}\n",
                 cases[i].ease);
        struct kiln_scene *scene = scene_of(text);
        assert_true(fabs(kiln_path_length(&scene->nodes[0].position.path) - 10) < 1e-12);
        for (int k = 0; k < 3; k++) {
            const double time_s = 1.5 + 0.5 * k;
            const struct kiln_node_frame a = frame_of(scene, "a", time_s);
            expect_near(cases[i].ease, time_s, a.at, 1 + 10 * cases[i].at[k], 2, 3, 1e-9);
            expect_near(cases[i].ease, time_s, a.velocity, 5 * cases[i].speed[k], 0, 0, 1e-9);
        }
        expect_near("before", 0, frame_of(scene, "a", 0).at, 1, 2, 3, 1e-12);
        expect_near("before", 0, frame_of(scene, "a", 0).velocity, 0, 0, 0, 0);
        expect_near("after", 9, frame_of(scene, "a", 9).at, 11, 2, 3, 1e-12);
        expect_near("after", 9, frame_of(scene, "a", 9).velocity, 0, 0, 0, 0);
        kiln_scene_destroy(&scene);
    }
}

/* Points on a circle about y with radius 3 m, from [3, 0, 0] towards -z. */
static void add_circle(char *text, size_t size, int count)
{
    size_t length =
        (size_t)snprintf(text, size, "  a: {heading: path, position: {path: {points: [");
    for (int i = 0; i < count; i++)
        length += (size_t)snprintf(text + length, size - length, "%s[%.8f, 1, %.8f]", i ? ", " : "",
                                   3 * cos(2 * PI * i / count), -3 * sin(2 * PI * i / count));
    snprintf(text + length, size - length, "], over: [0 s, 4 s], closed: true}}}\n");
}

static void a_path_through_a_circle_is_one(void **state)
{
    (void)state;
    char text[4000];
    add_circle(text, sizeof text, 64);
    struct kiln_scene *scene = scene_of(text);
    const double length = kiln_path_length(&scene->nodes[0].position.path);
    if (!(fabs(length - 6 * PI) < 1e-4))
        fail_msg("the length is %.9g, not %.9g", length, 6 * PI);
    for (int i = 0; i < 400; i++) {
        const double time_s = 0.01 * i, angle = 0.5 * PI * time_s;
        const struct kiln_node_frame a = frame_of(scene, "a", time_s);
        double ahead[3], up[3];
        expect_near("place", time_s, a.at, 3 * cos(angle), 1, -3 * sin(angle), 1e-4);
        assert_true(fabs(length_of(a.velocity) - length / 4) < 1e-6);
        turned(&a, (const double[3]){0, 0, 1}, ahead);
        turned(&a, (const double[3]){0, 1, 0}, up);
        expect_near("ahead", time_s, ahead, -sin(angle), 0, -cos(angle), 2e-3);
        expect_near("up", time_s, up, 0, 1, 0, 1e-9);
        expect_near("spin", time_s, a.spin, 0, 0.5 * PI, 0, 0.05);
    }
    kiln_scene_destroy(&scene);
}

static void an_axis_is_up_at_the_first_point(void **state)
{
    (void)state;
    static const struct {
        const char *ahead;
        double up[3];
    } cases[] = {{"z", {0, 1, 0}},  {"-z", {0, 1, 0}}, {"x", {0, 1, 0}},
                 {"-x", {0, 1, 0}}, {"y", {0, 0, -1}}, {"-y", {0, 0, 1}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[256];
        double up[3];
        snprintf(
            text, sizeof text,
            "  a: {heading: path, ahead: %s, position: {path: {points: [[0, 0, 0], [1, 0, 2]], "
            "over: [0 s, 1 s]}}}\n",
            cases[i].ahead);
        struct kiln_scene *scene = scene_of(text);
        const struct kiln_node_frame a = frame_of(scene, "a", 0);
        turned(&a, cases[i].up, up);
        expect_near(cases[i].ahead, 0, up, 0, 1, 0, 1e-12);
        kiln_scene_destroy(&scene);
    }
}

static void up_does_not_roll(void **state)
{
    (void)state;
    struct kiln_scene *scene =
        scene_of("  a: {heading: path, position: {path: {points: [[0, 0, 0], [0, 1, 0], [1, 3, 0], "
                 "[2, 3, 2], [0, 2, 4], [-3, 5, 1]], over: [0 s, 4 s]}}}\n");
    const double h = 1.0 / 1024;
    double up[3], ahead[3], before[3], after[3], left[3];
    const struct kiln_node_frame first = frame_of(scene, "a", 0);
    turned(&first, (const double[3]){0, 0, 1}, ahead);
    assert_true(ahead[1] > 0.9); /* it starts steeply */
    for (int i = 1; i < 512; i++) {
        const double time_s = i / 128.0;
        const struct kiln_node_frame a = frame_of(scene, "a", time_s - h);
        const struct kiln_node_frame b = frame_of(scene, "a", time_s);
        const struct kiln_node_frame c = frame_of(scene, "a", time_s + h);
        turned(&a, (const double[3]){0, 1, 0}, before);
        turned(&c, (const double[3]){0, 1, 0}, after);
        turned(&b, (const double[3]){1, 0, 0}, left);
        turned(&b, (const double[3]){0, 0, 1}, ahead);
        turned(&b, (const double[3]){0, 1, 0}, up);
        double change[3], along[3];
        for (int k = 0; k < 3; k++) {
            change[k] = (after[k] - before[k]) / (2 * h);
            along[k] = (c.at[k] - a.at[k]) / (2 * h);
        }
        if (!(fabs(dot(change, left)) < 2e-2))
            fail_msg("at %g s, up rolls by %g rad/s", time_s, dot(change, left));
        assert_true(dot(ahead, along) > 0.9999 * length_of(along));
        assert_true(fabs(dot(up, ahead)) < 1e-9);
        /* the speed along the curve is even */
        const double speed = kiln_path_length(&scene->nodes[0].position.path) / 4;
        assert_true(fabs(length_of(along) - speed) < 1e-3 * speed);
    }
    kiln_scene_destroy(&scene);
}

static void rates_are_those_of_the_frames(void **state)
{
    (void)state;
    struct kiln_scene *scene = scene_of(
        "  a: {rotation: {keys: {0 s: [0, 0, 0], 4 s: [40 deg, 300 deg, -70 deg]}, ease: smooth},\n"
        "      scale: {keys: {0 s: 1, 4 s: 3}}}\n"
        "  b: {parent: a, position: {path: {points: [[0, 0, 1], [1, 1, 0], [2, 0, 0], [2, 3, 1]], "
        "over: [0 s, 4 s], ease: smooth}}, heading: path, ahead: x, rotation: {keys: {0 s: [0, 0, "
        "0], 4 s: [0, 0, 90 deg]}}}\n"
        "  c: {parent: b, position: {noise: [[0, 0, 0], [1, 1, 1]], period: 2 s}, scale: 0.5}\n"
        "  d: {parent: c, position: [0, 1, 2], rotation: [10 deg, 20 deg, 30 deg]}\n");
    const double h = 1.0 / 1024;
    for (int i = 1; i < 255; i++) {
        const double time_s = i / 64.0 + 1.0 / 128;
        const struct kiln_node_frame a = frame_of(scene, "d", time_s - h);
        const struct kiln_node_frame b = frame_of(scene, "d", time_s);
        const struct kiln_node_frame c = frame_of(scene, "d", time_s + h);
        double rate[3], x[3], before[3], after[3];
        for (int k = 0; k < 3; k++)
            rate[k] = (c.at[k] - a.at[k]) / (2 * h);
        expect_near("velocity", time_s, b.velocity, rate[0], rate[1], rate[2],
                    1e-3 * (20 + length_of(rate)));
        turned(&b, (const double[3]){1, 0, 0}, x);
        turned(&a, (const double[3]){1, 0, 0}, before);
        turned(&c, (const double[3]){1, 0, 0}, after);
        const double spun[3] = {b.spin[1] * x[2] - b.spin[2] * x[1],
                                b.spin[2] * x[0] - b.spin[0] * x[2],
                                b.spin[0] * x[1] - b.spin[1] * x[0]};
        expect_near("spin", time_s, spun, (after[0] - before[0]) / (2 * h),
                    (after[1] - before[1]) / (2 * h), (after[2] - before[2]) / (2 * h), 0.05);
        assert_true(fabs(b.growth - (c.scale - a.scale) / (2 * h)) < 1e-3);
    }
    kiln_scene_destroy(&scene);
}

/* The product of rotations, places and scales of four nodes, by matrices of doubles. */
static void four_parents_are_a_product(void **state)
{
    (void)state;
    struct kiln_scene *scene =
        scene_of("  d: {parent: c, position: [0.5, 0, 1], rotation: [0, 0, 90 deg]}\n"
                 "  a: {position: [1, 2, 3], rotation: [90 deg, 0, 0], scale: 2}\n"
                 "  c: {parent: b, position: [0, 0, 2], rotation: [0, 90 deg, 0], scale: 0.5}\n"
                 "  b: {parent: a, position: [1, 0, 0], rotation: [0, 0, 90 deg], scale: 3}\n"
                 "  e: {parent: d, position: [0, 1, 0]}\n");
    /* a: x, -z, y of the inner y, z; by hand: b at a + 2 [1, 0, 0] */
    const struct kiln_node_frame b = frame_of(scene, "b", 0), c = frame_of(scene, "c", 0);
    expect_near("b", 0, b.at, 3, 2, 3, 1e-6);
    /* [0, 0, 2] about z is itself; about x it is [0, -2, 0]; times 6 */
    expect_near("c", 0, c.at, 3, -10, 3, 1e-5);
    /* d in b: [0.5, 0, 1] about y is [1, 0, -0.5]; about z [0, 1, -0.5]; about x [0, 0.5, 1]; * 3
     */
    const struct kiln_node_frame d = frame_of(scene, "d", 0), e = frame_of(scene, "e", 0);
    expect_near("d", 0, d.at, 3, -8.5, 6, 1e-5);
    assert_true(fabs(d.scale - 3) < 1e-6);
    /* e: [0, 1, 0] about z [-1, 0, 0]; about y [0, 0, 1]; about z the same; about x [0, -1, 0]; * 3
     */
    expect_near("e", 0, e.at, 3, -11.5, 6, 1e-5);
    assert_true(kiln_node_carries(scene, 1, 4) && !kiln_node_carries(scene, 4, 1));
    kiln_scene_destroy(&scene);
}

/* ---- births ---------------------------------------------------------------------------------- */

/* Runs a scene at 60 steps a second, in which nothing accelerates particles, and calls a check with
 * the place and the velocity at birth of each living particle of its first system. */
static void each_birth(const char *text, uint32_t steps,
                       void (*check)(float3 position, float3 velocity, double born_s))
{
    struct kiln_scene *scene = load_scene(text, NULL);
    struct simulation run;
    uint64_t alive;
    uint32_t seen = 0;
    simulation_start(&run, scene, NULL, 2);
    simulation_run(&run, steps);
    simulation_hash(&run, &alive);
    const struct kiln_particle *records = simulation_records(&run);
    const struct kiln_derived_params derived = kiln_scene_derived(scene, 0);
    for (uint32_t i = 0; i < run.pool.systems[0].capacity; i++) {
        if (!particle_is_alive(records[i]))
            continue;
        seen++;
        const float3 velocity = particle_velocity(records[i]);
        const double born_s = (double)particle_birth_time(derived, records[i]);
        const float flown_s = (float)(steps / 60.0 - born_s);
        check(float3_add_scaled(particle_position(records[i]), velocity, -flown_s), velocity,
              born_s);
    }
    assert_true(seen == alive && seen > 100);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

static void check_circle(float3 p, float3 v, double born_s)
{
    const double radius = hypot((double)p.x, (double)p.z), angle = 2 * PI * born_s;
    if (!(fabs(radius - 1) < 1e-5))
        fail_msg("born %.9g m from the axis of a circle of 1 m", radius);
    /* a birth is at a 64th of a step, whose time is a float */
    const double place[3] = {(double)p.x, (double)p.y, (double)p.z};
    expect_near("birth", born_s, place, cos(angle), 0, -sin(angle), 2e-5);
    assert_true(v.x == 0 && v.y == 0 && v.z == 0);
}

static void births_lie_on_the_circle_of_their_node(void **state)
{
    (void)state;
    each_birth("kiln: 1\noutput: {frames: 300, fps: 60}\n"
               "nodes:\n"
               "  hub: {rotation: {keys: {0 s: [0, 0, 0], 5 s: [0, 1800 deg, 0]}}}\n"
               "  arm: {parent: hub, position: [1, 0, 0]}\n"
               "systems:\n"
               "  a: {emit: {rate: 3000, speed: 0, life: 9 s, attach: arm, from: {point: {}}}}\n",
               120, check_circle);
    each_birth("kiln: 1\noutput: {frames: 300, fps: 60}\n"
               "nodes:\n"
               "  hub: {rotation: {keys: {0 s: [0, 0, 0], 5 s: [0, 1800 deg, 0]}}}\n"
               "systems:\n"
               "  a: {emit: {rate: 3000, speed: 0, life: 9 s, attach: hub, from: {point: {origin: "
               "[1, 0, 0]}}}}\n",
               120, check_circle);
}

static void check_inherited(float3 p, float3 v, double born_s)
{
    const double angle = 2 * PI * born_s;
    const double velocity[3] = {(double)v.x, (double)v.y, (double)v.z};
    (void)p;
    /* thrown at 2 m/s along z of the arm, which is ahead on the circle */
    const double speed = 2 + 2 * PI;
    expect_near("velocity", born_s, velocity, -speed * sin(angle), 0, speed * cos(angle), 2e-3);
}

static void births_inherit_the_velocity_of_their_node(void **state)
{
    (void)state;
    each_birth("kiln: 1\noutput: {frames: 300, fps: 60}\n"
               "nodes:\n"
               "  hub: {rotation: {keys: {0 s: [0, 0, 0], 5 s: [0, -1800 deg, 0]}}}\n"
               "  arm: {parent: hub, position: [1, 0, 0], scale: 7}\n"
               "systems:\n"
               "  a: {emit: {rate: 3000, speed: 2, life: 9 s, attach: arm, inherit: 1,\n"
               "             from: {point: {direction: [0, 0, 1]}}}}\n",
               120, check_inherited);
}

static void check_scaled(float3 p, float3 v, double born_s)
{
    const double place[3] = {(double)p.x, (double)p.y, (double)p.z};
    const double velocity[3] = {(double)v.x, (double)v.y, (double)v.z};
    /* the origin goes up at 1 unit/s, which is 3 m/s; the rim of 0.5 units turns by 2 rad/s */
    assert_true(fabs(hypot(place[0], place[2]) - 1.5) < 1e-5);
    assert_true(fabs(place[1] - 3 * born_s) < 1e-4);
    expect_near("velocity", born_s, velocity, 2 * place[2], 3, -2 * place[0], 1e-4);
}

static void lengths_of_a_shape_are_scaled(void **state)
{
    (void)state;
    each_birth(
        "kiln: 1\noutput: {frames: 300, fps: 60}\n"
        "nodes: {a: {scale: 3}}\n"
        "systems:\n"
        "  a:\n"
        "    emit: {rate: 900, speed: 0, life: 9 s, inherit: 1, attach: a,\n"
        "           from: {ring: {turn: 2 rad/s, origin: {keys: {0 s: [0, 0, 0], 5 s: [0, 5, "
        "0]}}}}}\n",
        60, check_scaled);
}

static void check_jump(float3 p, float3 v, double born_s)
{
    const double wanted = born_s < 0.5166 ? 1 : 6; /* the step of the jump ends then */
    if (!((double)p.x == wanted && v.x == 0))
        fail_msg("born at %g m at %g s", (double)p.x, born_s);
}

static void check_loop(float3 p, float3 v, double born_s)
{
    const double wanted = 6 * fmod(born_s, 0.5);
    if (!(fabs((double)p.x - wanted) < 1e-4 || fabs((double)p.x - wanted - 3) < 1e-4) ||
        !(fabs((double)v.x - 6) < 1e-3))
        fail_msg("born at %g m, %g m/s, at %g s, not at %g m", (double)p.x, (double)v.x, born_s,
                 wanted);
}

static void no_birth_lies_on_the_way_of_a_jump(void **state)
{
    (void)state;
    each_birth("kiln: 1\noutput: {frames: 300, fps: 60}\n"
               "nodes: {a: {position: {keys: {0 s: [1, 0, 0], 0.505 s: [6, 0, 0]}, ease: step}}}\n"
               "systems: {a: {emit: {rate: 900, speed: 0, life: 9 s, inherit: 1, attach: a}}}\n",
               60, check_jump);
    each_birth("kiln: 1\noutput: {frames: 300, fps: 60}\n"
               "nodes: {a: {position: {keys: {0 s: [0, 0, 0], 0.5 s: [3, 0, 0]}, repeat: loop}}}\n"
               "systems: {a: {emit: {rate: 900, speed: 0, life: 9 s, inherit: 1, attach: a}}}\n",
               60, check_loop);
}

/* ---- collisions ------------------------------------------------------------------------------ */

#define RAIN                                                                                       \
    "kiln: 1\noutput: {frames: 60, fps: 60}\n"                                                     \
    "systems: {a: {emit: {rate: 2000, life: 9 s, speed: 3, from: {box: {origin: [0.5, 2, -0.5], "  \
    "size: [2.5, 0.2, 2.5], direction: [0, -1, 0]}}}, collide: {restitution: 0.5}}}\n"

/* Both scenes move particles alike for 40 steps, but for rounding; many of them bounce. */
static void expect_same_motion(const char *attached, const char *by_hand)
{
    const char *const texts[2] = {attached, by_hand};
    struct kiln_scene *scenes[2];
    struct simulation runs[2];
    const struct kiln_particle *records[2];
    uint32_t bounced = 0, seen = 0, off = 0;
    for (int i = 0; i < 2; i++) {
        scenes[i] = load_scene(texts[i], NULL);
        simulation_start(&runs[i], scenes[i], NULL, 1);
        simulation_run(&runs[i], 40);
        records[i] = simulation_records(&runs[i]);
    }
    for (uint32_t i = 0; i < runs[0].pool.systems[0].capacity; i++) {
        if (!particle_is_alive(records[0][i]) || !particle_is_alive(records[1][i]))
            continue;
        const float3 v = particle_velocity(records[0][i]);
        const float3 way =
            float3_sub(particle_position(records[0][i]), particle_position(records[1][i]));
        seen++;
        bounced += v.y != -3.0f;
        off += float3_length(way) < 2e-3f ? 0 : 1; /* a graze of an edge may go either way */
    }
    if (!(seen > 1000 && bounced > 50 && off * 100 <= bounced))
        fail_msg("%u particles, %u bounced, %u elsewhere:\n%s", seen, bounced, off, attached);
    for (int i = 0; i < 2; i++) {
        simulation_end(&runs[i]);
        kiln_scene_destroy(&scenes[i]);
    }
}

static void particles_collide_where_objects_are_drawn(void **state)
{
    (void)state;
    /* a constant turn by 90 degrees about y takes x to -z */
    expect_same_motion(RAIN "nodes: {a: {position: [0.5, 0.2, -0.5], rotation: [0, 90 deg, 0], "
                            "scale: 2}}\n"
                            "backdrop: {objects: [{box: {attach: a, center: [0, 0.2, 0], size: "
                            "[0.8, 0.3, 0.2]}}]}\n",
                       RAIN
                       "backdrop: {objects: [{box: {center: [0.5, 0.6, -0.5], size: [0.4, 0.6, "
                       "1.6]}}]}\n");
    expect_same_motion(RAIN
                       "nodes: {a: {position: [0.5, 0.2, -0.5], rotation: [0, 90 deg, 0], "
                       "scale: 2}}\n"
                       "backdrop: {objects: [{cylinder: {attach: a, center: [0, 0.2, 0], axis: "
                       "[1, 0, 0], radius: 0.2, height: 0.7}}]}\n",
                       RAIN "backdrop: {objects: [{cylinder: {center: [0.5, 0.6, -0.5], axis: [0, "
                            "0, 1], radius: 0.4, height: 1.4}}]}\n");
    expect_same_motion(RAIN
                       "nodes: {a: {position: {keys: {0 s: [0, 0, -0.5], 1 s: [1, 0, -0.5]}}}}\n"
                       "backdrop: {objects: [{sphere: {attach: a, center: [0, 0.5, 0]}}]}\n",
                       RAIN "backdrop: {objects: [{sphere: {center: {keys: {0 s: [0, 0.5, -0.5], 1 "
                            "s: [1, 0.5, -0.5]}}}}]}\n");
    expect_same_motion(RAIN "nodes: {a: {position: [0.5, 0.6, -0.5], rotation: {keys: {0 s: [0, 0, "
                            "0], 1 s: [0, 90 deg, 0]}}}}\n"
                            "backdrop: {objects: [{box: {attach: a, center: [0, 0, 0], size: [1.2, "
                            "0.4, 0.4]}}]}\n",
                       RAIN
                       "backdrop: {objects: [{box: {center: [0.5, 0.6, -0.5], size: [1.2, 0.4, "
                       "0.4], rotation: {keys: {0 s: [0, 0, 0], 1 s: [0, 90 deg, 0]}}}}]}\n");
}

/* ---- files ----------------------------------------------------------------------------------- */

static const char PRINTED[] =
    "kiln: 1\n"
    "nodes:\n"
    "  a: {position: {path: {points: [[0, 0, 0], [1, 2.5, 0]], over: [50 %, 4 s], ease: out}},\n"
    "      heading: path, ahead: -x}\n"
    "  b: {parent: a, scale: {noise: [1, 2]}, position: [0, {keys: {0 s: 0, 1 s: 2}}, 0]}\n"
    "camera: {attach: b}\n"
    "backdrop: {objects: [{box: {attach: a}}], lights: [{point: {attach: b}}]}\n"
    "systems: {s: {emit: {rate: 1, attach: b}}}\n";

static void a_printed_scene_has_the_same_nodes(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(PRINTED, NULL);
    char *printed = print_scene(scene);
    struct kiln_scene *again = load_scene(printed, NULL);
    assert_string_equal(scene->hash, again->hash);
    assert_int_equal(again->node_count, 2);
    assert_true(again->nodes[0].position.path.over.min.constant == 2.5f);
    assert_true(again->nodes[0].ahead == KILN_AHEAD_MINUS_X);
    assert_string_equal(again->systems[0].emit.attach.name, "b");
    assert_true(again->camera.attach.node == 1 && again->backdrop.objects[0].attach.node == 0);
    assert_true(again->camera.position.y.constant == 0 && again->camera.target.z.constant == 1);
    const struct kiln_node_frame one = frame_of(scene, "b", 3.3), two = frame_of(again, "b", 3.3);
    assert_memory_equal(&one, &two, sizeof one);
    free(printed);
    kiln_scene_destroy(&scene);
    kiln_scene_destroy(&again);
}

/* ---- pictures -------------------------------------------------------------------------------- */

#define PICTURE                                                                                    \
    "kiln: 1\n"                                                                                    \
    "output: {size: [64, 36], frames: 60}\n"

/* Draws both texts after 20 steps; their pictures differ by less than a part of their light. */
static void expect_same(const char *attached, const char *by_hand)
{
    const struct frame_setting setting = {.techniques = FRAME_CPU};
    struct kiln_picture *a = frame_draw(NULL, by_hand, 20, &setting);
    struct kiln_picture *b = frame_draw(NULL, attached, 20, &setting);
    const double difference = frame_difference(a, b, FRAME_BEAUTY);
    if (!(difference < 1e-4))
        fail_msg("the pictures differ by %g\n%s", difference, attached);
    kiln_picture_destroy(&a);
    kiln_picture_destroy(&b);
}

/* At step 20, 1/3 s, `hub` has turned by 90 degrees: x is then -z. */
#define HUB                                                                                        \
    "nodes:\n"                                                                                     \
    "  hub: {position: [0.5, 1, 0], rotation: {keys: {0 s: [0, 0, 0], 1 s: [0, 270 deg, 0]}}}\n"   \
    "  arm: {parent: hub, position: [1, 0, 0], scale: 2}\n"

static void what_is_attached_is_where_its_node_is(void **state)
{
    (void)state;
    expect_same(PICTURE HUB "camera: {attach: arm, position: [0, 0.5, 2], target: [0, 0, 0]}\n"
                            "backdrop: {objects: [{sphere: {}}, {box: {center: [1, 1, 0]}}]}\n",
                PICTURE "camera: {position: [4.5, 2, -1], target: [0.5, 1, -1]}\n"
                        "backdrop: {objects: [{sphere: {}}, {box: {center: [1, 1, 0]}}]}\n");
    expect_same(PICTURE HUB "camera: {attach: hub}\n"
                            "backdrop: {objects: [{sphere: {center: [4, 1, 0]}}]}\n",
                PICTURE "camera: {position: [0.5, 1, 0], target: [1.5, 1, 0]}\n"
                        "backdrop: {objects: [{sphere: {center: [4, 1, 0]}}]}\n");
    expect_same(
        PICTURE HUB
        "backdrop:\n"
        "  objects:\n"
        "    - box: {attach: arm, center: [0, 0, 0], size: [0.5, 0.3, 0.1]}\n"
        "    - sphere: {attach: arm, center: [0, 0.4, 0], radius: 0.1 m}\n"
        "    - cylinder: {attach: hub, center: [0, -0.5, 1], axis: [1, 0, 0]}\n"
        "    - cone: {attach: hub, center: [0, 0.5, -1], axis: [1, 0.5, 0]}\n"
        "  lights:\n"
        "    - point: {attach: arm, position: [0.1, 0.2, 0.3], radius: 0.05 m}\n"
        "    - spot: {attach: hub, position: [0, 1, 0], direction: [1, -1, 0]}\n"
        "    - rectangle: {attach: arm, center: [0, 1, 0], direction: [0, -1, 0.5], up: [1, "
        "0, 0], width: 0.5 m, height: 0.2 m}\n",
        PICTURE "backdrop:\n"
                "  objects:\n"
                "    - box: {center: [0.5, 1, -1], size: [0.2, 0.6, 1]}\n"
                "    - sphere: {center: [0.5, 1.8, -1], radius: 0.2 m}\n"
                "    - cylinder: {center: [1.5, 0.5, 0], axis: [0, 0, -1]}\n"
                "    - cone: {center: [-0.5, 1.5, 0], axis: [0, 0.5, -1]}\n"
                "  lights:\n"
                "    - point: {position: [1.1, 1.4, -1.2], radius: 0.1 m}\n"
                "    - spot: {position: [0.5, 2, 0], direction: [0, -1, -1]}\n"
                "    - rectangle: {center: [0.5, 3, -1], direction: [0.5, -1, 0], up: [0, 0, -1], "
                "width: 1 m, height: 0.4 m}\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_arm_goes_in_a_circle),
        cmocka_unit_test(a_path_is_run_through_by_its_length),
        cmocka_unit_test(a_path_through_a_circle_is_one),
        cmocka_unit_test(an_axis_is_up_at_the_first_point),
        cmocka_unit_test(up_does_not_roll),
        cmocka_unit_test(rates_are_those_of_the_frames),
        cmocka_unit_test(four_parents_are_a_product),
        cmocka_unit_test(births_lie_on_the_circle_of_their_node),
        cmocka_unit_test(births_inherit_the_velocity_of_their_node),
        cmocka_unit_test(lengths_of_a_shape_are_scaled),
        cmocka_unit_test(no_birth_lies_on_the_way_of_a_jump),
        cmocka_unit_test(particles_collide_where_objects_are_drawn),
        cmocka_unit_test(a_printed_scene_has_the_same_nodes),
        cmocka_unit_test(what_is_attached_is_where_its_node_is),
    };
    return cmocka_run_group_tests_name("nodes", tests, NULL, NULL);
}
