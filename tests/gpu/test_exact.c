/* The shared arithmetic in GLSL against C, bit for bit, on a million vectors. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "gpu/probe.h"
#include "support/device.h"

static void vectors_agree_with_c(struct kiln_device *device, enum kiln_probe_stage stage)
{
    struct kiln_error error = {0};
    char reason[256];
    if (!kiln_probe_vectors(device, stage, 1 << 20, reason, &error))
        fail_msg("%s%s", reason, error.message);
    assert_string_equal(reason, "");
}

static void compute_agrees_with_c(void **state)
{
    vectors_agree_with_c(*state, KILN_PROBE_COMPUTE);
}

static void geometry_agrees_with_c(void **state)
{
    vectors_agree_with_c(*state, KILN_PROBE_GEOMETRY);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(compute_agrees_with_c),
        test_on_device(geometry_agrees_with_c),
    };
    return cmocka_run_group_tests_name("exact", tests, test_device_open, test_device_close);
}
