/* The device that GPU tests run on, opened once a program with a debug context. */
#ifndef KILN_TESTS_DEVICE_H
#define KILN_TESTS_DEVICE_H

#include "gpu/device.h"
#include "support/cmocka.h"

/* A log that shows warnings alone. */
void test_log(void *user, enum kiln_log_level level, const char *line);

/* The device of the group, for tests whose state is something else. */
struct kiln_device *test_device(void);

/* A group set-up of cmocka: *state becomes the device. KILN_TEST_DEVICE names another than the
 * first with GL. Ends the program as skipped (77) when there is none. */
int test_device_open(void **state);

/* The same for a group whose tests have states of their own: cmocka gives them that of the group,
 * if there is one. */
int test_device_open_alone(void **state);

int test_device_close(void **state);

/* A test's tear-down: GL errors that nobody looked at are failures. */
int test_device_is_clean(void **state);

/* A test of a group that was set up with test_device_open. */
#define test_on_device(function) cmocka_unit_test_teardown(function, test_device_is_clean)

#endif
