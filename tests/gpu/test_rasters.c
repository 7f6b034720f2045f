/* The techniques of stage `raster` agree on every scene: the layers of a frame in linear light, as
 * one technique draws them and as the others do. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <glob.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "asset/exr_in.h"
#include "support/device.h"

/* What the others are compared with, and these. */
static const char *const RASTERS[] = {"raster=geometry", "raster=instanced", "raster=tiled",
                                      "raster=cpu"};
enum { RASTER_COUNT = sizeof RASTERS / sizeof *RASTERS };

/* What a technique drew of the frame in the middle of the clip. */
static void render(struct kiln_device *device, const char *scene_path, const char *raster,
                   const char *file)
{
    struct kiln_error error = {0};
    static const char *const overrides[] = {"output.size=[384, 216]", "post.bloom.kind=none"};
    struct kiln_scene_params params = KILN_SCENE_DEFAULTS;
    params.overrides = overrides;
    params.override_count = 2;
    struct kiln_scene *scene = kiln_scene_load(scene_path, &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    uint32_t frame = kiln_scene_info(scene).frames / 2;
    const struct kiln_frame_range range = {frame, frame};
    struct kiln_render_params job = KILN_RENDER_DEFAULTS;
    job.output = file;
    job.ranges = &range;
    job.range_count = 1;
    job.techniques = &raster;
    job.technique_count = 1;
    job.overwrite = true;
    job.exr_bits = 32;
    if (!kiln_render(device, scene, &job, NULL, &error))
        fail_msg("%s", error.message);
    kiln_scene_destroy(&scene);
}

static struct kiln_asset_image *read_layer(const char *path, const char *layer)
{
    struct kiln_error error = {0};
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    size_t size = (size_t)ftell(file);
    rewind(file);
    void *bytes = malloc(size);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, size, file), size);
    fclose(file);
    struct kiln_asset_image *image = kiln_exr_parse(bytes, size, path, layer, &error);
    if (!image)
        fail_msg("%s", error.message);
    free(bytes);
    return image;
}

/* Mean relative error; the share of values that are off by more than 1 % of themselves and a tenth.
 */
struct difference {
    double mean, off;
};

static struct difference measure(const char *const files[2], const char *layer)
{
    struct kiln_asset_image *a = read_layer(files[0], layer), *b = read_layer(files[1], layer);
    size_t floats = (size_t)a->width * a->height * a->channels;
    const float *one = (const float *)a->pixels, *other = (const float *)b->pixels;
    double error_sum = 0, light_sum = 1e-9, off = 0;
    for (size_t i = 0; i < floats; i++) {
        double delta = fabs((double)one[i] - (double)other[i]), light = fabs((double)one[i]);
        error_sum += delta;
        light_sum += light;
        off += delta > 1e-2 * (light + 0.1);
    }
    kiln_asset_image_destroy(&a);
    kiln_asset_image_destroy(&b);
    return (struct difference){error_sum / light_sum, off / (double)floats};
}

/* Sprites of less than a pixel are there or not by the last bit of their place, and a layer is dark
 * but for them; so is a picture of nothing but stars. */
static void compare(const char *scene, size_t technique, const char *const files[2])
{
    static const char *const layers[] = {"beauty", "fire", "smoke", "bloom"};
    const char *name = strrchr(scene, '/') + 1;
    const bool stars = strcmp(name, "galaxy.yaml") == 0;
    for (size_t k = 0; k < 4; k++) {
        struct difference d = measure(files, layers[k]);
        print_message("%-28s %-16s %-7s %.2g %.2g\n", name, RASTERS[technique], layers[k], d.mean,
                      d.off);
        assert_true(d.mean <= (k > 0 ? 2e-2 : stars ? 2e-3 : 1e-3));
        assert_true(d.off <= (stars ? 2e-2 : k > 0 ? 6e-3 : 3e-3));
    }
}

static void techniques_agree_on_every_scene(void **state)
{
    glob_t scenes;
    assert_int_equal(glob(KILN_SOURCE_DIR "/scenes/*.yaml", 0, NULL, &scenes), 0);
    assert_true(scenes.gl_pathc >= 10);
    char folder[] = "/tmp/kiln_rasters_XXXXXX", paths[2][64];
    assert_non_null(mkdtemp(folder));
    for (int i = 0; i < 2; i++)
        snprintf(paths[i], sizeof paths[i], "%s/%d.exr", folder, i);
    const char *const files[2] = {paths[0], paths[1]};
    for (size_t i = 0; i < scenes.gl_pathc; i++) {
        render(*state, scenes.gl_pathv[i], RASTERS[0], files[0]);
        for (size_t k = 1; k < RASTER_COUNT; k++) {
            render(*state, scenes.gl_pathv[i], RASTERS[k], files[1]);
            compare(scenes.gl_pathv[i], k, files);
        }
    }
    for (int i = 0; i < 2; i++)
        unlink(files[i]);
    rmdir(folder);
    globfree(&scenes);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(techniques_agree_on_every_scene),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
