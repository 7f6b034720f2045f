/* Opens the device that GPU tests run on, and checks it for GL errors after each test. A test
 * program opens one device, with a debug context, for its whole group. */
#ifndef KILN_TESTS_DEVICE_H
#define KILN_TESTS_DEVICE_H

#include "gpu/device.h"
#include "support/cmocka.h"
#include "support/folders.h"

/* A log callback that prints only warnings, to stderr. */
void test_log(void *user, enum kiln_log_level level, const char *line);

/* Returns the device that test_device_open opened, for tests whose *state does not point to it. */
struct kiln_device *test_device(void);

/* Lists the devices of this machine as error messages do, such as "0 'cpu', 1 'llvmpipe'". size:
 * bytes of `names`. */
void test_device_names(char *names, size_t size);

/* Returns the largest relative rounding error of a value in a render target of a frame. On a GPU
 * the render targets have half floats, which round by up to 2^-11; on software GL they have 32-bit
 * floats, which round by up to 2^-24 (lib/frame/stages_set_up.c). */
double test_rounding(void);

/* A group set-up for cmocka. It opens the device that KILN_TEST_DEVICE names, or else the first one
 * with GL, and sets *state to it. If there is none, it ends the program with exit status 77, which
 * means skipped. */
int test_device_open(void **state);

/* Does what test_device_open does, but sets *state to NULL. A group uses it if its tests have
 * initial states of their own, which cmocka ignores when the group has a state. */
int test_device_open_alone(void **state);

/* A group tear-down for cmocka. It closes the device. */
int test_device_close(void **state);

/* A tear-down of a test for cmocka. It fails if GL had an error that the test did not report. */
int test_device_is_clean(void **state);

/* Makes an entry of a cmocka group whose test must leave no GL error behind. The group's set-up
 * must be test_device_open or test_device_open_alone. */
#define test_on_device(function) cmocka_unit_test_teardown(function, test_device_is_clean)

/* Makes such an entry of a test that works in a temporary folder of its own (support/folders.h). */
#define test_in_folder_on_device(function)                                                         \
    cmocka_unit_test_setup_teardown(function, test_enter_folder, test_device_leave_folder)

/* A tear-down of a test for cmocka: that of the folder, and that of the device. */
int test_device_leave_folder(void **state);

#endif
