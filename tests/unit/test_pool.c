/* lib/particles/pool: slots and the list of the living. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "particles/pool.h"

static void put(struct kiln_particle *records, const struct kiln_pool_system *system,
                uint32_t serial, bool alive)
{
    struct kiln_particle *p = &records[system->base + serial % system->capacity];
    *p = (struct kiln_particle){.position_serial = {.w = serial},
                                .velocity_birth = {.w = alive ? KILN_PARTICLE_ALIVE : 0}};
}

static void the_living_are_listed_by_system_and_serial(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_pool pool;
    kiln_pool_init(&pool, NULL, (const uint32_t[]){4, 0, 7}, 3);
    assert_int_equal(pool.slot_count, 11);
    assert_int_equal(pool.systems[2].base, 4);
    struct kiln_particle *records = kiln_buffer_host(&pool.records, KILN_READ_WRITE, &error);
    assert_non_null(records);
    uint32_t entries[11];
    assert_int_equal(kiln_pool_alive(&pool, records, entries), 0);

    /* system 0 is on its second round: serials 3 .. 6, of which 4 died; system 2 has room left */
    pool.systems[0].next_serial = 7;
    for (uint32_t serial = 0; serial < 7; serial++)
        put(records, &pool.systems[0], serial, serial != 4);
    pool.systems[2].next_serial = 3;
    for (uint32_t serial = 0; serial < 3; serial++)
        put(records, &pool.systems[2], serial, true);
    assert_int_equal(kiln_pool_used(&pool.systems[0]), 4);
    assert_int_equal(kiln_pool_used(&pool.systems[2]), 3);

    static const uint32_t systems[] = {0, 0, 0, 2, 2, 2}, serials[] = {3, 5, 6, 0, 1, 2};
    assert_int_equal(kiln_pool_alive(&pool, records, entries), 6);
    for (int i = 0; i < 6; i++) {
        assert_int_equal(KILN_ENTRY_SYSTEM(entries[i]), systems[i]);
        assert_int_equal(records[KILN_ENTRY_SLOT(entries[i])].position_serial.w, serials[i]);
    }
    kiln_pool_finish(&pool);
    assert_int_equal(pool.slot_count, 0);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_living_are_listed_by_system_and_serial),
    };
    return cmocka_run_group_tests_name("pool", tests, NULL, NULL);
}
