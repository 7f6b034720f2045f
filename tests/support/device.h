/* The device that GPU tests run on, opened once a program with a debug context. */
#ifndef TESTS_SUPPORT_DEVICE_H
#define TESTS_SUPPORT_DEVICE_H

#include <stdio.h>
#include <stdlib.h>

#include "gpu/device.h"
#include "support/cmocka.h"

static inline void test_log(void *user, enum kiln_log_level level, const char *line)
{
    (void)user;
    if (level == KILN_LOG_WARNING)
        fprintf(stderr, "%s\n", line);
}

static struct kiln_device *test_opened_device;

/* The device of the group, for tests whose state is something else. */
static inline struct kiln_device *test_device(void)
{
    return test_opened_device;
}

/* A group set-up of cmocka: *state becomes the device. KILN_TEST_DEVICE names another than the
 * first with GL. Ends the program as skipped (77) when there is none. */
static inline int test_device_open(void **state)
{
    struct kiln_error error = {0};
    struct kiln_device_params params = KILN_DEVICE_DEFAULTS;
    params.wanted = getenv("KILN_TEST_DEVICE");
    params.gl = true;
    params.debug = true;
    params.log.write = test_log;
    struct kiln_device *device = kiln_device_open(&params, &error);
    if (!device) {
        fprintf(stderr, "skipped: %s\n", error.message);
        exit(77);
    }
    fprintf(stderr, "on %s\n", kiln_device_info(device)->name);
    *state = test_opened_device = device;
    return 0;
}

/* The same for a group whose tests have states of their own: cmocka gives them that of the group,
 * if there is one. */
static inline int test_device_open_alone(void **state)
{
    const int failed = test_device_open(state);
    *state = NULL;
    return failed;
}

static inline int test_device_close(void **state)
{
    (void)state;
    kiln_device_close(&test_opened_device);
    return 0;
}

/* A test's tear-down: GL errors that nobody looked at are failures. */
static inline int test_device_is_clean(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    if (kiln_device_check(test_device(), "after the test", &error))
        return 0;
    fprintf(stderr, "%s\n", error.message);
    return -1;
}

/* A test of a group that was set up with test_device_open. */
#define test_on_device(function) cmocka_unit_test_teardown(function, test_device_is_clean)

#endif
