/* Makes a system of balls for tests of interactions between particles, places balls in it, and sums
 * up their mass, momentum and kinetic energy. */
#include "support/balls.h"

#include "support/cmocka.h"

struct kiln_interaction *balls_init(struct scene_fixture *f, uint32_t count, float radius)
{
    fixture_init(f);
    struct kiln_system *s = fixture_add_system(f, "balls", 0.0f);
    s->emit.life = fixture_range(1000.0f, 1000.0f);
    s->capacity = count;
    s->look.size = fixture_constant(2.0f * radius);
    s->look.scale = fixture_range(1.0f, 1.0f);
    s->interaction_count = 1;
    s->interactions[0] = (struct kiln_interaction){.kind = KILN_INTERACT_COLLIDE,
                                                   .radius = fixture_constant(radius),
                                                   .restitution = fixture_constant(1.0f),
                                                   .apart = fixture_constant(0.5f),
                                                   .rounds = 4};
    return &s->interactions[0];
}

void balls_place(struct simulation *run, uint32_t slot, float3 position, float3 velocity)
{
    struct kiln_error error = {0};
    struct kiln_particle *records = kiln_buffer_host(&run->pool.records, KILN_READ_WRITE, &error);
    assert_non_null(records);
    records[slot] = (struct kiln_particle){
        .position_serial = {FLOAT_BITS(position.x), FLOAT_BITS(position.y), FLOAT_BITS(position.z),
                            slot},
        .velocity_birth = {FLOAT_BITS(velocity.x), FLOAT_BITS(velocity.y), FLOAT_BITS(velocity.z),
                           BALLS_FIRST_STEP << KILN_BIRTH_STEP_SHIFT | KILN_PARTICLE_ALIVE},
    };
    if (run->pool.systems[0].next_serial <= slot)
        run->pool.systems[0].next_serial = slot + 1;
    run->step = BALLS_FIRST_STEP;
}

float balls_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (float)((double)(*seed >> 8) / 8388608.0 - 1.0);
}

struct balls_sums balls_sum(struct simulation *run, uint32_t count, double (*mass)(uint32_t serial))
{
    const struct kiln_particle *records = simulation_records(run);
    struct balls_sums sums = {0};
    for (uint32_t i = 0; i < count; i++) {
        if (!particle_is_alive(records[i]))
            continue;
        const float3 v = particle_velocity(records[i]);
        const double x = (double)v.x, y = (double)v.y, z = (double)v.z;
        const double m = mass ? mass(i) : 1.0;
        sums.mass += m;
        sums.momentum[0] += m * x;
        sums.momentum[1] += m * y;
        sums.momentum[2] += m * z;
        sums.energy += 0.5 * m * (x * x + y * y + z * z);
    }
    return sums;
}
