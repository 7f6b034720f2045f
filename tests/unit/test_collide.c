/* Collision with boxes and the floor: closed forms, and what must never happen. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "shared/collide.h"
#include "support/cmocka.h"
#include "support/simulation.h"
#include "support/thrown.h"

/* Each face in turn: a mirror with the speed reduced, at the exact point and time of impact. */
static void a_box_mirrors_at_every_face(void **state)
{
    (void)state;
    for (int face = 0; face < 6; face++) {
        int axis = face / 2;
        double sign = face % 2 ? 1 : -1;
        double from[3] = {0.1, 0.2, 0.3}, v[3] = {0.5, 0.25, -0.5};
        from[axis] = sign * 3;
        v[axis] = -sign * 8;
        struct kiln_system *system =
            one_particle(FLOAT3((float)from[0], (float)from[1], (float)from[2]),
                         FLOAT3((float)v[0], (float)v[1], (float)v[2]));
        system->collide.slowdown = fixture_constant(0.5f);
        fixture_add_box(&fixture, 0.0f, 0.0f, 0.0f, 2.0f, 2.0f, 2.0f);
        struct kiln_particle p = after(30); /* impact at 0.25 s, in the middle of no step */
        float3 x = particle_position(p), u = particle_velocity(p);
        double found_x[3] = {(double)x.x, (double)x.y, (double)x.z};
        double found_v[3] = {(double)u.x, (double)u.y, (double)u.z};
        for (int i = 0; i < 3; i++) {
            double mirrored = (i == axis ? -v[i] : v[i]) * 0.5;
            assert_near(found_v[i], mirrored, 1e-5);
            assert_near(found_x[i], from[i] + v[i] * 0.25 + mirrored * 0.25, 2e-4);
        }
    }
}

/* A ball on the floor without loss keeps its energy and its height, within the error of the
 * integrator. */
static void a_lossless_ball_keeps_bouncing(void **state)
{
    (void)state;
    struct kiln_system *system = one_particle(FLOAT3(0, 2, 0), FLOAT3(0, -0.001f, 0));
    fixture.scene.backdrop.floor_enabled = true;
    fixture.scene.backdrop.floor_collide = true;
    fixture_add_force(system, KILN_FORCE_GRAVITY)->vector = fixture_constant3(0, -10, 0);
    fixture_finish(&fixture, 500);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    double highest = 0;
    for (int step = 0; step < 500; step++) {
        simulation_run(&run, 1);
        float3 x = particle_position(simulation_records(&run)[0]);
        assert_true(x.y > 0.0f);
        if (step > 300)
            highest = fmax(highest, (double)x.y);
    }
    assert_near(highest, 2.0, 0.5);
    simulation_end(&run);
}

/* A particle falls on through the height of a floor that the scene does not have. */
static void a_floor_that_is_not_there_stops_nobody(void **state)
{
    (void)state;
    for (int enabled = 0; enabled < 2; enabled++) {
        struct kiln_system *system = one_particle(FLOAT3(0, 1, 0), FLOAT3(0, -4, 0));
        system->collide.slowdown = fixture_constant(0.5f);
        fixture.scene.backdrop.floor_enabled = enabled != 0;
        fixture.scene.backdrop.floor_collide = true;
        struct kiln_particle p = after(60);
        assert_near((double)particle_position(p).y, enabled ? 1.5 : -3.0, 1e-3);
    }
}

static bool inside_any(const struct kiln_scene *scene, float3 p, float time_s)
{
    const struct kiln_backdrop *b = &scene->backdrop;
    if (kiln_backdrop_floor_collides(b) && p.y < kiln_scene_value(scene, &b->floor_height, time_s))
        return true;
    for (uint32_t i = 0; i < b->object_count; i++) {
        if (!b->objects[i].collide)
            continue;
        float3 center = kiln_scene_value3(scene, &b->objects[i].center, time_s);
        float3 size = kiln_scene_value3(scene, &b->objects[i].size, time_s);
        float3 low = float3_add_scaled(center, size, -0.5f);
        float3 high = float3_add_scaled(center, size, 0.5f);
        if (p.x > low.x && p.x < high.x && p.y > low.y && p.y < high.y && p.z > low.z &&
            p.z < high.z)
            return true;
    }
    return false;
}

/* Ten times the speeds of the fire beam against plates of a millimetre: a closed room of them, from
 * which nothing may escape, with a thin floor inside. 40 m/s is 0.67 m a step. */
static void nothing_tunnels_at_ten_times_the_speed(void **state)
{
    (void)state;
    static const float randomness[] = {0.0f, 0.4f, 1.0f};
    for (int k = 0; k < 3; k++) {
        fixture_init(&fixture);
        struct kiln_system *system = fixture_add_system(&fixture, "fast", 2000.0f);
        system->emit.angle = fixture_constant(3.14159274f);
        system->emit.speed = fixture_range(30.0f, 400.0f);
        system->emit.life = fixture_range(3.0f, 3.0f);
        system->collide.enabled = true;
        system->collide.randomness = fixture_constant(randomness[k]);
        const float thick = 0.001f;
        fixture_add_box(&fixture, 1, 0, 0, thick, 4, 4);
        fixture_add_box(&fixture, -1, 0, 0, thick, 4, 4);
        fixture_add_box(&fixture, 0, 1, 0, 4, thick, 4);
        fixture_add_box(&fixture, 0, -1, 0, 4, thick, 4);
        fixture_add_box(&fixture, 0, 0, 1, 4, 4, thick);
        fixture_add_box(&fixture, 0, 0, -1, 4, 4, thick);
        fixture_finish(&fixture, 120);
        struct simulation run;
        simulation_start(&run, &fixture.scene, NULL, 2);
        for (uint32_t step = 1; step <= 120; step++) {
            simulation_run(&run, 1);
            const struct kiln_particle *records = simulation_records(&run);
            for (uint32_t i = 0; i < run.pool.slot_count; i++) {
                float3 p = particle_position(records[i]);
                if (!(fabsf(p.x) < 1 && fabsf(p.y) < 1 && fabsf(p.z) < 1))
                    fail_msg("particle %u at (%g, %g, %g) in step %u", i, (double)p.x, (double)p.y,
                             (double)p.z, step);
            }
        }
        uint64_t alive;
        simulation_hash(&run, &alive);
        assert_int_equal(alive, 4000);
        simulation_end(&run);
    }
}

/* The thesis's clamp lets the same particles through: what the swept mode is for. */
static void the_clamp_mode_tunnels(void **state)
{
    (void)state;
    struct kiln_system *system = one_particle(FLOAT3(-1, 0, 0), FLOAT3(400, 0, 0));
    fixture_add_box(&fixture, 0, 0, 0, 0.001f, 4, 4);
    assert_true(particle_position(after(2)).x < 0.0f);
    system->collide.mode = KILN_COLLIDE_CLAMP;
    assert_true(particle_position(after(2)).x > 0.0f);
}

static void the_clamp_mode_puts_on_the_nearest_face(void **state)
{
    (void)state;
    struct kiln_system *system = one_particle(FLOAT3(0.9f, 0.97f, 0), FLOAT3(0, -6, 0));
    system->collide.mode = KILN_COLLIDE_CLAMP;
    system->collide.slowdown = fixture_constant(0.25f);
    fixture_add_box(&fixture, 0, 0, 0, 2, 2, 2);
    struct kiln_particle p = after(1); /* at y 0.87 it is nearer to the side */
    assert_near((double)particle_position(p).x, 1.0, 1e-6);
    assert_near((double)particle_position(p).y, 0.87, 1e-6);

    one_particle(FLOAT3(0, 1.05f, 0), FLOAT3(0, -6, 0))->collide.mode = KILN_COLLIDE_CLAMP;
    fixture.scene.systems[0].collide.slowdown = fixture_constant(0.25f);
    fixture_add_box(&fixture, 0, 0, 0, 2, 2, 2);
    p = after(1);
    assert_near((double)particle_position(p).y, 1.0, 1e-6);
    assert_near((double)particle_velocity(p).y, 1.5, 1e-6);
}

/* The whole zoo, its moving, growing and overlapping boxes: after no step is a particle of the
 * swept mode inside a box. */
static void nobody_ends_a_step_inside(void **state)
{
    (void)state;
    for (int order = 0; order < 2; order++) {
        fixture_zoo(&fixture, (enum kiln_integration)order, 300);
        struct simulation run;
        simulation_start(&run, &fixture.scene, NULL, 2);
        for (uint32_t step = 1; step <= 300; step++) {
            simulation_run(&run, 1);
            float end_s = kiln_scene_time(&fixture.scene, step);
            const struct kiln_particle *records = simulation_records(&run);
            for (uint32_t i = 0; i < fixture.scene.system_count; i++) {
                const struct kiln_collide *collide = &fixture.scene.systems[i].collide;
                if (!collide->enabled || collide->mode != KILN_COLLIDE_SWEPT)
                    continue;
                const struct kiln_pool_system *slots = &run.pool.systems[i];
                for (uint32_t k = slots->base; k < slots->base + slots->capacity; k++)
                    if (particle_is_alive(records[k]))
                        assert_false(
                            inside_any(&fixture.scene, particle_position(records[k]), end_s));
            }
        }
        simulation_end(&run);
    }
}

/* Without forces no bounce may add speed, whatever the randomness; with a slowdown each takes some.
 */
static void energy_never_grows(void **state)
{
    (void)state;
    static const float slowdowns[] = {1.0f, 0.7f, 0.0f};
    for (int k = 0; k < 3; k++) {
        fixture_init(&fixture);
        struct kiln_system *system = fixture_add_system(&fixture, "gas", 500.0f);
        system->emit.angle = fixture_constant(3.14159274f);
        system->emit.speed = fixture_range(1.0f, 20.0f);
        system->emit.life = fixture_range(9.0f, 9.0f);
        system->collide.enabled = true;
        system->collide.randomness = fixture_constant(0.5f);
        system->collide.slowdown = fixture_constant(slowdowns[k]);
        fixture_add_box(&fixture, 0, -1.5f, 0, 6, 1, 6);
        fixture_add_box(&fixture, 1.5f, 0, 0, 1, 6, 6);
        fixture_add_box(&fixture, -1.5f, 0, 0.3f, 1, 6, 6);
        fixture_finish(&fixture, 120);
        struct simulation run;
        simulation_start(&run, &fixture.scene, NULL, 1);
        static double before[2000];
        memset(before, 0, sizeof before);
        uint32_t slowed = 0;
        for (uint32_t step = 1; step <= 120; step++) {
            simulation_run(&run, 1);
            for (uint32_t i = 0; i < run.pool.systems[0].next_serial; i++) {
                struct kiln_particle p = simulation_records(&run)[i];
                double speed = (double)float3_length(particle_velocity(p));
                if (particle_birth_step(p) != step) {
                    assert_true(speed <= before[i] * (1 + 2e-6));
                    slowed += speed < before[i] * 0.99;
                }
                before[i] = speed;
            }
        }
        assert_int_equal(slowed > 0, slowdowns[k] < 1.0f);
        simulation_end(&run);
    }
}

/* Randomness 1: any direction of the hemisphere about the normal, evenly; 0: the mirror alone. */
static void randomness_fills_the_hemisphere(void **state)
{
    (void)state;
    struct collide_answer answer = {.randomness = 1.0f, .slowdown = 0.5f};
    float3 velocity = FLOAT3(3.0f, -4.0f, 0.0f);
    double mean_up = 0, mean_x = 0;
    for (uint32_t i = 0; i < 20000; i++) {
        answer.stream = random_stream(1, i);
        answer.purpose = RANDOM_BOUNCE;
        float3 v = collide_bounce(answer, velocity, 3, false);
        assert_near((double)float3_length(v), 2.5, 1e-5);
        assert_true(v.y >= 0.0f);
        mean_up += (double)v.y / 2.5 / 20000;
        mean_x += (double)v.x / 2.5 / 20000;
    }
    assert_near(mean_up, 0.5, 0.01);
    assert_near(mean_x, 0.0, 0.015);
    answer.randomness = 0.0f;
    float3 mirror = collide_bounce(answer, velocity, 3, false);
    assert_near((double)mirror.x, 1.5, 1e-6);
    assert_near((double)mirror.y, 2.0, 1e-6);
    float3 leaving = FLOAT3(1.0f, 2.0f, 3.0f);
    float3 same = collide_bounce(answer, leaving, 3, false);
    assert_memory_equal(&same, &leaving, sizeof same);
}

/* A wall that comes at 10 m/s throws a resting particle at twice that speed. */
static void moving_boxes_push(void **state)
{
    (void)state;
    one_particle(FLOAT3(1, 0, 0), FLOAT3(0, 0.0001f, 0));
    struct kiln_object *box = fixture_add_box(&fixture, 0, 0, 0, 1, 1, 1);
    box->center.x = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0.0f, 0.0f, 1.0f, 10.0f);
    struct kiln_particle p = after(30); /* met at 0.05 s */
    assert_near((double)particle_velocity(p).x, 20.0, 1e-3);
    assert_near((double)particle_position(p).x, 1.0 + 20.0 * 0.45, 1e-2);

    one_particle(FLOAT3(1, 0, 0), FLOAT3(0, 0.0001f, 0));
    box = fixture_add_box(&fixture, 0, 0, 0, 1, 1, 1); /* its face comes at half its growth */
    box->size.x = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0.0f, 1.0f, 1.0f, 21.0f);
    assert_near((double)particle_velocity(after(30)).x, 20.0, 1e-3);
}

/* Past a corner within one step: beside the box in x, then in y, never in it. */
static void a_near_miss_is_no_hit(void **state)
{
    (void)state;
    one_particle(FLOAT3(-2.2f, 0, 0), FLOAT3(120, 120, 0)); /* 2 m a step each way */
    fixture_add_box(&fixture, 0, 0, 0, 2, 2, 2);
    struct kiln_particle p = after(2);
    assert_near((double)particle_position(p).x, 1.8, 1e-4);
    assert_near((double)particle_position(p).y, 4.0, 1e-4);
    assert_near((double)particle_velocity(p).x, 120.0, 1e-4);

    one_particle(FLOAT3(-1.8f, 0, 0), FLOAT3(120, 120, 0)); /* this one hits the side */
    fixture_add_box(&fixture, 0, 0, 0, 2, 2, 2);
    assert_near((double)particle_velocity(after(2)).x, -120.0, 1e-3);
}

/* Born inside, or caught between closing boxes: out by the nearest face, or up. */
static void the_trapped_are_freed(void **state)
{
    (void)state;
    one_particle(FLOAT3(0.1f, 0.9f, -0.2f), FLOAT3(0, -0.5f, 0));
    fixture_add_box(&fixture, 0, 0, 0, 2, 2, 2);
    struct kiln_particle p = after(1);
    assert_near((double)particle_position(p).y, 1.0 + 0.5 / 60.0, 1e-3);
    assert_near((double)particle_velocity(p).y, 0.5, 1e-6);

    one_particle(FLOAT3(0, 0.5f, 0), FLOAT3(0.001f, 0, 0));
    struct kiln_object *left = fixture_add_box(&fixture, -1, 0, 0, 1.5f, 4, 4);
    struct kiln_object *right = fixture_add_box(&fixture, 1, 0, 0, 1.5f, 4, 4);
    left->center.x = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, -1, 0.1f, -0.7f);
    right->center.x = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 1, 0.1f, 0.7f);
    p = after(10);
    assert_false(inside_any(&fixture.scene, particle_position(p), 10.0f / 60.0f));
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_mirrors_at_every_face),
        cmocka_unit_test(a_lossless_ball_keeps_bouncing),
        cmocka_unit_test(a_floor_that_is_not_there_stops_nobody),
        cmocka_unit_test(nothing_tunnels_at_ten_times_the_speed),
        cmocka_unit_test(the_clamp_mode_tunnels),
        cmocka_unit_test(the_clamp_mode_puts_on_the_nearest_face),
        cmocka_unit_test(nobody_ends_a_step_inside),
        cmocka_unit_test(energy_never_grows),
        cmocka_unit_test(randomness_fills_the_hemisphere),
        cmocka_unit_test(moving_boxes_push),
        cmocka_unit_test(a_near_miss_is_no_hit),
        cmocka_unit_test(the_trapped_are_freed),
    };
    return cmocka_run_group_tests_name("collide", tests, NULL, NULL);
}
