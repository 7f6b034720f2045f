/* Opens the GL device that a group of GPU tests shares, checks it for GL errors after each test,
 * and closes it. Without a device, the test program ends as skipped. */
#include "support/device.h"

#include <stdio.h>
#include <stdlib.h>

static struct kiln_device *test_opened_device;

void test_log(void *user, enum kiln_log_level level, const char *line)
{
    (void)user;
    if (level == KILN_LOG_WARNING)
        fprintf(stderr, "%s\n", line);
}

struct kiln_device *test_device(void)
{
    return test_opened_device;
}

void test_device_names(char *names, size_t size)
{
    struct kiln_device_info infos[32];
    for (size_t i = 0; i < 32; i++)
        infos[i] = kiln_device_info_empty();
    const size_t count = kiln_device_list(infos, sizeof *infos, 32, NULL);
    size_t length = 0;
    assert_in_range(count, 1, 32);
    for (size_t i = 0; i < count; i++) {
        length += (size_t)snprintf(names + length, size - length, "%s%zu '%s'", i ? ", " : "", i,
                                   infos[i].name);
        assert_true(length < size);
    }
}

double test_rounding(void)
{
    return test_device()->info.software ? 0x1p-24 : 0x1p-11;
}

int test_device_open(void **state)
{
    struct kiln_error error = {0};
    struct kiln_device_params params = kiln_device_defaults();
    params.wanted = getenv("KILN_TEST_DEVICE");
    params.gl = true;
    params.debug = true;
    params.log.write = test_log;
    struct kiln_device *device = kiln_device_open(&params, &error);
    if (!device) {
        fprintf(stderr, "skipped: %s\n", error.message);
        exit(77);
    }
    fprintf(stderr, "on %s\n", kiln_device_get_info(device)->name);
    *state = test_opened_device = device;
    return 0;
}

int test_device_open_alone(void **state)
{
    const int failed = test_device_open(state);
    *state = NULL;
    return failed;
}

int test_device_close(void **state)
{
    (void)state;
    kiln_device_close(&test_opened_device);
    return 0;
}

int test_device_is_clean(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    if (kiln_device_check(test_device(), "after the test", &error))
        return 0;
    fprintf(stderr, "%s\n", error.message);
    return -1;
}

int test_device_leave_folder(void **state)
{
    const int failed = test_device_is_clean(state);
    return test_leave_folder(state) || failed;
}
