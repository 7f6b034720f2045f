/* Checks that the exact arithmetic of shaders/shared gives the same bits in GLSL as in C, for a
 * million test vectors in each shader stage that can simulate. If this fails, this device simulates
 * differently from other machines, and the exactness probe (lib/gpu/probe.h), which tests fewer
 * vectors when kiln starts, may miss it. */
#include <stddef.h>
#include <stdint.h>

#include "gpu/probe.h"
#include "support/cmocka.h"
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

static void fragments_agree_with_c(void **state)
{
    vectors_agree_with_c(*state, KILN_PROBE_FRAGMENT);
}

/* The probe takes any number of vectors. The fragment stage gets vectors as rows of texels, so the
 * last row may be only partly filled. */
static void any_number_of_vectors_is_probed(void **state)
{
    char reason[256];
    struct kiln_error error = {0};
    for (uint32_t count = 1; count < 200; count += 63)
        for (int stage = KILN_PROBE_COMPUTE; stage <= KILN_PROBE_FRAGMENT; stage++)
            if (!kiln_probe_vectors(*state, (enum kiln_probe_stage)stage, count, reason, &error))
                fail_msg("%s%s", reason, error.message);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(compute_agrees_with_c),
        test_on_device(geometry_agrees_with_c),
        test_on_device(fragments_agree_with_c),
        test_on_device(any_number_of_vectors_is_probed),
    };
    return cmocka_run_group_tests_name("exact", tests, test_device_open, test_device_close);
}
