/* The device without GL: it renders where EGL cannot be loaded, loads nothing of GL, and its pixels
 * are the same bytes for every width of vectors and any number of threads. */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/file.h"
#include "base/hash.h"
#include "base/simd.h"
#include "kiln.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/parts.h"
#include "support/scenes.h"

static struct kiln_scene *load(const char *path)
{
    static const char *const small[] = {"output.size=[96, 54]", NULL};
    return load_coarse_scene(path, small);
}

/* A sample of the tests steps each scene for a second before its first frame, instead of up to 13:
 * most of their time would be that of steps, which unit.slots compares at each width of vectors. */
static struct kiln_scene *load_early(const char *path)
{
    static const char *const early[] = {"output.size=[96, 54]", "simulation.warmup=1 s", NULL};
    return test_is_full() ? load(path) : load_coarse_scene(path, early);
}

/* Renders a frame into a file, if one is named; the techniques become `techniques`. */
static void render(struct kiln_device *device, const struct kiln_scene *scene, const char *file,
                   uint32_t threads, char techniques[256])
{
    struct kiln_error error = {0};
    struct kiln_render_params params = kiln_render_defaults();
    const struct kiln_frame_range frame = {10, 10};
    params.ranges = &frame;
    params.range_count = 1;
    params.output = file;
    params.overwrite = true;
    params.exr_bits = 32;
    params.threads = threads;
    struct kiln_render_stats stats = kiln_render_stats_empty();
    if (!kiln_render(device, scene, &params, &stats, &error))
        fail_msg("%s", error.message);
    if (techniques)
        memcpy(techniques, stats.techniques, sizeof stats.techniques);
}

static struct kiln_device *open_device(const char *wanted)
{
    struct kiln_error error = {0};
    struct kiln_device_params params = kiln_device_defaults();
    params.wanted = wanted;
    struct kiln_device *device = kiln_device_open(&params, &error);
    if (!device)
        fail_msg("%s", error.message);
    return device;
}

/* ---- libraries ------------------------------------------------------------------------------- */

static bool is_loaded(const char *library)
{
    FILE *maps = fopen("/proc/self/maps", "r");
    assert_non_null(maps);
    char line[1024];
    bool found = false;
    while (fgets(line, sizeof line, maps))
        found = found || strstr(line, library);
    fclose(maps);
    return found;
}

/* Before any other test, since libraries stay loaded. */
static void nothing_of_gl_is_loaded(void **state)
{
    (void)state;
    struct kiln_device *device = open_device(KILN_DEVICE_CPU);
    const struct kiln_device_info *info = kiln_device_get_info(device);
    assert_true(info->usable && info->exact && !info->gl);
    assert_string_equal(info->name, KILN_DEVICE_CPU);
    assert_int_equal(info->index, 0);
    assert_true(info->threads > 0 && info->vectors[0]);
    struct kiln_scene *scene = load(KILN_SOURCE_DIR "/scenes/torch.yaml");
    char techniques[256];
    render(device, scene, NULL, 2, techniques);
    for (const char *at = techniques; (at = strchr(at, '=')); at++)
        assert_int_equal(strncmp(at, "=cpu", 4), 0);
    kiln_scene_destroy(&scene);
    kiln_device_close(&device);

    static const char *const libraries[] = {"libEGL",     "libGL",      "libOpenGL",
                                            "libgallium", "swrast_dri", "libLLVM"};
    assert_true(is_loaded("libepoxy")); /* the maps can be read */
    for (size_t i = 0; i < sizeof libraries / sizeof *libraries; i++)
        assert_false(is_loaded(libraries[i]));
}

/* What the next test runs: nothing is asked for, and nothing of GL works. */
static int render_by_default(void)
{
    struct kiln_error error = {0};
    struct kiln_device *device = kiln_device_open(NULL, &error);
    struct kiln_scene *scene = kiln_scene_load(KILN_SOURCE_DIR "/scenes/torch.yaml", NULL, &error);
    struct kiln_render_params params = kiln_render_defaults();
    const struct kiln_frame_range frame = {0, 0};
    params.ranges = &frame;
    params.range_count = 1;
    bool ok = device && scene && !kiln_device_get_info(device)->gl &&
              kiln_render(device, scene, &params, NULL, &error);
    if (!ok)
        fprintf(stderr, "%s\n", error.message);
    kiln_scene_destroy(&scene);
    kiln_device_close(&device);
    return ok ? 0 : 1;
}

/* A file that is no library hides the one behind it. */
static void it_is_the_default_where_egl_is_missing(void **state)
{
    (void)state;
    char folder[] = "/tmp/kiln-libraries-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/libEGL.so.1", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fclose(file);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        setenv("LD_LIBRARY_PATH", folder, 1);
        execl("/proc/self/exe", "test_host", "--render", (char *)NULL);
        _exit(127);
    }
    int status = 0;
    assert_true(waitpid(child, &status, 0) == child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    unlink(path);
    rmdir(folder);
}

/* ---- bytes ----------------------------------------------------------------------------------- */

/* Of some scenes the PNG as well, drawn once more: it follows from the EXR. (Not of the fountain,
 * of which most is simulation.) */
enum { PNG_STRIDE = 4, PNG_FIRST = 2 };

/* A sample of the scenes leaves out the starlings, whose steps take long. */
enum { SCENE_STRIDE = 5 };

/* The hashes of a frame as EXR with all layers, and as PNG. */
static void hash_frame(struct kiln_device *device, const struct kiln_scene *scene,
                       const char *folder, uint32_t threads, int count, char hashes[2][65])
{
    static const char *const names[2] = {"frame.exr", "frame.png"};
    for (int i = 0; i < count; i++) {
        char path[KILN_PATH_SIZE];
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        render(device, scene, path, threads, NULL);
        assert_true(kiln_hash_sha256_file(path, hashes[i]));
        unlink(path);
    }
}

/* The widest level that there is: the quickest. */
static enum kiln_simd widest(void)
{
    enum kiln_simd simd = KILN_SIMD_COUNT - 1;
    while (simd > kiln_simd_narrowest() && !kiln_simd_has(simd))
        simd--;
    return simd;
}

/* The level that a scene is compared with the widest at: in turn those narrower. */
static enum kiln_simd level_of(size_t scene)
{
    enum kiln_simd narrower[KILN_SIMD_COUNT];
    size_t count = 0;
    for (enum kiln_simd simd = kiln_simd_narrowest(); simd < widest(); simd++) {
        if (kiln_simd_has(simd))
            narrower[count++] = simd;
    }
    return count ? narrower[scene % count] : widest();
}

/* A scene at two levels, and by two numbers of threads. */
static void a_scene_is_the_same_bytes(void **state)
{
    static const uint32_t threads[KILN_SIMD_COUNT] = {1, 5, 3, 2};
    const struct test_scene *given = *state;
    char folder[] = "/tmp/kiln-host-XXXXXX";
    assert_non_null(mkdtemp(folder));
    struct kiln_scene *scene = load_early(given->path);
    const enum kiln_simd levels[2] = {widest(), level_of(given->number / SCENE_STRIDE)};
    int count = given->number % PNG_STRIDE == PNG_FIRST ? 2 : 1;
    char hashes[2][2][65];
    for (int k = 0; k < 2; k++) {
        setenv("KILN_SIMD", kiln_simd_name(levels[k]), 1);
        struct kiln_device *device = open_device(KILN_DEVICE_CPU);
        hash_frame(device, scene, folder, threads[levels[k]] + (uint32_t)k, count, hashes[k]);
        kiln_device_close(&device);
    }
    for (int k = 0; k < count; k++) {
        if (strcmp(hashes[0][k], hashes[1][k]) != 0)
            fail_msg("another %s by %s", k ? "PNG" : "EXR", kiln_simd_name(levels[1]));
    }
    kiln_scene_destroy(&scene);
    unsetenv("KILN_SIMD");
    rmdir(folder);
}

static void wrong_vectors_are_a_usage_error(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_device_params params = kiln_device_defaults();
    params.wanted = KILN_DEVICE_CPU;
    setenv("KILN_SIMD", "mmx", 1);
    assert_null(kiln_device_open(&params, &error));
    expect_error_simd(&error, "mmx");
    unsetenv("KILN_SIMD");
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--render") == 0)
        return render_by_default();
    setenv("XDG_CACHE_HOME", "/dev/null", 1); /* each width of vectors makes its own flipbooks */
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_of_gl_is_loaded),
        cmocka_unit_test(it_is_the_default_where_egl_is_missing),
        cmocka_unit_test(wrong_vectors_are_a_usage_error),
    };
    struct test_list list = {.count = 0};
    test_list_add(&list, tests, sizeof tests / sizeof *tests);
    test_list_add_scenes(&list, (struct CMUnitTest)cmocka_unit_test(a_scene_is_the_same_bytes),
                         SCENE_STRIDE);
    return test_list_run(&list, "host", argc, argv, NULL, NULL);
}
