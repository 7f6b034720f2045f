/* Checks that the GPU and the CPU compute the same hash of a simulation's state, for numbers of
 * particles around multiples of the work group's size, and that any changed bit of a particle, or
 * of what is left of one, changes the hash. If this fails, checks of the state hash report false
 * differences, or miss real ones. */
#include <stddef.h>
#include <stdint.h>

#include "shared/random.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/scene_fixture.h"
#include "support/simulation.h"

static struct scene_fixture fixture; /* too large for a stack */

/* Fills particle records with arbitrary words. */
static void fill(struct kiln_particle *records, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        records[i] = (struct kiln_particle){
            .position_serial = {random_mix(i), i * 7, i * 11, i},
            .velocity_birth = {i * 3, i * 5, ~i, random_mix(~i)}}; /* about half are alive */
}

static void both_hashes_agree(void **state)
{
    static const uint32_t sizes[] = {0, 1, 63, 64, 65, 1023, 1024, 1025, 70000};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        fixture_init(&fixture);
        for (int i = 0; i < 3; i++)
            fixture_add_system(&fixture, "any", 1.0f)->capacity = sizes[s] + (uint32_t)i;
        struct simulation cpu, inplace;
        simulation_start(&cpu, &fixture.scene, NULL, 3);
        simulation_start(&inplace, &fixture.scene, *state, 1);
        struct kiln_error error = {0};
        struct kiln_pool *pool = &inplace.pool;
        fill(kiln_buffer_host(&pool->records, KILN_READ_WRITE, &error), pool->slot_count);
        pool->systems[0].next_serial = sizes[s] / 2;
        pool->systems[1].next_serial = UINT32_MAX;
        pool->systems[2].next_serial = sizes[s];

        uint64_t cpu_alive = 1, inplace_alive = 2;
        struct kiln_state_hash a, b;
        assert_true(kiln_simulate_hash(cpu.simulate, pool, &a, &cpu_alive, &error));
        assert_true(kiln_simulate_hash(inplace.simulate, pool, &b, &inplace_alive, &error));
        assert_int_equal(cpu_alive, inplace_alive);
        assert_int_equal(a.lane[0], b.lane[0]);
        assert_int_equal(a.lane[1], b.lane[1]);
        if (sizes[s] > 1000)
            assert_in_range(cpu_alive, sizes[s], sizes[s] + sizes[s] / 2);
        simulation_end(&cpu);
        simulation_end(&inplace);
    }
}

/* Changing any bit of a living particle, or of what is left of a dead one, changes both 32-bit
 * lanes of the hash. Changing a bit of an empty slot leaves the hash as it is, except for the birth
 * word, whose bits mean that the slot has a particle. */
static void every_bit_counts(void **state)
{
    fixture_init(&fixture);
    fixture_add_system(&fixture, "any", 1.0f)->capacity = 8;
    struct simulation run;
    simulation_start(&run, &fixture.scene, *state, 1);
    run.pool.systems[0].next_serial = 8;
    struct kiln_error error = {0};
    for (uint32_t bit = 0; bit < 3 * 256; bit++) {
        uint32_t slot = bit / 256;
        uint64_t alive;
        struct kiln_particle *records =
            kiln_buffer_host(&run.pool.records, KILN_READ_WRITE, &error);
        fill(records, 8);
        records[0].velocity_birth.w |= KILN_PARTICLE_ALIVE;
        records[1].velocity_birth.w = 0;
        records[2].velocity_birth.w &= ~KILN_PARTICLE_ALIVE;
        struct kiln_state_hash before = simulation_hash(&run, &alive);
        uint32_t words[8];
        records = kiln_buffer_host(&run.pool.records, KILN_READ_WRITE, &error);
        memcpy(words, &records[slot], sizeof words);
        words[bit % 256 / 32] ^= 1u << bit % 32;
        memcpy(&records[slot], words, sizeof words);
        struct kiln_state_hash after = simulation_hash(&run, &alive);
        const bool counts = slot != 1 || bit % 256 >= 7 * 32;
        assert_int_equal(before.lane[0] != after.lane[0], counts);
        assert_int_equal(before.lane[1] != after.lane[1], counts);
    }
    simulation_end(&run);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(both_hashes_agree),
        test_on_device(every_bit_counts),
    };
    return cmocka_run_group_tests_name("hash", tests, simulation_device_open, test_device_close);
}
