/* The shared arithmetic in GLSL against C, bit for bit, on a million vectors. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "gpu/probe.h"
#include "support/device.h"

static void a_million_vectors_agree_with_c(void **state)
{
    struct kiln_error error = {0};
    char reason[256];
    if (!kiln_probe_vectors(*state, 1 << 20, reason, &error))
        fail_msg("%s%s", reason, error.message);
    assert_string_equal(reason, "");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(a_million_vectors_agree_with_c),
    };
    return cmocka_run_group_tests_name("exact", tests, test_device_open, test_device_close);
}
