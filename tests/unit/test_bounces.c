/* A ball that falls onto each kind of collider and loses nothing: where it is, by the closed form,
 * how high it still rises, and with which order the time and the place of an impact are found.
 */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "shared/exact.h"
#include "support/cmocka.h"
#include "support/folders.h"
#include "support/simulation.h"
#include "support/surfaces.h"
#include "support/thrown.h"

enum { INTEGRATIONS = 4 };

static const char *const names[INTEGRATIONS] = {
    [KILN_INTEGRATE_SEMI_IMPLICIT] = "semi_implicit",
    [KILN_INTEGRATE_POSITION_FIRST] = "position_first",
    [KILN_INTEGRATE_TRAPEZOID] = "trapezoid",
    [KILN_INTEGRATE_RK4] = "rk4",
};

static const double gravity = 9.81; /* m/s^2 */

struct fall {
    double error;         /* m: how far the ball is from the closed form, at most */
    double energy, least; /* the largest and the smallest, as parts of that of the start */
};

/* A ball falls from above the top of a collider, for so many 60ths of a second. */
static struct fall fall(size_t kind, enum kiln_integration integration, double height,
                        uint32_t steps)
{
    struct kiln_system *system = one_particle(FLOAT3(0, (float)height, 0), FLOAT3(0, -1e-6f, 0));
    system->emit.life = fixture_range(1000.0f, 1000.0f);
    fixture_add_force(system, KILN_FORCE_GRAVITY)->vector =
        fixture_constant3(0, -(float)gravity, 0);
    fixture.scene.integration = integration;
    surfaces[kind].add();
    fixture_finish(&fixture, steps);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);

    const double dt = 1.0 / 60.0, down_s = sqrt(2 * height / gravity);
    double ahead_s = 0; /* of these two, velocities are those of half a step earlier or later */
    if (integration == KILN_INTEGRATE_SEMI_IMPLICIT)
        ahead_s = -dt / 2;
    else if (integration == KILN_INTEGRATE_POSITION_FIRST)
        ahead_s = dt / 2;
    struct fall fall = {.least = 9};
    for (uint32_t step = 1; step <= steps; step++) {
        simulation_run(&run, 1);
        const struct kiln_particle p = simulation_records(&run)[0];
        const double y = (double)particle_position(p).y;
        const double v = (double)particle_velocity(p).y + gravity * ahead_s;
        const double s = fmod(step * dt + down_s, 2 * down_s) - down_s; /* since it was highest */
        const double energy = (gravity * y + v * v / 2) / (gravity * height);
        fall.error = fmax(fall.error, fabs(y - (height - gravity * s * s / 2)));
        fall.energy = fmax(fall.energy, energy);
        fall.least = fmin(fall.least, energy);
    }
    simulation_end(&run);
    return fall;
}

/* From 4 m for 20 s. The integrators of first order find the time of an impact to a part of a step;
 * from this height the energy that they lose by that is 1.4 %. */
static void a_ball_follows_the_closed_form(void **state)
{
    (void)state;
    static const double allowed[INTEGRATIONS] = {0.6, 0.6, 1e-3, 1e-3};
    for (size_t kind = 0; kind < SURFACES; kind++) {
        for (int i = 0; i < INTEGRATIONS; i++) {
            const struct fall f = fall(kind, (enum kiln_integration)i, 4, 1200);
            if (!(f.error <= allowed[i] && f.energy <= 1 + 1e-3 && f.least >= 0.98))
                fail_msg("%s, %s: %g m off, %.5f to %.5f of the energy", surfaces[kind].name,
                         names[i], f.error, f.least, f.energy);
        }
    }
}

/* From many heights, for a minute: the energy never drifts. An integrator of first order gives an
 * impact the velocity of the middle of its step; that is off by half of what gravity does in one.
 */
static void no_bounce_adds_energy(void **state)
{
    (void)state;
    for (size_t kind = 0; kind < SURFACES; kind++) {
        for (int i = 0; i < INTEGRATIONS; i++) {
            for (double height = 0.7; height < 9; height *= 2.1) {
                const struct fall f = fall(kind, (enum kiln_integration)i, height, 3600);
                const double first_order = sqrt(2 * gravity * height) / (60 * height);
                const double bound = i < KILN_INTEGRATE_TRAPEZOID ? first_order : 1e-3;
                if (!(f.energy <= 1 + bound && f.least >= 1 - bound))
                    fail_msg("%s, %s, from %g m: %.5f to %.5f of the energy", surfaces[kind].name,
                             names[i], height, f.least, f.energy);
            }
        }
    }
}

/* On what bears it, friction slows a slide by its factor on the weight, from step to step. */
static void a_slide_slows_by_friction(void **state)
{
    (void)state;
    for (size_t kind = 0; kind < SURFACES; kind++) {
        if (surfaces[kind].form != SURFACE_FLAT)
            continue;
        for (int i = 0; i < INTEGRATIONS; i++) {
            struct kiln_system *system = one_particle(FLOAT3(0, 1e-4f, 0), FLOAT3(3, 0, 0));
            system->collide.restitution = fixture_constant(0.0f);
            system->collide.friction = fixture_constant(0.3f);
            fixture_add_force(system, KILN_FORCE_GRAVITY)->vector =
                fixture_constant3(0, -(float)gravity, 0);
            fixture.scene.integration = (enum kiln_integration)i;
            surfaces[kind].add();
            const struct kiln_particle p = after(30);
            const double expected = 3 - 0.3 * gravity * 0.5;
            const double v = (double)particle_velocity(p).x, y = (double)particle_position(p).y;
            if (!(fabs(v - expected) < 0.05 && fabs(y) < 3e-3))
                fail_msg("%s, %s: %g m/s instead of %g, %g m up", surfaces[kind].name, names[i], v,
                         expected, y);
        }
    }
}

/* One particle that lies still, and what pulls at it; surfaces take all that goes against them. */
static void lay(enum kiln_integration integration, float3 at, float3 pull)
{
    struct kiln_system *system = one_particle(at, FLOAT3(0, 1e-6f, 0));
    system->collide.restitution = fixture_constant(0.0f);
    system->collide.friction = fixture_constant(0.0f);
    fixture_add_force(system, KILN_FORCE_GRAVITY)->vector =
        fixture_constant3(pull.x, pull.y, pull.z);
    fixture.scene.integration = integration;
}

/* Down a slope of 1 in 2, wherever it lies: a quarter of g along z, less its part across. */
static void a_slide_down_a_slope_gets_faster(void **state)
{
    (void)state;
    static const float heights[] = {0, 3, 1000};
    for (int i = 0; i < INTEGRATIONS; i++) {
        for (int k = 0; k < 3; k++) {
            lay((enum kiln_integration)i, FLOAT3(0, heights[k] + 1e-3f, 0), FLOAT3(0, -5, 0));
            struct kiln_object *slope = fixture_add_plane(&fixture, 0, heights[k], 0);
            slope->axis = fixture_constant3(0, 1, 0.5f);
            const double z = (double)particle_position(after(90)).z, expected = 2.25;
            if (!(fabs(z - expected) < 0.04))
                fail_msg("%s at %g m: %g m instead of %g", names[i], (double)heights[k], z,
                         expected);
        }
    }
}

/* In the edge between two surfaces, and at the bottom of a groove. */
static void an_edge_holds_nothing_back(void **state)
{
    (void)state;
    static const float3 normals[][2] = {{{1, 0, 0}, {0, 1, 0}}, {{1, 1, 0}, {-1, 1, 0}}};
    static const float3 pulls[] = {{-5, -5, 2}, {0, -7, 2}};
    for (int i = 0; i < INTEGRATIONS; i++) {
        for (int k = 0; k < 2; k++) {
            lay((enum kiln_integration)i, FLOAT3(1e-3f, 1e-3f, 0), pulls[k]);
            for (int side = 0; side < 2; side++)
                fixture_add_plane(&fixture, 0, 0, 0)->axis =
                    fixture_constant3(normals[k][side].x, normals[k][side].y, normals[k][side].z);
            const float3 p = particle_position(after(60));
            if (!(fabs((double)p.z - 1) < 0.05 && fabs((double)p.x) + fabs((double)p.y) < 0.02))
                fail_msg("%s, edge %d: at (%g, %g, %g)", names[i], k, (double)p.x, (double)p.y,
                         (double)p.z);
        }
    }
}

/* ---- order of convergence -------------------------------------------------------------------- */

struct impact {
    double time_s, place; /* m: along the surface */
};

/* A particle at the end of a spring at the origin, let go at (2, 1, 0), meets a plane at this
 * height: when and where, as its state a second later tells by the closed form. */
static struct impact spring_impact(enum kiln_integration integration, uint32_t rate, double height)
{
    const double w = 3;
    struct kiln_system *system = one_particle(FLOAT3(2, 1, 0), FLOAT3(0, -1e-6f, 0));
    fixture.scene.fps = fixture.scene.rate = (struct kiln_rational){rate, 1};
    fixture.scene.dt_s = 1.0f / (float)rate;
    fixture.scene.integration = integration;
    struct kiln_force *force = fixture_add_force(system, KILN_FORCE_ATTRACT);
    force->strength = fixture_constant((float)(w * w));
    force->falloff = KILN_FALLOFF_LINEAR;
    fixture_add_plane(&fixture, 0, (float)height, 0);
    const struct kiln_particle p = after(rate);
    const double x = (double)particle_position(p).x, y = (double)particle_position(p).y;
    const double vx = (double)particle_velocity(p).x, vy = (double)particle_velocity(p).y;
    const double amplitude = sqrt(y * y + vy * vy / (w * w));
    const double now = atan2(-vy / w, y), gap = 6.103515625e-5;
    const double turned = acos(height / amplitude) + now;
    const double left = acos((height + gap) / amplitude) + now; /* it was put in front of it */
    return (struct impact){1 - turned / w, x * cos(left) - vx / w * sin(left)};
}

/* The largest errors over heights, because an impact may come anywhere in a step. */
static struct impact errors_of(enum kiln_integration integration, uint32_t rate)
{
    struct impact worst = {0, 0};
    for (double height = 0.2; height < 0.5; height += 0.01) {
        const struct impact found = spring_impact(integration, rate, height);
        worst.time_s = fmax(worst.time_s, fabs(found.time_s - acos(height) / 3));
        worst.place = fmax(worst.place, fabs(found.place - 2 * height));
    }
    return worst;
}

/* Halving the step divides the error by 2^order. */
static void impacts_are_found_with_the_order_of_the_integrator(void **state)
{
    (void)state;
    static const struct {
        uint32_t rate; /* coarse enough for floats, fine enough for the order to show */
        double order;
    } steps[INTEGRATIONS] = {{64, 1}, {64, 1}, {16, 2}, {4, 4}};
    for (int i = 0; i < INTEGRATIONS; i++) {
        const enum kiln_integration integration = (enum kiln_integration)i;
        const struct impact coarse = errors_of(integration, steps[i].rate);
        const struct impact fine = errors_of(integration, 4 * steps[i].rate);
        const double time = log2(coarse.time_s / fine.time_s) / 2;
        const double place = log2(coarse.place / fine.place) / 2;
        if (!(time > steps[i].order - 0.4 && place > steps[i].order - 0.4))
            fail_msg("%s: order %.2f in time (%g s), %.2f in place (%g m)", names[i], time,
                     fine.time_s, place, fine.place);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_follows_the_closed_form),
        cmocka_unit_test(no_bounce_adds_energy),
        cmocka_unit_test(a_slide_slows_by_friction),
        cmocka_unit_test(a_slide_down_a_slope_gets_faster),
        cmocka_unit_test(an_edge_holds_nothing_back),
        cmocka_unit_test(impacts_are_found_with_the_order_of_the_integrator),
    };
    return cmocka_run_group_tests_name("bounces", tests, test_enter_folder, test_leave_folder);
}
