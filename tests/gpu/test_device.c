/* Checks how devices, which are GL drivers or the CPU without GL, are listed, chosen and opened
 * (lib/gpu/device.h), how GL errors are reported, and which sizes of work groups are chosen. If
 * this fails, a user gets the wrong device, cannot learn why there is none, or misses an error of
 * GL. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "gpu/probe.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"

static struct kiln_device *open_named(const char *wanted, struct kiln_error *error)
{
    struct kiln_device_params params = kiln_device_defaults();
    params.wanted = wanted;
    *error = (struct kiln_error){0};
    return kiln_device_open(&params, error);
}

/* Prepares entries for kiln_device_list. Each entry must hold the size of its struct. */
static void empty(struct kiln_device_info *infos, size_t count)
{
    for (size_t i = 0; i < count; i++)
        infos[i] = kiln_device_info_empty();
}

static void list_describes_usable_devices(void **state)
{
    (void)state;
    struct kiln_device_info infos[32];
    empty(infos, 32);
    char advice[256];
    size_t count = kiln_device_list(infos, sizeof(struct kiln_device_info), 32, advice);
    assert_in_range(count, 1, 32);
    size_t usable = 0;
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(infos[i].index, i);
        assert_true(infos[i].name[0] != '\0');
        assert_true(infos[i].usable == (infos[i].problem[0] == '\0'));
        assert_true(infos[i].gl == (i > 0));
        if (!infos[i].usable || !infos[i].gl)
            continue;
        usable++;
        assert_true(infos[i].max_work_group_invocations >= 1024);
        assert_true(infos[i].max_shared_memory_bytes >= 32 * 1024);
        assert_true(infos[i].max_storage_block_bytes >= 1 << 24);
        assert_true(infos[i].max_texture_size >= 16384);
        assert_true(infos[i].max_array_layers >= 2048);
    }
    assert_true(usable >= 1);

    /* kiln_device_list returns the number of all devices even if it fills in fewer. */
    struct kiln_device_info first = {.size = sizeof first, .index = 77};
    assert_int_equal(kiln_device_list(&first, sizeof(struct kiln_device_info), 1, NULL), count);
    assert_string_equal(first.name, infos[0].name);
    assert_int_equal(kiln_device_list(NULL, sizeof(struct kiln_device_info), 0, NULL), count);
}

static void list_has_no_device_twice(void **state)
{
    (void)state;
    struct kiln_device_info infos[32];
    empty(infos, 32);
    size_t count = kiln_device_list(infos, sizeof(struct kiln_device_info), 32, NULL);
    for (size_t i = 0; i < count && i < 32; i++)
        for (size_t j = 0; j < i; j++)
            assert_false(strcmp(infos[i].platform, "surfaceless") == 0 &&
                         strcmp(infos[i].name, infos[j].name) == 0);
}

static void list_leaves_the_current_context(void **state)
{
    struct kiln_device *device = *state;
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    assert_true(kiln_device_list(NULL, sizeof(struct kiln_device_info), 0, NULL) > 0);
    GLint bound = 0;
    glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &bound);
    assert_int_equal(bound, buffer);
    glDeleteBuffers(1, &buffer);
    struct kiln_error error = {0};
    assert_true(kiln_device_check(device, "list", &error));
}

static void a_device_is_chosen_by_number_and_name(void **state)
{
    struct kiln_error error = {0};
    struct kiln_device_info infos[32];
    empty(infos, 32);
    size_t count = kiln_device_list(infos, sizeof(struct kiln_device_info), 32, NULL);
    for (size_t i = 0; i < count && i < 32; i++) {
        if (!infos[i].usable)
            continue;
        char number[16];
        snprintf(number, sizeof number, "%zu", i);
        struct kiln_device *device = open_named(number, &error);
        assert_non_null(device);
        assert_string_equal(kiln_device_get_info(device)->name, infos[i].name);
        assert_int_equal(kiln_device_get_info(device)->index, i);
        kiln_device_close(&device);
        assert_null(device);
    }
    /* The default device is a GPU if there is one, otherwise the CPU without GL. */
    bool has_gpu = false;
    for (size_t i = 0; i < count && i < 32; i++)
        has_gpu = has_gpu || (infos[i].usable && !infos[i].software);
    struct kiln_device *device = open_named(NULL, &error);
    assert_non_null(device);
    assert_true(kiln_device_get_info(device)->software == !has_gpu);
    assert_true(kiln_device_get_info(device)->gl == has_gpu);
    kiln_device_close(&device);
    kiln_device_close(&device);

    /* A caller that asks for GL gets a device with GL. */
    struct kiln_device_params params = kiln_device_defaults();
    params.gl = true;
    device = kiln_device_open(&params, &error);
    assert_non_null(device);
    assert_true(kiln_device_get_info(device)->gl);
    kiln_device_close(&device);
    assert_true(kiln_device_make_current(*state, &error));
}

static void software_is_chosen_by_name(void **state)
{
    struct kiln_error error = {0};
    struct kiln_device *device = open_named("software", &error);
    if (!device) {
        char names[512];
        test_device_names(names, sizeof names);
        expect_error(&error, KILN_NO_DEVICE,
                     "there is no device 'software'; there are: %s; the packages libegl-mesa0 and "
                     "libgl1-mesa-dri bring a software device",
                     names);
        skip();
    }
    assert_true(kiln_device_get_info(device)->software);
    kiln_device_close(&device);

    struct kiln_device_info infos[32];
    empty(infos, 32);
    size_t matches = 0, count = kiln_device_list(infos, sizeof(struct kiln_device_info), 32, NULL);
    for (size_t i = 0; i < count && i < 32; i++)
        matches += strstr(infos[i].name, "llvmpipe") != NULL;
    device = open_named("LLVMpipe", &error);
    assert_int_equal(device != NULL, matches == 1);
    kiln_device_close(&device);
    assert_true(kiln_device_make_current(*state, &error));
}

static void a_wrong_choice_lists_the_devices(void **state)
{
    struct kiln_error error;
    char names[512];
    test_device_names(names, sizeof names);
    assert_null(open_named("no such device", &error));
    expect_error(&error, KILN_NO_DEVICE, "there is no device 'no such device'; there are: %s",
                 names);

    static const char *const numbers[] = {"99", "18446744073709551615"};
    for (size_t i = 0; i < 2; i++) {
        assert_null(open_named(numbers[i], &error));
        expect_error(&error, KILN_NO_DEVICE, "there is no device '%s'; there are: %s", numbers[i],
                     names);
    }
    assert_null(open_named("", &error));
    expect_error(&error, KILN_USAGE, "the name of the device is empty");
    assert_true(kiln_device_make_current(*state, &error));
}

/* The open device, a new probe of it and the list of devices must agree on whether the device
 * computes the same bits as C. Mesa's software GL, llvmpipe, must do so. */
static void exactness_is_probed(void **state)
{
    const struct kiln_device_info *info = kiln_device_get_info(*state);
    char reason[256];
    struct kiln_error error = {0};
    assert_true(info->exact == kiln_probe_exact(*state, KILN_PROBE_COMPUTE, reason, &error));
    assert_true(info->exact || !strstr(info->name, "llvmpipe"));
    struct kiln_device_info infos[32];
    empty(infos, 32);
    size_t count = kiln_device_list(infos, sizeof(struct kiln_device_info), 32, NULL);
    assert_true(info->index < count);
    assert_true(infos[info->index].exact == info->exact);
}

static void two_devices_live_side_by_side(void **state)
{
    struct kiln_device *first = *state;
    struct kiln_error error;
    struct kiln_device *second = open_named(NULL, &error);
    assert_non_null(second);
    assert_true(kiln_device_check(second, "second", &error));
    kiln_device_close(&second);
    assert_true(kiln_device_make_current(first, &error));
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    assert_true(buffer != 0);
    glDeleteBuffers(1, &buffer);
    assert_true(kiln_device_check(first, "first", &error));
}

/* kiln_device_check must report a GL error once, and not again at the next call. The end of the
 * message is not compared, since the driver words it. */
static void gl_errors_are_found_once(void **state)
{
    struct kiln_device *device = *state;
    struct kiln_error error = {0};
    const struct kiln_log log = device->log;
    device->log = (struct kiln_log){0};
    glEnable(GL_TEXTURE_2D_ARRAY);
    assert_false(kiln_device_check(device, "here", &error));
    expect_error_around(&error, KILN_DEVICE_FAILED, "", "here: GL: invalid enum (0x0500): ");
    assert_true(kiln_device_check(device, "here", &error));

    /* An error that kiln's debug callback received counts even if glGetError has cleared it. */
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBufferData(GL_ARRAY_BUFFER, 16, NULL, GL_STATIC_DRAW);
    assert_int_equal(glGetError(), GL_INVALID_OPERATION);
    assert_false(kiln_device_check(device, "there", &error));
    expect_error_around(&error, KILN_DEVICE_FAILED, "", "there: GL: ");
    assert_true(kiln_device_check(device, "there", &error));
    device->log = log;
}

static void work_groups_are_powers_of_two_within_limits(void **state)
{
    struct kiln_device *device = *state;
    const uint32_t limit = (uint32_t)device->info.max_work_group_invocations;
    static const struct {
        uint32_t asked, most, expected;
    } cases[] = {{0, 512, 48}, {1, 512, 1}, {64, 512, 64}, {96, 512, 64}, {4096, 512, 512}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        device->work_group_size = cases[i].asked;
        assert_int_equal(kiln_device_group_size(device, 48, cases[i].most), cases[i].expected);
    }
    device->work_group_size = UINT32_MAX;
    uint32_t size = kiln_device_group_size(device, 48, 1u << 31);
    assert_true(size <= limit && 2 * size > limit);
    device->work_group_size = 0;
}

static void out_of_memory_is_named(void **state)
{
    struct kiln_device *device = *state;
    struct kiln_error error = {0};
    const struct kiln_log log = device->log;
    device->log = (struct kiln_log){0};
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
    glBufferData(GL_COPY_WRITE_BUFFER, (GLsizeiptr)1 << 50, NULL, GL_STATIC_DRAW);
    assert_false(kiln_device_check(device, "pool", &error));
    expect_error_around(&error, KILN_DEVICE_FAILED, "",
                        "pool: GL: the device is out of memory (0x0505): ");
    glDeleteBuffers(1, &buffer);
    device->log = log;
}

/* Fails unless a process in which an environment variable has this value finds no device with GL
 * and gives this advice. A process looks for drivers and libraries only once, so a child process
 * runs this program with --list. */
static void assert_explained(const char *variable, const char *value, const char *advice)
{
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        setenv(variable, value, 1);
        dup2(ends[1], STDOUT_FILENO);
        execl("/proc/self/exe", "test_device", "--list", (char *)NULL);
        _exit(127);
    }
    close(ends[1]);
    char text[1024] = "";
    ssize_t length = read(ends[0], text, sizeof text - 1);
    close(ends[0]);
    int status = 0;
    assert_true(waitpid(child, &status, 0) == child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == KILN_NO_DEVICE);
    assert_true(length > 0);
    expect_message(text, "1 devices; %s; no device with OpenGL: %s\n", advice, advice);
}

static void missing_drivers_are_explained(void **state)
{
    (void)state;
    char folder[] = "/tmp/kiln-drivers-XXXXXX"; /* an empty folder: it describes no driver */
    assert_non_null(mkdtemp(folder));
    assert_explained("__EGL_VENDOR_LIBRARY_DIRS", folder,
                     "EGL has no driver that works without a display; install the package "
                     "libegl-mesa0, or the GPU vendor's EGL");
    rmdir(folder);
}

/* A library that cannot be loaded must be explained. An empty file libEGL.so.1 hides the library of
 * this name in later folders of the search path. */
static void missing_libraries_are_explained(void **state)
{
    (void)state;
    char dir[] = "/tmp/kiln-libraries-XXXXXX", path[64];
    assert_non_null(mkdtemp(dir));
    snprintf(path, sizeof path, "%s/libEGL.so.1", dir);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fclose(file);
    assert_explained("LD_LIBRARY_PATH", dir,
                     "libEGL.so.1 cannot be loaded; install the package libegl1");
    unlink(path);
    rmdir(dir);
}

/* Lists and opens devices in the child process of assert_explained, and prints the advice and the
 * error. Returns the error's code. */
static int list_and_open(void)
{
    char advice[256];
    struct kiln_error error = {0};
    size_t count = kiln_device_list(NULL, sizeof(struct kiln_device_info), 0, advice);
    struct kiln_device_params params = kiln_device_defaults();
    params.gl = true;
    struct kiln_device *device = kiln_device_open(&params, &error);
    printf("%zu devices; %s; %s\n", count, advice, error.message);
    kiln_device_close(&device);
    return (int)error.code;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--list") == 0)
        return list_and_open();
    static const struct CMUnitTest tests[] = {
        test_on_device(list_describes_usable_devices),
        test_on_device(list_has_no_device_twice),
        test_on_device(list_leaves_the_current_context),
        test_on_device(a_device_is_chosen_by_number_and_name),
        test_on_device(software_is_chosen_by_name),
        test_on_device(a_wrong_choice_lists_the_devices),
        test_on_device(exactness_is_probed),
        test_on_device(two_devices_live_side_by_side),
        test_on_device(gl_errors_are_found_once),
        test_on_device(work_groups_are_powers_of_two_within_limits),
        test_on_device(out_of_memory_is_named),
        test_on_device(missing_drivers_are_explained),
        test_on_device(missing_libraries_are_explained),
    };
    return cmocka_run_group_tests_name("device", tests, test_device_open, test_device_close);
}
