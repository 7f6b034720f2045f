/* Names the statuses of tests, and chooses the worse of two codes. A test has a status for people
 * and a code for programs; of several tests, `kiln test` ends with the worst code. */
#include "kiln_program.h"

const char *kiln_test_status_name(enum kiln_test_status status)
{
    static const char *const names[KILN_TEST_STATUS_COUNT] = {
        [KILN_TEST_PASS] = "pass",     [KILN_TEST_SKIP] = "skip", [KILN_TEST_WARN] = "warn",
        [KILN_TEST_CHANGE] = "change", [KILN_TEST_NEW] = "new",   [KILN_TEST_FAIL] = "fail",
        [KILN_TEST_ERROR] = "error",
    };
    return (unsigned)status < KILN_TEST_STATUS_COUNT ? names[status] : "";
}

enum kiln_code kiln_code_worse(enum kiln_code a, enum kiln_code b)
{
    /* Every code but KILN_OK must be here, since a code that is not here counts as KILN_OK. */
    static const enum kiln_code worst_first[] = {
        KILN_INTERRUPTED,    KILN_DEVICE_FAILED, KILN_OVER_LIMIT, KILN_IO,
        KILN_NO_DEVICE,      KILN_INVALID_INPUT, KILN_USAGE,      KILN_FRAME_FAILED,
        KILN_GOLDEN_MISSING, KILN_READER_GONE,
    };
    for (size_t i = 0; i < sizeof worst_first / sizeof *worst_first; i++) {
        if (a == worst_first[i] || b == worst_first[i])
            return worst_first[i];
    }
    return KILN_OK;
}
