/* lib/particles/pool: slots and entries. */
#include <stddef.h>
#include <stdint.h>

#include "particles/pool.h"
#include "support/cmocka.h"
#include "support/pools.h"

static void slots_follow_one_another(void **state)
{
    (void)state;
    struct kiln_pool pool;
    pool_init(&pool, NULL, (const uint32_t[]){4, 0, 7}, 3);
    assert_int_equal(pool.slot_count, 11);
    assert_int_equal(pool.systems[1].base, 4);
    assert_int_equal(pool.systems[2].base, 4);
    assert_int_equal(kiln_pool_used(&pool.systems[0]), 0);
    pool.systems[0].next_serial = 7; /* on its second round */
    pool.systems[2].next_serial = 3;
    assert_int_equal(kiln_pool_used(&pool.systems[0]), 4);
    assert_int_equal(kiln_pool_used(&pool.systems[2]), 3);
    assert_int_equal(KILN_ENTRY_SYSTEM(KILN_ENTRY(KILN_MAX_SYSTEMS - 1, 0x3fffffe)),
                     KILN_MAX_SYSTEMS - 1);
    assert_int_equal(KILN_ENTRY_SLOT(KILN_ENTRY(KILN_MAX_SYSTEMS - 1, 0x3fffffe)), 0x3fffffe);
    kiln_pool_finish(&pool);
    assert_int_equal(pool.slot_count, 0);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(slots_follow_one_another),
    };
    return cmocka_run_group_tests_name("pool", tests, NULL, NULL);
}
