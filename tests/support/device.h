/* Opens the device that GPU tests run on, once in each program, with a debug context. */
#ifndef KILN_TESTS_DEVICE_H
#define KILN_TESTS_DEVICE_H

#include "gpu/device.h"
#include "support/cmocka.h"

/* A log callback that prints warnings only. */
void test_log(void *user, enum kiln_log_level level, const char *line);

/* Returns the device that the group opened, for tests whose state is not the device. */
struct kiln_device *test_device(void);

/* Returns how much a value in a frame's pictures may be rounded, relative to it: as a half float on
 * a GPU, as a float on software GL (lib/frame/stages.c). */
double test_rounding(void);

/* A group set-up of cmocka: *state becomes the device, the first with GL or the one that
 * KILN_TEST_DEVICE names. Ends the program as skipped (77) when there is none. */
int test_device_open(void **state);

/* Does what test_device_open does, but sets *state to NULL: with a state of the group, cmocka would
 * ignore the states of its tests. */
int test_device_open_alone(void **state);

/* A group tear-down that closes the device. */
int test_device_close(void **state);

/* A test's tear-down that fails if there is a GL error that was not reported. */
int test_device_is_clean(void **state);

/* Defines a test of a group that was set up with test_device_open. */
#define test_on_device(function) cmocka_unit_test_teardown(function, test_device_is_clean)

#endif
