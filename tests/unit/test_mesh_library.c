/* Meshes are imported once each, and before there are threads: a child of a process with threads
 * may wait for ever for a lock that one of them holds. */
#include <dirent.h>
#include <pthread.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "asset/geometry/mesh_library.h"
#include "kiln.h"
#include "support/cmocka.h"

static const char FOLDER[] = KILN_SOURCE_DIR "/tests/mutation";
#define TETRAHEDRON KILN_SOURCE_DIR "/tests/mutation/tetrahedron.obj"
#define CARD        KILN_SOURCE_DIR "/tests/mutation/card.obj"
#define MOVING      KILN_SOURCE_DIR "/tests/mutation/moving.gltf"

static int forks, forks_with_threads;

static int count_threads(void)
{
    int count = 0;
    DIR *folder = opendir("/proc/self/task");
    assert_non_null(folder);
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL;)
        count += entry->d_name[0] != '.';
    closedir(folder);
    return count;
}

/* Called by every fork. */
static void on_fork(void)
{
    forks++;
    forks_with_threads += count_threads() > 1;
}

/* ---- a library ------------------------------------------------------------------------------- */

static void what_is_there_is_given_again(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_mesh_library *library = kiln_mesh_library_create(FOLDER, NULL, NULL, NULL);
    forks = 0;
    const struct kiln_mesh *plain = kiln_mesh_library_get(library, CARD, &error);
    const struct kiln_mesh *unwrapped = kiln_mesh_library_get_unwrapped(library, CARD, &error);
    const struct kiln_skin *moving = kiln_mesh_library_get_skin(library, MOVING, &error);
    assert_non_null(plain);
    assert_non_null(unwrapped);
    assert_non_null(moving);
    assert_null(plain->uvs);
    assert_non_null(unwrapped->uvs);
    assert_string_equal(plain->hash, unwrapped->hash);
    assert_int_equal(forks, 3);

    assert_ptr_equal(kiln_mesh_library_get_skin(library, MOVING, &error), moving);
    assert_ptr_equal(kiln_mesh_library_get_unwrapped(library, CARD, &error), unwrapped);
    assert_ptr_equal(kiln_mesh_library_get(library, CARD, &error), plain);
    assert_int_equal(forks, 3);
    const struct kiln_mesh *still = kiln_mesh_library_get(library, MOVING, &error);
    assert_non_null(still);
    assert_string_equal(still->hash, kiln_skin_mesh(moving)->hash);
    kiln_mesh_library_destroy(&library);
    assert_null(library);
    kiln_mesh_library_destroy(&library);
}

static void failures_are_told_and_not_kept(void **state)
{
    (void)state;
    struct kiln_mesh_library *library = kiln_mesh_library_create(FOLDER, NULL, NULL, NULL);
    for (int i = 0; i < 2; i++) {
        struct kiln_error error = {0};
        assert_null(kiln_mesh_library_get_skin(library, TETRAHEDRON, &error));
        assert_int_equal(error.code, KILN_INVALID_INPUT);
        assert_string_equal(error.message, TETRAHEDRON ": the file has no animation");
    }
    struct kiln_error error = {0};
    assert_non_null(kiln_mesh_library_get(library, TETRAHEDRON, &error));
    kiln_mesh_library_destroy(&library);
}

/* ---- a render -------------------------------------------------------------------------------- */

static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [32, 18], fps: 30, frames: 2}\n"
    "backdrop:\n"
    "  objects:\n"
    "  - mesh: {file: tetrahedron.obj, collide: true, cells: 8}\n"
    "  - mesh: {file: tetrahedron.obj, collide: true, collider: volume, cells: 8}\n"
    "  - mesh: {file: tetrahedron.obj, collide: true, collider: depth_maps}\n"
    "  - mesh: {file: moving.gltf, animation: {}, collide: true, collider: volume, cells: 8}\n"
    "  - mesh: {file: moving.gltf, animation: {}, position: [1, 0, 0]}\n"
    "  - mesh: {file: card.obj, paint: {size: 16}}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 100, life: 1 s, speed: 1}\n"
    "    collide: {}\n"
    "    paint: {radius: 0.1}\n"
    "    look: {shape: mesh, mesh: {file: tetrahedron.obj}}\n"
    "  b:\n"
    "    emit: {rate: 100, life: 1 s, speed: 1}\n"
    "    look: {shape: mesh, mesh: {file: tetrahedron.obj}}\n";

static void a_render_imports_each_once(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_scene_params params = KILN_SCENE_DEFAULTS;
    params.asset_root = FOLDER;
    forks = forks_with_threads = 0;
    struct kiln_scene *scene = kiln_scene_parse(SCENE, sizeof SCENE - 1, "s", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    assert_int_equal(forks, 3);
    assert_int_equal(forks_with_threads, 0);

    struct kiln_device_params wanted = KILN_DEVICE_DEFAULTS;
    wanted.wanted = KILN_DEVICE_CPU;
    struct kiln_device *device = kiln_device_open(&wanted, &error);
    assert_non_null(device);
    struct kiln_render_params render = KILN_RENDER_DEFAULTS;
    struct kiln_render_stats stats;
    render.threads = 2;
    if (!kiln_render(device, scene, &render, &stats, &error))
        fail_msg("%s", error.message);
    assert_int_equal(forks, 3);
    kiln_device_close(&device);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    if (pthread_atfork(on_fork, NULL, NULL) != 0)
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_there_is_given_again),
        cmocka_unit_test(failures_are_told_and_not_kept),
        cmocka_unit_test(a_render_imports_each_once),
    };
    return cmocka_run_group_tests_name("mesh_library", tests, NULL, NULL);
}
