/* Loads scenes from texts and files, and prints them as texts, for tests. Only try_scene returns an
 * error; in the other functions an error fails the test. */
#include "support/scenes.h"

#include <stdio.h>
#include <string.h>

#include "scene/scene.h"
#include "support/cmocka.h"

struct kiln_scene *try_scene(const char *text, const char *const *overrides,
                             struct kiln_error *error)
{
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = overrides;
    while (overrides && overrides[params.override_count])
        params.override_count++;
    return kiln_scene_parse(text, strlen(text), SCENE_NAME, &params, error);
}

struct kiln_scene *load_scene(const char *text, const char *const *overrides)
{
    struct kiln_error error = {0};
    struct kiln_scene *scene = try_scene(text, overrides, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

struct kiln_scene *load_scene_file(const char *path)
{
    struct kiln_error error = {0};
    struct kiln_scene *scene = kiln_scene_load(path, NULL, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

struct kiln_scene *load_coarse_scene(const char *path, const char *const *overrides)
{
    struct kiln_error error = {0};
    const char *list[5] = {NULL};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = list;
    while (overrides[params.override_count] && params.override_count < 4) {
        list[params.override_count] = overrides[params.override_count];
        params.override_count++;
    }
    struct kiln_scene *scene = kiln_scene_load(path, &params, &error);
    if (scene && scene->gas_count > 0) {
        list[params.override_count++] = "gas.*.cells=40";
        kiln_scene_destroy(&scene);
        scene = kiln_scene_load(path, &params, &error);
    }
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

struct kiln_scene *load_fixture(const char *name, const char *override)
{
    char path[256];
    const char *const overrides[] = {override};
    const struct kiln_scene_params params = {.size = sizeof params,
                                             .asset_root = KILN_SOURCE_DIR,
                                             .overrides = overrides,
                                             .override_count = override != NULL};
    struct kiln_error error = {0};
    snprintf(path, sizeof path, KILN_SOURCE_DIR "/tests/motion/%s.yaml", name);
    struct kiln_scene *scene = kiln_scene_load(path, &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

char *print_scene(const struct kiln_scene *scene)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_true(kiln_scene_print(scene, out));
    assert_int_equal(fclose(out), 0);
    return text;
}
