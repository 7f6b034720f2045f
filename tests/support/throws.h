/* Particles that are thrown at meshes, which are written to the folder of a test. */
#ifndef TESTS_SUPPORT_THROWS_H
#define TESTS_SUPPORT_THROWS_H

#include <math.h>
#include <stdio.h>

#include "support/simulation.h"

static inline void assert_near(double found, double expected, double allowed)
{
    if (!(fabs(found - expected) <= allowed))
        fail_msg("%.9g instead of %.9g, allowed %g off", found, expected, allowed);
}

struct body {
    FILE *out;
    int count; /* of vertices so far */
};

static inline void add_box(struct body *body, double x, double y, double z, double w, double h,
                           double d)
{
    static const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (int i = 0; i < 8; i++)
        fprintf(body->out, "v %g %g %g\n", x + (i & 1 ? w : -w) / 2, y + (i & 2 ? h : -h) / 2,
                z + (i & 4 ? d : -d) / 2);
    for (int i = 0; i < 6; i++)
        fprintf(body->out, "f %d %d %d %d\n", body->count + 1 + faces[i][0],
                body->count + 1 + faces[i][1], body->count + 1 + faces[i][2],
                body->count + 1 + faces[i][3]);
    body->count += 8;
}

enum { RINGS = 40 };

/* A ball of radius 1 out of RINGS rings of twice as many points. */
static inline void add_ball(struct body *body)
{
    const int around = 2 * RINGS;
    const double pi = 3.14159265358979;
    for (int i = 1; i < RINGS; i++)
        for (int k = 0; k < around; k++)
            fprintf(body->out, "v %.9g %.9g %.9g\n", sin(pi * i / RINGS) * cos(2 * pi * k / around),
                    cos(pi * i / RINGS), sin(pi * i / RINGS) * sin(2 * pi * k / around));
    fprintf(body->out, "v 0 1 0\nv 0 -1 0\n");
    const int top = around * (RINGS - 1) + 1;
    for (int k = 0; k < around; k++) {
        const int a = k + 1, b = (k + 1) % around + 1, last = around * (RINGS - 2);
        fprintf(body->out, "f %d %d %d\nf %d %d %d\n", top, b, a, top + 1, last + a, last + b);
        for (int i = 0; i + 2 < RINGS; i++)
            fprintf(body->out, "f %d %d %d %d\n", i * around + a, i * around + b,
                    (i + 1) * around + b, (i + 1) * around + a);
    }
}

static inline struct body begin(const char *path)
{
    struct body body = {.out = fopen(path, "w")};
    assert_non_null(body.out);
    return body;
}

/* One particle, which meets what collides. */
static inline struct kiln_system *shoot(struct scene_fixture *f, const double from[3],
                                        const double v[3])
{
    fixture_init(f);
    struct kiln_system *system = fixture_add_system(f, "one", 0.0f);
    system->emit.bursts[0] = (struct kiln_burst){0.0, 1};
    system->emit.burst_count = 1;
    system->emit.life = fixture_range(10.0f, 10.0f);
    const float speed = (float)sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    system->emit.speed = fixture_range(speed, speed);
    system->emit.origin = fixture_constant3((float)from[0], (float)from[1], (float)from[2]);
    system->emit.direction = fixture_constant3((float)v[0], (float)v[1], (float)v[2]);
    system->collide.enabled = true;
    return system;
}

/* That particle after so many steps. */
static inline struct kiln_particle after(struct scene_fixture *f, uint32_t steps)
{
    fixture_finish(f, steps);
    struct simulation run;
    simulation_start(&run, &f->scene, NULL, 1);
    simulation_run(&run, steps);
    struct kiln_particle p = simulation_records(&run)[0];
    assert_true(particle_is_alive(p));
    simulation_end(&run);
    return p;
}

/* Falls and flies from above the origin in all directions down. */
static inline void a_crowd_around(struct scene_fixture *f, uint32_t count, float speed,
                                  float gravity)
{
    fixture_init(f);
    struct kiln_system *system = fixture_add_system(f, "crowd", 0.0f);
    system->emit.bursts[0] = (struct kiln_burst){0.0, count};
    system->emit.burst_count = 1;
    system->emit.life = fixture_range(10.0f, 10.0f);
    system->emit.shape = KILN_EMITTER_BOX;
    system->emit.origin = fixture_constant3(0.0f, 3.0f, 0.0f);
    system->emit.size = fixture_constant3(3.0f, 0.1f, 3.0f);
    system->emit.direction = fixture_constant3(0.0f, -1.0f, 0.0f);
    system->emit.angle = fixture_constant(0.7f);
    system->emit.speed = fixture_range(0.1f * speed, speed);
    system->collide.enabled = true;
    system->collide.randomness = fixture_constant(0.3f);
    system->collide.slowdown = fixture_constant(0.8f);
    fixture_add_force(system, KILN_FORCE_GRAVITY)->vector = fixture_constant3(0.0f, -gravity, 0.0f);
    fixture_finish(f, 60);
}

#endif
